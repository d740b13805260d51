"""Flying an aircraft through the core's equations of motion: the truth of a virtual flight."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.flight import Maneuver, Motion
from alula.model import AXES, AeroModel
from alula.simulate.airframe import GRAVITY, Airframe, core_model

CONTROLS = ("de", "da", "dr", "df", "dt", "thrust")  # the core's inputs, in its order


@dataclass(frozen=True)
class SimulatedFlight:
    """What the aircraft did, without any sensor between.

    motion: as reconstruction would give it, coefficients in `motion.recorded`. position: (n, 3)
    m NED. velocity: (n, 3) m/s against the Earth, NED. air_velocity: (n, 3) m/s body axes.
    mach: (n,).
    """

    motion: Motion
    position: Array
    velocity: Array
    air_velocity: Array
    mach: Array


def initial_state(
    V: float,
    alpha: float,
    theta: float,
    h: float,
    *,
    beta: float = 0.0,
    phi: float = 0.0,
    psi: float = 0.0,
    rates: tuple[float, float, float] = (0.0, 0.0, 0.0),
    wind: Array | None = None,
) -> Array:
    """State (13,) of the core for an airspeed (m/s), flow and Euler angles (rad), height (m).

    rates: p q r, rad/s; wind: (3,) NED m/s, the way it blows to.
    """
    quaternion = np.empty(4)
    core.quaternion_from_euler(phi, theta, psi, quaternion)
    air = V * np.array([np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)])
    state = np.concatenate([[0.0, 0.0, -h], quaternion, air, rates])
    if wind is not None:
        state[7:10] += attitudes(state[None])[1][0] @ wind
    return state


def attitudes(states: Array) -> tuple[Array, Array]:
    """Euler angles (n, 3) rad and R_BE (n, 3, 3) of the core's states (n, 13)."""
    euler, rotation = np.empty((len(states), 3)), np.empty((len(states), 3, 3))
    core.attitudes(states, euler, rotation)
    return euler, rotation


def fly(
    airframe: Airframe,
    model: AeroModel,
    x0: Array,
    t: Array,
    controls: Mapping[str, Array | float],
    *,
    wind: Array | None = None,
    gravity: float = GRAVITY,
    substeps: int = 1,
    maneuver: Maneuver | None = None,
) -> SimulatedFlight:
    """Fly from x0 (13,), see `initial_state`, over times t (n,) of even spacing.

    controls: `de da dr df` rad, `dt`, `thrust` N, each (n,) or one number; absent ones are zero;
    straight lines between samples. substeps: RK4 steps per sample. Raises BadInput where time is
    not even, a control is unknown or not finite, or the flight diverges.
    """
    t = np.asarray(t, dtype=np.float64)
    dt = (t[-1] - t[0]) / (len(t) - 1) if len(t) > 1 else 0.0
    if not dt > 0.0 or np.max(np.abs(np.diff(t) - dt)) > 1e-6 * dt:
        raise refuse(
            "uneven_time",
            where="simulation",
            expected="at least two times of even, increasing spacing",
            found=f"{len(t)} times, mean step {dt:g} s",
            do="Give evenly spaced times.",
        )
    inputs = _inputs(controls, len(t))
    states, outputs = np.empty((len(t), 13)), np.empty((len(t), 17))
    start = np.ascontiguousarray(x0, dtype=np.float64)
    flown = core_model(airframe, model, wind, gravity).fly(
        start, inputs, dt, substeps, states, outputs
    )
    if flown < len(t):
        raise refuse(
            "diverged",
            where=f"simulation, t = {t[flown]:g} s",
            expected="a finite state",
            found="a state that grew without bound",
            do="Check the model's signs, the mass properties and the inputs.",
        )
    maneuver = maneuver or Maneuver("flight", "simulation", "simulated", float(t[0]), float(t[-1]))
    return _as_flight(model, maneuver, t, inputs, states, outputs)


def _inputs(controls: Mapping[str, Array | float], n: int) -> Array:
    out = np.zeros((n, len(CONTROLS)))
    for name, values in controls.items():
        if name not in CONTROLS:
            raise refuse(
                "unknown_control",
                where="simulation",
                expected=f"one of {', '.join(CONTROLS)}",
                found=f"'{name}'",
                do="Use Alula's names of the controls.",
            )
        column = np.asarray(values, dtype=np.float64)
        if column.shape not in ((), (n,)) or not np.isfinite(column).all():
            raise refuse(
                "bad_control",
                where=f"simulation, control {name}",
                expected=f"{n} finite numbers or one",
                found=f"shape {column.shape}",
                do="Give one value per time.",
            )
        out[:, CONTROLS.index(name)] = column
    return out


def _as_flight(
    model: AeroModel, maneuver: Maneuver, t: Array, inputs: Array, states: Array, outputs: Array
) -> SimulatedFlight:
    euler, R = attitudes(states)
    ax, ay, az, pdot, qdot, rdot, V, alpha, beta, mach, rho = (frozen(c) for c in outputs.T[:11])
    p, q, r = (frozen(c) for c in states.T[10:13])
    motion = Motion(
        maneuver=maneuver,
        t=frozen(t),
        V=V, alpha=alpha, beta=beta,
        p=p, q=q, r=r,
        pdot=pdot, qdot=qdot, rdot=rdot,
        ax=ax, ay=ay, az=az,
        phi=frozen(euler[:, 0]), theta=frozen(euler[:, 1]), psi=frozen(euler[:, 2]),
        h=frozen(-states[:, 2]),
        rho=rho,
        controls={name: frozen(inputs[:, i]) for i, name in enumerate(CONTROLS[:5])},
        thrust=frozen(inputs[:, 5]),
        recorded={c: frozen(outputs[:, 11 + i]) for i, c in enumerate(AXES[model.axes])},
    )  # fmt: skip
    cosine = np.cos(beta)
    air = np.stack([np.cos(alpha) * cosine, np.sin(beta), np.sin(alpha) * cosine], axis=1)
    return SimulatedFlight(
        motion=motion,
        position=frozen(states[:, :3]),
        velocity=frozen(np.einsum("nij,ni->nj", R, states[:, 7:10])),
        air_velocity=frozen(V[:, None] * air),
        mach=mach,
    )
