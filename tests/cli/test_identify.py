"""`alula identify`: what the data cannot tell, validation, choices, and what is written."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from alula.model import load_model
from cli.command import SmallProject, alula


def parameter(envelope: dict[str, Any], name: str) -> dict[str, Any]:
    (found,) = [p for p in envelope["result"]["parameters"] if p["name"] == name]
    return dict(found)


def with_flaps(small: SmallProject, mapping: str) -> None:
    """A flap channel, and a model that asks for its effect."""
    small.edit("[channels]\n", f"[channels]\ndf = {mapping}\n")
    small.edit('Cm = "1 + alpha + qhat + de"', 'Cm = "1 + alpha + qhat + de + df"')


def test_two_collinear_regressors(small: SmallProject) -> None:
    """A flap that follows the elevator: only a combination of both effects shows."""
    with_flaps(small, '{from = "de_deg", unit = "deg"}')
    ran = small.identify()
    assert ran.code == 1
    assert ran.envelope["status"] == "not_identifiable"
    for name, other in (("Cm_de", "Cm_df"), ("Cm_df", "Cm_de")):
        found = parameter(ran.envelope, name)
        assert found["verdict"] == "not_identifiable"
        assert found["value"] is None
        assert found["se"] is None
        assert [t["name"] for t in found["tied_to"]] == [other]
        assert found["tied_to"][0]["weight"] == pytest.approx(1.0, rel=1e-6)  # equal columns
    for name in ("Cm_alpha", "Cm_q"):  # the rest is as it was
        assert parameter(ran.envelope, name)["verdict"] == "ok"
    text = alula("identify", small.path).out
    assert "not identifiable: only Cm_de + 1 Cm_df" in text
    assert "not identifiable: Cm_de, Cm_df." in text


@pytest.mark.parametrize("method", ["oe", "fe", "fd"])
def test_linear_equations_from_the_project_file(small: SmallProject, method: str) -> None:
    """The whole way: options in the file, readings, linear search, report and model."""
    options = 'equations = "linear"\nband_hz = [0.05, 1.5]\ndelayed = ["de"]\n'
    small.edit("[identify.models]", f"[identify.options]\n{options}[identify.models]")
    model, report = small.folder / "m.toml", small.folder / "r.html"
    ran = small.identify("--method", method, "--model", model, "--report", report)
    assert ran.code == 0, ran.err
    truth = json.loads((small.folder / "truth.json").read_text())["parameters"]
    for name in ("Cm_alpha", "Cm_q", "Cm_de", "CL_alpha"):
        found = parameter(ran.envelope, name)
        assert found["unit"] == "1/rad"
        # linear equations about the mean flight of a maneuver through 6 deg: within a tenth
        assert found["value"] == pytest.approx(truth[name], rel=0.1)
    assert load_model(model).params["Cm_q"] == parameter(ran.envelope, "Cm_q")["value"]
    assert ("delay_de" in report.read_text()) == (method == "fd")
    delays = [p["name"] for p in ran.envelope["result"]["parameters"] if p["unit"] == "s"]
    assert delays == (["delay_de"] if method == "fd" else [])
    aside = {m["found"] for m in ran.messages("option_of_another_method")}
    assert aside == (set() if method == "fd" else {"band_hz, delayed"})


@pytest.mark.parametrize(("value", "tied"), [("0", []), ("10", ["Cm_0"])])
def test_unexcited_parameter(small: SmallProject, value: str, tied: list[str]) -> None:
    """Flaps that rest: at zero they tell nothing, elsewhere they look like the constant term."""
    with_flaps(small, f'{{constant = {value}, unit = "deg"}}')
    ran = small.identify()
    assert ran.code == 1
    assert ran.envelope["status"] == "not_identifiable"
    found = parameter(ran.envelope, "Cm_df")
    assert found["verdict"] == "not_identifiable"
    assert [t["name"] for t in found["tied_to"]] == tied
    assert parameter(ran.envelope, "Cm_de")["verdict"] == "ok"


def test_held_out_maneuver_validates(small: SmallProject) -> None:
    small.edit("end = 20.0", "end = 13.0")
    small.add_maneuver("unseen", 13.0, 20.0, "held_out = true")
    ran = small.identify("--truth", small.folder / "truth.json")
    assert ran.code == 0, ran.err
    fit = ran.envelope["result"]["fit"]["Cm"]
    assert fit["n"] == 1301
    assert fit["n_held_out"] == 701
    assert 0.99 < fit["r2_held_out"] < 1.0  # the model is exact, sensors are as in the demo
    assert not ran.messages("non_finite")
    text = alula("identify", small.path).out
    assert "not validated" not in text
    assert f"{fit['r2_held_out']:.4f}" in text


def test_held_out_samples_leave_the_estimate_alone(small: SmallProject) -> None:
    """By the recorded motion, so that the filter's shared constants cannot carry anything over."""
    small.edit("end = 20.0", "end = 13.0")
    alone = small.identify("--filter", "none").envelope["result"]["parameters"]
    small.add_maneuver("unseen", 13.0, 20.0, "held_out = true")
    beside = small.identify("--filter", "none").envelope["result"]["parameters"]
    assert [p["value"] for p in beside] == [p["value"] for p in alone]


