"""Steady straight flight: the angle of attack, elevator and thrust that hold it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.model import AeroModel
from alula.simulate.airframe import GRAVITY, Airframe, core_model
from alula.simulate.fly import initial_state

_TOLERANCE = 1e-8  # m/s2 and rad/s2 (times one meter): far below any sensor


@dataclass(frozen=True)
class Trim:
    """A steady flight condition: state (13,), controls by name, angles (rad), thrust (N)."""

    state: Array
    controls: dict[str, float]
    alpha: float
    theta: float
    thrust: float
    residual: float  # largest rate left, m/s2 or rad/s2


def trim_level(
    airframe: Airframe,
    model: AeroModel,
    V: float,
    h: float,
    *,
    gamma: float = 0.0,
    psi: float = 0.0,
    controls: dict[str, float] | None = None,
    limits: dict[str, tuple[float, float]] | None = None,
    wind: Array | None = None,
    gravity: float = GRAVITY,
) -> Trim:
    """Trim wings level at airspeed V (m/s), height h (m) and climb angle gamma (rad).

    Unknowns: alpha, de, thrust. limits: their ranges, rad, rad, N; default -20 to 20 deg, -30 to
    30 deg, no negative thrust. controls: the others, held. Solved by bounded least squares on the
    rates of u, w, q. Raises BadInput naming the limit that is reached where there is no such
    flight.
    """
    bounds = {
        "alpha": (-0.35, 0.35),
        "de": (-0.5236, 0.5236),
        "thrust": (0.0, 10.0 * airframe.mass),
        **(limits or {}),
    }
    names = ("alpha", "de", "thrust")
    held = {"da": 0.0, "dr": 0.0, "df": 0.0, "dt": 0.0, **(controls or {})}
    aircraft = core_model(airframe, model, wind, gravity)
    dx, y = np.empty(13), np.empty(17)

    def state_at(alpha: float) -> Array:
        return initial_state(V, alpha, gamma + alpha, h, psi=psi, wind=wind)

    def rates(z: Array) -> Array:
        alpha, de, thrust = (float(s) for s in z * scale)
        u = np.array([de, held["da"], held["dr"], held["df"], held["dt"], thrust])
        aircraft.rates(state_at(alpha), u, dx, y)
        return np.array([dx[7], dx[9], dx[11]])

    scale = np.array([0.1, 0.1, airframe.mass])  # the unknowns in sizes near one
    low, high = np.array([bounds[n] for n in names]).T / scale
    start = np.clip(np.array([0.05, 0.0, 1.0 * airframe.mass]) / scale, low, high)
    solution = least_squares(rates, start, bounds=(low, high), xtol=1e-15, ftol=1e-15, gtol=1e-15)
    residual = float(np.max(np.abs(rates(solution.x))))
    alpha, de, thrust = (float(s) for s in solution.x * scale)
    if residual > _TOLERANCE:
        at_limit = [n for n, active in zip(names, solution.active_mask, strict=True) if active]
        raise refuse(
            "no_trim",
            where=f"trim at V = {V:g} m/s, h = {h:g} m",
            expected="a steady flight within the limits",
            found=f"rates of {residual:.2g} left; at its limit: {', '.join(at_limit) or 'nothing'}",
            do="Choose another airspeed or height, or widen the limits.",
        )
    return Trim(
        state=state_at(alpha),
        controls={"de": de, **held},
        alpha=alpha,
        theta=gamma + alpha,
        thrust=thrust,
        residual=residual,
    )
