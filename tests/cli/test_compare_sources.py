"""`alula compare` with sources of every kind as columns."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.model import Reference
from alula.predict.vortex_lattice import vortex_lattice
from campaign.derivative_files import DATCOM, avl_file
from cli.command import ROOT, alula, assert_refused

SPORTSTAR = ROOT / "aircraft" / "sportstar.toml"
FLOWN = ROOT / "aircraft" / "sportstar_aero.toml"

# Dittrich 2016, Tables 4.4 and 4.5: estimates from flight and what three programs gave, with the
# ratios as printed. The programs' C_mq stands in his table beside the flown sum as it is.
TABLES: dict[str, dict[str, float]] = {
    "Est": {"CD_0": 0.0510, "CD_alpha": 0.6908, "CL_0": 0.4879, "CL_alpha": 5.0702,
            "CL_de": 0.4730, "Cm_0": -0.1025, "Cm_alpha": -0.428, "Cm_q": -25.379,
            "Cm_de": -2.077},
    "Tornado": {"CD_0": 0.0148, "CD_alpha": 0.2326, "CL_0": 0.5619, "CL_alpha": 4.9873,
                "CL_de": 0.5175, "Cm_0": -0.0013, "Cm_alpha": -0.979, "Cm_q": -10.768,
                "Cm_de": -1.373},
    "AVL": {"CD_0": 0.0244, "CL_0": 0.5692, "CL_alpha": 4.8796, "CL_de": 0.4419,
            "Cm_0": 0.0266, "Cm_alpha": -0.476, "Cm_q": -8.992, "Cm_de": -1.147},
    "Datcom": {"CD_alpha": 0.3574, "CL_0": 0.4256, "CL_alpha": 4.9805, "CL_de": 0.4820,
               "Cm_0": 0.0308, "Cm_alpha": -0.777, "Cm_q": -8.182, "Cm_de": -1.328},
}  # fmt: skip
PRINTED: dict[str, dict[str, float]] = {
    "CD_0": {"Tornado": 0.29, "AVL": 0.48},
    "CD_alpha": {"Tornado": 0.34, "Datcom": 0.52},
    "CL_0": {"Tornado": 1.15, "AVL": 1.17, "Datcom": 0.87},
    "CL_alpha": {"Tornado": 0.98, "AVL": 0.96, "Datcom": 0.98},
    "CL_de": {"Tornado": 1.09, "AVL": 0.93, "Datcom": 1.02},
    "Cm_0": {"Tornado": 0.01, "AVL": -0.26, "Datcom": -0.30},
    "Cm_alpha": {"Tornado": 2.29, "AVL": 1.11, "Datcom": 1.81},
    "Cm_q": {"Tornado": 0.42, "AVL": 0.35, "Datcom": 0.32},
    "Cm_de": {"Tornado": 0.66, "AVL": 0.55, "Datcom": 0.64},
}


def table(folder: Path, name: str, values: dict[str, float], more: str = "") -> Path:
    rows = "\n".join(f"{n},{v}" for n, v in values.items())
    path = folder / f"{name}.csv"
    path.write_text(f"# axes = body\n# per = rad\n{more}name,value\n{rows}\n")
    return path


def compared(*words: object) -> tuple[dict[str, Any], dict[str, list[Any]], Any]:
    ran = alula("compare", *words, "--json", "-")
    assert ran.code == 0, ran.err
    result = ran.envelope["result"]
    return result, {p["name"]: p["entries"] for p in result["parameters"]}, ran


def test_published_table(tmp_path: Path) -> None:
    paths = [table(tmp_path, name, values) for name, values in TABLES.items()]
    result, rows, _ = compared(*paths)
    names = [c["name"] for c in result["columns"]]
    assert names == list(TABLES)
    for name, ratios in PRINTED.items():
        for source, ratio in ratios.items():
            got = rows[name][names.index(source)]["ratio"]
            assert got == pytest.approx(ratio, abs=0.006), (name, source)  # 1.8154 is printed 1.81


def test_all_kinds_side_by_side(tmp_path: Path) -> None:
    plane = load_aircraft(SPORTSTAR)
    assert plane.geometry is not None
    lattice = vortex_lattice(
        plane.geometry, Reference(plane.S, plane.b, plane.c), np.zeros(3), alpha=0.05, wake="held"
    )
    (tmp_path / "case.st").write_text(avl_file(lattice, "ST"))
    (tmp_path / "case.sb").write_text(avl_file(lattice, "SB"))
    (tmp_path / "datcom.out").write_text(DATCOM)
    prediction = tmp_path / "prediction.json"
    assert alula("predict", SPORTSTAR, "--V", 45, "--json", prediction).code == 0
    tunnel = table(tmp_path, "tunnel", {"Cm_q + Cm_alphadot": -17.0, "Cm_alpha": -0.5})
    files = [tmp_path / f for f in ("case.st", "case.sb", "datcom.out")]
    result, rows, ran = compared(FLOWN, *files, prediction, tunnel, SPORTSTAR, "--V", 45,
                                 "--method", "combined", "--method", "semi")  # fmt: skip
    assert [c["kind"] for c in result["columns"]] == [
        "model", "avl", "avl", "datcom", "prediction", "table", "prediction", "prediction",
    ]  # fmt: skip
    damping = rows["Cm_q + Cm_alphadot"]
    assert damping[0]["value"] == pytest.approx(-25.379)  # flown: the sum
    assert damping[1]["verdict"] == damping[2]["verdict"] == "alone"  # AVL: a part, and it is said
    assert damping[1]["sigmas"] is None
    assert damping[3]["value"] == pytest.approx(math.degrees(-0.184 - 0.07), rel=1e-6)
    assert damping[5]["value"] == -17.0
    assert damping[4]["value"] == pytest.approx(damping[6]["value"])  # file and on the spot
    low, high = damping[4]["ratio_ci95"]
    assert low < damping[4]["ratio"] < high < 1.0  # the gap that Dittrich found
    # Both files of AVL are one lattice: along body axes they agree.
    for name, entries in rows.items():
        if entries[1] is not None and entries[2] is not None:
            assert entries[1]["value"] == pytest.approx(entries[2]["value"], abs=2e-5), name
    assert ran.messages("moment_point_taken")
    assert ran.messages("axes_converted")


def test_limit_leaves_parts_of_sums_alone(tmp_path: Path) -> None:
    one = tmp_path / "one.csv"
    one.write_text("# axes = body\n# per = rad\nname,value,se\nCm_q + Cm_alphadot,-25,1\n")
    two = tmp_path / "two.csv"
    two.write_text("# axes = body\n# per = rad\nname,value,se\nCm_q,-10,1\n")
    ran = alula("compare", one, two, "--limit", 3, "--json", "-")
    assert ran.code == 0
    assert ran.messages("lag_not_stated")
    assert "-10*" in alula("compare", one, two).out


def test_interval_of_a_ratio(tmp_path: Path) -> None:
    """Fieller's interval for 2 +- 0.1 over 4 +- 0.4, against 2e5 draws."""
    head = "# axes = body\n# per = rad\nname,value,se\n"
    one, two, three = (tmp_path / f"{n}.csv" for n in "abc")
    one.write_text(head + "CL_alpha,4,0.4\n")
    two.write_text(head + "CL_alpha,2,0.1\n")
    three.write_text(head + "CL_alpha,1,1\n")
    _, rows, _ = compared(one, two)
    low, high = rows["CL_alpha"][1]["ratio_ci95"]
    rng = np.random.default_rng(0)
    draws = rng.normal(2.0, 0.1, 200_000) / rng.normal(4.0, 0.4, 200_000)
    # A bound that the ratio of the draws leaves on either side as often as 2.5 %, to 0.4 %.
    assert np.mean(draws < low) == pytest.approx(0.025, abs=0.004)
    assert np.mean(draws > high) == pytest.approx(0.025, abs=0.004)
    _, rows, _ = compared(three, two)  # 1 +- 1 is not told from zero: any ratio
    assert rows["CL_alpha"][1]["ratio_ci95"] == [None, None]


