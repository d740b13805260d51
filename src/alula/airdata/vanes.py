"""Angle vanes: what they read, and the flow at the center of gravity from what they read.

Fronts of core/include/alula/airdata/vane.hpp. Angles rad, body axes, m, m/s, rad/s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, warn
from alula.core import core


@dataclass(frozen=True)
class Vane:
    """upwash: relative, 0.1 reads a tenth too much. bias: rad. arm: from the center of gravity."""

    upwash: float = 0.0
    bias: float = 0.0
    arm: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def numbers(self) -> Array:
        """As the core takes it."""
        return np.array([self.upwash, self.bias, *self.arm])


@dataclass(frozen=True)
class CenterFlow:
    """Flow at the center of gravity, (n,) each: V m/s, alpha, beta rad; NaN where refused."""

    V: Array
    alpha: Array
    beta: Array
    messages: tuple[Message, ...] = ()


def vane_readings(alpha: Vane, beta: Vane, velocity: Array, rates: Array) -> tuple[Array, Array]:
    """Readings (n,) of the alpha and the beta vane; velocity, rates: (n, 3) of the center.

    The beta vane reads the flank angle atan(v/u) of the flow at its place.
    """
    out = np.empty((len(velocity), 2))
    core.vane_readings(alpha.numbers(), beta.numbers(), _rows(velocity), _rows(rates), out)
    return out[:, 0], out[:, 1]


def flow_from_vanes(
    alpha: Vane,
    beta: Vane,
    alpha_reading: ArrayLike,
    beta_reading: ArrayLike,
    V: ArrayLike,
    rates: Array,
    pitot: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> CenterFlow:
    """Flow at the center of gravity of readings (n,) of both vanes and airspeed at `pitot`.

    rates: (n, 3) rad/s. Samples without such a flow are NaN, and counted in the messages.
    """
    readings = np.column_stack(np.broadcast_arrays(alpha_reading, beta_reading, V))
    out = np.empty((len(readings), 3))
    refused = core.flow_from_vanes(
        alpha.numbers(), beta.numbers(), np.array(pitot, dtype=np.float64), _rows(readings),
        _rows(rates), out,
    )  # fmt: skip
    messages = (
        (
            warn(
                "vane_reading",
                where="angle vanes",
                expected="readings within 80 deg and a positive airspeed",
                found=f"something else in {refused} of {len(out)} samples",
                do="These samples are NaN; look at the vanes and the airspeed there.",
            ),
        )
        if refused
        else ()
    )
    return CenterFlow(frozen(out[:, 0]), frozen(out[:, 1]), frozen(out[:, 2]), messages)


def beta_of_flank(flank: ArrayLike, alpha: ArrayLike) -> Array:
    """Sideslip asin(v/V) of the flank angle atan(v/u), at alpha = atan(w/u)."""
    return np.asarray(np.arctan(np.tan(flank) * np.cos(alpha)))


def flank_of_beta(beta: ArrayLike, alpha: ArrayLike) -> Array:
    """Flank angle atan(v/u) of the sideslip asin(v/V), at alpha = atan(w/u)."""
    return np.asarray(np.arctan2(np.sin(beta), np.cos(beta) * np.cos(alpha)))


def _rows(values: ArrayLike) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64)
