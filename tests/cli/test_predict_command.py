"""`alula predict`: from the shape to numbers, a page and a model that flies."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from alula.model import load_model
from cli.command import ROOT, SmallProject, alula, assert_refused, contents, small_project

SPORTSTAR = ROOT / "aircraft" / "sportstar.toml"


def predicted(*words: object) -> dict[str, Any]:
    ran = alula("predict", SPORTSTAR, *words, "--json", "-")
    assert ran.code == 0, ran.err
    assert ran.envelope["schema"] == "alula.prediction/1"
    result = ran.envelope["result"]
    assert isinstance(result, dict)
    return result


def by_name(result: dict[str, Any], key: str = "derivatives") -> dict[str, dict[str, Any]]:
    return {p["name"]: p for p in result[key]}


def test_every_derivative_has_error_and_source() -> None:
    result = predicted("--V", 45)
    found = by_name(result)
    assert {"CL_alpha", "CL_de", "CD_0", "Cm_q", "Cm_alphadot", "Cn_r", "Cl_p"} <= found.keys()
    for p in found.values():
        assert p["se"] > 0.0, p
        assert p["source"]
        assert p["ci95"][0] < p["value"] < p["ci95"][1]
    flown = by_name(result, "as_flown")
    whole = flown["Cm_q + Cm_alphadot"]["value"]
    assert whole == pytest.approx(found["Cm_q"]["value"] + found["Cm_alphadot"]["value"])
    # Dittrich's band of what Tornado, AVL and Datcom gave over his estimates, sec. 4.6.3.
    assert 0.87 <= found["CL_alpha"]["value"] / 5.0702 <= 1.17
    assert 0.87 <= found["CL_de"]["value"] / 0.4730 <= 1.17
    assert [m["method"] for m in result["methods"]] == ["lattice and bodies", "semi-empirical"]
    x = result["neutral_point"]["position"][0]
    assert x == pytest.approx(1.25 * found["Cm_alpha"]["value"] / found["CL_alpha"]["value"])
    assert result["mesh_study"]["counts"][0] == 174
    assert {s["surface"] for s in result["lattice"]["loads"]["span"]} >= {"wing", "tailplane"}


def test_conventions_are_printed() -> None:
    ran = alula("predict", SPORTSTAR, "--per-deg", "--axes", "body")
    assert ran.code == 0, ran.err
    assert "body axes" in ran.out
    assert "per degree" in ran.out
    assert "pb/2V, qc/2V, rb/2V" in ran.out
    assert re.search(r"^CL_alpha_per_deg +0\.0[89]", ran.out, re.MULTILINE)
    assert re.search(r"^Cm_q +-1[0-9]\.", ran.out, re.MULTILINE)  # rates stay per hat


def test_per_degree_and_axes_are_the_same_numbers() -> None:
    rad, deg = by_name(predicted()), by_name(predicted("--per-deg"))
    assert deg["Cm_de_per_deg"]["value"] == pytest.approx(np.radians(rad["Cm_de"]["value"]))
    square = np.radians(1.0) ** 2 * rad["CD_alpha2"]["value"]
    assert deg["CD_alpha2_per_deg2"]["value"] == pytest.approx(square)
    result = predicted("--axes", "body", "--alpha-deg", 6)
    stability = by_name(predicted("--alpha-deg", 6))
    c, s = np.cos(np.radians(6.0)), np.sin(np.radians(6.0))
    Cl, Cn = stability["Cl_beta"]["value"], stability["Cn_beta"]["value"]
    assert by_name(result)["Cn_beta"]["value"] == pytest.approx(Cl * s + Cn * c)


@pytest.mark.parametrize("method", ["lattice", "semi", "bodies", "strip"])
def test_each_method_alone(method: str) -> None:
    result = predicted("--method", method, "--alpha-deg", 2)
    assert len(result["methods"]) == 1
    found = by_name(result)
    if method == "bodies":  # a fuselage alone is unstable both ways
        assert found["Cm_alpha"]["value"] > 0.0 > found["Cn_beta"]["value"]
    else:
        assert 4.0 < found["CL_alpha"]["value"] < 6.0
        assert found["Cm_de"]["value"] < -1.0
    assert (result["lattice"] is None) == (method != "lattice")


def test_panels_and_mesh_study() -> None:
    result = predicted("--method", "lattice", "--panels", "wing=4x6", "--panels", "fin=2x3")
    assert result["lattice"]["panels"]["wing"] == [4, 6]
    assert result["lattice"]["panels"]["fin"] == [2, 3]
    study = {p["name"]: p for p in result["mesh_study"]["derivatives"]}
    assert len(study["CL_alpha"]["values"]) == 3
    assert study["CL_alpha"]["error"] > 0.0


def test_model_flies(tmp_path: Path) -> None:
    """From the shape to trim, modes and a virtual flight."""
    aero = tmp_path / "predicted.toml"
    assert alula("predict", SPORTSTAR, "--V", 45, "--model", aero).code == 0
    model = load_model(aero)
    assert model.covariance is not None
    assert model.params["Cm_q"] < -10.0  # with Cm_alphadot, as it flies
    trim = alula("trim", SPORTSTAR, "--V", 45, "--h", 500, "--model", aero, "--json", "-")
    assert trim.code == 0, trim.err
    assert 0.0 < trim.envelope["result"]["alpha"] < 0.15
    modes = alula("modes", SPORTSTAR, "--V", 45, "--h", 500, "--model", aero, "--json", "-")
    assert modes.code == 0, modes.err
    found = {m["name"]: m for m in modes.envelope["result"]["modes"]}
    assert {"short_period", "phugoid", "dutch_roll", "roll", "spiral"} <= found.keys()
    # A light airplane's (Roskam I, ch. 6): heavily damped, 2 to 8 rad/s.
    assert 0.4 < found["short_period"]["damping"] < 1.0
    assert 2.0 < found["short_period"]["frequency"] < 8.0
    plan = tmp_path / "plan.toml"
    ran = alula("plan", SPORTSTAR, "--V", 45, "--h", 500, "--model", aero, "--out", plan)
    assert ran.code in (0, 1), ran.err
    ran = alula("fly", plan, "--out", tmp_path / "flown", "--seed", 1)
    assert ran.code == 0, ran.err
    assert list((tmp_path / "flown").iterdir())


def test_page_and_picture(tmp_path: Path) -> None:
    page, picture = tmp_path / "p.html", tmp_path / "p.svg"
    ran = alula("predict", SPORTSTAR, "--report", page, "--three-view", picture)
    assert ran.code == 0, ran.err
    html = page.read_text()
    for words in ("Derivatives", "Geometry", "Span loads", "Mesh study", "neutral point",
                  "CL_alpha", "Datcom"):  # fmt: skip
        assert words in html
    assert "<script" not in html
    assert "http" not in re.sub(r'http-equiv|xmlns="[^"]*"', "", html)  # nothing from outside
    assert html.count('class="threeview"') == 3
    assert 'class="neutral"' in picture.read_text()
    again = alula("predict", SPORTSTAR, "--report", page, "--three-view", picture)
    assert again.code == 0
    assert page.read_text() == html


def test_same_input_same_json() -> None:
    assert predicted() == predicted()


def edited(tmp_path: Path, old: str, new: str) -> Path:
    text = SPORTSTAR.read_text()
    assert old in text
    path = tmp_path / "plane.toml"
    path.write_text(text.replace(old, new))
    shutil.copyfile(SPORTSTAR.parent / "sportstar_aero.toml", tmp_path / "sportstar_aero.toml")
    return path


def test_without_geometry_it_says_what_to_add(tmp_path: Path) -> None:
    text = SPORTSTAR.read_text()
    path = tmp_path / "plane.toml"
    path.write_text(text[: text.index("# x ahead of the datum")].replace('  "geometry",\n', ""))
    ran = alula("predict", path, "--json", "-")
    assert_refused(ran, "missing_geometry", "geometry.surfaces", 'role = "wing"')


def test_control_without_surface_is_named(tmp_path: Path) -> None:
    path = edited(tmp_path, 'controls = [{name = "rudder", hinge = 0.6, gains = {dr = 1.0}}]\n', "")
    ran = alula("predict", path, "--json", "-")
    assert ran.code == 0
    (said,) = ran.messages("control_without_surface")
    assert "dr" in said["where"] + said["expected"] + said["found"]
    names = {p["name"] for p in ran.envelope["result"]["derivatives"]}
    assert not any(n.endswith("_dr") for n in names)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--panels", "wing"], "panels"),
        (["--panels", "canard=3x4"], "unknown_surface"),
        (["--panels", "wing=0x4"], "panels"),
        (["--V", "-5"], "impossible_condition"),
        (["--V", "9"], "beyond_stall"),
        (["--h", "1e6"], "impossible_condition"),
        (["--mach", "1.2"], "impossible_condition"),
        (["--method", "lattice", "--mach", "0.85"], "lattice_condition"),
        (["--alpha-deg", "60"], "impossible_condition"),
        (["--method", "bodies", "--model", "m.toml"], "incomplete_prediction"),
    ],
)
def test_bad_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], code: str
) -> None:
    monkeypatch.chdir(tmp_path)
    ran = alula("predict", SPORTSTAR, *words, "--report", "r.html", "--json", "-")
    if code == "lattice_condition":
        assert ran.code == 2
        assert "Traceback" not in ran.err
    else:
        assert_refused(ran, code)
    assert contents(tmp_path) == {}


def test_foreign_file_is_not_overwritten(tmp_path: Path) -> None:
    mine = tmp_path / "mine.svg"
    mine.write_text("<svg/>")
    ran = alula("predict", SPORTSTAR, "--three-view", mine, "--json", "-")
    assert_refused(ran, "output_not_writable")
    assert mine.read_text() == "<svg/>"


def test_project_names_a_prediction_as_prior(demo_files: Path, tmp_path: Path) -> None:
    """Output error with the prediction's priors: named in the messages, narrower than without."""
    project: SmallProject = small_project(demo_files, tmp_path / "project")
    assert alula("predict", SPORTSTAR, "--model", project.folder / "before.toml").code == 0
    alone = alula("identify", project.path, "--method", "oe", "--json", "-", "--quiet")
    text = project.path.read_text()
    project.path.write_text(text + '\n[identify.options]\npriors = "before.toml"\n')
    both = alula("identify", project.path, "--method", "oe", "--json", "-", "--quiet")
    assert alone.code == both.code == 0, both.err
    (said,) = both.messages("priors_of_model")
    assert "predicted" in said["found"]
    se = [{p["name"]: p["se"] for p in r.envelope["result"]["parameters"]} for r in (alone, both)]
    assert se[1]["CL_q"] < se[0]["CL_q"]
    json.dumps(se)


def test_a_speed_outside_the_envelope_is_said() -> None:
    """87 kt typed as m/s: the airplane's limit is 75 m/s."""
    ran = alula("predict", SPORTSTAR, "--method", "semi", "--V", 87, "--json", "-")
    assert ran.code == 0, ran.err
    (said,) = ran.messages("outside_envelope")
    assert "75 m/s" in said["expected"]
    assert "--V is in m/s" in said["do"]


def test_what_was_typed_in_degrees_is_said_in_degrees() -> None:
    ran = alula("predict", SPORTSTAR, "--V", 45, "--alpha-deg", 40, "--json", "-")
    assert_refused(ran, "impossible_condition", "(40 deg)", "(20 deg)")


def test_a_surface_with_a_capital_is_asked_about() -> None:
    ran = alula("predict", SPORTSTAR, "--V", 45, "--panels", "Wing=4x8", "--json", "-")
    assert_refused(ran, "unknown_surface", "Did you mean 'wing'?")
