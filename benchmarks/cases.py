"""The path reconstruction case of the shared baselines, and Alula's filters as its peers see them.

The case and the peers live outside the repository (`ALULA_BASELINES`, else `../shared/baselines`):
case 1 is a minute of flight at 100 Hz, 14 states, 7 outputs; its README states the filter.
"""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[1]
BASELINES = Path(os.environ.get("ALULA_BASELINES", ROOT.parent / "shared" / "baselines"))
Case = dict[str, Any]
Filter = Callable[[Case], tuple[np.ndarray, Any]]

# Outputs of the case in the core's order of quantities: height, attitude, airspeed, the two linear
# vanes of which the angle of attack has upwash.
_QUANTITIES = (0, 1, 2, 3, 4, 6, 9)
_VANES = (5.0, 0.0, 0.0)


def available() -> bool:
    """True where the baselines are found; then their modules can be imported."""
    if not (BASELINES / "path_reconstruction.py").exists():
        return False
    if str(BASELINES) not in sys.path:
        sys.path.insert(0, str(BASELINES))
    return True


def case() -> Case:
    """Arrays of case 1."""
    return dict(importlib.import_module("path_model").case())


def peers() -> Any:
    """The module that holds `ukf_numba`, `ekf_numba`, `ukf_numpy`, `ekf_numpy`."""
    return importlib.import_module("path_reconstruction")


def ours(module: str, name: str, c: Case) -> Filter:
    """Alula's filter `name` (ekf, iekf, ukf, srukf) for this case, of the compiled `module`."""
    core = importlib.import_module(f"alula.{module}")
    model = core.PathModel()
    model.states, model.motion, model.dynamic, model.gravity = 14, 7, 13, 9.80665
    for i in range(6):
        model.set_unknown(i, 7 + i)
    model.set_input_sigma([float(s) for s in c["sigma_imu"]])
    for i in range(7):
        model.set_walk(7 + i, float(c["sigma_walk"][i]))
    for k, quantity in enumerate(_QUANTITIES):
        place = _VANES if k > 4 else (0.0, 0.0, 0.0)
        slot = 13 if k == 5 else -1
        model.add_sensor(quantity, place, float(c["sigma_z"][k]), scale_slot=slot)
    start = np.full(len(c["t"]), -1, dtype=np.int32)
    start[0] = 0
    sigma = np.sqrt(np.diag(c["P0"]))
    initial = np.concatenate([c["x0"][:7], sigma[:7]])[None]
    run = getattr(core, f"path_{name}")

    def filtered(c: Case) -> tuple[np.ndarray, Any]:
        out = run(model, c["t"], c["inputs"], c["measurements"], start, initial, c["x0"], sigma)
        return out["x"][-1], out["x"]

    return filtered


def difference(a: np.ndarray, b: np.ndarray) -> float:
    """Largest |a - b| / max(|b|, 1e-3) over the states, as the baselines define it."""
    return float(np.max(np.abs(a - b) / np.maximum(np.abs(b), 1e-3)))
