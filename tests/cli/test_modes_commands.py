"""`alula trim`, `linearize`, `modes`: what they write, and how they refuse."""

from __future__ import annotations

import shutil
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

from alula.simulate import LinearModel
from alula.simulate.modes import modes_of
from cli.command import ROOT, Ran, alula, assert_refused

AIRCRAFT = ROOT / "aircraft"
SPORTSTAR = AIRCRAFT / "sportstar.toml"
POINT = ("--V", 45, "--h", 1000)


def run(command: str, *words: object, aircraft: Path = SPORTSTAR) -> Ran:
    return alula(command, aircraft, *words, "--json", "-")


def result(ran: Ran, schema: str) -> dict:
    assert ran.code == 0, ran.err
    envelope = ran.envelope
    assert envelope["schema"] == f"alula.{schema}/1"
    assert envelope["status"] == "ok"
    assert [Path(f["path"]).name for f in envelope["inputs"]] == [
        "sportstar.toml",
        "sportstar_aero.toml",
    ]
    return envelope["result"]


def test_trim_by_throttle_and_by_thrust() -> None:
    modeled = result(run("trim", *POINT), "trim")
    given = result(run("trim", *POINT, "--engines", "given"), "trim")
    assert 0.0 < modeled["controls"]["dt"] < 1.0
    assert modeled["controls"]["thrust"] == 0.0
    assert modeled["further"]["omega"] > 100.0  # rad/s of a propeller in cruise
    assert given["controls"]["thrust"] > 300.0
    # the same lift either way; the propeller's torque asks for ailerons
    assert modeled["alpha"] == pytest.approx(given["alpha"], abs=2e-4)
    assert modeled["controls"]["da"] != 0.0
    assert abs(given["controls"]["da"]) < 1e-6  # the wing's halves separate unequally by as much
    assert max(modeled["residual"], given["residual"]) < 1e-8


@pytest.mark.parametrize(
    ("words", "key", "value"),
    [
        (("--kind", "climb", "--gamma-deg", 2), "gamma", np.radians(2)),
        (("--kind", "turn", "--bank-deg", -30), "phi", np.radians(-30)),
        (("--kind", "turn", "--n", 1.5), "load_factor", 1.5),
        (("--kind", "turn", "--turn-rate-deg", 6), "turn_rate", np.radians(6)),
        (("--kind", "pull-up", "--n", 2), "load_factor", 2.0),
    ],
    ids=str,
)
def test_kinds_of_flight(words: tuple[object, ...], key: str, value: float) -> None:
    found = result(run("trim", *POINT, "--engines", "given", *words), "trim")
    assert found[key] == pytest.approx(value, abs=1e-9)


def test_glide_with_the_engine_idling_descends() -> None:
    found = result(run("trim", "--V", 35, "--h", 1000, "--kind", "glide"), "trim")
    assert found["controls"]["dt"] == 0.0
    assert np.radians(-15) < found["gamma"] < np.radians(-3)


def test_trim_says_it_in_degrees() -> None:
    said = alula("trim", SPORTSTAR, *POINT).out
    assert "level at V = 45 m/s" in said
    assert "throttle" in said
    assert " deg" in said


def test_further_states_have_units_and_meaning() -> None:
    lines = alula("trim", SPORTSTAR, *POINT).out.splitlines()
    said = {line.split()[0]: line for line in lines}
    assert said["omega"].endswith("rad/s speed of a propeller")
    for side in ("left", "right"):
        assert said[f"X_{side}"].endswith(f"flow on the {side} wing, 1: all")
    behind = alula("trim", AIRCRAFT / "x8.toml", "--V", 18, "--h", 100, "--actuators").out
    assert any(x.endswith("A s   taken from the battery") for x in behind.splitlines())
    assert behind.count("deg  behind its actuator") == 2
    fans = alula("trim", AIRCRAFT / "citation2.toml", "--V", 120, "--h", 5000).out
    assert "power that a turbofan has reached" in fans


def test_matrices_are_columns_that_do_not_touch() -> None:
    said = alula("linearize", SPORTSTAR, *POINT).out
    rows = [x.split() for x in said.splitlines() if x.startswith("  ")]
    parts = [rows[:5], rows[5:]]
    for part, states in zip(parts, (["V", "alpha", "q", "theta"], ["beta", "p", "r", "phi"]),
                            strict=True):  # fmt: skip
        assert part[0][:4] == states
        for name, row in zip(states, part[1:], strict=True):
            assert row[0] == name
            assert len(row) == len(part[0]) + 1
            [float(cell) for cell in row[1:] if cell != "|"]
    assert "omega, X_left, X_right" in said


def test_linearize_and_modes_tell_the_same_roots() -> None:
    matrices = result(run("linearize", *POINT), "linearization")
    found = result(run("modes", *POINT), "modes")
    A = np.array(matrices["A"])
    eigenvalues = np.linalg.eigvals(A)
    for mode in found["modes"]:
        root = complex(*mode["eigenvalue"])
        # beside three roots of heading and place; see test_modes.py
        assert np.min(np.abs(eigenvalues - root)) < 1e-6
    part = LinearModel(
        tuple(matrices["longitudinal"]["states"]), (), (),
        np.array(matrices["longitudinal"]["A"]), np.zeros((4, 0)), np.zeros((0, 4)),
        np.zeros((0, 0)),
    )  # fmt: skip
    assert {m.name for m in modes_of(part, 45.0)} == {"short_period", "phugoid"}
    assert matrices["unsteady"] == {}
    assert np.array(matrices["C"]).shape == (len(matrices["outputs"]), len(matrices["states"]))
    assert {"short_period", "phugoid", "dutch_roll", "roll", "spiral", "rotor"} <= {
        m["name"] for m in found["modes"]
    }


