"""Speed of the navigation filters, measured by core/bench/navigation.cpp: the best of several."""

from __future__ import annotations

import programs
from alula.core import ISA

MUST = {"attitude": 0.5, "position": 0.5, "joint": 5.0, "joint_worst": 5.0}  # microseconds
WORDS = {
    "attitude": "attitude step",
    "attitude_update": "its update",
    "position": "position step",
    "position_update": "its late update",
    "joint": "joint step",
    "joint_flight": "mean step at 400 Hz with every sensor at its rate",
    "joint_worst": "a step in which seven sensors come at once",
}


def navigation_speed(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds; that nothing is allocated is tested in core/tests."""
    steps, rounds = (2_000, 5) if quick else (10_000, 30)
    best = programs.run("navigation", ISA, steps, rounds)
    words = "; ".join(f"{WORDS[n]} {d:.3f} ({f:.3f} in float)" for n, (d, f) in best.items())
    holds = all(max(best[name]) < most for name, most in MUST.items())
    return f"µs, double, {ISA}: {words}; no allocations (core/tests/test_navigate.cpp)", holds
