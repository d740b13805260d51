"""Bad input given to the command: exit 2 (or a warning by name), what to do, no traceback, and
nothing written.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from alula.model import load_model
from cli.command import SmallProject, alula, assert_refused, contents, process

# --- the log -------------------------------------------------------------------------------------


def test_empty_file(small: SmallProject) -> None:
    small.log.write_bytes(b"")
    small.refused("empty_file", "longitudinal.csv", "0 bytes")


def test_log_that_is_not_there(small: SmallProject) -> None:
    small.log.unlink()
    small.refused("file_not_readable", "longitudinal.csv")


def test_wrong_type_behind_the_extension(small: SmallProject) -> None:
    small.log.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 9)
    small.refused("wrong_type", "longitudinal.csv")


def test_readable_type_behind_the_wrong_extension_is_read_and_said(small: SmallProject) -> None:
    columns = {f"c{k}": values for k, values in enumerate(small.table.T)}
    text = small.path.read_text()
    for k, name in enumerate(small.header):
        text = text.replace(f'from = "{name}"', f'from = "c{k}"')
    small.path.write_text(text)
    with small.log.open("wb") as file:
        np.savez(file, **columns)
    ran = small.identify()
    assert ran.code == 0
    assert "[wrong_type]" in ran.err


def test_missing_channel(small: SmallProject) -> None:
    small.edit('from = "alpha_deg"', 'from = "alfa_deg"')
    small.refused("missing_channel", "alfa_deg", "alpha_deg")


def test_channel_that_the_job_needs_is_not_mapped(small: SmallProject) -> None:
    small.edit('az = {from = "az_m/s2", unit = "m/s2"}\n', "")
    small.refused("missing_channel", "az")


def test_duplicate_channel(small: SmallProject) -> None:
    small.header[small.header.index("beta_deg")] = "alpha_deg"
    small.write_log()
    small.refused("duplicate_channel", "alpha_deg")


def test_channel_mapped_twice(small: SmallProject) -> None:
    small.edit("[channels]\n", '[channels]\nV = {from = "V_m/s", unit = "m/s"}\n')
    small.refused("not_toml", "demo.toml", "line")


def test_ragged_rows(small: SmallProject) -> None:
    lines = small.log.read_text().splitlines()
    lines[500] = lines[500].rsplit(",", 3)[0]
    small.log.write_text("\n".join(lines) + "\n")
    small.refused("ragged_rows", "501")
    small.edit(
        'path = "longitudinal.csv"', 'path = "longitudinal.csv"\nrepair = ["drop_ragged_rows"]'
    )
    ran = small.identify()
    assert ran.code == 0
    (dropped,) = ran.messages("dropped_ragged_rows")
    assert "1" in dropped["found"]
    (file,) = ran.envelope["inputs"]
    assert file["skipped"] >= len(lines[500])  # the row is in the account


def test_unit_row_is_no_data(small: SmallProject) -> None:
    header, rest = small.log.read_text().split("\n", 1)
    units = ",".join(name.rpartition("_")[2] for name in small.header)
    small.log.write_text(f"{header}\n{units}\n{rest}")
    ran = small.identify()
    assert ran.code == 0
    assert ran.envelope["result"]["fit"]["Cm"]["n"] == len(small.table)


def test_unit_row_that_contradicts_the_project(small: SmallProject) -> None:
    header, rest = small.log.read_text().split("\n", 1)
    units = ",".join(name.rpartition("_")[2] for name in small.header)
    small.log.write_text(f"{header}\n{units.replace('m/s2', 'ft/s2', 1)}\n{rest}")
    ran = small.check()
    assert ran.code == 0
    (message,) = ran.messages("unit_contradiction")
    assert message["level"] == "warning"
    assert "'ft/s2'" in message["expected"]
    assert "'m/s2'" in message["found"]
    assert "[unit_contradiction]" in ran.err


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", ""])
def test_not_a_number_within_a_maneuver(small: SmallProject, value: str) -> None:
    """A hole of under three samples is bridged and said."""
    lines = small.log.read_text().splitlines()
    column = small.header.index("alpha_deg")
    for k in (700, 701):
        fields = lines[k].split(",")
        fields[column] = value
        lines[k] = ",".join(fields)
    small.log.write_text("\n".join(lines) + "\n")
    ran = small.identify()
    assert ran.code == 0, ran.err
    (message,) = ran.messages("not_finite")
    assert "alpha" in message["where"]
    assert "2 of 2001" in message["found"]


def test_fill_values(small: SmallProject) -> None:
    small.column("alpha_deg")[700:702] = -9999
    small.write_log()
    small.refused("fill_value", "alpha", "-9999", "fill_values = [-9999]")
    small.edit('path = "longitudinal.csv"', 'path = "longitudinal.csv"\nfill_values = [-9999]')
    ran = small.identify()
    assert ran.code == 0
    (message,) = ran.messages("fill_values")
    assert "2 of 2001" in message["found"]


@pytest.mark.parametrize(("code", "back"), [("duplicate_time", 0.01), ("backward_time", 0.05)])
def test_time_stamps(small: SmallProject, code: str, back: float) -> None:
    small.column("t_s")[900] -= back
    small.write_log()
    small.refused(code, "1 of 2001", f"drop_{code}s")
    small.edit('path = "longitudinal.csv"', f'path = "longitudinal.csv"\nrepair = ["drop_{code}s"]')
    ran = small.identify()
    assert ran.code == 0
    (message,) = ran.messages(f"dropped_{code}")
    assert message["level"] != "error"


def test_gap_is_refused_or_split_as_asked(small: SmallProject) -> None:
    small.table = np.delete(small.table, slice(1200, 1260), axis=0)
    small.write_log()
    small.refused("gap_in_maneuver", "11.99 to 12.6 s", "on_gap = 'split'")
    small.edit('kind = "3211"', 'kind = "3211"\non_gap = "split"')
    ran = small.identify()
    assert ran.code in (0, 1), ran.err
    (message,) = ran.messages("split_at_gaps")
    assert "longitudinal.1" in message["do"]
    maneuvers = ran.envelope["result"]["reconstruction"]["maneuvers"]
    assert sorted(maneuvers) == ["longitudinal.1", "longitudinal.2"]
    one = small.identify("--maneuver", "longitudinal.2")
    assert sorted(one.envelope["result"]["reconstruction"]["maneuvers"]) == ["longitudinal.2"]
    assert_refused(
        small.identify("--maneuver", "longitudinal.3"), "unknown_maneuver", "'longitudinal.3'"
    )


def test_constant_channel(small: SmallProject) -> None:
    small.column("de_deg")[:] = 1.5
    small.write_log()
    ran = small.identify()
    assert ran.code == 1
    assert "[constant_channel]" in ran.err
    assert "channel de" in ran.err
    assert ran.envelope["status"] == "not_identifiable"


@pytest.mark.parametrize(
    ("column", "factor", "unit"), [("az_m/s2", 1 / 9.80665, "g"), ("q_deg/s", 1.0, "deg/s")]
)
def test_units_that_cannot_be_right(
    small: SmallProject, column: str, factor: float, unit: str
) -> None:
    """az about -1 looks like g; 35 rad/s looks like deg/s: asked, not assumed."""
    small.column(column)[:] *= factor
    if column == "q_deg/s":
        small.column(column)[:] *= 35.0 / np.abs(small.column(column)).max()
        small.edit(
            'q = {from = "q_deg/s", unit = "deg/s"}', 'q = {from = "q_deg/s", unit = "rad/s"}'
        )
    small.write_log()
    small.refused("unit_implausible", f"unit = '{unit}'")


def test_axes_with_z_up(small: SmallProject) -> None:
    small.column("az_m/s2")[:] *= -1.0
    small.write_log()
    small.refused("axes_z_up", "channel az", "sign = -1")


def test_corrupt_matlab_file(small: SmallProject) -> None:
    path = small.folder / "log.mat"
    scipy.io.savemat(path, {"t": small.column("t_s"), "V": small.column("V_m/s")})
    whole = bytearray(path.read_bytes())
    whole[140:180] = b"\xff" * 40
    path.write_bytes(whole)
    small.edit('path = "longitudinal.csv"', 'path = "log.mat"')
    small.refused("corrupt_file", "log.mat")


def test_log_of_names_that_terminals_and_json_must_survive(small: SmallProject) -> None:
    small.log.write_text("[red]\x1b[2J\x1b]0;title\x07,é\u202e\n" + "1,2\n" * 100)
    said = small.refused("missing_channel", "[red]?[2J?]0;title?, é?")
    assert not set("\x1b\x07\u202e") & set(said)


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


# --- the command line ----------------------------------------------------------------------------


def test_unknown_maneuver(small: SmallProject) -> None:
    ran = small.identify("--maneuver", "roll")
    assert_refused(ran, "unknown_maneuver", "'roll'", "longitudinal")


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (("--filter", "kf"), "'ekf'"),
        (("--method", "magic"), "'ee'"),
        (("--threads", "-1"), "-1"),
        (("--seed", "one"), "one"),
        (("--wrong",), "--wrong"),
        (("second.toml",), "second.toml"),
    ],
)
def test_options_that_are_wrong(sound: SmallProject, words: tuple[str, ...], found: str) -> None:
    assert_refused(sound.identify(*words), "usage", found)


@pytest.mark.parametrize("option", ["--report", "--model", "--json"])
@pytest.mark.parametrize("place", ["missing/out", "sportstar.toml/out", "."])
def test_output_that_cannot_be_written(small: SmallProject, option: str, place: str) -> None:
    """A folder that is missing, a file for a folder, a folder for a file: known before the work."""
    before = contents(small.folder)
    words = ["identify", small.path, option, small.folder / place]
    ran = alula(*words)
    assert ran.code == 2
    assert "[output_not_writable]" in ran.err
    assert "reading logs" not in ran.err
    assert "Traceback" not in ran.err
    assert contents(small.folder) == before


@pytest.mark.parametrize("option", ["--report", "--model", "--json"])
@pytest.mark.parametrize("target", ["longitudinal.csv", "demo.toml", "truth.json"])
def test_no_output_replaces_what_alula_did_not_write(
    small: SmallProject, option: str, target: str
) -> None:
    before = contents(small.folder)
    ran = alula("identify", small.path, option, small.folder / target)
    assert ran.code == 2
    assert "[output_not_writable]" in ran.err
    assert contents(small.folder) == before


def test_outputs_may_be_written_again(small: SmallProject) -> None:
    names = {"--report": "r.html", "--model": "m.toml", "--json": "j.json"}
    words = [word for key, name in names.items() for word in (key, small.folder / name)]
    for _ in range(2):
        ran = alula("identify", small.path, *words)
        assert ran.code == 0, ran.err


def test_pipe_or_device_is_no_file(small: SmallProject) -> None:
    """Writing by rename would put a file in its place."""
    pipe = small.folder / "pipe"
    os.mkfifo(pipe)
    ran = alula("identify", small.path, "--json", pipe)
    assert ran.code == 2
    assert "--json -" in ran.err
    assert pipe.is_fifo()


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"parameters": 3}', '{"parameters": {"Cm_0": "x"}}', "\x00"]
)
def test_truth_that_is_none(small: SmallProject, text: str) -> None:
    truth = small.folder / "t.json"
    truth.write_text(text)
    assert_refused(small.identify("--truth", truth), "bad_truth", "t.json")


def test_new_overwrites_nothing(small: SmallProject) -> None:
    before = contents(small.folder)
    ran = alula("new", small.log, "--output", small.path, "--json", "-")
    assert_refused(ran, "file_exists", "demo.toml")
    empty = small.folder / "empty.csv"
    empty.touch()
    ran = alula("new", empty, "--output", small.folder / "new.toml", "--json", "-")
    assert_refused(ran, "empty_file", "empty.csv")
    assert {k for k in contents(small.folder) if k not in before} == {str(empty)}


# --- by a process of its own ---------------------------------------------------------------------


def test_refusal_by_the_real_command(small: SmallProject) -> None:
    small.log.write_bytes(b"")
    assert_refused(process("identify", small.path, "--json", "-"), "empty_file")
    plain = process("identify", small.path)
    assert plain.code == 2
    assert plain.out == ""
    assert "Traceback" not in plain.err


def test_interrupted(small: SmallProject) -> None:
    """Ctrl-C ends with 130, no traceback and no file."""
    small.table = np.vstack([small.table] * 40)  # long enough to be interrupted
    small.column("t_s")[:] = 0.01 * np.arange(len(small.table))
    small.write_log()
    small.edit("end = 20.0", "end = 800.0")
    before = contents(small.folder)
    running = subprocess.Popen(
        [sys.executable, "-m", "alula", "identify", str(small.path), "--filter", "ml",
         "--report", str(small.folder / "r.html")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # A shell that runs the tests in the background has made its children deaf to Ctrl-C.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    assert running.stderr is not None
    assert "reading logs" in running.stderr.readline()
    time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    out, err = running.communicate(timeout=120)
    assert running.returncode == 130, out + err
    assert "Traceback" not in err
    assert out == ""
    assert contents(small.folder) == before


@pytest.mark.parametrize(
    ("words", "streams"),
    [
        (("check",), "stdout"),
        (("check",), "both"),
        (("identify",), "stdout"),
        (("identify", "--json", "-"), "both"),
    ],
)
def test_reader_that_goes_away(small: SmallProject, words: tuple[str, ...], streams: str) -> None:
    """`alula ... | head`: no complaint, the command's own exit code, and its files all the same."""
    command, *more = words
    report = ["--report", str(small.folder / "r.html")] if command == "identify" else []
    with (small.folder / "stderr").open("w+") as err:
        running = subprocess.Popen(
            [sys.executable, "-m", "alula", command, str(small.path), *more, *report],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if streams == "both" else err,
        )
        assert running.stdout is not None
        running.stdout.close()
        assert running.wait(timeout=120) == 0
        err.seek(0)
        said = err.read()
    assert "Traceback" not in said
    assert "Broken pipe" not in said
    assert (small.folder / "r.html").exists() == (command == "identify")


@pytest.mark.parametrize("encoding", ["ascii", "utf-8"])
def test_file_names_of_any_bytes(small: SmallProject, encoding: str) -> None:
    """A folder named in Latin-1 on a system of UTF-8, and a terminal that knows ASCII only."""
    small.edit('name = "Demo: light', 'name = "😀 Demo: light')
    folder = small.folder.with_name(os.fsdecode(b"caf\xe9"))
    small.folder.rename(folder)
    words = {"--report": "r.html", "--model": "m.toml", "--truth": "truth.json"}
    ran = process(
        "identify",
        folder / "demo.toml",
        *(word for key, name in words.items() for word in (key, folder / name)),
        env={**os.environ, "PYTHONIOENCODING": encoding},
        errors="surrogateescape",
    )
    assert ran.code == 0, ran.err
    assert "Cm_alpha" in ran.out
    assert "caf\ufffd" in (folder / "r.html").read_text()
    assert load_model(folder / "m.toml").params
