"""Flies an exported aircraft in JSBSim, in a process of its own: it prints, and it may crash.

python -P jsbsim_child.py FOLDER NAME IN.npz OUT.npz; it loads nothing else of Alula.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

FT = 0.3048


def main(folder: str, name: str, given: str, out: str) -> None:
    """Read the run from IN.npz, fly, write OUT.npz.

    IN: initial (dict of property and value), commands (n, k) with their names, dt, substeps,
    outputs (names of properties). OUT: values (n, m), one row per sample.
    """
    import jsbsim

    with np.load(given) as run:
        initial = dict(zip(run["initial_names"].tolist(), run["initial"].tolist(), strict=True))
        start = dict(zip(run["start_names"].tolist(), run["start"].tolist(), strict=True))
        commands, names = run["commands"], run["command_names"].tolist()
        dt, substeps = float(run["dt"]), int(run["substeps"])
        outputs = run["outputs"].tolist()
    fdm: Any = jsbsim.FGFDMExec(None)
    fdm.set_debug_level(0)
    fdm.set_aircraft_path(folder)
    fdm.load_model(name)
    fdm.set_dt(dt / substeps)
    for key, x in initial.items():
        fdm[key] = x
    for key, x in zip(names, commands[0], strict=True):
        fdm[key] = x
    if not fdm.run_ic():
        raise RuntimeError("JSBSim did not take the initial conditions")
    for key, x in start.items():
        fdm[key] = x
    # The first run advances nothing yet but sees commands and states; outputs follow each run.
    values = np.empty((len(commands), len(outputs)))
    for i in range(len(commands)):
        if i:
            before, change = commands[i - 1], commands[i] - commands[i - 1]
            moving = np.flatnonzero(change).tolist()
            for key, x in zip(names, before, strict=True):
                fdm[key] = x
            for j in range(substeps):
                for k in moving:
                    fdm[names[k]] = before[k] + j / substeps * change[k]
                fdm.run()
        values[i] = [fdm[key] for key in outputs]
    np.savez(Path(out), values=values)


if __name__ == "__main__":
    main(*sys.argv[1:5])
