"""Bad input given to the command, in the project or its aircraft: exit 2 (or a warning by name),
what to do, no traceback, and nothing written.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cli.command import SmallProject, alula, assert_refused, contents

# --- the aircraft against the log ----------------------------------------------------------------


def test_control_that_contradicts_the_motion_fails_the_check(small: SmallProject) -> None:
    small.column("de_deg")[:] *= -1.0
    small.write_log()
    ran = small.check()
    assert ran.code == 1
    assert ran.envelope["status"] == "check_failed"
    (message,) = ran.messages("control_sign")
    assert "'de'" in message["where"]
    assert "'+TEU' instead of '+TED'" in message["do"]
    identified = small.identify()
    assert identified.code == 1
    assert identified.envelope["status"] == "check_failed"
    assert "[control_sign]" in identified.err


def test_impossible_inertia(small: SmallProject) -> None:
    small.edit("Iyy = 695.0", "Iyy = 1823.0", "sportstar.toml")
    said = small.refused("impossible_inertia", "sportstar.toml", "1823")
    assert "expected the largest principal moment at most the sum of the others" in said


def test_missing_aircraft_file(small: SmallProject) -> None:
    (small.folder / "sportstar.toml").unlink()
    small.refused("missing_aircraft", "sportstar.toml")


def test_project_without_an_aircraft(small: SmallProject) -> None:
    small.edit('aircraft = "sportstar.toml"\n', "")
    small.refused("missing_aircraft", 'aircraft = "my_aircraft.toml"')


# --- the project file ----------------------------------------------------------------------------


def test_window_outside_the_log(small: SmallProject) -> None:
    small.edit("end = 20.0", "end = 25.0")
    small.refused("window_outside_log", "maneuver longitudinal", "0 to 20 s", "0 to 25 s")


@pytest.mark.parametrize(("name", "meant"), [("CM", "Cm"), ("Cmm", "Cm"), ("cz", "CZ")])
def test_a_coefficient_that_nobody_knows(small: SmallProject, name: str, meant: str) -> None:
    """It would else count as one that none of the maneuvers serves, and be left out."""
    small.edit('\nCm = "', f'\n{name} = "')
    said = small.refused("unknown_coefficient", f"identify.models.{name}")
    assert f"Did you mean {meant}" in said


def test_a_term_that_nobody_knows(small: SmallProject) -> None:
    small.edit('Cm = "1 + alpha', 'Cm = "1 + alfa')
    said = small.refused("unknown_term", "demo.toml: identify.models.Cm, formula", "character 5")
    assert "Did you mean 'alpha'?" in said


def test_a_column_under_its_other_word(small: SmallProject) -> None:
    small.edit('from = "de_deg"', 'from = "elevator"')
    said = small.refused("missing_channel", "'elevator'")
    assert "Did you mean 'de_deg'?" in said


def test_another_kind_of_file_says_what_takes_it(small: SmallProject) -> None:
    ran = alula("identify", small.folder / "sportstar.toml", "--json", "-")
    assert_refused(ran, "bad_value", "alula.aircraft/1", "alula trim, modes, plan and predict")


def test_json_where_a_model_is_wanted(small: SmallProject) -> None:
    result = small.folder / "result.json"
    result.write_text('{"schema": "alula.identification/1"}')
    ran = alula("validate", small.path, "--model", result, "--json", "-")
    assert_refused(ran, "not_toml", "`alula identify --model FILE` writes a model")


def test_overlapping_windows(small: SmallProject) -> None:
    small.edit("end = 20.0", "end = 12.0")
    small.add_maneuver("second", 8.0, 20.0)
    ran = small.identify()
    assert ran.code in (0, 1)
    assert "[overlapping_windows]" in ran.err
    assert "8 to 12 s" in ran.err


def test_formula_with_an_unknown_term(small: SmallProject) -> None:
    small.edit('Cm = "1 + alpha + qhat + de"', 'Cm = "1 + alpha + qhatt + de"')
    small.refused("unknown_term", "qhatt", "'qhat'")
    assert alula("check", small.path).code == 2  # before anything is reconstructed


def test_formula_that_is_code(small: SmallProject) -> None:
    small.edit('Cm = "1 + alpha + qhat + de"', "Cm = \"__import__('os').getcwd()\"")
    before = contents(small.folder)
    ran = small.identify()
    assert ran.code == 2
    assert "formula" in ran.err
    assert "Traceback" not in ran.err
    assert contents(small.folder) == before


def test_fewer_samples_than_parameters(small: SmallProject) -> None:
    small.edit("end = 20.0", "end = 0.12")  # 13 samples
    powers = " + ".join(f"alpha^{k} + qhat^{k}" for k in range(2, 9))
    small.edit('Cm = "1 + alpha + qhat + de"', f'Cm = "1 + alpha + qhat + de + {powers}"')
    small.refused("too_few_samples", "13")


def test_window_of_a_few_samples(small: SmallProject) -> None:
    small.edit("end = 20.0", "end = 0.03")
    small.refused("too_few_samples", "maneuver longitudinal")


def test_held_out_maneuvers_only(small: SmallProject) -> None:
    small.edit('kind = "3211"', 'kind = "3211"\nheld_out = true')
    small.refused("no_maneuver", "not held out", "longitudinal")


def test_no_maneuver(small: SmallProject) -> None:
    text = small.path.read_text()
    at = text.index("[[maneuvers]]")
    small.path.write_text(text[:at] + text[text.index("[reconstruct]", at) :])
    small.refused("no_maneuver", "[[maneuvers]]")


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"", "missing_key"),
        (b"schema = ", "not_toml"),
        (b"\xff\xfe\x00", "not_toml"),
        (b"\x89PNG\r\n", "not_toml"),
        (b'schema = "alula.aircraft/1"\n', "bad_value"),
    ],
)
def test_not_a_project_file(small: SmallProject, content: bytes, code: str) -> None:
    small.path.write_bytes(content)
    small.refused(code, "demo.toml")


@pytest.mark.parametrize("name", ["none.toml", "."])
def test_no_project_file(tmp_path: Path, name: str) -> None:
    for command in ("check", "identify"):
        ran = alula(command, tmp_path / name, "--json", "-")
        assert_refused(ran, "file_not_readable", str(tmp_path))


def test_variable_that_is_not_set(small: SmallProject, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ALULA_NOWHERE", raising=False)
    small.edit('path = "longitudinal.csv"', 'path = "${ALULA_NOWHERE}/longitudinal.csv"')
    small.refused("variable_not_set", "ALULA_NOWHERE", "export")


def test_unknown_key_and_method(small: SmallProject) -> None:
    small.edit('filter = "ekf"', 'filtr = "ekf"')
    small.refused("unknown_key", "filtr", "'filter'")
    small.edit('filtr = "ekf"', 'filter = "ekf"')
    small.edit('method = "ee"', 'method = "magic"')
    small.refused("unknown_method", "magic", "ee")


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("wighting = 'equal'", "unknown_option"),
        ("weighting = 'most'", "unknown_option"),
        ("weighting = 3.0", "bad_option"),
        ("scales = 3.0", "bad_option"),
        ("common_constant = 'yes'", "bad_option"),
    ],
)
def test_options_of_the_method(small: SmallProject, line: str, code: str) -> None:
    with small.path.open("a") as file:
        file.write(f"\n[identify.options]\n{line}\n")
    small.refused(code, line.split()[0])
