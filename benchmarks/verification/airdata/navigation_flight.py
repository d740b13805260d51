"""Ten minutes of SportStar in 10 m/s of wind and turbulence: joint filter, and the pair beside it.

Flown by a pilot who turns, climbs and changes speed, in Dryden turbulence. Inertial samples at 800
Hz; air data, field and barometer at 50 Hz; satellites at 5 Hz, 0.2 s late; biases, their walks and
white noise as in NOISE. What is not simulated: colored errors of the satellites, bias of vanes.
Turbulence is part of the wind: its estimate is compared with the air's velocity at the aircraft.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.stats import chi2

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.model import load_model
from alula.navigate import (
    Inertial,
    JointSettings,
    Navigation,
    PairSettings,
    Readings,
    assumed_sideslip,
    navigate_joint,
    navigate_pair,
    rotations,
)
from alula.simulate import airframe_of, fly
from alula.simulate.airframe import core_model
from alula.simulate.condition import Condition
from alula.simulate.pilot_law import holding
from alula.simulate.trim import trim
from alula.simulate.wind import Turbulence
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft"
RATE, AIR_RATE, GPS_RATE, DELAY = 800, 50, 5, 0.2  # Hz, s
WIND, W20 = np.array([6.0, -8.0, 0.0]), 10.0  # m/s: 10 m/s of wind, and at 20 ft the same
HEIGHT, SPEED = 150.0, 45.0  # m, m/s
FIELD = (20.9e-6, 1.8e-6, 43.8e-6)  # T, NED
NOISE: Mapping[str, float] = {
    "gyro": 2e-4, "gyro_bias": 8e-3, "gyro_walk": 1e-5,  # rad/s per root Hz, rad/s, per root s
    "force": 5e-3, "force_bias": 0.05, "force_walk": 5e-4,  # m/s2 likewise
    "V": 0.3, "alpha": np.radians(0.3), "beta": np.radians(0.3), "field": 0.5e-6,
    "height": 0.5, "height_bias": 3.0, "height_walk": 0.02,
    "position": 1.5, "velocity": 0.15,
}  # fmt: skip
SETTLED = 30.0  # s, of the filters; not counted
EVERY = 80  # inertial samples for a row of the result: 0.1 s
ATTITUDE_MUST, WIND_MUST = 0.5, 0.5  # deg, m/s


@dataclass(frozen=True)
class Truth:
    """At times t (n,): R_BE (n, 3, 3), euler, velocity, position, wind with its gust (n, 3); biases
    of gyro, accelerometer (n, 3) and height (n,).
    """

    t: Array
    R: Array
    euler: Array
    velocity: Array
    position: Array
    wind: Array
    gyro_bias: Array
    force_bias: Array
    height_bias: Array


def flown(seconds: float, seed: int) -> Any:
    """The flight itself, at the rate of the inertial sensors."""
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    frame = airframe_of(aircraft, engines="modeled")
    model = replace(load_model(AIRCRAFT / "sportstar_aero.toml"), stall=None)
    level = trim(frame, model, Condition(SPEED, HEIGHT), wind=WIND)
    law = holding(core_model(frame, model, WIND), level, SPEED)
    t = np.arange(round(seconds * RATE) + 1) / RATE
    # Every 40 s a turn of 90 degrees in 15 s, right and left; height and speed change between.
    turn = np.radians(90.0) / 15.0
    phase = np.floor(t / 40.0)
    turning = (t % 40.0) < 15.0
    sign = np.where(phase % 3 == 2, -1.0, 1.0)
    rate = np.where(turning & (t > 20.0), sign * turn, 0.0)
    references: dict[str, Array | float] = dict(law.references)
    references["psi"] = law.references["psi"] + np.cumsum(rate) / RATE
    references["phi"] = law.references["phi"] + np.arctan(rate * SPEED / 9.80665)
    references["h"] = HEIGHT + 15.0 * np.sin(2.0 * np.pi * t / 97.0)
    references["V"] = SPEED + 3.0 * np.sin(2.0 * np.pi * t / 61.0)
    hands = replace(law.pilot({}), references=references)
    return fly(
        frame, model, level.state, t, {**level.controls}, wind=WIND, pilot=hands,
        turbulence=Turbulence(W20=W20, seed=seed), check=False,
    )  # fmt: skip


def measured(flight: Any, seed: int) -> tuple[Inertial, list[Readings], Truth]:
    """What the sensors made of it, and the truth at the filters' rows."""
    random = np.random.default_rng(1000 + seed)
    m = flight.motion
    n, t = len(m.t), np.asarray(m.t)

    def normal(*shape: int) -> Array:
        return random.standard_normal(shape)

    def walk(size: float, step: float, width: int) -> Array:
        steps = step / np.sqrt(RATE) * normal(n, width)
        return np.asarray(size * normal(width) + np.cumsum(steps, axis=0))

    def white(density: float) -> Array:
        return density * np.sqrt(RATE) * normal(n, 3)

    gyro_bias = walk(NOISE["gyro_bias"], NOISE["gyro_walk"], 3)
    force_bias = walk(NOISE["force_bias"], NOISE["force_walk"], 3)
    height_bias = walk(NOISE["height_bias"], NOISE["height_walk"], 1)[:, 0]
    rate = np.column_stack([m.p, m.q, m.r]) + gyro_bias + white(NOISE["gyro"])
    force = np.column_stack([m.ax, m.ay, m.az]) + force_bias + white(NOISE["force"])
    R = rotations(flight.plant_states[:, 3:7])
    field = np.einsum("nij,j->ni", R, FIELD)
    air, gps = np.arange(0, n, RATE // AIR_RATE), np.arange(0, n, RATE // GPS_RATE)
    ta, tg, late = t[air], t[gps], t[gps] + DELAY

    def read(kind: str, values: Array, name: str) -> Readings:
        return Readings(kind, ta, values[air] + NOISE[name] * normal(len(air)), NOISE[name])

    readings = [
        Readings("position", tg, flight.position[gps] + NOISE["position"] * normal(len(gps), 3),
                 NOISE["position"], late),
        Readings("velocity", tg, flight.velocity[gps] + NOISE["velocity"] * normal(len(gps), 3),
                 NOISE["velocity"], late),
        Readings("field", ta, field[air] + NOISE["field"] * normal(len(air), 3), NOISE["field"]),
        read("height", m.h + height_bias, "height"),
        read("V", m.V, "V"),
        read("alpha", m.alpha, "alpha"),
        read("beta", m.beta, "beta"),
    ]  # fmt: skip
    row = np.arange(0, n, EVERY)
    wind = flight.velocity - np.einsum("nji,nj->ni", R, flight.air_velocity)
    euler = np.column_stack([m.phi, m.theta, m.psi])
    truth = Truth(
        t[row], R[row], euler[row], flight.velocity[row], flight.position[row], wind[row],
        gyro_bias[row], force_bias[row], height_bias[row],
    )  # fmt: skip
    return Inertial(t, rate, force), readings, truth


def joint_settings() -> JointSettings:
    """Noise as it is; turbulence as MIL-F-8785C has it at that height and wind."""
    feet = HEIGHT / 0.3048
    over = 0.177 + 0.000823 * feet
    sideways, along = 0.1 * W20 / over**0.4, HEIGHT / over**1.2
    return JointSettings(
        gyro=NOISE["gyro"], gyro_walk=NOISE["gyro_walk"], accelerometer=NOISE["force"],
        accelerometer_walk=NOISE["force_walk"], height_walk=NOISE["height_walk"],
        wind_walk=0.01, gust=(sideways, sideways, 0.1 * W20),
        # at high frequencies Dryden's v and w have 3/2 of a Gauss-Markov process' power
        gust_length=(along / 1.5, along / 1.5, HEIGHT / 1.5), field=FIELD,
    )  # fmt: skip


def errors(found: Navigation, truth: Truth) -> dict[str, Array]:
    """Truth less estimate by part; 'turn' (n, 3), rad about the body axes, 'euler' too."""
    relative = np.einsum("nij,nkj->nik", truth.R, rotations(found.q))  # R_true R_hat'
    turn = 0.5 * np.column_stack(
        [relative[:, 1, 2] - relative[:, 2, 1], relative[:, 2, 0] - relative[:, 0, 2],
         relative[:, 0, 1] - relative[:, 1, 0]]
    )  # fmt: skip
    euler = truth.euler - found.euler
    return {
        "turn": turn,
        "euler": np.asarray((euler + np.pi) % (2.0 * np.pi) - np.pi),
        "velocity": truth.velocity - found.velocity,
        "position": truth.position - found.position,
        "gyro_bias": truth.gyro_bias - found.gyro_bias,
        "force_bias": truth.force_bias - found.force_bias,
        "wind": truth.wind - found.wind,
    }


def nees(found: Navigation, error: Mapping[str, Array], part: str) -> Array:
    """Normalized estimation error squared (n,), three degrees of freedom."""
    P = found.part(part)
    return np.einsum("ni,ni->n", error[part], np.linalg.solve(P, error[part][..., None])[..., 0])


def rms(values: Array) -> Array:
    """Root of the mean square of each column."""
    return np.asarray(np.sqrt(np.mean(np.square(values), axis=0)))


PARTS = ("turn", "velocity", "position", "gyro_bias", "force_bias", "wind")
CONFIDENCE, LEAST_INSIDE = 0.95, 0.85  # of the times at which the sum over seeds lies in its bounds


@dataclass(frozen=True)
class Judged:
    """Of one filter over several seeds: rms of phi theta psi (deg) and wind (m/s) over all, the
    largest of a seed, and by part the mean of NEES with the share of times inside its bounds.
    """

    euler: Array
    wind: Array
    worst_euler: float
    worst_wind: float
    nees: Mapping[str, tuple[float, float]]


def judged(runs: list[tuple[Navigation, Truth]], parts: tuple[str, ...]) -> Judged:
    """NEES is looked at every 10 s, summed over the seeds, which alone are independent."""
    euler, wind, sums = [], [], {p: [] for p in parts}
    for found, truth in runs:
        error, counted = errors(found, truth), truth.t > SETTLED
        euler.append(np.degrees(rms(error["euler"][counted])))
        wind.append(rms(error["wind"][counted]))
        for part in parts:
            sums[part].append(nees(found, error, part)[counted][::100])
    low, high = chi2.ppf([0.5 - 0.5 * CONFIDENCE, 0.5 + 0.5 * CONFIDENCE], 3 * len(runs))
    table = {}
    for part in parts:
        total = np.sum(sums[part], axis=0)
        share = float(np.mean((total > low) & (total < high)))
        table[part] = (float(np.mean(total)) / len(runs), share)
    return Judged(
        rms(np.array(euler)), rms(np.array(wind)), float(np.max(euler)), float(np.max(wind)), table
    )


def navigation_flight(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds: every seed's attitude and wind, NEES of every part."""
    seconds, seeds = (150.0, 3) if quick else (600.0, 10)
    joint, no_vanes, pair = [], [], []
    for seed in range(seeds):
        inertial, readings, truth = measured(flown(seconds, seed), seed)
        joint.append((navigate_joint(inertial, readings, joint_settings(), every=EVERY), truth))
        without = [r for r in readings if r.kind not in ("alpha", "beta")]
        without.append(assumed_sideslip(inertial))
        no_vanes.append((navigate_joint(inertial, without, joint_settings(), every=EVERY), truth))
        settings = PairSettings(gyro=NOISE["gyro"], gyro_walk=NOISE["gyro_walk"], field=FIELD)
        pair.append((navigate_pair(inertial, readings, settings, every=EVERY), truth))
    best, plain = judged(joint, PARTS), judged(no_vanes, PARTS)
    other = judged(pair, ("turn",))
    inside = all(share >= LEAST_INSIDE for _, share in best.nees.values())
    holds = best.worst_euler < ATTITUDE_MUST and best.worst_wind < WIND_MUST and inside

    def angles(j: Judged) -> str:
        return ", ".join(f"{a:.2f}" for a in j.euler)

    def table(j: Judged) -> str:
        return ", ".join(f"{p} {mean:.1f} ({100 * s:.0f} %)" for p, (mean, s) in j.nees.items())

    got = (
        f"{seeds} flights of {seconds:g} s; joint filter: phi, theta, psi rms {angles(best)} deg "
        f"(largest of a flight {best.worst_euler:.2f}), wind with turbulence "
        f"{', '.join(f'{w:.2f}' for w in best.wind)} m/s ({best.worst_wind:.2f}); NEES of 3, and "
        f"share of times in its {100 * CONFIDENCE:.0f} % bounds: {table(best)}; without alpha and "
        f"beta, sideslip taken to be near zero: {angles(plain)} deg, wind "
        f"{', '.join(f'{w:.2f}' for w in plain.wind)} m/s, NEES {table(plain)}; "
        f"the pair: {angles(other)} deg, NEES {table(other)}"
    )
    return got, holds
