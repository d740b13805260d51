"""Bad input given to the command, in the log: exit 2 (or a warning by name), what to do, no
traceback, and nothing written.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io

from cli.command import SmallProject, assert_refused


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
