"""Five-hole probe: time of one inverse in the core, c_p with its sine left in, over the domain.

One thread; a loop in the core over many pressures, the least of several rounds. That nothing is
allocated is tested in core/tests/test_airdata.cpp.
"""

from __future__ import annotations

import numpy as np

from alula.core import ISA
from verification.airdata.armhawk_probe import cfd, probes

MUST = 0.5e-6  # s


def measure(quick: bool = False) -> dict[str, float]:
    """Seconds for one inverse, by probe and scalar."""
    random = np.random.default_rng(1)
    n, out = 2000, {}
    a, b = random.uniform(-np.radians(30.0), np.radians(30.0), (2, n))
    for name, probe in probes(cfd()).items():
        p = probe.pressures(random.uniform(50.0, 1000.0, n), a, b)
        for single in (False, True):
            kind = f"{name}, {'float' if single else 'double'}"
            out[kind] = probe.time_of_inverse(p, 20 if quick else 200, single)
    return out


def check(quick: bool = False) -> tuple[str, bool]:
    """Times in words, and whether the slowest holds."""
    found = measure(quick)
    words = ", ".join(f"{name} {1e6 * s:.3f}" for name, s in found.items())
    return f"µs for one inverse ({ISA}): {words}", max(found.values()) < MUST