def test_linearize_beside_the_trimmed_point() -> None:
    found = result(
        run("linearize", *POINT, "--move", "q=0.2", "--move", "phi_deg=20", "--move", "de_deg=-5"),
        "linearization",
    )
    x = dict(zip(found["states"], found["x0"], strict=True))
    assert (x["q"], x["phi"]) == pytest.approx((0.2, np.radians(20)))
    u = dict(zip(found["inputs"], found["u0"], strict=True))
    assert u["de"] == pytest.approx(np.radians(-5))
    assert "theta" in found["unsteady"]
    assert "Not a steady flight" in alula("linearize", SPORTSTAR, *POINT, "--move", "q=0.2").out


def test_requirements_are_judged_with_their_edition() -> None:
    found = result(run("modes", *POINT, "--class", "I", "--category", "C"), "modes")
    assert (found["class"], found["category"]) == ("I", "C")
    rows = found["requirements"]
    assert {r["edition"] for r in rows} == {
        "MIL-F-8785C (5 November 1980)",
        "CS-23 Amendment 4 (2015)",
        "CS-25 Amendment 27 (2021)",
    }
    for row in rows:
        assert (row["verdict"] == "not judged") == bool(row["why"])
    assert found["n_alpha"] > 0.0


def test_a_requirement_asked_for_and_missed_fails(tmp_path: Path) -> None:
    """Yaw damping of the wrong sign: the Dutch roll grows, which CS-23.181(b) forbids."""
    text = (AIRCRAFT / "sportstar_aero.toml").read_text()
    old = next(line for line in text.splitlines() if line.startswith("Cn_r ="))
    model = tmp_path / "growing.toml"
    model.write_text(text.replace(old, "Cn_r = 0.3"))
    words = (*POINT, "--model", model)
    assert run("modes", *words).code == 0  # nobody asked
    asked = run("modes", *words, "--against", "cs23")
    assert asked.code == 1
    assert asked.envelope["status"] == "check_failed"
    missed = [m["where"] for m in asked.messages("requirement_missed")]
    assert missed == ["CS-23 Amendment 4 (2015), 23.181(b)"]
    assert run("modes", *POINT, "--against", "cs23").code == 0


def test_in_a_turn_nothing_is_judged() -> None:
    found = result(run("modes", *POINT, "--kind", "turn", "--bank-deg", 30), "modes")
    assert {r["verdict"] for r in found["requirements"]} == {"not judged"}
    assert {r["why"] for r in found["requirements"]} == {"in a turn"}


def test_picture(tmp_path: Path) -> None:
    path = tmp_path / "s.svg"
    assert alula("modes", SPORTSTAR, *POINT, "--plot", path).code == 0
    tree = ElementTree.parse(path)
    texts = ["".join(e.itertext()) for e in tree.iter("{http://www.w3.org/2000/svg}text")]
    for name in ("short period", "phugoid", "Dutch roll", "roll", "spiral"):
        assert texts.count(name) == 1
    assert not [p for p in tmp_path.iterdir() if p != path]


@pytest.mark.parametrize("command", ["trim", "linearize", "modes"])
def test_refusals(command: str, tmp_path: Path) -> None:
    assert_refused(run(command, "--V", 120, "--h", 1000), "outside_envelope", "V = 120 m/s")
    assert_refused(
        run(command, *POINT, "--kind", "climb", "--gamma-deg", 30),
        "no_trim",
        "force along the flight path",
        "throttle at 1",
    )
    assert_refused(run(command, *POINT, "--kind", "turn"), "bad_condition")
    assert_refused(run(command, *POINT, aircraft=tmp_path / "none.toml"), "file_not_readable")
    bare = tmp_path / "bare.toml"
    lines = [x for x in SPORTSTAR.read_text().splitlines() if not x.startswith("aero =")]
    bare.write_text("\n".join(lines))
    assert_refused(run(command, *POINT, aircraft=bare), "no_model")
    model = AIRCRAFT / "sportstar_aero.toml"
    assert run(command, *POINT, "--model", model, aircraft=bare).code == 0


def test_anyway_outside_of_the_envelope_is_said() -> None:
    ran = run("trim", "--V", 45, "--h", 5000, "--anyway", "--engines", "given")
    assert ran.code == 0
    assert ran.messages("outside_envelope")[0]["level"] == "warning"


@pytest.mark.parametrize("move", ["gamma=1", "q", "q=fast", "thrust_deg=3", "q=inf"])
def test_bad_moves_are_refused(move: str) -> None:
    assert_refused(run("linearize", *POINT, "--move", move), "bad_move")


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [("mass = ", "mass = -", ""), ("Ixx = ", "Ixx = 1e6  # ", "impossible_inertia")],
)
def test_impossible_bodies(tmp_path: Path, old: str, new: str, code: str) -> None:
    text = (AIRCRAFT / "dasmat_citation.toml").read_text()
    assert f"\n{old}" in text
    path = tmp_path / "damaged.toml"
    path.write_text(text.replace(f"\n{old}", f"\n{new}", 1))
    shutil.copyfile(AIRCRAFT / "sportstar_aero.toml", tmp_path / "aero.toml")
    ran = run("trim", "--V", 80, "--h", 1000, "--model", tmp_path / "aero.toml", aircraft=path)
    assert ran.code == 2
    assert "Traceback" not in ran.err
    assert not code or ran.messages(code)
    assert "mass" in ran.err or "inertia" in ran.err


def test_no_picture_where_it_cannot_be_written(tmp_path: Path) -> None:
    ran = run("modes", *POINT, "--plot", tmp_path / "none" / "s.svg")
    assert_refused(ran, "output_not_writable")


def test_unknown_class_is_refused() -> None:
    assert_refused(run("modes", *POINT, "--class", "V"), "unknown_class")
