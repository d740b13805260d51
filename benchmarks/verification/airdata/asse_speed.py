"""Time of one ASSE solution of 20 samples, and of one step of its filter: core/bench/asse.cpp.

The least of several rounds for every solution along a maneuver, their mean. That nothing is
allocated is tested in core/tests/test_asse.cpp.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace

import numpy as np

import programs
from alula.airdata.asse import AsseSettings
from alula.core import ISA
from verification.airdata.asse_flights import flown, sensed

MUST = 5e-6  # s


def asse_speed(quick: bool) -> tuple[str, bool]:
    """Times in words, and whether the solution in double precision holds."""
    made = sensed(flown("sweep"), 0)
    settings = replace(AsseSettings(), block=0.0)  # a solution with every airspeed
    rounds = 10 if quick else 60
    rows = np.column_stack(made.record.arrays())
    with tempfile.NamedTemporaryFile(suffix=".doubles") as file:
        file.write(np.asarray(settings.numbers(), dtype=np.float64).tobytes() + rows.tobytes())
        file.flush()
        found = programs.run("asse", ISA, file.name, 20, rounds)
    (window, window_float), (step, step_float) = found["window"], found["step"]
    return (
        f"({ISA}) 20 samples {1e6 * window:.2f} µs, in single precision {1e6 * window_float:.2f}; "
        f"filter {1e6 * step:.2f} µs a step, {1e6 * step_float:.2f}",
        bool(max(window, window_float) < MUST),
    )
