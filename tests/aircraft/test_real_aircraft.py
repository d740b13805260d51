"""The ready aircraft and the projects on real data load, and agree with the recordings."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.base.project import load_project
from data import ROOT, data

HOUSE = Path(__file__).parents[2]


PROJECTS = [
    path
    for path in sorted((HOUSE / "examples/real").glob("*.toml"))
    if 'schema = "alula.project/1"' in path.read_text()
]


@pytest.mark.parametrize("path", PROJECTS, ids=lambda p: p.stem)
def test_real_projects_load(path: Path) -> None:
    project = load_project(path)
    assert project.aircraft is not None
    aircraft = load_aircraft(project.aircraft)
    assert all(log.path.is_relative_to(ROOT) for log in project.logs)
    # A coefficient computed from motion needs mass; a recorded one does not.
    needs_mass = project.identify.models and project.identify.coefficients_from == "motion"
    assert aircraft.mass is not None or not needs_mass


def test_citation_inertia_keeps_its_radii_of_gyration_and_says_it_is_at_the_limit() -> None:
    aircraft = load_aircraft(HOUSE / "aircraft/citation.toml")
    got = aircraft.mass_properties(np.array([0.0, 500.0]))
    ratio = got.inertia / got.mass[:, None, None]
    np.testing.assert_allclose(ratio[1], ratio[0], rtol=1e-4)  # five figures in the file
    assert [m.code for m in aircraft.messages] == ["inertia_at_limit"]


def test_twin_otter_span_and_chord_are_the_recording_s() -> None:
    aircraft = load_aircraft(HOUSE / "aircraft/twin_otter.toml")
    x = scipy.io.loadmat(data("twin_otter", "totter_lon_020213f1_018.mat"))["fdata"]
    S, b, c = x[0, 76:79] * np.array([0.3048**2, 0.3048, 0.3048])
    np.testing.assert_allclose([aircraft.b, aircraft.c], [b, c], rtol=1e-3)  # of four figures
    np.testing.assert_allclose(aircraft.S, S, rtol=1e-2)  # the type's 420 ft2, here 422.5


def test_attas_accelerometers_are_not_at_the_center_of_gravity_they_are_named_for() -> None:
    """With the file's arms the side force depends on sideslip as found elsewhere, CYb -1.0035."""
    aircraft = load_aircraft(HOUSE / "aircraft/attas.toml")
    mass = aircraft.mass_properties(np.zeros(1)).mass[0]

    def side_force(arm: Array) -> tuple[float, float]:
        """Slope of CY on beta and its R2, aileron and rudder maneuver together."""
        CY, beta = [], []
        for name in ("Ail1", "Rud1"):
            x = scipy.io.loadmat(data("attas", f"fAttas{name}.mat"))[f"fAttas{name}"]
            w, dw = np.radians(x[:, 6:9]), np.radians(x[:, 16:19])
            ay = (x[:, 1:4] - np.cross(dw, arm) - np.cross(w, np.cross(w, arm)))[:, 1]
            boom = np.cross(w, aircraft.sensor_position("beta"))[:, 1]
            beta.append(np.radians(x[:, 13]) - boom / x[:, 14])
            CY.append(mass * ay / (0.5 * x[:, 33] * x[:, 14] ** 2 * aircraft.S))
        y, b = np.concatenate(CY), np.concatenate(beta)
        return float(np.polyfit(b, y, 1)[0]), float(np.corrcoef(b, y)[0, 1] ** 2)

    slope, r2 = side_force(aircraft.sensor_position("ay"))
    assert slope == pytest.approx(-1.0035, rel=0.06)  # both are cross-checks, not truth
    assert r2 > 0.96
    assert side_force(np.zeros(3))[1] < 0.96


@pytest.mark.parametrize("way", ["totals", "components"])
def test_the_documented_file_loads(tmp_path: Path, way: str) -> None:
    """The blocks of docs/aircraft_file.md in their order make an aircraft file, in either way."""
    text = (HOUSE / "docs/aircraft_file.md").read_text()
    blocks = re.findall(r"```toml\n(.*?)```", text, flags=re.DOTALL)
    left_out = blocks[2 if way == "totals" else 1]
    assert ("[[mass.components]]" in left_out) == (way == "totals")
    # Totals include the persons; tanks stand in place of the fuel.
    others = "[[mass.tanks]]", *(["[[mass.persons]]"] if way == "totals" else [])
    blocks = [b for b in blocks if b is not left_out and not b.startswith(others)]
    file = "".join(blocks)
    path = tmp_path / "aircraft.toml"
    path.write_text(file if way == "totals" else file.replace('"mass.Ixz", ', ""))
    aircraft = load_aircraft(path)
    assert aircraft.messages == ()
    assert aircraft.mass is not None
    assert aircraft.mass.fuel is not None
    assert set(aircraft.sensors) == {"imu", "airdata", "gps", "beta"}
