"""Time of one ASSE solution of 20 samples, and of one step of its filter, inside the core.

The least of several rounds for every solution along a maneuver, their mean. That nothing is
allocated is tested in core/tests/test_asse.cpp.
"""

from __future__ import annotations

from dataclasses import replace

from alula.airdata.asse import AsseSettings
from alula.core import ISA, core
from verification.asse_flights import flown, sensed

MUST = 5e-6  # s


def asse_speed(quick: bool) -> tuple[str, bool]:
    """Times in words, and whether the solution in double precision holds."""
    made = sensed(flown("sweep"), 0)
    settings = replace(AsseSettings(), block=0.0)  # a solution with every airspeed
    rounds = 10 if quick else 60
    arrays = made.record.arrays()
    window, window_float, step, step_float = core.asse_seconds(
        *arrays, settings.numbers(), 20, rounds
    )
    return (
        f"({ISA}) 20 samples {1e6 * window:.2f} µs, in single precision {1e6 * window_float:.2f}; "
        f"filter {1e6 * step:.2f} µs a step, {1e6 * step_float:.2f}",
        bool(max(window, window_float) < MUST),
    )
