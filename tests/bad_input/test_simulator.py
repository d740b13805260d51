"""What the simulator's commands refuse, and what they say once, on damaged ready aircraft."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.simulate import Airframe, fly
from alula.simulate.airframe import core_model
from alula.simulate.virtual_loading import toml_text
from cli.command import ROOT, Ran, alula, assert_refused
from simulate.virtual import doublet, plan_tree

READY = ROOT / "aircraft"
POINT = ("--V", 45, "--h", 915)
FLYING = ("trim", "linearize", "modes", "plan")


def damaged(folder: Path, name: str, *changes: tuple[str, str]) -> Path:
    """A copy of a ready file with patterns replaced, each of which must be there."""
    text = (READY / name).read_text()
    for pattern, new in changes:
        text, count = re.subn(pattern, new, text, count=1, flags=re.M)
        assert count == 1, pattern
    path = folder / name
    path.write_text(text)
    return path


def citation(folder: Path, *changes: tuple[str, str]) -> Path:
    return damaged(folder, "citation.toml", *changes)


def with_model(command: str, aircraft: Path) -> Ran:
    model = READY / "citation2_aero.toml"
    return alula(
        command, aircraft, "--V", 120, "--h", 5000, "--model", model, "--json", "-"
    )  # fmt: skip


def flown(folder: Path, *words: object, **changes: Any) -> Ran:
    plan = folder / "plan.toml"
    plan.write_text(toml_text(plan_tree(**changes)))
    return alula("fly", plan, "--out", folder / "out", "--json", "-", *words)


@pytest.mark.parametrize("command", FLYING)
@pytest.mark.parametrize("Ixz", ["48000.0", "47836.6"])
def test_singular_inertia(tmp_path: Path, command: str, Ixz: str) -> None:
    """Ixz of the geometric mean of Ixx and Izz and more: no principal moment is left, or less."""
    ran = with_model(command, citation(tmp_path, ("^Ixz = .*", f"Ixz = {Ixz}")))
    assert_refused(ran, "impossible_inertia", "principal moments")


@pytest.mark.parametrize("command", FLYING)
@pytest.mark.parametrize(("key", "value"), [("mass", "-5.0"), ("mass", "0.0"), ("Iyy", "nan")])
def test_mass_that_no_body_has(tmp_path: Path, command: str, key: str, value: str) -> None:
    ran = with_model(command, citation(tmp_path, (f"^{key} = .*", f"{key} = {value}")))
    assert_refused(ran, "bad_value", f"mass.{key}", value)
    assert "expected be" not in ran.err


def test_figures_rounded_over_the_limit_fly_with_a_warning() -> None:
    """The limit of a body is missed by 0.17 % in its moments as published."""
    ran = with_model("trim", READY / "citation.toml")
    assert ran.code == 0
    (said,) = ran.messages("inertia_at_limit")
    assert "0.17 % over" in said["found"]


def test_file_and_simulator_draw_the_same_line() -> None:
    """What the aircraft file warns of flies; beyond its tolerance of 1 % both refuse."""
    from alula.model import load_model

    model = load_model(READY / "sportstar_aero.toml")
    core_model(Airframe(500.0, np.diag([500.0, 500.0, 1009.0])), model)
    with pytest.raises(BadInput, match="impossible_inertia"):
        core_model(Airframe(500.0, np.diag([500.0, 500.0, 1011.0])), model)


@pytest.mark.parametrize("command", FLYING)
def test_trim_outside_the_envelope(command: str) -> None:
    ran = alula(command, READY / "sportstar.toml", "--V", 120, "--h", 1000, "--json", "-")
    assert ran.code == 2
    assert ran.messages("outside_envelope") or ran.messages("no_trim")
    assert "120 m/s" in ran.err


def test_model_asked_outside_its_validity_is_said_once_with_the_value(tmp_path: Path) -> None:
    hard = [{"id": "pull", "inputs": [doublet("de", 12.0)]}]
    ran = flown(tmp_path, conditions=[{"V": [45.0, 50.0], "h": 915.0}], maneuvers=hard)
    assert ran.code == 0
    alpha = [m for m in ran.messages("outside_validity") if m["where"].endswith("alpha")]
    (said,) = alpha  # one for both maneuvers, with the value of each
    assert said["expected"] == "-3.438 to 10.89 deg"
    found = re.findall(r"(V\d+)_h915_pull: (-?[\d.]+) deg at t = ", said["found"])
    assert [name for name, _ in found] == ["V45", "V50"]
    assert all(not -3.438 <= float(value) <= 10.89 for _, value in found)
    assert ran.err.count("[outside_validity]") == len(ran.messages("outside_validity"))


def test_flight_inside_the_validity_says_nothing(tmp_path: Path) -> None:
    ran = flown(tmp_path)
    assert ran.code == 0
    assert ran.envelope["messages"] == []


def test_step_too_large_for_the_fastest_mode_names_the_step_to_use(tmp_path: Path) -> None:
    ran = flown(tmp_path, rate=2.0, step=1.0)
    assert_refused(ran, "step_too_large", "for a mode of", "lower `step`")
    assert not (tmp_path / "out").exists()
    (said,) = ran.messages("step_too_large")
    step = float(re.findall(r"steps of ([\d.]+) s", said["expected"])[0])
    assert flown(tmp_path, rate=2.0, step=step).code == 0


def test_python_refuses_a_large_step_unasked() -> None:
    from alula.aircraft import load_aircraft
    from alula.model import load_model
    from alula.simulate import airframe_of, trim_level

    frame = airframe_of(load_aircraft(READY / "sportstar.toml"))
    model = load_model(READY / "sportstar_aero.toml")
    level = trim_level(frame, model, 45.0, 915.0)
    with pytest.raises(BadInput, match="step_too_large"):
        fly(frame, model, level.state, np.arange(0.0, 5.0, 0.5), level.inputs)


@pytest.mark.parametrize("hole", ["nan", "inf"])
@pytest.mark.parametrize("command", FLYING)
def test_hole_in_an_engines_table(tmp_path: Path, command: str, hole: str) -> None:
    path = damaged(tmp_path, "sportstar.toml", (r"^(\s*CT = \[)\s*[-\d.]+", rf"\g<1>{hole}"))
    model = READY / "sportstar_aero.toml"
    ran = alula(command, path, *POINT, "--model", model, "--json", "-")
    assert ran.code == 2
    assert "CT" in ran.err
    assert hole in ran.err
    assert "Traceback" not in ran.err


def test_hole_in_a_models_table(tmp_path: Path) -> None:
    model = tmp_path / "model.toml"
    text = (READY / "sportstar_aero.toml").read_text()
    model.write_text(
        text + "\n[tables.cxt]\nvalues = [0.0, nan, 1.0]\n[tables.cxt.axes]\nalpha = [0, 1, 2]\n"
    )
    ran = alula("trim", READY / "sportstar.toml", *POINT, "--model", model, "--json", "-")
    assert ran.code == 2
    assert "cxt" in ran.err
    assert "nan" in ran.err


@pytest.mark.parametrize("range_", ["[nan, 0.19]", "[0.3, -0.1]"])
def test_validity_that_is_no_range(tmp_path: Path, range_: str) -> None:
    model = damaged(tmp_path, "sportstar_aero.toml", (r"^alpha = \[.*", f"alpha = {range_}"))
    ran = alula("trim", READY / "sportstar.toml", *POINT, "--model", model, "--json", "-")
    assert_refused(ran, "bad_validity", "alpha")


@pytest.mark.parametrize(
    "declaration",
    [
        '<!ENTITY a "x">',
        '<!ENTITY a SYSTEM "file:///etc/hostname">',
        '<!ENTITY a "x"><!ENTITY b "&a;&a;&a;&a;">',
        '<!ENTITY % a SYSTEM "http://127.0.0.1/x.dtd"> %a;',
    ],
)
def test_xml_entities(tmp_path: Path, declaration: str) -> None:
    path = tmp_path / "model.dml"
    path.write_text(
        f'<?xml version="1.0"?>\n<!DOCTYPE DAVEfunc [{declaration}]>\n<DAVEfunc>&a;</DAVEfunc>'
    )
    out = tmp_path / "model.toml"
    ran = alula("export", path, "--to", "model", "--out", out, "--json", "-")
    assert_refused(ran, "unsafe_xml", "entit")
    assert not out.exists()


def test_plan_with_unknown_keys(tmp_path: Path) -> None:
    ran = flown(tmp_path, colour="red")
    assert_refused(ran, "unknown_key", "colour")
    ran = flown(tmp_path, maneuvers=[{"id": "pull", "inputs": [doublet("de", 1.5, widht=1.0)]}])
    assert_refused(ran, "unknown_key", "width")


@pytest.mark.parametrize("command", FLYING)
@pytest.mark.parametrize(
    ("option", "word"),
    [("--V", "nan"), ("--V", "inf"), ("--V", "-5"), ("--V", "0"), ("--h", "nan"), ("--h", "inf")],
)
def test_conditions_that_are_none(command: str, option: str, word: str) -> None:
    words = {"--V": "45", "--h": "915", option: word}
    flat = [part for pair in words.items() for part in pair]
    ran = alula(command, READY / "sportstar.toml", *flat, "--json", "-")
    assert ran.code == 2
    assert ran.envelope["status"] == "bad_input"


def test_flaps_that_are_no_number() -> None:
    ran = alula("trim", READY / "sportstar.toml", *POINT, "--flaps-deg", "nan", "--json", "-")
    assert_refused(ran, "bad_control", "df")


def test_files_of_another_kind_are_told_in_one_line() -> None:
    model = READY / "sportstar_aero.toml"
    ran = alula("trim", model, *POINT, "--json", "-")
    (said,) = ran.envelope["messages"]
    assert said["expected"] == "'alula.aircraft/1'"
    assert said["found"] == "'alula.model/1'"


def test_a_picture_replaces_only_a_picture(tmp_path: Path) -> None:
    mine = tmp_path / "sportstar.toml"
    mine.write_text("mine = 1\n")
    words = ("modes", READY / "sportstar.toml", *POINT, "--quiet", "--json", "-", "--plot")
    assert_refused(alula(*words, mine), "output_not_writable")
    assert mine.read_text() == "mine = 1\n"
    picture = tmp_path / "modes.svg"
    assert [alula(*words, picture).code for _ in range(2)] == [0, 0]


def test_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")  # whoever runs this, a file holds no folder
    ran = flown(tmp_path, "--out", tmp_path / "file" / "out")
    assert_refused(ran, "output_not_writable")


def test_folder_that_is_not_there(tmp_path: Path) -> None:
    ran = flown(tmp_path, "--out", tmp_path / "none" / "out")
    assert_refused(ran, "output_not_writable")


@pytest.mark.parametrize(
    "words",
    [
        ("trim", "sportstar.toml", "--V", "45"),
        ("fly",),
        ("plan", "sportstar.toml", *map(str, POINT), "--kind", "loop"),
        ("modes", "sportstar.toml", *map(str, POINT), "--against", "cs99"),
        ("export", "sportstar_aero.toml", "--to", "csv", "--out", "x"),
        ("linearize", "sportstar.toml", *map(str, POINT), "--speed", "3"),
    ],
    ids=lambda words: words[0],
)
def test_command_lines_that_cannot_be_read(
    words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(READY)
    ran = alula(*words, "--json", "-")
    assert ran.code == 2
    assert ran.envelope["status"] == "bad_input"
    assert "Traceback" not in ran.err


@pytest.mark.parametrize("command", ["fly", "validate", "trim", "linearize", "modes", "export"])
def test_missing_files(command: str, tmp_path: Path) -> None:
    words: tuple[object, ...] = POINT if command in ("trim", "linearize", "modes") else ()
    if command == "export":
        words = ("--to", "daveml", "--out", tmp_path / "x.dml")
    assert_refused(alula(command, tmp_path / "none.toml", *words, "--json", "-"),
                   "file_not_readable", "none.toml")  # fmt: skip