def test_other_point_and_reference_are_converted(tmp_path: Path) -> None:
    values = {"CL_alpha": 5.0, "CL_0": 0.0, "Cm_alpha": -0.5, "CD_0": 0.0}
    at = "# S = 10.6\n# b = 8.65\n# c = 1.25\n# point = {} 0 0\n"
    first = table(tmp_path, "first", values, at.format(0))
    second = table(tmp_path, "second", values, at.format(0.125))
    _, rows, ran = compared(first, second)
    # Stable by 0.1 c CL_alpha less about the point 0.1 c further back.
    assert rows["Cm_alpha"][1]["value"] == pytest.approx(-0.5 + 0.1 * 5.0)
    assert ran.messages("moment_point_converted")
    half = table(tmp_path, "half", values, at.format(0).replace("10.6", "5.3"))
    _, rows, ran = compared(first, half)
    assert rows["CL_alpha"][1]["value"] == pytest.approx(2.5)
    assert ran.messages("reference_converted")
    aside = table(tmp_path, "aside", values, at.format("0 1").replace(" 0 0", " 0"))
    assert_refused(alula("compare", first, aside, "--json", "-"), "moment_point")


def test_avl_in_feet_is_the_same_aircraft(tmp_path: Path) -> None:
    plane = load_aircraft(SPORTSTAR)
    assert plane.geometry is not None
    lattice = vortex_lattice(
        plane.geometry, Reference(plane.S, plane.b, plane.c), np.zeros(3), alpha=0.05
    )
    text = avl_file(lattice, "ST")
    feet = text.replace("Sref =       10.6", "Sref =     114.10")
    feet = feet.replace("Cref =       1.25", "Cref =      4.101")
    feet = feet.replace("Bref =       8.65", "Bref =     28.379")
    (tmp_path / "m.st").write_text(text)
    (tmp_path / "ft.st").write_text(feet)
    _, rows, ran = compared(FLOWN, tmp_path / "m.st", tmp_path / "ft.st")
    assert ran.messages("other_unit")
    for name, entries in rows.items():
        if entries[1] is not None:
            assert entries[1]["value"] == entries[2]["value"], name


