"""The ARM-Hawk's accelerometer in 18 static positions (Pusztai 2018, Eq. (3.15), appendix D)."""

from __future__ import annotations

import numpy as np

from alula.navigate.calibration import calibrate
from alula.navigate.calibration.result import Errors, length_errors
from verification.places import ROOT

PROJECT = ROOT / "examples/real/armhawk_calibration.toml"
# The author's published matrix and offset (m/s2).
MATRIX = np.array(
    [
        [9.8459e-01, 8.0660e-04, -2.3062e-02],
        [-3.3592e-03, 1.0027e00, 2.4024e-03],
        [4.9667e-03, -3.3054e-03, 1.0109e00],
    ]
)
OFFSET = np.array([-7.6722e-02, -8.5341e-02, -7.2458e-02])
BEFORE, LARGEST, RMS = "2.08", 0.30, 0.16  # percent


def armhawk_accelerometer(quick: bool) -> tuple[str, bool]:
    """Error of the length before and after, with the author's matrix on the same data beside it."""
    found = calibrate(PROJECT).sensors["accelerometer"]
    author = length_errors((found.raw - OFFSET) @ MATRIX.T, found.length)
    holds = (
        len(found.raw) == 18
        and f"{100.0 * found.before.largest:.2f}" == BEFORE
        and 100.0 * found.after.largest <= LARGEST
        and 100.0 * found.after.rms <= RMS
        and found.determined
    )
    return (
        f"before {_percent(found.before)}, after {_percent(found.after)}; "
        f"the author's matrix {_percent(author)} (largest and rms)",
        holds,
    )


def _percent(errors: Errors) -> str:
    return f"{100.0 * errors.largest:.3f} % and {100.0 * errors.rms:.3f} %"