def test_without_held_out_maneuvers_nothing_is_called_validated(sound: SmallProject) -> None:
    text = alula("identify", sound.path).out
    assert "not validated: CD, CL, Cm: no maneuver is held out" in text
    fit = sound.identify().envelope["result"]["fit"]["Cm"]
    assert fit["n_held_out"] == 0
    assert fit["r2_held_out"] is None


def test_models_without_a_maneuver_are_said(small: SmallProject) -> None:
    with small.path.open("a") as file:
        file.write('Cl = "1 + beta + phat + rhat + da + dr"\n')
    ran = small.identify()
    assert ran.code == 0
    (message,) = ran.messages("model_not_served")
    assert "none for Cl" in message["found"]
    assert "Cl" not in ran.envelope["result"]["fit"]


def test_project_without_models_reconstructs_only(small: SmallProject) -> None:
    text = small.path.read_text()
    small.path.write_text(text[: text.index("[identify]")])
    ran = small.identify()
    assert ran.code == 0
    assert ran.envelope["result"]["parameters"] == []
    assert ran.envelope["result"]["reconstruction"]["biases"]


def test_truth_stands_beside(sound: SmallProject) -> None:
    truth = json.loads((sound.folder / "truth.json").read_text())["parameters"]
    ran = sound.identify("--truth", sound.folder / "truth.json")
    for found in ran.envelope["result"]["parameters"]:
        assert found["truth"] == truth[found["name"]]
        # one seed; 99.9 % interval and the white part of the error bar's own uncertainty
        assert abs(found["value"] - found["truth"]) < 4.0 * found["se"]
    without = sound.identify().envelope["result"]["parameters"]
    assert all("truth" not in p for p in without)


def test_report_and_model_are_written(small: SmallProject, tmp_path: Path) -> None:
    report, model = tmp_path / "r.html", tmp_path / "m.toml"
    ran = alula("identify", small.path, "--report", report, "--model", model)
    assert ran.code == 0
    assert f"Report: {report}" in ran.out
    assert f"Model: {model}" in ran.out
    assert report.read_text().startswith("<!DOCTYPE html>")
    values = load_model(model).params
    for found in small.identify().envelope["result"]["parameters"]:
        assert values[found["name"]] == pytest.approx(found["value"], rel=1e-12)
    assert sorted(p.name for p in tmp_path.iterdir() if p.is_file()) == ["m.toml", "r.html"]


def test_logs_are_only_read(small: SmallProject) -> None:
    before = {p: p.stat().st_mtime_ns for p in small.folder.iterdir()}
    small.log.chmod(0o444)
    assert small.identify().code == 0
    assert {p: p.stat().st_mtime_ns for p in small.folder.iterdir()} == before


def test_option_takes_the_place_of_the_projects_filter(small: SmallProject) -> None:
    assert tomllib.loads(small.path.read_text())["reconstruct"]["filter"] == "ekf"
    assert small.identify("--filter", "ukf").envelope["result"]["reconstruction"]["method"] == "ukf"


def test_maneuvers_by_choice(small: SmallProject) -> None:
    """Ids with a point are ids like others; only parts of a split maneuver share a name."""
    small.edit("end = 20.0", "end = 10.0")
    small.add_maneuver("longitudinal.b", 10.5, 20.0)

    def chosen(*ids: str) -> list[str]:
        words = [word for id in ids for word in ("--maneuver", id)]
        return sorted(small.identify(*words).envelope["result"]["reconstruction"]["maneuvers"])

    assert chosen("longitudinal") == ["longitudinal"]
    assert chosen("longitudinal.b") == ["longitudinal.b"]
    both = ["longitudinal", "longitudinal.b"]
    assert chosen(*both) == chosen() == both


def test_every_sample_of_the_window_is_used(sound: SmallProject) -> None:
    fit = sound.identify().envelope["result"]["fit"]
    assert {f["n"] for f in fit.values()} == {len(sound.table)}
    assert np.isfinite([f["r2"] for f in fit.values()]).all()


def test_a_mistake_of_our_own_is_told_apart(
    small: SmallProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("a slip")

    monkeypatch.setattr("alula.campaign.run_project", broken)
    ran = alula("identify", small.path)
    assert ran.code == 70  # neither 'not identifiable' nor 'bad input'
    assert "ZeroDivisionError: a slip" in ran.err
    assert "please report it" in ran.err
