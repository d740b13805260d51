"""SportStar maneuvers with 200 seeds of noise: how often 95 % intervals hold the aircraft file.

Output error: white noise on its outputs, and noise with a memory of three samples. Equation error:
the same flights go through reconstruction first, whose covariance the intervals carry.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.identify.flown.output_error import identify_output_error
from alula.identify.result import Identification
from alula.simulate import SimulatedFlight
from alula.simulate.inputs import Steps
from verification.estimation.noisy_flights import (
    LATERAL,
    LONGITUDINAL,
    Aircraft,
    flown,
    measured,
    sportstar,
)
from verification.main_job.demo_coverage import coverage, run_seeds

DEG = np.pi / 180.0
MEMORY = np.exp(-1.0 / 3.0)  # from sample to sample: of three samples, 0.12 s
PITCH = {"CD": "1 + alpha", "CL": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de"}
ROLL = {
    "CY": "1 + beta + phat + rhat + dr",
    "Cl": "1 + beta + phat + rhat + da + dr",
    "Cn": "1 + beta + phat + rhat + da + dr",
}
CASES = {"longitudinal": (PITCH, LONGITUDINAL), "lateral": (ROLL, LATERAL)}


def flights(aircraft: Aircraft) -> dict[str, SimulatedFlight]:
    """One elevator maneuver, one of rudder and aileron, from level flight at 38 m/s."""
    de = Steps(-1.5 * DEG, 1.0, (1.2, 0.8, 0.4, 0.4), (1.0, -1.0, 1.0, -1.0), 0.1)
    dr = Steps(3.0 * DEG, 1.0, (0.9, 0.9), (1.0, -1.0), 0.1)
    da = Steps(3.0 * DEG, 5.0, (0.8, 1.6, 0.8), (1.0, -1.0, 1.0), 0.1)
    return {
        "longitudinal": flown(
            aircraft, "elevator", {"de": de}, seconds=15.0, rate=25.0, aspect="longitudinal"
        ),
        "lateral": flown(
            aircraft, "lateral", {"dr": dr, "da": da}, seconds=12.0, rate=25.0, aspect="lateral"
        ),
    }


def output_error(
    aircraft: Aircraft, flight: SimulatedFlight, aspect: str, seed: int, memory: float
) -> Identification:
    """One seed of one maneuver. Constants that the aircraft file lacks are zero in truth."""
    formulas, outputs = CASES[aspect]
    return identify_output_error(
        [measured(aircraft, flight, outputs, seed, memory)],
        formulas,
        states=aspect,
        outputs=outputs,
        truth={"CY_0": 0.0, "Cl_0": 0.0, "Cn_0": 0.0, **aircraft.model.params},
    )


@dataclass(frozen=True)
class Covered:
    """Hits (runs, k) of the intervals and errors (runs, k) in standard errors; what failed."""

    names: tuple[str, ...]
    hits: Array
    errors: Array
    failed: int

    @property
    def share(self) -> float:
        """Pooled."""
        return float(np.mean(self.hits))


def cover(runs: int, memory: float, first: int = 0) -> Covered:
    """Both maneuvers with every seed; a failed search or a lost parameter counts as a miss."""
    aircraft = sportstar()
    names: list[str] = []
    hits, errors, failed = [], [], 0
    for aspect, flight in flights(aircraft).items():
        h, e = [], []
        for seed in range(first, first + runs):
            found = output_error(aircraft, flight, aspect, seed, memory)
            own = [p for p in found.parameters if p.truth is not None]
            failed += not found.status.startswith("converged")
            h.append([bool(p.ci95[0] <= p.truth <= p.ci95[1]) for p in own])
            e.append([(p.value - p.truth) / p.se for p in own])
        names += [p.name for p in own]
        hits.append(np.array(h, dtype=float))
        errors.append(np.array(e))
    return Covered(tuple(names), np.hstack(hits), np.hstack(errors), failed)


def worst(c: Covered) -> str:
    """The parameter whose intervals hold least often."""
    shares = c.hits.mean(axis=0)
    i = int(np.argmin(shares))
    return f"{c.names[i]} {shares[i]:.0%}"


def campaign_coverage(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds."""
    runs, demo = (20, 4) if quick else (200, 16)
    white, coloured = cover(runs, 0.0), cover(runs, MEMORY)
    regression = run_seeds(range(demo), workers=1)
    by = coverage(regression)
    bias: dict[str, float] = {}
    for name in dict.fromkeys(e.name for run in regression for e in run):
        z = [(e.value - e.truth) / e.se for run in regression for e in run if e.name == name]
        bias[name] = float(np.nanmean(z))
    most = sorted(bias, key=lambda n: -abs(bias[n]))[:3]
    got = (
        f"{runs} seeds, output error: white noise {white.share:.1%} (least {worst(white)}), "
        f"coloured {coloured.share:.1%} (least {worst(coloured)}), "
        f"{white.failed + coloured.failed} of {4 * runs} searches failed; {demo} demo campaigns "
        f"through reconstruction, equation error: {by.pooled:.1%} (least {by.worst[0]} "
        f"{by.worst[1]:.0%}); its bias by noisy regressors, in standard errors: "
        + ", ".join(f"{n} {bias[n]:+.2f}" for n in most)
    )
    slack = 0.03 if quick else 0.0  # of 20 seeds with intervals that are not independent
    holds = (
        0.92 - slack <= white.share <= 0.98 + slack
        and 0.88 - slack <= coloured.share <= 0.99
        and 0.85 - slack <= by.pooled <= 0.99
    )
    return got, holds
