"""The ARM-Hawk's magnetometer turned through all directions (Pusztai 2018, Eq. (3.17) to (3.20),
appendix D)."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.navigate.calibration import calibrate
from verification.places import ROOT

PROJECT = ROOT / "examples/real/armhawk_calibration.toml"
# The author's published matrix and hard-iron offset (T).
MATRIX = np.array(
    [
        [1.0491e00, 1.7427e-02, 1.7537e-02],
        [-1.7268e-02, 1.0827e00, -9.2422e-03],
        [-4.1222e-02, 3.3487e-03, 1.0721e00],
    ]
)
OFFSET = np.array([-1.0318e-04, -6.9476e-05, -7.3740e-05])
CURRENT = np.array([8.2807e-09, 1.2813e-08, -2.3106e-08])  # T/A
NEAR = 0.2e-6  # T


def armhawk_magnetometer(quick: bool) -> tuple[str, bool]:
    """Hard iron beside the author's; rms of the field's magnitude with both calibrations."""
    found = calibrate(PROJECT).sensors["magnetometer"]
    ours = _rms(found.calibrated, found.length)
    author = _rms((found.raw - OFFSET) @ MATRIX.T, found.length)
    away = found.offset - OFFSET
    current = float(np.max(np.abs(found.current - CURRENT)))
    holds = bool(np.all(np.abs(away) <= NEAR)) and ours <= author and found.determined
    return (
        f"hard iron {', '.join(f'{1e6 * v:+.3f}' for v in away)} µT from the author's; rms of the "
        f"magnitude {1e6 * ours:.4f} µT, with his matrix {1e6 * author:.4f} µT; "
        f"current's field within {1e12 * current:.2g} pT/A of his",
        holds,
    )


def _rms(field: Array, length: Array) -> float:
    return float(np.sqrt(np.mean((np.linalg.norm(field, axis=1) - length) ** 2)))
