"""Static-pressure port: correction fitted to CFD or flight points, and applied.

Pusztai 2018, Eq. (3.10), (3.11): p_air = p_port + (rho/rho_0)(b U + c U^2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.core import core


@dataclass(frozen=True)
class StaticPort:
    """linear: Pa s/m. quadratic: Pa s2/m2. density: kg/m3 of the calibration. fastest: m/s, end of
    it, beyond which the pressure coefficient is held. rms: Pa, of the fit."""

    linear: float
    quadratic: float
    density: float
    fastest: float
    rms: float = 0.0

    def correction(self, U: ArrayLike, density: ArrayLike) -> Array:
        """Air's pressure less the port's, Pa, at forward speeds (n,) m/s and densities kg/m3."""
        u, rho = np.broadcast_arrays(
            np.asarray(U, dtype=np.float64), np.asarray(density, dtype=np.float64)
        )
        out = np.empty(u.size)
        core.static_pressure_correction(
            self.linear, self.quadratic, self.density, self.fastest,
            np.ascontiguousarray(u).reshape(-1), np.ascontiguousarray(rho).reshape(-1), out,
        )  # fmt: skip
        return out.reshape(u.shape)


def fit_static_port(U: ArrayLike, correction: ArrayLike, density: float) -> StaticPort:
    """Least squares on speeds (n,) m/s and corrections (n,) Pa: air's pressure less the port's.

    Raises BadInput for fewer than 4 points, or values that are not finite or no speeds.
    """
    u, dp = (np.array(a, dtype=np.float64).ravel() for a in (U, correction))
    sound = u.shape == dp.shape and len(u) >= 4 and bool(np.isfinite(u).all() and np.all(u > 0.0))
    if not sound or not np.isfinite(dp).all() or not density > 0.0:
        raise refuse(
            "static_port_points",
            where="static-port calibration",
            expected="four or more finite points at positive speeds, and a density",
            found=f"{len(u)} speeds, {len(dp)} pressures, density {density:g}",
            do="Give U in m/s, the correction in Pa and the density in kg/m3.",
        )
    x = np.column_stack([u, u**2])
    (b, c), *_ = np.linalg.lstsq(x, dp, rcond=None)
    rms = float(np.sqrt(np.mean((dp - x @ (b, c)) ** 2)))
    return StaticPort(float(b), float(c), density, float(np.max(u)), rms)
