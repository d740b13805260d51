"""Angles of ASSE, joint filter and identified lift model against the truth of simulated flights.

The SportStar, flown by hand in nearly calm air (turns, climbs, pitch and yaw inputs), and for ten
minutes in 10 m/s of wind and its turbulence as in `navigation_flight`. The log is what a recorder
keeps: IMU and attitude at 100 Hz (or 50), air data at 50 Hz, satellites at 5 Hz, each sensor at its
own place, with biases and noise; vanes with 10 and 5 % of upwash. The lift model is identified by
Alula from four simulated maneuvers with sensor errors. All goes through `angles_of`, as in
`alula airdata --angles --model`, the calibration of the vanes before it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from scipy.stats import chi2

from alula.aircraft import Aircraft, load_aircraft
from alula.airdata.inflight import calibrate_in_flight
from alula.airdata.inflight_record import record_of
from alula.base.arrays import Array, frozen
from alula.base.project import Project
from alula.campaign.airdata import vane_arms
from alula.campaign.angle_board import arm_of
from alula.campaign.angles import Angles, angles_of
from alula.campaign.job import run_project
from alula.flight import Channel, Flight
from alula.identify import identified_model
from alula.model import AeroModel, Reference
from alula.simulate import flow_angles, velocity_at
from alula.simulate.fly import SimulatedFlight
from alula.simulate.sensors import specific_force_at
from alula.simulate.virtual_campaign import fly_plan
from alula.simulate.virtual_plan import load_plan
from verification.airdata.inflight_calibration import flown as wandering
from verification.airdata.navigation_flight import AIRCRAFT, flown

DEG = float(np.radians(1.0))
SETTLED = 30.0  # s, of joint filter and ASSE; not counted
LOG = 100  # Hz
CALM, ROUGH = 0.2, 1.5  # m/s of turbulence as stated
# Largest rms in calm air, deg: vanes' own noise and ASSE's and the filter's sigma at twice.
MUST = {("alpha", "ASSE"): 1.5, ("beta", "ASSE"): 2.5, ("alpha", "joint filter"): 1.0,
        ("beta", "joint filter"): 1.0, ("alpha", "lift model"): 0.2}  # fmt: skip
OBSERVED = 0.6  # share of the calm flights on which ASSE reports the angle of attack
SIGMA: Mapping[str, float] = {
    "ax": 0.03, "ay": 0.03, "az": 0.03, "p": 0.1 * DEG, "q": 0.1 * DEG, "r": 0.1 * DEG,
    "V": 0.3, "alpha": 0.2 * DEG, "beta": 0.2 * DEG, "h": 0.5, "rho": 0.0,
    "v_north": 0.1, "v_east": 0.1, "v_down": 0.1, "north": 1.5, "east": 1.5, "down": 2.5,
    "phi": 0.05 * DEG, "theta": 0.05 * DEG, "psi": 0.05 * DEG,
    "de": 0.05 * DEG, "da": 0.05 * DEG, "dr": 0.05 * DEG, "thrust": 5.0,
}  # fmt: skip
SIZES: Mapping[str, float] = {"a": 0.02, "w": 0.1 * DEG, "tilt": 0.5 * DEG, "vane": 1.0 * DEG}
SOURCES = ("recorded", "ASSE", "joint filter", "lift model", "voted")
SLOW = 20.0  # s, correlation of the attitude's error


@dataclass(frozen=True)
class Judged:
    """One source against the truth, over what it reports. rms, bias: deg; share of the time;
    nees: mean of the squared error over its stated variance.
    """

    rms: float
    bias: float
    share: float
    nees: float


@cache
def lift_model() -> AeroModel:
    """Identified from four simulated maneuvers, as `alula fly` and `alula identify` make it."""
    root = AIRCRAFT.parent
    sensors = (root / "examples" / "demo" / "campaign.toml").read_text()
    sensors = sensors[sensors.index("[sensors]") : sensors.index("[identify]")]
    plan = f"""schema = "alula.plan/1"
