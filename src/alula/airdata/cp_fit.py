"""Pressure coefficient of a probe's port over the flow angle, fitted to CFD or tunnel points.

Pusztai 2018, Eq. (3.5): c_p = a1 sin 2 theta + a2 cos 2 theta + a3. The sine and the cosine are one
cosine of free phase, A cos 2 (theta - phase): the tip does not see the flow quite as a sphere does,
which turns every side port by the phase. `as_port_angle` takes it that way, which keeps the
pattern smooth and symmetric for flow from any side; a sine of theta itself has a cone at zero.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse

LARGEST_POWERS = 9  # of cos(theta) that the core holds


@dataclass(frozen=True)
class Cp:
    """c_p(theta) = sum of power[k] cos^k(theta) + sine sin(2 theta).

    low, high: rad, the flow angles that the points covered.
    """

    power: Array
    sine: float = 0.0
    low: float = 0.0
    high: float = float(np.pi / 2)

    def __call__(self, theta: ArrayLike) -> Array:
        """c_p at flow angles theta, rad."""
        theta = np.asarray(theta, dtype=np.float64)
        even = np.polynomial.polynomial.polyval(np.cos(theta), self.power)
        return np.asarray(even + self.sine * np.sin(2.0 * theta))


def harmonic_cp(cosines: ArrayLike, low: float = 0.0, high: float = np.pi / 2) -> Cp:
    """c_p = sum of cosines[k] cos(k theta)."""
    return Cp(frozen(chebyshev.cheb2poly(np.asarray(cosines, dtype=np.float64))), 0.0, low, high)


def approximated_cp(
    cp: Callable[[Array], Array], low: float, high: float, harmonics: int = 8
) -> tuple[Cp, float]:
    """Any c_p(theta) as cosines of theta and its multiples, and the largest error on [low, high].

    For fits that the core has no form for. low, high: rad.
    """
    theta = np.linspace(low, high, 400)
    basis = np.cos(np.outer(theta, np.arange(harmonics + 1)))
    wanted = np.asarray(cp(theta), dtype=np.float64)
    # On less than half a turn the cosines are nearly dependent: the shortest of the equally good.
    cosines = np.linalg.lstsq(basis, wanted, rcond=1e-9)[0]
    return harmonic_cp(cosines, low, high), float(np.max(np.abs(basis @ cosines - wanted)))


@dataclass(frozen=True)
class CpFit:
    """Three-term fit: a1 sin 2 theta + a2 cos 2 theta + a3, with covariance (3, 3).

    theta, cp: the points; rms, largest: of what is left.
    """

    a: Array
    covariance: Array
    theta: Array
    cp: Array
    rms: float
    largest: float

    @property
    def amplitude(self) -> float:
        """A of A cos 2 (theta - phase) + a3."""
        return float(np.hypot(self.a[0], self.a[1]))

    @property
    def phase(self) -> float:
        """By which a side port is turned toward the tip, rad."""
        return float(0.5 * np.arctan2(self.a[0], self.a[1]))

    def as_printed(self) -> Cp:
        """The three terms over the port's own flow angle."""
        low, high = float(np.min(self.theta)), float(np.max(self.theta))
        a1, a2, a3 = self.a
        return Cp(frozen([a3 - a2, 0.0, 2.0 * a2]), float(a1), low, high)

    def as_port_angle(self) -> Cp:
        """A cos 2 theta + a3, for a port turned by the phase: `port_angle - phase`."""
        A, a3 = self.amplitude, float(self.a[2])
        low, high = np.min(self.theta) - self.phase, np.max(self.theta) - self.phase
        return Cp(frozen([a3 - A, 0.0, 2.0 * A]), 0.0, float(low), float(high))


def fit_cp(theta: ArrayLike, cp: ArrayLike) -> CpFit:
    """Least squares of Eq. (3.5) on points theta (n,) rad, the port's flow angle, and c_p (n,).

    Raises BadInput for fewer than 6 points, values that are not finite, or angles that do not
    tell the three terms apart.
    """
    theta, cp = (np.array(a, dtype=np.float64).ravel() for a in (theta, cp))
    if theta.shape != cp.shape or len(theta) < 6 or not np.isfinite(theta).all():
        raise _points(f"{len(theta)} angles and {len(cp)} coefficients")
    if not np.isfinite(cp).all():
        raise _points(f"{int(np.sum(~np.isfinite(cp)))} coefficients that are not finite")
    x = np.column_stack([np.sin(2 * theta), np.cos(2 * theta), np.ones_like(theta)])
    if np.linalg.cond(x) > 1e3:
        raise _points(f"angles from {np.degrees(theta.min()):.3g} to {np.degrees(theta.max()):.3g}")
    a = np.linalg.lstsq(x, cp, rcond=None)[0]
    left = cp - x @ a
    variance = float(left @ left) / (len(theta) - 3)
    return CpFit(
        a=frozen(a),
        covariance=frozen(variance * np.linalg.inv(x.T @ x)),
        theta=frozen(theta),
        cp=frozen(cp),
        rms=float(np.sqrt(np.mean(left**2))),
        largest=float(np.max(np.abs(left))),
    )


def _points(found: str) -> Exception:
    return refuse(
        "probe_points",
        where="c_p points of the probe",
        expected="six or more finite points over at least 45 deg of flow angle",
        found=found,
        do="Give the flow angle of the port in rad (tunnel angle plus port angle) and c_p.",
    )


def read_points(path: Path, columns: tuple[int, ...]) -> Array:
    """Columns (0-based) of an ANSYS parameter table: comments, one line of names, then rows.

    Returns (n, k). Raises BadInput where there is no such table.
    """
    rows = []
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
        body = [line for line in lines if line.strip() and not line.lstrip().startswith("#")][1:]
        rows = [[float(line.split(",")[k]) for k in columns] for line in body]
    except (OSError, UnicodeDecodeError, ValueError, IndexError) as error:
        raise refuse(
            "probe_table",
            where=str(path),
            expected="a comma-separated table with a line of names",
            found=str(error),
            do="Export the parameter table again.",
        ) from None
    return np.array(rows, dtype=np.float64).reshape(-1, len(columns))