def test_origin_of_the_programs_axes(tmp_path: Path) -> None:
    """Datcom's point 2.1 m behind its own origin; the datum is 2 m behind it: 0.1 m apart."""
    path = tmp_path / "datcom.out"
    path.write_text(DATCOM)
    _, there, _ = compared(FLOWN, path)
    _, moved, ran = compared(FLOWN, path, "--origin", "2.0,0,0")
    assert ran.messages("moment_point_converted")
    a = [rows["Cm_alpha"][1]["value"] for rows in (there, moved)]
    lift, drag = there["CL_alpha"][1]["value"], there["CD_0"][1]["value"]
    # The point 0.1 m behind the datum is carried forward to it.
    assert a[1] - a[0] == pytest.approx(-0.1 / 1.25 * (lift + drag), rel=1e-6)
    assert_refused(alula("compare", FLOWN, path, "--origin", "1,2", "--json", "-"), "usage")


def test_prediction_is_judged_by_the_flight(tmp_path: Path, demo_files: Path) -> None:
    from cli.command import small_project

    project = small_project(demo_files, tmp_path / "project")
    result, _, _ = compared(FLOWN, SPORTSTAR, "--project", project.path)
    for name in ("CL", "Cm"):
        own, predicted = result["judged"][name]["entries"]
        assert own["r2"] > predicted["r2"] > 0.3  # good for a model that has not flown


@pytest.mark.parametrize(
    ("name", "text", "code"),
    [
        ("empty.csv", "", "unreadable_derivatives"),
        ("a.st", "Stability-axis derivatives...\n", "unreadable_derivatives"),
        ("d.out", "DATCOM\n0 ALPHA CD\n", "unreadable_derivatives"),
        ("p.json", '{"schema": "alula.prediction/1", "status": "ok", "result": {}}',
         "unreadable_derivatives"),
        ("p.json", '{"schema": "alula.prediction/1", "status": "bad_input", "result": {}}',
         "not_a_result"),
    ],
)  # fmt: skip
def test_what_is_no_source(tmp_path: Path, name: str, text: str, code: str) -> None:
    path = tmp_path / name
    path.write_text(text)
    assert_refused(alula("compare", FLOWN, path, "--json", "-"), code, name)
