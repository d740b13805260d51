"""A finite surface's section coefficients over the whole circle: flat plate behind stall.

Viterna and Corrigan, NASA CP-2230, 1982: behind the last known angle lift and drag go over to
those of a plate of the surface's aspect ratio; the pitching moment follows from the plate's center
of pressure (Hoerner's data, as in Khan and Nahon, AIAA 2015-2768).
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from alula.aircraft.geometry import Polar
from alula.base.arrays import Array, frozen

STEPS = 721  # every half degree
_REAR = 0.7  # lift of flow from behind over that from ahead, Montgomerie 1996
_LEAST_DRAG = 0.02


def plate_drag(aspect: float) -> float:
    """Drag coefficient of a plate across the flow (Viterna and Corrigan 1982), up to A = 50."""
    return 1.11 + 0.018 * min(aspect, 50.0)


def full_circle(polar: Polar, k: float, induced: float, aspect: float) -> Array:
    """c_l, c_d, c_m (3, 721) over -180 to 180 deg as the core's sections take them.

    k: lift of the finite surface over that of its sections; induced: 1/(pi e A). c_l holds k; c_d
    leaves out the induced drag c_l^2 `induced`, which the core adds, so that behind stall their sum
    is the plate's.
    """
    alpha = np.linspace(-np.pi, np.pi, STEPS)
    low, high = float(polar.alpha[0]), float(polar.alpha[-1])
    known = (alpha >= low) & (alpha <= high)
    c_l, c_d, c_m = (np.empty(STEPS) for _ in range(3))
    lift, drag, moment = (
        PchipInterpolator(polar.alpha, y) for y in (k * polar.c_l, polar.c_d, polar.c_m)
    )
    c_l[known], c_d[known], c_m[known] = (
        lift(alpha[known]),
        drag(alpha[known]),
        moment(alpha[known]),
    )
    for side, end in ((1.0, high), (-1.0, low)):
        rows = side * alpha > side * end
        at = (
            side * float(lift(end)),
            float(drag(end)) + induced * float(lift(end)) ** 2,
            side * float(moment(end)),
        )
        a, d, m = _behind(side * alpha[rows], side * end, at, aspect)
        c_l[rows], c_m[rows] = side * a, side * m
        c_d[rows] = d - induced * a**2
    # Both branches meet in flow straight from behind.
    for y in (c_l, c_d, c_m):
        y[0] = y[-1] = 0.5 * (y[0] + y[-1])
    return frozen([c_l, c_d, c_m])


def _behind(
    alpha: Array, stall: float, at: tuple[float, float, float], aspect: float
) -> tuple[Array, Array, Array]:
    """Lift, whole drag and moment at angles (n,) from `stall` to 180 deg; at: those at `stall`."""
    most = plate_drag(aspect)
    s, c = np.sin(stall), np.cos(stall)
    A2 = (at[0] - most * s * c) * s / c**2
    B2 = (at[1] - most * s**2) / c
    front = np.minimum(alpha, np.pi - alpha)  # as if from ahead
    inner = np.clip(front, stall, None)
    sine, cosine = np.sin(inner), np.cos(inner)
    c_l = most * sine * cosine + A2 * cosine**2 / sine
    c_d = most * sine**2 + B2 * cosine
    rear = alpha > 0.5 * np.pi
    # Within `stall` of flow from behind the lift goes to zero in a straight line.
    c_l = np.where(rear, -_REAR * c_l * np.minimum(front / stall, 1.0), c_l)
    c_d = np.maximum(c_d, _LEAST_DRAG)

    def plate(a: Array, lift: Array, total: Array) -> Array:
        normal = lift * np.cos(a) + total * np.sin(a)
        return np.asarray(-normal * (0.25 - 0.175 * (1.0 - 2.0 * a / np.pi)))

    start = at[2] - float(plate(np.array(stall), np.array(at[0]), np.array(at[1])))
    fade = np.where(rear, 0.0, (np.cos(alpha) / c) ** 2)
    return c_l, c_d, plate(alpha, c_l, c_d) + start * fade
