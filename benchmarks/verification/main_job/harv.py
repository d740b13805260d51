"""The HARV compatibility check, with the publication's initial motion read from its own file.

The publication holds a smoothed initial motion fixed and lets its scale errors act about it. The
three numbers belong to the data, so they are taken from there and stand in no file of ours.
"""

from __future__ import annotations

from pathlib import Path

from alula.aircraft import load_aircraft
from alula.base.project import InitialSpec, load_project
from alula.logs.maneuvers import maneuvers
from alula.logs.reader import read_all
from alula.reconstruct import Reconstruction, reconstruct
from verification.places import ROOT

PROJECT = ROOT / "examples" / "real" / "harv.toml"


def harv_reconstruction(recording: Path) -> Reconstruction:
    """The example project by maximum likelihood. recording: compat_lon_example.mat; ALULA_DATA must
    name the folder it is in.
    """
    from scipy.io import loadmat

    x0 = loadmat(recording)["x0"].ravel()  # u v w ft/s, phi theta psi rad
    initial = {
        "u": InitialSpec(value=float(x0[0]), unit="ft/s"),
        "w": InitialSpec(value=float(x0[2]), unit="ft/s"),
        "theta": InitialSpec(value=float(x0[4]), unit="rad"),
    }
    project = load_project(PROJECT)
    flights = read_all(project)
    chosen, _ = maneuvers(project, flights)
    spec = project.reconstruct.model_copy(update={"initial": {chosen[0].id: initial}})
    return reconstruct(flights, chosen, load_aircraft(project.aircraft), spec)
