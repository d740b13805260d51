"""The demo flown with many seeds: how often the 95 % intervals hold the truth.

The noise, the sensors' biases and scale errors differ from seed to seed; the aircraft and its
maneuvers are the same. Nothing of the estimate is told to the simulation or the other way round.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from verification.places import ROOT

sys.path.insert(0, str(ROOT / "examples" / "demo"))


@dataclass(frozen=True)
class Estimate:
    """One parameter of one seed."""

    name: str
    value: float
    se: float
    low: float
    high: float
    truth: float
    verdict: str

    @property
    def covered(self) -> bool:
        """Whether the 95 % interval holds the truth."""
        return self.low <= self.truth <= self.high


@dataclass(frozen=True)
class Coverage:
    """pooled, and by parameter, over the seeds."""

    pooled: float
    by_parameter: dict[str, float]
    worst: tuple[str, float]


def identify_demo(seed: int) -> list[Estimate]:
    """The demo with one seed. Parameters that the truth lacks are constants whose truth is zero."""
    from make_logs import simulate_demo

    from alula.campaign import run_project

    with tempfile.TemporaryDirectory() as folder:
        files = simulate_demo(seed, Path(folder))
        truth = json.loads(files.truth.read_text())["parameters"]
        found = run_project(str(files.project), truth=truth).identification
    return [
        Estimate(p.name, p.value, p.se, *p.ci95, truth.get(p.name, 0.0), p.verdict)
        for p in found.parameters
    ]


def run_seeds(seeds: Iterable[int], workers: int = 2) -> list[list[Estimate]]:
    """The demo for every seed, side by side."""
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(identify_demo, seeds))


def coverage(runs: list[list[Estimate]]) -> Coverage:
    """Share of intervals that hold the truth."""
    by: dict[str, list[bool]] = {}
    for run in runs:
        for estimate in run:
            by.setdefault(estimate.name, []).append(estimate.covered)
    shares = {name: float(np.mean(hits)) for name, hits in by.items()}
    worst = min(shares, key=lambda name: shares[name])
    pooled = float(np.mean([hit for hits in by.values() for hit in hits]))
    return Coverage(pooled, shares, (worst, shares[worst]))
