"""One maneuver of a virtual flight test: trimmed, flown, sensed."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.units import expected_unit, to_si
from alula.flight import Motion
from alula.model import AeroModel
from alula.simulate.airframe import airframe_of
from alula.simulate.fly import SimulatedFlight, attitudes, fly
from alula.simulate.sensors import (
    SensorError,
    every,
    flow_angles,
    readings,
    specific_force_at,
    velocity_at,
)
from alula.simulate.trim import Trim, trim_level
from alula.simulate.virtual_loading import Loading
from alula.simulate.virtual_maneuvers import Condition, VirtualManeuver
from alula.simulate.virtual_plan import SENSED, Plan, SensorPlan

# Unit of each channel in the log, where it is not the SI unit itself.
_LOGGED = {"rad": "deg", "rad/s": "deg/s", "kg": "kg", "1": "1"}


@dataclass(frozen=True)
class Flown:
    """What came of one maneuver. readings: by channel, SI, NaN where a sensor has no sample."""

    plan: VirtualManeuver
    flight: SimulatedFlight
    trim: Trim
    readings: Mapping[str, Array]


def trimmed(loading: Loading, model: AeroModel, condition: Condition, wind: Array) -> Trim:
    """The steady flight of a condition, within the control limits of the aircraft file.

    Raises BadInput where there is none.
    """
    limits = {k: v for k, v in loading.aircraft.control_limits.items() if k == "de"}
    return trim_level(
        airframe_of(loading.aircraft, loading.fuel_used),
        model,
        condition.V,
        condition.h,
        gamma=condition.gamma,
        psi=condition.psi,
        controls={"df": condition.df},
        limits=limits,
        wind=wind,
    )


def fly_maneuver(
    plan: Plan, asked: VirtualManeuver, loading: Loading, model: AeroModel, trim: Trim
) -> SimulatedFlight:
    """The true motion of one maneuver from its trim; nothing in it is random but turbulence.

    Deflections stop at the control limits of the aircraft file. Raises BadInput where it diverges.
    """
    t = times(plan, asked)
    controls: dict[str, Array | float] = {**trim.controls, "thrust": trim.thrust}
    for name, signal in asked.signals.items():
        low, high = loading.aircraft.control_limits.get(name, (-np.inf, np.inf))
        controls[name] = np.clip(trim.controls[name] + signal.value(t), low, high)
    return fly(
        airframe_of(loading.aircraft, loading.fuel_used),
        model,
        trim.state,
        t,
        controls,
        wind=np.array(plan.wind),
        substeps=max(1, int(np.ceil(1.0 / (plan.rate * plan.step) - 1e-9))),
        maneuver=asked.maneuver,
    )


def times(plan: Plan, asked: VirtualManeuver) -> Array:
    """The log's time stamps, (n,) s from 0."""
    return np.arange(round(asked.maneuver.end * plan.rate) + 1) / plan.rate


def channels_of(plan: Plan, loadings: Mapping[str, Loading]) -> tuple[str, ...]:
    """The channels that every log of the plan holds, in one order."""
    wanted = set(SENSED) - {"df", "dt", "fuel_used"}
    if any(c.df_deg for c in plan.conditions):
        wanted.add("df")
    if any(
        getattr(e, "kind", "given") != "given"
        for x in loadings.values()
        for e in x.aircraft.engines
    ):
        wanted.add("dt")
    if any(x.fuel_used for x in loadings.values()):
        wanted.add("fuel_used")
    wanted -= {name for name, spec in plan.sensors.items() if not spec.use}
    return tuple(name for name in SENSED if name in wanted)


def constants_of(plan: Plan, seed: int) -> dict[str, float]:
    """The sensors' constant errors, SI, the same in every flight: 'b_alpha' rad, 'k_alpha' 1."""
    out = {}
    for name, spec in plan.sensors.items():
        for key, value, sigma in (
            ("b", spec.in_si(spec.bias), spec.in_si(spec.bias_sigma)),
            ("k", spec.scale, spec.scale_sigma),
        ):
            if value or sigma:
                label = f"{key}_{name}"
                out[label] = value + sigma * float(generator(seed, label).standard_normal())
    return out


def generator(seed: int, label: str) -> np.random.Generator:
    """Random numbers of their own for each label: none depends on what else is flown, or when."""
    words = np.frombuffer(hashlib.sha256(label.encode()).digest(), dtype="<u4")
    return np.random.default_rng(np.random.SeedSequence([seed, *(int(w) for w in words)]))


