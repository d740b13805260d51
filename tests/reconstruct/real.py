"""The example projects on recorded flights, loaded as a user would load them."""

from __future__ import annotations

from pathlib import Path

from alula.aircraft import load_aircraft
from alula.base.project import load_project
from alula.logs.maneuvers import maneuvers
from alula.logs.reader import read_all
from alula.reconstruct import Reconstruction, reconstruct
from data import data

EXAMPLES = Path(__file__).parents[2] / "examples" / "real"


def reconstructed(name: str, *methods: str) -> dict[str, Reconstruction]:
    """The project `name`, whose data are in the folder of that name, by each of the methods."""
    data(name)
    project = load_project(EXAMPLES / f"{name}.toml")
    flights = read_all(project)
    planned, _ = maneuvers(project, flights)
    aircraft = load_aircraft(project.aircraft)
    return {
        method: reconstruct(
            flights, planned, aircraft, project.reconstruct.model_copy(update={"filter": method})
        )
        for method in methods
    }