name = "Lift of the SportStar"
aircraft = "{AIRCRAFT / "sportstar.toml"}"
rate = 100.0
duration = 16.0
engines = "given"
[[conditions]]
V = [30.0, 36.0, 42.0, 50.0]
h = 300.0
[[maneuvers]]
id = "elevator"
reference_V = 45.0
inputs = [
  {{control = "de", kind = "doublet", amplitude_deg = 2.2, start = 1.5, width = 0.5, ramp = 0.3}},
  {{control = "de", kind = "doublet", amplitude_deg = -2.2, start = 9.0, width = 0.4, ramp = 0.3}},
]
{sensors}
[identify]
CD = "1 + alpha"
CL = "1 + alpha + qhat + de"
Cm = "1 + alpha + qhat + de"
"""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "plan.toml"
        path.write_text(plan)
        made = fly_plan(load_plan(path), Path(folder) / "flown", seed=3, threads=1)
        job = run_project(str(made.project))
    aircraft = job.checked.aircraft
    return identified_model(
        job.identification, "SportStar, identified",
        Reference(aircraft.S, aircraft.b, aircraft.c), data=job.data,
        reference_point=aircraft.reference_point,
    )  # fmt: skip


@cache
def the_aircraft() -> Aircraft:
    """The SportStar as it was loaded."""
    return load_aircraft(AIRCRAFT / "sportstar.toml")


def project(gust: float) -> Project:
    """What a user states: the noise of the sensors and the turbulence."""
    table: dict[str, object] = {
        "schema": "alula.project/1", "name": "Ten minutes",
        "logs": [{"id": "flight", "path": "flight.csv"}],
        "navigate": {
            "gust": gust, "gust_length": 150.0,
            "sensors": {n: {"sigma": SIGMA[n]} for n in
                        ("V", "alpha", "beta", "v_north", "v_east", "v_down", "north", "east",
                         "down", "h")},
        },
        "reconstruct": {"imu": {n: {"sigma": SIGMA[n]} for n in ("ax", "ay", "az", "p", "q", "r")}},
    }  # fmt: skip
    return Project.model_validate(table)


def log_of(made: SimulatedFlight, seed: int) -> Flight:
    """What the recorder kept of it."""
    random = np.random.default_rng([23, seed])
    aircraft, m = the_aircraft(), made.motion
    w = np.column_stack([m.p, m.q, m.r])
    w_dot = np.column_stack([m.pdot, m.qdot, m.rdot])
    f = specific_force_at(np.column_stack([m.ax, m.ay, m.az]), w, w_dot, arm_of(aircraft, "ax"))
    boom = flow_angles(velocity_at(made.air_velocity, w, arm_of(aircraft, "V")))
    rate = 1.0 / float(m.t[1] - m.t[0])
    every = max(1, round(rate / LOG))

    def bias(size: float) -> float:
        return float(size * random.standard_normal())

    def slow(size: float) -> Array:
        n = -(-len(m.t) // every)
        keep = np.exp(-every / (rate * SLOW))
        out = size * random.standard_normal(n)
        out[1:] *= np.sqrt(1.0 - keep**2)
        for k in range(1, n):
            out[k] += keep * out[k - 1]
        return out

    inertial = {n: x + bias(SIZES["a"]) for n, x in zip(("ax", "ay", "az"), f.T, strict=True)}
    inertial |= {n: x + bias(SIZES["w"]) for n, x in zip("pqr", w.T, strict=True)}
    inertial |= {n: getattr(m, n) for n in ("phi", "theta", "psi")}
    inertial |= {n: made.inputs[:, k] for k, n in enumerate(("de", "da", "dr"))}
    air = {"V": boom[0], "alpha": 1.1 * boom[1] + bias(SIZES["vane"]),
           "beta": 1.05 * boom[2] + bias(SIZES["vane"]), "h": m.h, "rho": m.rho,
           "thrust": made.engine_force[:, 0]}  # fmt: skip
    satellites = dict(zip(("north", "east", "down"), made.position.T, strict=True))
    satellites |= dict(zip(("v_north", "v_east", "v_down"), made.velocity.T, strict=True))
    channels = {}
    for group, step in ((inertial, every), (air, round(rate / 50)), (satellites, round(rate / 5))):
        t = frozen(m.t[::step])
        for name, values in group.items():
            x = np.array(values)[::step]
            if name in ("phi", "theta"):
                x = x + slow(SIZES["tilt"])
            x = x + SIGMA[name] * random.standard_normal(len(x))
            channels[name] = Channel(name, t, frozen(x), "", "simulated")
    return Flight("flight", channels)


def compared(made: SimulatedFlight, seed: int, gust: float) -> Angles:
    """All sources of the flight, as `alula airdata --angles --model` has them."""
    flight = log_of(made, seed)
    aircraft = the_aircraft()
    calibration = calibrate_in_flight(record_of(flight, arms=vane_arms(aircraft)))
    return angles_of(project(gust), aircraft, flight, calibration, lift_model())


def judged(found: Angles, made: SimulatedFlight) -> dict[str, dict[str, Judged]]:
    """By angle and source."""
    out: dict[str, dict[str, Judged]] = {}
    for kind, one in found.compared.items():
        truth = np.interp(one.t, made.motion.t, getattr(made.motion, kind))
        late = one.t > SETTLED
        rows = {n: (s.values, s.sigma, s.reported, s.observed) for n, s in one.sources.items()}
        if one.voted is not None:
            v = one.voted
            there = np.isfinite(v.angle)
            rows["voted"] = (v.angle, v.sigma, there, there)
        out[kind] = {}
        for name, (values, sigma, there, seen) in rows.items():
            use = there & late
            if use.any():
                e = values[use] - truth[use]
                out[kind][name] = Judged(
                    float(np.sqrt(np.mean(e**2))) / DEG, float(np.mean(e)) / DEG,
                    float(np.mean(seen[late])), float(np.mean((e / sigma[use]) ** 2)),
                )  # fmt: skip
    return out


def check(quick: bool = False) -> tuple[str, bool]:
    """What was found, and whether it holds: rms in calm air, no error above what was stated."""
    seeds = range(2 if quick else 5)
    calm, rough = (200.0, 120.0) if quick else (300.0, 600.0)
    flights = {
        "calm air": [(wandering(k, calm, sigma=CALM), CALM, k) for k in seeds],
        "10 m/s of wind": [(flown(rough, k), ROUGH, k) for k in seeds],
    }
    words, holds = [], True
    most = float(chi2.ppf(0.999, len(seeds))) / len(seeds)  # errors last: a flight counts once
    for air, made in flights.items():
        found = [judged(compared(m, seed, gust), m) for m, gust, seed in made]
        for kind in ("alpha", "beta"):
            parts = []
            for name in SOURCES:
                each = [f[kind][name] for f in found if name in f[kind]]
                if not each:
                    parts.append(f"{name} not observable")
                    continue
                rms = float(np.sqrt(np.mean([j.rms**2 for j in each])))
                share = float(np.sum([j.share for j in each])) / len(found)
                nees = float(np.mean([j.nees for j in each]))
                parts.append(f"{name} {rms:.2f}° on {share:.0%}, NEES {nees:.2f}")
                holds &= nees < most
                if air == "calm air":
                    holds &= rms < MUST.get((kind, name), np.inf)
                    holds &= share >= OBSERVED or (kind, name) != ("alpha", "ASSE")
            words.append(f"{air}, {kind}: {'; '.join(parts)}")
    return f"{len(seeds)} flights each. " + ". ".join(words), bool(holds)
