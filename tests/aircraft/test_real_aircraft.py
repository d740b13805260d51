"""The ready aircraft and the projects on real data load, and agree with the recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.io

from alula.aircraft import load_aircraft
from alula.base.project import load_project
from data import ROOT, data

HOUSE = Path(__file__).parents[2]


@pytest.mark.parametrize(
    "path", sorted((HOUSE / "examples/real").glob("*.toml")), ids=lambda p: p.stem
)
def test_real_projects_load(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ALULA_DATA", str(ROOT))
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
