"""What the sensors of a virtual flight test read: where they sit, and what they do wrong."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np

from alula.base.arrays import Array
from alula.base.units import expected_unit, to_si
from alula.simulate.fly import SimulatedFlight, attitudes
from alula.simulate.sensors import (
    SensorError,
    every,
    flow_angles,
    lagged,
    readings,
    specific_force_at,
    velocity_at,
)
from alula.simulate.virtual_loading import Loading
from alula.simulate.virtual_plan import SENSED, Plan, SensorPlan

PERFECT = SensorPlan()
# Unit of each channel in the log, where it is not the SI unit itself.
_LOGGED = {"rad": "deg", "rad/s": "deg/s", "kg": "kg", "1": "1"}


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


def errors_of(
    plan: Plan, channels: tuple[str, ...], constants: Mapping[str, float]
) -> dict[str, SensorError]:
    """What each sensor does wrong, SI."""
    out = {}
    for name in channels:
        spec = plan.sensors.get(name, PERFECT)
        out[name] = SensorError(
            scale=constants.get(f"k_{name}", 0.0),
            bias=constants.get(f"b_{name}", 0.0),
            sigma=spec.in_si(spec.sigma),
            step=spec.in_si(spec.step),
            lag=spec.lag,
            loss=spec.loss,
            stuck=None if spec.stuck is None else (spec.stuck[0], spec.stuck[1]),
        )
    return out


def sense(
    plan: Plan,
    flight: SimulatedFlight,
    loading: Loading,
    errors: Mapping[str, SensorError],
    seed: int,
) -> dict[str, Array]:
    """What the sensors make of a flight, by channel, SI, each (n,).

    Controls are in the aircraft file's own sense, as a log has them.
    """
    motion = flight.motion
    truth = sensed(flight, loading)
    out = {}
    for name, error in errors.items():
        random = generator(seed, f"{motion.maneuver.id}/{name}")
        rate = plan.sensors.get(name, PERFECT).rate
        own = np.arange(len(motion.t)) if rate is None else every(motion.t, rate)
        if error.lag > 0.0:  # a sensor lags all the time, not only when it is asked
            truth[name] = lagged(motion.t, truth[name], error.lag)
            error = replace(error, lag=0.0)
        values = np.full(len(motion.t), np.nan)
        values[own] = readings(truth[name][own], error, random, motion.t[own])
        sign = loading.aircraft.control_sign(name) if name in motion.controls else 1.0
        out[name] = sign * values
    return out


def sensed(flight: SimulatedFlight, loading: Loading) -> dict[str, Array]:
    """What sensors without errors would read where they sit, SI, Alula's senses, (n,) each."""
    motion, aircraft = flight.motion, loading.aircraft
    cg = loading.cg
    rates = np.stack([motion.p, motion.q, motion.r], axis=1)
    out = {name: getattr(motion, name) for name in ("p", "q", "r", "phi", "theta", "psi")}

    def arm(channel: str) -> Array:
        return np.asarray(aircraft.sensor_position(channel) - cg)

    force = np.stack([motion.ax, motion.ay, motion.az], axis=1)
    turning = np.stack([motion.pdot, motion.qdot, motion.rdot], axis=1)
    for i, name in enumerate(("ax", "ay", "az")):
        out[name] = specific_force_at(force, rates, turning, arm(name))[:, i]
    for i, name in enumerate(("V", "alpha", "beta")):
        out[name] = flow_angles(velocity_at(flight.air_velocity, rates, arm(name)))[i]
    rotation = attitudes(flight.plant_states)[1]  # lever arms turn with the aircraft
    for i, name in enumerate(("v_north", "v_east", "v_down")):
        swing = velocity_at(np.zeros_like(rates), rates, arm(name))
        out[name] = flight.velocity[:, i] + np.einsum("nj,nj->n", rotation[:, :, i], swing)
    out["h"] = motion.h - rotation[:, :, 2] @ arm("h")
    out |= {name: motion.controls[name] for name in ("de", "da", "dr", "df", "dt")}
    out["thrust"] = np.zeros(len(motion.t)) if motion.thrust is None else motion.thrust
    out["fuel_used"] = np.full(len(motion.t), loading.fuel_used)
    return {name: np.array(values, dtype=np.float64) for name, values in out.items()}


@cache
def logged(name: str) -> tuple[str, float]:
    """Unit of a channel in the log, and SI per unit: ('deg', 0.01745...) for 'alpha'."""
    si = expected_unit(name) or "1"
    unit = _LOGGED.get(si, si)
    return unit, to_si(unit).scale
