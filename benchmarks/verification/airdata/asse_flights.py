"""Lerro's two maneuvers (J. Guidance 2020, Figures 2 and 3), flown by the SportStar.

From trim, throttle and the other controls held; the propeller turns and the trim is not quite
symmetric, as in his. Stall: a short dive, then a smooth pull beyond the stalling angle, elevator
alone. Sweep: steps of the rudder alone, shorter and shorter.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from alula.aircraft import load_aircraft
from alula.airdata.asse import AsseRecord, AsseSettings, gravity_in_body
from alula.base.arrays import Array
from alula.model import load_model
from alula.simulate import Condition, airframe_of, fly, trim
from alula.simulate.inputs import Signal, Steps, Sum
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft" / "sportstar.toml"
DEG = np.pi / 180.0
STEP = 1e-4  # s, of the simulation
STALL = Sum(
    (
        Steps(2.5 * DEG, 2.0, (2.0,), (1.0,), 1.0),
        Steps(-6.0 * DEG, 4.5, (3.0, 3.5, 1.0), (0.4, 0.7, 0.9), 2.0),
    )
)
RUDDER = (1.0, 2.0, 2.0, 1.8, 1.8, 1.5, 1.5, 1.2, 1.2, 1.0, 0.5)  # s
SWEEP = Steps(8.0 * DEG, 2.0, RUDDER, tuple((-1.0) ** i for i in range(len(RUDDER))), 0.5)


@dataclass(frozen=True)
class Flown:
    """A maneuver every 0.1 ms: t (n,), V, alpha, beta (n,); f, w (n, 3); Euler angles (n, 3).

    excited: the angle the maneuver excites. first, last: s of its first and last control input.
    """

    excited: str
    first: float
    last: float
    t: Array
    V: Array
    alpha: Array
    beta: Array
    f: Array
    w: Array
    euler: Array

    def between(self, t: Array) -> NDArray[np.bool_]:
        """Which of times t (n,) lie between first and last control input."""
        return np.asarray((t >= self.first) & (t <= self.last))

    def record(self, every: int = 1, airspeed_every: int = 1) -> AsseRecord:
        """Without noise, every so many steps; the airspeed at every so many of those."""
        part = slice(None, None, every)
        V = np.array(self.V[part])
        V[np.arange(len(V)) % airspeed_every != 0] = np.nan
        gravity = gravity_in_body(self.euler[part, 0], self.euler[part, 1])
        return AsseRecord(t=self.t[part], f=self.f[part], w=self.w[part], gravity=gravity, V=V)


@cache
def flown(kind: str) -> Flown:
    """'stall' or 'sweep'."""
    frame = airframe_of(load_aircraft(AIRCRAFT), engines="modeled")
    model = load_model(AIRCRAFT.with_name("sportstar_aero.toml"))
    chosen: dict[str, tuple[str, Signal, float, float, float]] = {
        "stall": ("de", STALL, 32.0, 14.5, 14.0),
        "sweep": ("dr", SWEEP, 38.0, 18.5, 2.0 + sum(RUDDER) + 0.5),
    }
    channel, signal, V, seconds, last = chosen[kind]
    start = trim(frame, model, Condition(V, 1500.0))
    t = np.asarray(np.arange(round(seconds / STEP) + 1) * STEP, dtype=np.float64)
    controls: dict[str, Array | float] = {**start.inputs}
    controls[channel] = start.controls[channel] + signal.value(t)
    m = fly(frame, model, start.state, t, controls).motion
    return Flown(
        excited="alpha" if kind == "stall" else "beta", first=2.0, last=last,
        t=m.t, V=m.V, alpha=m.alpha, beta=m.beta,
        f=np.stack([m.ax, m.ay, m.az], axis=1), w=np.stack([m.p, m.q, m.r], axis=1),
        euler=np.stack([m.phi, m.theta, m.psi], axis=1),
    )  # fmt: skip


@dataclass(frozen=True)
class Sensed:
    """One seed: the record at 100 Hz, the truth there, and what the estimator is told first."""

    record: AsseRecord
    t: Array
    alpha: Array
    beta: Array
    settings: AsseSettings


def sensed(flight: Flown, seed: int, delay: float = 0.0) -> Sensed:
    """The maneuver as an IMU of Xsens MTi-G class senses it, 100 Hz, and a pitot tube at 50 Hz.

    Noise 0.05 deg/s and 0.002 m/s2 per root hertz, accelerometer bias 0.02 m/s2, bank and pitch to
    1 deg rms in motion, taken as correlated over 20 s. Gyro bias 0.1 deg/s: what is left of the
    1 deg/s over temperature after zeroing at rest before the flight. Airspeed noise 0.3 m/s per
    sample. The first guess of the angles is drawn from its own uncertainty, 5 deg. delay: s by
    which the airspeed is late, a multiple of 10 ms.
    """
    rate, settings = 100.0, AsseSettings(delay=delay)
    random = np.random.default_rng(seed)
    exact = flight.record(round(1.0 / (rate * STEP)))
    n, root = len(exact.t), np.sqrt(rate)

    def noise(density: float, bias: float) -> Array:
        white = random.normal(0.0, density * root, (n, 3))
        return np.asarray(white + random.normal(0.0, bias, 3))

    f = exact.f + noise(settings.density_a, settings.sigma_a)
    w = exact.w + noise(settings.density_w, settings.sigma_w)
    keep = np.exp(-1.0 / (rate * settings.tilt_time))
    error = random.normal(0.0, settings.sigma_tilt, (n, 2))
    error[1:] *= np.sqrt(1.0 - keep**2)
    for i in range(1, n):
        error[i] += keep * error[i - 1]
    euler = flight.euler[:: round(1.0 / (rate * STEP))]
    late = round(delay * rate)
    V = np.concatenate([np.full(late, exact.V[0]), exact.V[: n - late]])
    V = V + random.normal(0.0, settings.sigma_V, n)
    V[1::2] = np.nan
    part = slice(None, None, round(1.0 / (rate * STEP)))
    alpha, beta = flight.alpha[part], flight.beta[part]
    guess = random.normal(0.0, settings.first_sigma, 2)
    return Sensed(
        record=AsseRecord(
            t=exact.t, f=f, w=w, V=V,
            gravity=gravity_in_body(euler[:, 0] + error[:, 0], euler[:, 1] + error[:, 1]),
        ),
        t=exact.t, alpha=alpha, beta=beta,
        settings=AsseSettings(
            delay=delay, first_alpha=float(alpha[0] + guess[0]),
            first_beta=float(beta[0] + guess[1]),
        ),
    )  # fmt: skip
