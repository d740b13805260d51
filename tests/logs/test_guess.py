"""`alula new`: a project file guessed from a log."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.base.project import Project, load_project
from alula.logs import new_project, read_all
from alula.logs.synonyms import guess_name
from data import data
from logs.made import csv_text, flight_table


def guessed(log: Path, folder: Path) -> tuple[str, Project]:
    text = new_project(log, folder)
    (folder / "project.toml").write_text(text, encoding="utf-8")
    return text, load_project(folder / "project.toml")


@pytest.mark.parametrize(
    ("label", "name", "unit"),
    [
        ("ALCG", "alpha", ""),
        ("aoa", "alpha", ""),
        ("alpha_deg", "alpha", "deg"),
        ("TAS", "V", ""),
        ("Dadc1_tas", "V", ""),
        ("pitch", "theta", ""),
        ("elevator", "de", ""),
        ("p_deg_s", "p", "deg/s"),
        ("h_ft", "h", "ft"),
        ("az_g", "az", "g"),
        ("V_kt", "V", "kt"),
        ("V_cas", "V_cas", ""),
        ("eulerAngle_deg_Yaw", "psi", "deg"),
        ("CL", "CL", ""),
        ("Cl", "Cl", ""),
        ("V", "V", ""),
        ("v", "v", ""),
        ("elephants", "", ""),
        ("engine_temp_bearing", "", ""),
    ],
)
def test_names(label: str, name: str, unit: str) -> None:
    assert guess_name(label) == (name, unit)


def test_a_csv_log(tmp_path: Path) -> None:
    table = flight_table()
    names = ("Time", "Nz [g]", "PitchRate (deg/s)", "Pitch", 'bearing\u2028 "temp"')
    (tmp_path / "my log.csv").write_text(csv_text(table * [1, 1 / 9.80665, 1, 1, 1], names=names))
    text, project = guessed(tmp_path / "my log.csv", tmp_path)
    assert list(project.channels) == ["t", "az", "q", "theta"]
    assert all(
        "# confirm" in line for line in text.splitlines() if line.startswith(("t =", "az ="))
    )
    flight = read_all(project)["my_log"]
    np.testing.assert_allclose(flight["az"].values, table[:, 1], rtol=1e-14)
    np.testing.assert_allclose(flight["q"].values, np.radians(table[:, 2]), rtol=1e-14)
    np.testing.assert_allclose(flight["theta"].values, np.radians(table[:, 3]), rtol=1e-14)
    (maneuver,) = project.maneuvers
    assert (maneuver.start, maneuver.end) == (table[0, 0], table[-1, 0])
    assert "temp" in text  # the column without a guess is listed


def test_z_up_and_fill_values_are_guessed(tmp_path: Path) -> None:
    table = flight_table()
    table[:, 1] *= -1
    table[10, 4] = -9999
    (tmp_path / "log.csv").write_text(csv_text(table))
    _, project = guessed(tmp_path / "log.csv", tmp_path)
    assert project.channels["az"].sign == -1
    assert project.logs[0].fill_values == [-9999]
    assert np.isnan(read_all(project)["log"]["V"].values[10])


def test_citation(tmp_path: Path) -> None:
    """Units as the data's own description states them; knots by the Mach number beside them,
    feet by the rate of climb.
    """
    _, project = guessed(data("citation_ph_lab", "flight.npz"), tmp_path)
    right = {"q": "deg/s", "theta": "deg", "alpha": "deg", "de": "deg", "temperature": "degC"}
    right |= {"lon": "deg", "climb_rate": "ft/min", "t": "s", "V": "kt", "V_cas": "kt", "h": "ft"}
    assert {name: project.channels[name].unit for name in right} == right
    az = project.channels["az"]  # "g with 1 g removed"
    assert (az.unit, az.offset, az.sign) == ("g", 1, -1)
    assert len(read_all(project)["flight"].channels) > 20


def test_a_matrix_without_names(tmp_path: Path) -> None:
    text, project = guessed(data("attas", "fAttasElv1.mat"), tmp_path)
    assert list(project.channels) == ["t"]
    assert project.channels["t"].sources == (1,)
    assert sum(line.startswith("#   ") for line in text.splitlines()) == 44


@pytest.mark.parametrize(
    "parts",
    [
        ("twin_otter", "totter_lon_020213f1_018.mat"),
        ("harv", "compat_lon_example.mat"),
        ("armhawk", "flight", "state.mat"),
        ("dhc2", "y13aus_da1.asc"),
        ("citation_two_step", "da3211.mat"),
        ("nesc_6dof", "Atmos_11_TrimCheckSubsonicF16", "Atmos_11_sim_04.csv"),
    ],
)
def test_every_log_gets_a_project_that_reads(tmp_path: Path, parts: tuple[str, ...]) -> None:
    _, project = guessed(data(*parts), tmp_path)
    assert "t" in project.channels
    read_all(project)
