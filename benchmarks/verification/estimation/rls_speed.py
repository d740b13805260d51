"""Recursive least squares: time a sample with 8 parameters, histories and standard errors included.

One thread, one Python call over a recording; processor time, so that what else runs on the machine
does not count; the best of several rounds. That nothing is
allocated is tested in core/tests/test_recursive.cpp.
"""

from __future__ import annotations

import time

import numpy as np

from alula.core import ISA
from alula.identify.equation_error.recursive_least_squares import (
    Forgetting,
    recursive_least_squares,
)

PARAMETERS, MUST = 8, 1e-6  # s a sample
KINDS = {
    "no forgetting": Forgetting(),
    "forgetting along the regressor": Forgetting(0.999),
    "plain forgetting": Forgetting(0.999, directional=False),
    "adaptive, window of 50": Forgetting(0.999, window=50),
}


def measure(quick: bool = False) -> dict[str, float]:
    """Seconds a sample by kind of forgetting."""
    samples, rounds = 20_000, 5 if quick else 30
    rng = np.random.default_rng(1)
    x = rng.standard_normal((samples, PARAMETERS))
    z = x @ np.arange(PARAMETERS) + rng.standard_normal(samples)
    best = dict.fromkeys(KINDS, np.inf)
    for _ in range(rounds):
        for name, forgetting in KINDS.items():
            begin = time.thread_time()
            recursive_least_squares(x, z, forgetting)
            best[name] = min(best[name], (time.thread_time() - begin) / samples)
    return best


def check(quick: bool = False) -> tuple[str, bool]:
    """Times in words, and whether the slowest holds."""
    found = measure(quick)
    words = ", ".join(f"{name} {1e6 * s:.2f}" for name, s in found.items())
    return f"µs of processor time a sample ({ISA}): {words}", max(found.values()) < MUST
