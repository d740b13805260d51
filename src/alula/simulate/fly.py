"""Flying an aircraft through the core's equations of motion: the truth of a virtual flight."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse
from alula.core import core
from alula.flight import Maneuver, Motion
from alula.model import AXES, AeroModel
from alula.simulate.airframe import GRAVITY, Airframe, Earth, core_model
from alula.simulate.flight_check import check_step, outside_validity
from alula.simulate.pilot import Pilot
from alula.simulate.wind import Turbulence, Wind

CONTROLS = ("de", "da", "dr", "df", "dt", "thrust")  # the core's first inputs, in its order
BODY_STATES = 13


@dataclass(frozen=True)
class SimulatedFlight:
    """What the aircraft did, without any sensor between.

    motion: as reconstruction would give it, coefficients in `motion.recorded`, controls as they
    stood (behind actuators). position: (n, 3) north, east, down, m; on WGS-84 latitude, longitude
    (rad), height (m). velocity: (n, 3) m/s against the Earth, NED. air_velocity: (n, 3) m/s body
    axes. mach: (n,). states: further states (n,) by name: rotor speeds 'omega' rad/s, 'power',
    'charge' A s, separation 'X', actuators, 'fuel_used' kg. inputs: (n, 12) as flown, pilot, gusts
    and turbulence included: de da dr df dt thrust ug vg wg pg qg rg. engine_force (N),
    engine_moment (N m, about the center of gravity): (n, 3) body axes. plant_states: (n, k), all
    states of the core; any row starts a flight. messages: what was noticed.
    """

    motion: Motion
    position: Array
    velocity: Array
    air_velocity: Array
    mach: Array
    states: Mapping[str, Array] = field(default_factory=dict)
    inputs: Array = field(default_factory=lambda: frozen(np.zeros((0, 12))))
    engine_force: Array = field(default_factory=lambda: frozen(np.zeros((0, 3))))
    engine_moment: Array = field(default_factory=lambda: frozen(np.zeros((0, 3))))
    plant_states: Array = field(default_factory=lambda: frozen(np.zeros((0, BODY_STATES))))
    messages: tuple[Message, ...] = ()


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
    earth: Earth = "flat",
    latitude: float = 0.0,
    longitude: float = 0.0,
) -> Array:
    """State (13,) of the core for an airspeed (m/s), flow and Euler angles (rad), height (m).

    rates: p q r against inertial space, rad/s; wind: (3,) NED m/s, the way it blows to. latitude,
    longitude: geodetic, rad, on WGS-84.
    """
    position, quaternion = np.array([0.0, 0.0, -h]), np.empty(4)
    if earth == "wgs84":
        core.ecef_state(latitude, longitude, h, phi, theta, psi, position, quaternion)
    else:
        core.quaternion_from_euler(phi, theta, psi, quaternion)
    air = V * np.array([np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)])
    state = np.concatenate([position, quaternion, air, rates])
    if wind is not None:
        state[7:10] += attitudes(state[None], earth)[1][0] @ wind
    return state


def attitudes(states: Array, earth: Earth = "flat") -> tuple[Array, Array]:
    """Euler angles (n, 3) rad and R_BE (n, 3, 3) from NED of the core's states (n, 13 or more)."""
    return _attitudes(states, earth)[:2]


def _attitudes(states: Array, earth: Earth) -> tuple[Array, Array, Array]:
    """Also the places (n, 3): north, east, height, or latitude, longitude, height."""
    n = len(states)
    euler, rotation, where = np.empty((n, 3)), np.empty((n, 3, 3)), np.empty((n, 3))
    core.attitudes(np.ascontiguousarray(states), euler, rotation, where, earth == "wgs84")
    return euler, rotation, where


def fly(
    airframe: Airframe,
    model: AeroModel,
    x0: Array,
    t: Array,
    controls: Mapping[str, Array | float],
    *,
    wind: Array | Wind | None = None,
    gravity: float = GRAVITY,
    substeps: int = 1,
    maneuver: Maneuver | None = None,
    hold: bool = False,
    gusts: Array | None = None,
    turbulence: Turbulence | None = None,
    pilot: Pilot | None = None,
    stall: bool = True,
    check: bool = True,
) -> SimulatedFlight:
    """Fly from x0 over times t (n,) of even spacing.

    x0: (13,), see `initial_state` (rotors, separation, actuators then start as they come to rest
    in that motion), or all states of the core. controls: `de da dr df` rad, `dt`, `thrust` N, each
    (n,) or one number; absent ones are zero; straight lines between samples, or held. substeps:
    RK4 steps per sample. gusts: (n, 6) ug vg wg m/s, pg qg rg rad/s, body axes. stall: False
    leaves the model's stall out. check: refuse a step that is too large for the fastest mode of
    the start, and warn of a coarse one. Raises BadInput where time is not even, a control is
    unknown or not finite, the step is too large, or the flight diverges.
    """
    t, dt = even_times(t)
    n = len(t)
    inputs = control_rows(controls, n)
    plant = core_model(airframe, model, wind, gravity, stall=stall)
    extra: dict[str, Any] = {} if pilot is None else pilot.arguments(n)
    if gusts is not None:
        extra["gusts"] = gust_rows(gusts, n)
    if turbulence is not None:
        extra |= turbulence.arguments(model.reference.b, (n - 1) * substeps + 1)
    start = full_start(plant, x0, inputs[0])
    messages: tuple[Message, ...] = ()
    if check:
        A = plant.jacobian(start, inputs[0])[0]
        messages = check_step(A, dt / substeps)
    states, outputs = np.empty((n, plant.state_count)), np.empty((n, plant.output_count))
    flown_inputs = np.empty((n, plant.input_count))
    flown = plant.fly(start, inputs, dt, substeps, states, outputs, flown_inputs, hold, **extra)
    if flown < n:
        raise refuse("diverged", **divergence("simulation", float(t[flown])))
    maneuver = maneuver or Maneuver("flight", "simulation", "simulated", float(t[0]), float(t[-1]))
    names = plant.further_states
    return as_flight(airframe, model, maneuver, t, names, states, outputs, flown_inputs, messages)


