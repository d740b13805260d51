"""A body that tumbles free of any moment: a million steps, rate times step 0.005."""

from __future__ import annotations

import numpy as np

from alula.core import core

INERTIA = np.array([[900.0, 60.0, -80.0], [60.0, 1000.0, 30.0], [-80.0, 30.0, 1700.0]])
TOLERANCE = 1e-9
# About no axis, near the middle one (which is not stable), near the long and the short one.
RATES = ((1.0, -2.0, 1.5), (0.01, 2.7, 0.01), (2.7, 0.2, 0.1), (0.1, 0.2, 2.7))


def drifts(steps: int = 1_000_000) -> dict[str, float]:
    """Largest relative drift over the cases: energy, length and vector of the angular momentum."""
    worst = np.zeros(3)
    for rates in RATES:
        w = np.array(rates)
        found = core.tumbling_drift(INERTIA, w, 0.005 / float(np.linalg.norm(w)), steps)
        worst = np.maximum(worst, found)
    return dict(zip(("energy", "momentum", "direction"), worst.tolist(), strict=True))


def check(quick: bool = False) -> tuple[str, bool]:
    """What was found, and whether energy and angular momentum stay within 1e-9."""
    found = drifts(100_000 if quick else 1_000_000)
    words = (
        f"energy {found['energy']:.1e}, angular momentum {found['momentum']:.1e}, as a vector in "
        f"inertial axes {found['direction']:.1e} (4 motions)"
    )
    return words, max(found.values()) < TOLERANCE
