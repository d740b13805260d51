"""Monitor of flow-angle sources: 200 flights with a fault, and ten hours without any.

Truth is the angle of attack of the wandering flight of inflight_calibration.py. Six sources see
it: two vanes, probe, ASSE (5 Hz, often silent), navigation and lift model, each with white noise
and an error that wanders slowly (first order, 5 s). Every flight has its fault at a time, in a
source and of a kind of its own: stuck, 3 deg of bias, noise of 2 deg, or dead.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.signal import lfilter

from alula.airdata.monitor import Source, monitor
from alula.base.arrays import Array
from verification.airdata.inflight_calibration import flown

STEP, SECONDS, HOURS = 0.02, 40.0, 10.0
RUNS, SOON, SHARE = 200, 2.0, 0.95
DEG = float(np.radians(1.0))
WANDER = 5.0  # s
SOURCES = {
    "vane left": Source(0.2 * DEG, 0.15 * DEG),
    "vane right": Source(0.2 * DEG, 0.15 * DEG),
    "probe": Source(0.1 * DEG, 0.2 * DEG),
    "ASSE": Source(0.3 * DEG, 0.4 * DEG, 8),
    "navigation": Source(0.1 * DEG, 0.4 * DEG),
    "model": Source(0.2 * DEG, 0.4 * DEG),
}
KINDS = ("stuck", "biased", "noisy", "dead")


@dataclass(frozen=True)
class Run:
    """One flight with a fault: when, in what, of what kind; who was named, as what, how late."""

    kind: str
    source: str
    named: str
    reason: str
    late: float
    error: float  # rms of the vote after the fault, rad


@cache
def truth() -> Array:
    """Angle of attack of one flight of 300 s at 50 Hz."""
    return np.array(flown(0, 300.0).motion.alpha)[:-1]


def sensed(alpha: Array, random: np.random.Generator) -> dict[str, Array]:
    """What the sources make of it."""
    n, out = len(alpha), {}
    keep = np.exp(-STEP / WANDER)
    for name, source in SOURCES.items():
        drive = source.slow * np.sqrt(1.0 - keep**2) * random.standard_normal(n)
        drive[0] = source.slow * random.standard_normal()
        slow = lfilter([1.0], [1.0, -keep], drive)
        out[name] = alpha + slow + source.white * random.standard_normal(n)
    silent = np.ones(n, dtype=bool)
    silent[::10] = False  # 5 Hz
    out["ASSE"][silent] = np.nan
    return out


def faulty(seed: int) -> Run:
    """One flight with a fault."""
    random = np.random.default_rng([17, seed])
    n = round(SECONDS / STEP)
    begin = int(random.integers(len(truth()) - n))
    alpha = truth()[begin : begin + n]
    readings, t = sensed(alpha, random), np.arange(n) * STEP
    at = round(random.uniform(10.0, SECONDS - 5.0) / STEP)
    name, kind = list(SOURCES)[seed % len(SOURCES)], KINDS[seed // len(SOURCES) % len(KINDS)]
    x = readings[name]
    if kind == "stuck":
        there = np.isfinite(x)
        x[at:] = np.where(there[at:], x[:at][there[:at]][-1], np.nan)
    elif kind == "biased":
        x[at:] += 3.0 * DEG * random.choice([-1.0, 1.0])
    elif kind == "noisy":
        x[at:] += 2.0 * DEG * random.standard_normal(n - at)
    else:
        x[at:] = np.nan
    voted = monitor(t, readings, SOURCES)
    first = voted.named[0] if voted.named else None
    error = float(np.sqrt(np.mean((voted.angle[at:] - alpha[at:]) ** 2)))
    if first is None:
        return Run(kind, name, "", "", np.inf, error)
    return Run(kind, name, first.source, first.reason, first.t - t[at], error)


def false_alarms(hours: float, seed: int = 0) -> int:
    """Sources named in that many hours without any fault; each is back after 10 s."""
    from alula.airdata.monitor import MonitorSettings

    random, count = np.random.default_rng([19, seed]), 0
    done = 0.0
    while done < hours:
        alpha = np.concatenate([truth(), truth()[::-1]] * 3)  # half an hour, without a jump
        voted = monitor(
            np.arange(len(alpha)) * STEP, sensed(alpha, random), SOURCES,
            MonitorSettings(readmit=10.0),
        )  # fmt: skip
        count += len(voted.named)
        done += len(alpha) * STEP / 3600.0
    return count


def check(quick: bool = False) -> tuple[str, bool]:
    """Figures in words, and whether they hold."""
    runs = [faulty(seed) for seed in range(48 if quick else RUNS)]
    good = [r.named == r.source and 0.0 <= r.late <= SOON for r in runs]
    right = [g and r.reason == r.kind for g, r in zip(good, runs, strict=True)]
    alarms = false_alarms(1.0 if quick else HOURS)
    kinds = ", ".join(
        f"{k} {np.mean([g for g, r in zip(good, runs, strict=True) if r.kind == k]):.0%}"
        for k in KINDS
    )
    late = [r.late for g, r in zip(good, runs, strict=True) if g]
    worst = max(r.error for r in runs) / DEG
    return (
        f"{len(runs)} runs: {np.mean(good):.1%} named within {SOON:g} s ({kinds}; median "
        f"{np.median(late):.2f} s; {np.mean(right):.0%} with the right reason); vote errs by at "
        f"most {worst:.2f}° rms after the fault; {alarms} false alarms in "
        f"{1.0 if quick else HOURS:g} h",
        bool(np.mean(good) >= SHARE and alarms < 1),
    )