def even_times(t: Array) -> tuple[Array, float]:
    """Times (n,), s, and their step; raises BadInput where they are not even."""
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
    return t, float(dt)


def divergence(where: str, t: float) -> dict[str, str]:
    """What is said of a flight whose state stopped being finite at t, s."""
    return {
        "where": f"{where}, t = {t:g} s",
        "expected": "a finite state",
        "found": "a state that grew without bound",
        "do": "Check the model's signs, the mass properties and the inputs.",
    }


def full_start(plant: Any, x0: Array, u: Array) -> Array:
    """All states to start from, of 13 or all, under input u (6,)."""
    start = np.array(x0, dtype=np.float64)
    if start.shape not in ((BODY_STATES,), (plant.state_count,)):
        raise refuse(
            "initial_state",
            where="simulation",
            expected=f"13 states, or {plant.state_count}: {', '.join(plant.further_states)} too",
            found=f"shape {start.shape}",
            do="Use initial_state, a trim of the same aircraft, or a row of plant_states.",
        )
    if len(start) == plant.state_count:
        return start
    settled = np.zeros(plant.state_count)
    plant.settle(start, u, settled)
    return settled


def control_rows(controls: Mapping[str, Array | float], n: int) -> Array:
    """Rows (n, 6) of the core's first inputs; raises BadInput for what is not one."""
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


def gust_rows(gusts: Array, n: int) -> Array:
    """Gusts (n, 6) as the core takes them; raises BadInput for others."""
    out = np.ascontiguousarray(gusts, dtype=np.float64)
    if out.shape != (n, 6) or not np.isfinite(out).all():
        raise refuse(
            "bad_gust",
            where="simulation, gusts",
            expected=f"finite numbers of shape ({n}, 6): ug vg wg m/s, pg qg rg rad/s",
            found=f"shape {out.shape}",
            do="Give one row per time.",
        )
    return out


def as_flight(
    airframe: Airframe,
    model: AeroModel,
    maneuver: Maneuver,
    t: Array,
    names: list[str],
    states: Array,
    outputs: Array,
    inputs: Array,
    messages: tuple[Message, ...],
) -> SimulatedFlight:
    """What the core wrote at times t (n,) as a flight; names: of the further states.

    states and inputs belong to the flight from here on and can no more be written to.
    """
    states.setflags(write=False)
    inputs.setflags(write=False)
    euler, R, where = _attitudes(states, airframe.earth)
    ax, ay, az, pdot, qdot, rdot, V, alpha, beta, mach, rho = (frozen(c) for c in outputs.T[:11])
    p, q, r = (frozen(c) for c in states.T[10:13])
    further = {name: frozen(states[:, BODY_STATES + i]) for i, name in enumerate(names)}
    # Behind an actuator a control stands where the actuator is.
    controls = {
        name: further.get(name, frozen(inputs[:, i])) for i, name in enumerate(CONTROLS[:5])
    }
    motion = Motion(
        maneuver=maneuver,
        t=frozen(t),
        V=V, alpha=alpha, beta=beta,
        p=p, q=q, r=r,
        pdot=pdot, qdot=qdot, rdot=rdot,
        ax=ax, ay=ay, az=az,
        phi=frozen(euler[:, 0]), theta=frozen(euler[:, 1]), psi=frozen(euler[:, 2]),
        h=frozen(where[:, 2]),
        rho=rho,
        controls=controls,
        thrust=frozen(outputs[:, 23]),
        recorded={c: frozen(outputs[:, 11 + i]) for i, c in enumerate(AXES[model.axes])},
    )  # fmt: skip
    cosine = np.cos(beta)
    air = np.stack([np.cos(alpha) * cosine, np.sin(beta), np.sin(alpha) * cosine], axis=1)
    return SimulatedFlight(
        motion=motion,
        position=frozen(where if airframe.earth == "wgs84" else states[:, :3]),
        velocity=frozen(np.einsum("nij,ni->nj", R, states[:, 7:10])),
        air_velocity=frozen(V[:, None] * air),
        mach=mach,
        states=further,
        inputs=inputs,
        engine_force=frozen(outputs[:, 17:20]),
        engine_moment=frozen(outputs[:, 20:23]),
        plant_states=states,
        messages=(*messages, *outside_validity(model, motion, mach)),
    )
