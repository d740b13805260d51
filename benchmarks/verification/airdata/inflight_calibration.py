"""In-flight calibration of air data on flights whose truth is known: coverage, and the refusal.

A two-seat light airplane in wind and Dryden turbulence wanders about by hand: turns of changing
bank, speeds and pitch and yaw inputs, on no course. Its sensors have the errors below; attitude
and GPS have biases, noise, and the GPS is late. Every seed has air, noise and errors of its own. A
straight flight in the same air has to be refused.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy import stats

from alula.aircraft import load_aircraft
from alula.airdata.inflight import calibrate_in_flight
from alula.airdata.inflight_record import AirDataRecord
from alula.airdata.inflight_result import SOUGHT, InFlightCalibration
from alula.base.arrays import Array
from alula.model import load_model
from alula.simulate import Turbulence, airframe_of, flow_angles, fly, trim_level, velocity_at
from alula.simulate.airframe import core_model
from alula.simulate.fly import SimulatedFlight, attitudes
from alula.simulate.pilot import Pilot
from alula.simulate.pilot_law import holding
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft"
SPEED, HEIGHT, STEP = 45.0, 1000.0, 0.02
VANES = (1.5, -3.0, 0.0)  # m from the center of gravity, on the wing
SEEDS, FEW, SECONDS = 40, 4, 300.0
LEAST = 0.90  # share of 95 % intervals that hold; 40 seeds of 6 parameters: 0.95 less 3.5 sigma


@dataclass(frozen=True)
class Truth:
    """What the sensors do wrong, and the mean wind."""

    errors: dict[str, float]


def truth_of(seed: int) -> Truth:
    """Errors of one seed."""
    r = np.random.default_rng([7, seed])
    return Truth(
        {
            "k_V": 0.04 * r.standard_normal(),
            "k_alpha": 0.1 + 0.1 * r.standard_normal(),
            "b_alpha": np.radians(1.0) * r.standard_normal(),
            "k_beta": 0.1 * r.standard_normal(),
            "b_beta": np.radians(1.0) * r.standard_normal(),
            "static_error": 0.05 * r.standard_normal(),
            "wind_north": 8.0 * r.standard_normal(),
            "wind_east": 8.0 * r.standard_normal(),
            "wind_down": 0.0,
            "b_phi": np.radians(0.3) * r.standard_normal(),
            "b_theta": np.radians(0.3) * r.standard_normal(),
            "b_psi": np.radians(1.0) * r.standard_normal(),
            "gps_delay": 0.15,
        }
    )


@cache
def _aircraft() -> tuple[object, object]:
    return (
        airframe_of(load_aircraft(AIRCRAFT / "sportstar.toml")),
        load_model(AIRCRAFT / "sportstar_aero.toml"),
    )


def flown(seed: int, seconds: float, straight: bool = False, sigma: float = 1.0) -> SimulatedFlight:
    """The flight of a seed; sigma: m/s of turbulence."""
    frame, model = _aircraft()
    wind = np.array([truth_of(seed).errors[n] for n in ("wind_north", "wind_east", "wind_down")])
    trim = trim_level(frame, model, SPEED, HEIGHT, wind=wind)  # type: ignore[arg-type]
    law = holding(core_model(frame, model, wind, 9.80665), trim, SPEED)  # type: ignore[arg-type]
    t = np.arange(round(seconds / STEP) + 1) * STEP
    references: dict[str, Array | float] = dict(law.references)
    controls = {**trim.controls, "thrust": trim.thrust}
    gains = dict(law.gains)
    if not straight:
        r = np.random.default_rng([11, seed])
        for gone in (("de", "h"), ("da", "psi")):
            gains.pop(gone, None)

        def steps(each: float, size: float) -> Array:
            levels = r.uniform(-size, size, round(seconds / each) + 2)
            return np.interp(t, np.arange(len(levels)) * each, levels)

        references["phi"] = steps(8.0, np.radians(40.0))
        references["theta"] = law.references["theta"] + steps(6.0, np.radians(5.0))
        controls["dr"] = controls["dr"] + steps(1.5, np.radians(4.0))
        controls["de"] = controls["de"] + steps(1.0, np.radians(2.0))
    return fly(
        frame, model, trim.state, t, controls, wind=wind,  # type: ignore[arg-type]
        turbulence=Turbulence(sigma=sigma, seed=seed), pilot=Pilot(gains, references, {}),
    )  # fmt: skip


def record(flight: SimulatedFlight, truth: Truth, seed: int) -> AirDataRecord:
    """What the sensors made of the flight."""
    e, r, m = truth.errors, np.random.default_rng([13, seed]), flight.motion
    t, n = m.t, len(m.t)
    rates = np.column_stack([m.p, m.q, m.r])
    center = flow_angles(flight.air_velocity)
    vane = flow_angles(velocity_at(flight.air_velocity, rates, VANES))

    def noisy(x: Array, sigma: float) -> Array:
        return np.asarray(x + sigma * r.standard_normal(n))

    def gps(x: Array, sigma: float) -> Array:
        own = np.arange(0.0, t[-1] + 0.1, 0.2)  # 5 Hz
        late = np.interp(own - e["gps_delay"], t, x) + sigma * r.standard_normal(len(own))
        return np.interp(t, own, late)

    deg = float(np.radians(1.0))
    euler = attitudes(flight.plant_states)[0]
    readings = {
        "V": noisy((1.0 + e["k_V"]) * center[0], 0.3),
        "alpha": noisy((1.0 + e["k_alpha"]) * vane[1] + e["b_alpha"], 0.2 * deg),
        "beta": noisy((1.0 + e["k_beta"]) * vane[2] + e["b_beta"], 0.2 * deg),
        "h": noisy(m.h - e["static_error"] * center[0] ** 2 / 19.6133 + 12.0, 0.5),
        "h_gps": gps(m.h, 1.0),
    }
    for k, name in enumerate(("de", "da", "dr")):
        readings[name] = noisy(flight.inputs[:, k], 0.05 * deg)
    for name in ("p", "q", "r"):
        bias = 0.2 * deg * r.standard_normal()
        readings[name] = noisy(getattr(m, name) + bias, 0.2 * deg)
    for name in ("ax", "ay", "az"):
        readings[name] = noisy(getattr(m, name) + 0.05 * r.standard_normal(), 0.1)
    for k, name in enumerate(("phi", "theta", "psi")):
        readings[name] = noisy(np.unwrap(euler[:, k]) + e[f"b_{name}"], 0.1 * deg)
    for k, name in enumerate(("north", "east", "down")):
        readings[f"v_{name}"] = gps(flight.velocity[:, k], 0.1)
    return AirDataRecord(t, readings, {"alpha": VANES, "beta": VANES})


def calibrated(seed: int, seconds: float = SECONDS, straight: bool = False) -> InFlightCalibration:
    """The calibration from one flight."""
    return calibrate_in_flight(record(flown(seed, seconds, straight), truth_of(seed), seed))


def check(quick: bool = False) -> tuple[str, bool]:
    """Figures in words, and whether they hold."""
    seeds = range(FEW if quick else SEEDS)
    names = (*SOUGHT, "wind_north", "wind_east")
    found = {seed: calibrated(seed) for seed in seeds}
    inside = {
        n: [f[n].ci95[0] <= truth_of(s).errors[n] <= f[n].ci95[1] for s, f in found.items()]
        for n in names
    }
    told = float(
        np.mean([f[n].verdict != "not_identifiable" for f in found.values() for n in names])
    )
    share = float(np.mean([inside[n] for n in SOUGHT]))
    least = stats.binom.ppf(0.001, len(seeds), 0.95) / len(seeds)
    each = {n: float(np.mean(inside[n])) for n in names}
    straight = [calibrated(s, SECONDS, straight=True) for s in ((0,) if quick else range(5))]
    refused = not any(f.rich for f in straight)
    se = {n: float(np.median([f[n].se for f in found.values()])) for n in names}
    words = ", ".join(
        f"{n} {each[n]:.0%} (se "
        + (f"{np.degrees(se[n]):.2f}°" if n.startswith("b_") else f"{se[n]:.3f}")
        + ")"
        for n in names
    )
    good = (
        told >= LEAST
        and refused
        and share >= (0.8 if quick else LEAST)
        and min(each.values()) >= least
    )
    return (
        f"{len(seeds)} flights of {SECONDS:g} s in 1 m/s turbulence, truth inside 95 % intervals: "
        f"{words}; together {share:.1%}; {told:.1%} determined; "
        f"straight flights refused: {refused}",
        bool(good),
    )