def sense(
    plan: Plan,
    flight: SimulatedFlight,
    loading: Loading,
    channels: tuple[str, ...],
    constants: Mapping[str, float],
    seed: int,
) -> dict[str, Array]:
    """What the sensors make of a flight, by channel, SI, each (n,).

    Controls are in the aircraft file's own sense, as a log has them.
    """
    motion = flight.motion
    truth = sensed(flight, loading)
    out = {}
    for name in channels:
        spec = plan.sensors.get(name, SensorPlan())
        error = SensorError(
            scale=constants.get(f"k_{name}", 0.0),
            bias=constants.get(f"b_{name}", 0.0),
            sigma=spec.in_si(spec.sigma),
            step=spec.in_si(spec.step),
            lag=spec.lag,
            loss=spec.loss,
            stuck=None if spec.stuck is None else (spec.stuck[0], spec.stuck[1]),
        )
        random = generator(seed, f"{motion.maneuver.id}/{name}")
        own = slice(None) if spec.rate is None else every(motion.t, spec.rate)
        if spec.lag > 0.0:  # a sensor lags all the time, not only when it is asked
            lagging = replace(SensorError(), lag=spec.lag)
            truth[name] = readings(truth[name], lagging, random, motion.t)
            error = replace(error, lag=0.0)
        values = np.full(len(motion.t), np.nan)
        values[own] = readings(truth[name][own], error, random, motion.t[own])
        sign = loading.aircraft.control_sign(name) if name in motion.controls else 1.0
        out[name] = sign * values
    return out


def sensed(flight: SimulatedFlight, loading: Loading) -> dict[str, Array]:
    """What sensors without errors would read where they sit, SI, Alula's senses, (n,) each."""
    motion, aircraft = flight.motion, loading.aircraft
    burned = np.full(1, loading.fuel_used) if motion.fuel_used is None else motion.fuel_used
    cg = aircraft.mass_properties(burned).cg
    rates = np.stack([motion.p, motion.q, motion.r], axis=1)
    out = {name: getattr(motion, name) for name in ("p", "q", "r", "phi", "theta", "psi")}

    def arm(channel: str) -> Array:
        return np.asarray((aircraft.sensor_position(channel) - cg).mean(axis=0))

    force = np.stack([motion.ax, motion.ay, motion.az], axis=1)
    turning = np.stack([motion.pdot, motion.qdot, motion.rdot], axis=1)
    for i, name in enumerate(("ax", "ay", "az")):
        out[name] = specific_force_at(force, rates, turning, arm(name))[:, i]
    for i, name in enumerate(("V", "alpha", "beta")):
        out[name] = flow_angles(velocity_at(flight.air_velocity, rates, arm(name)))[i]
    # R_BE of what was flown, from its own angles: lever arms turn with the aircraft.
    rotation = _rotation(motion)
    for i, name in enumerate(("v_north", "v_east", "v_down")):
        swing = velocity_at(np.zeros_like(rates), rates, arm(name))
        out[name] = flight.velocity[:, i] + np.einsum("nj,nj->n", rotation[:, :, i], swing)
    out["h"] = motion.h - rotation[:, :, 2] @ arm("h")
    out |= {name: motion.controls[name] for name in ("de", "da", "dr", "df", "dt")}
    out["thrust"] = np.zeros(len(motion.t)) if motion.thrust is None else motion.thrust
    out["fuel_used"] = np.broadcast_to(burned, motion.t.shape)
    return {name: np.array(values, dtype=np.float64) for name, values in out.items()}


def _rotation(motion: Motion) -> Array:
    """R_BE (n, 3, 3) from Euler angles 3-2-1."""
    from alula.core import core

    states = np.zeros((len(motion.t), 13))
    for row, phi, theta, psi in zip(states, motion.phi, motion.theta, motion.psi, strict=True):
        core.quaternion_from_euler(phi, theta, psi, row[3:7])
    return attitudes(states)[1]


def logged(name: str) -> tuple[str, float]:
    """Unit of a channel in the log, and SI per unit: ('deg', 0.01745...) for 'alpha'."""
    si = expected_unit(name) or "1"
    unit = _LOGGED.get(si, si)
    return unit, to_si(unit).scale
