"""The SportStar exported to JSBSim and flown there beside Alula, with engine and stall."""

from __future__ import annotations

import tempfile

import numpy as np

from alula.aircraft import load_aircraft
from alula.export.jsbsim import export_jsbsim
from alula.export.jsbsim_check import ANGLES
from alula.model import load_model
from alula.simulate import airframe_of
from verification.places import ROOT


def exported_jsbsim(quick: bool) -> tuple[str, bool]:
    """The row 'exported SportStar flown in JSBSim': what remains after 20 s of each doublet."""
    aircraft = load_aircraft(ROOT / "aircraft" / "sportstar.toml")
    assert aircraft.aero is not None
    model = load_model(aircraft.aero)
    airframe = airframe_of(aircraft, engines="modeled")
    with tempfile.TemporaryDirectory() as folder:
        done = export_jsbsim(aircraft, airframe, model, folder)
    words = []
    for c in done.comparisons:
        worst = max(ANGLES, key=lambda n: c.difference[n])
        words.append(
            f"{c.maneuver}: V {c.difference['V']:.2g} m/s, worst angle {worst} "
            f"{np.degrees(c.difference[worst]):.2g} deg"
        )
    remains = "what remains is of first order in JSBSim's step, here 1 ms"
    return "; ".join((*words, remains)), all(c.passed for c in done.comparisons)
