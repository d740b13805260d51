"""Bad logs: each ends in a message that says where, expected, found and what to do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.io

from data import data
from logs.made import (
    NAMED,
    NAMES,
    codes,
    csv_text,
    flight_table,
    read_flight,
    refused,
    write_csv,
)

TABLE = flight_table()


def edited(folder: Path, **columns: object) -> Path:
    """The flight as CSV with columns replaced."""
    table = TABLE.copy()
    for name, values in columns.items():
        table[:, NAMES.index(name)] = values
    return write_csv(folder, table)


def test_empty_file(tmp_path: Path) -> None:
    for name in ("log.csv", "log.npz", "log.mat", "log.parquet"):
        path = tmp_path / name
        path.touch()
        error = refused(path)
        assert codes(error) == ["empty_file"]
        assert str(path) in error.messages[0].where


def test_no_such_file(tmp_path: Path) -> None:
    assert codes(refused(tmp_path / "none.csv")) == ["file_not_readable"]
    assert codes(refused(tmp_path)) == ["file_not_readable"]  # a folder


def test_header_without_rows(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,az,q,theta,V\n")
    assert codes(refused(path)) == ["no_rows"]


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("log.csv", b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 9),
        ("log.mat", b"ULog\x01\x12\x35\x01" + bytes(99)),
        ("log.csv", b"\x1f\x8b" + bytes(99)),
        ("log.npz", b"\x93NUMPY\x01\x00" + bytes(99)),
        ("log.txt", bytes(range(256)) * 20),
    ],
)
def test_wrong_type_behind_the_extension(tmp_path: Path, name: str, content: bytes) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    assert codes(refused(path)) == ["wrong_type"]


def test_text_that_is_no_log(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("<html>\n<body>Not found</body>\n</html>\n")
    assert codes(refused(path)) == ["no_rows"]


def test_right_content_behind_a_wrong_extension_is_said(tmp_path: Path) -> None:
    path = write_csv(tmp_path, name="log.mat")
    flight = read_flight(path)
    assert codes(flight)[0] == "wrong_type"
    assert flight.messages[0].level == "warning"


def test_missing_channel(tmp_path: Path) -> None:
    path = write_csv(tmp_path)
    error = refused(path, {**NAMED, "theta": ("tehta", "deg"), "alpha": (6, "deg")})
    assert codes(error) == ["missing_channel", "missing_channel"]  # both at once
    assert "Did you mean 'theta'?" in error.messages[0].do
    assert "1 to 5" in error.messages[1].expected


def test_duplicate_channel(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(csv_text(TABLE, names=("t", "az", "q", "q", "V")))
    channels = {k: v for k, v in NAMED.items() if k != "theta"}
    error = refused(path, channels)
    assert codes(error) == ["duplicate_channel"]
    assert "column 3, column 4" in error.messages[0].found
    read_flight(path, {**channels, "q": (3, "deg/s")})  # by number it can be used


def test_ragged_rows(tmp_path: Path) -> None:
    lines = csv_text(TABLE).splitlines()
    lines[10] += ",1"
    lines[20] = lines[20].rsplit(",", 1)[0]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(lines) + "\n")
    error = refused(path)
    assert codes(error) == ["ragged_rows"]
    assert "line 11, 21" in error.messages[0].where
    flight = read_flight(path, repair=["drop_ragged_rows"])
    assert codes(flight).count("dropped_ragged_rows") == 1
    assert len(flight["V"].t) == len(TABLE) - 2
    dropped = len(lines[0]) + len(lines[10]) + len(lines[20]) + 3
    assert flight.files[0].skipped == dropped


def test_log_cut_off_in_its_last_row(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(csv_text(TABLE)[:-30])
    assert codes(refused(path)) == ["ragged_rows"]


def test_unit_row_is_no_sample(tmp_path: Path) -> None:
    lines = csv_text(TABLE).splitlines()
    path = tmp_path / "log.csv"
    path.write_text("\n".join([lines[0], "s,m/s2,deg/s,deg,m/s", *lines[1:]]) + "\n")
    flight = read_flight(path)
    assert len(flight["V"].t) == len(TABLE)
    np.testing.assert_array_equal(flight["V"].values, TABLE[:, 4])


def test_text_in_a_column_of_numbers(tmp_path: Path) -> None:
    lines = csv_text(TABLE).splitlines()
    lines[7] = lines[7].rsplit(",", 1)[0] + ",error"
    path = tmp_path / "log.csv"
    path.write_text("\n".join(lines) + "\n")
    flight = read_flight(path)
    (message,) = [m for m in flight.messages if m.code == "not_numeric"]
    assert "1 of 400" in message.found
    assert "'error'" in message.found
    assert np.flatnonzero(np.isnan(flight["V"].values)).tolist() == [6]


@pytest.mark.parametrize("text", ["nan", "NaN", "", "inf", "-inf", "N/A"])
def test_nan_and_infinity(tmp_path: Path, text: str) -> None:
    lines = csv_text(TABLE).splitlines()
    for i in (5, 6):
        lines[i] = lines[i].rsplit(",", 1)[0] + "," + text
    path = tmp_path / "log.csv"
    path.write_text("\n".join(lines) + "\n")
    flight = read_flight(path)
    (message,) = [m for m in flight.messages if m.code == "not_finite"]
    assert "2 of 400" in message.found
    assert np.flatnonzero(~np.isfinite(flight["V"].values)).tolist() == [4, 5]
    assert not np.isinf(flight["V"].values).any()


def test_fill_values_are_asked_about(tmp_path: Path) -> None:
    speed = TABLE[:, 4].copy()
    speed[50:60] = -9999
    path = edited(tmp_path, V=speed)
    error = refused(path)
    assert codes(error) == ["fill_value"]
    assert "fill_values = [-9999]" in error.messages[0].do
    flight = read_flight(path, fill_values=[-9999])
    (message,) = [m for m in flight.messages if m.code == "fill_values"]
    assert "10 of 400" in message.found
    assert np.isnan(flight["V"].values[50:60]).all()
    as_is = read_flight(path, {"t": ("t", "s"), "x": ("V", "1")}, fill_values=[])
    np.testing.assert_array_equal(as_is["x"].values, speed)


def test_channel_without_a_valid_sample(tmp_path: Path) -> None:
    assert codes(refused(edited(tmp_path, V=np.nan))) == ["no_valid_sample"]


@pytest.mark.parametrize(
    ("code", "repair", "shift"),
    [
        ("duplicate_time", "drop_duplicate_times", 0.02),
        ("backward_time", "drop_backward_times", 0.05),
    ],
)
def test_time_stamps(tmp_path: Path, code: str, repair: str, shift: float) -> None:
    t = TABLE[:, 0].copy()
    t[[100, 200]] = np.round(t[[100, 200]] - shift, 6)
    path = edited(tmp_path, t=t)
    error = refused(path)
    assert codes(error) == [code]
    assert "2 of 400" in error.messages[0].found
    assert "sample 101" in error.messages[0].found
    flight = read_flight(path, repair=[repair])
    assert codes(flight).count(f"dropped_{code}") == 1
    np.testing.assert_array_equal(flight["V"].t, np.delete(TABLE[:, 0], [100, 200]))
    np.testing.assert_array_equal(flight["V"].values, np.delete(TABLE[:, 4], [100, 200]))


def test_a_clock_set_anew_is_no_slip(tmp_path: Path) -> None:
    t = TABLE[:, 0].copy()
    t[200:] -= 3.0
    path = edited(tmp_path, t=t)
    both = ["drop_backward_times", "drop_duplicate_times"]
    assert codes(refused(path, repair=both)) == ["backward_time"]


def test_gaps_are_listed(tmp_path: Path) -> None:
    path = write_csv(tmp_path, np.delete(TABLE, slice(100, 150), axis=0))
    (message,) = [m for m in read_flight(path).messages if m.code == "gaps"]
    assert "1 gaps: 1.98 to 3 s" in message.found


def test_irregular_sampling_is_said(tmp_path: Path) -> None:
    t = TABLE[:, 0].copy()
    t[1::2] += 0.008
    assert "irregular_sampling" in codes(read_flight(edited(tmp_path, t=t)))


def test_constant_channel(tmp_path: Path) -> None:
    flight = read_flight(edited(tmp_path, V=51.5))
    (message,) = [m for m in flight.messages if m.code == "constant_channel"]
    assert message.level == "warning"
    assert "51.5 in all 400 samples" in message.found


def test_a_sensor_that_sticks_is_said(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.1, len(TABLE))
    V = 50.0 + noise
    V[150:] = V[150]  # 5 s of 8
    flight = read_flight(edited(tmp_path, V=V))
    (message,) = [m for m in flight.messages if m.code == "stuck_channel"]
    assert message.level == "warning"
    assert "from 3 to 7.98 s" in message.found
    assert "channel V" in message.where
    for quiet in (50.0 + noise, np.round(50.0 + noise, 1), np.maximum(V - V[150], 0.0)):
        # moving; coarse; an airspeed at its least value on the ground
        assert "stuck_channel" not in codes(read_flight(edited(tmp_path, V=quiet)))


def implausible(path: Path, **channels: tuple[str, str]) -> str:
    error = refused(path, {**NAMED, **channels})
    assert set(codes(error)) == {"unit_implausible"}
    return " ".join(f"{m.found} {m.do}" for m in error.messages)


def test_accelerations_taken_for_g(tmp_path: Path) -> None:
    assert "write unit = 'm/s2'" in implausible(edited(tmp_path), az=("az", "g"))


def test_accelerations_in_g(tmp_path: Path) -> None:
    path = edited(tmp_path, az=TABLE[:, 1] / 9.80665)
    assert "write unit = 'g'" in implausible(path)
    flight = read_flight(path, {**NAMED, "az": ("az", "g")})
    np.testing.assert_allclose(flight["az"].values, TABLE[:, 1], rtol=1e-14)


def test_accelerations_in_feet(tmp_path: Path) -> None:
    assert "write unit = 'ft/s2'" in implausible(edited(tmp_path, az=TABLE[:, 1] / 0.3048))


def test_rates_in_degrees(tmp_path: Path) -> None:
    """35 rad/s looks like deg/s."""
    path = edited(tmp_path, q=35 * np.cos(2 * TABLE[:, 0]))
    assert "write unit = 'deg/s'" in implausible(path, q=("q", "rad/s"))


def test_slow_rates_in_degrees_show_by_the_attitude(tmp_path: Path) -> None:
    """4 rad/s is possible; four times what the attitude turns is not."""
    assert "q in deg/s" in implausible(write_csv(tmp_path), q=("q", "rad/s"))


def test_angles_in_degrees(tmp_path: Path) -> None:
    path = write_csv(tmp_path)
    assert "write unit = 'deg'" in implausible(path, alpha=("theta", "rad"))
    assert "unit = 'deg'" in implausible(path, theta=("theta", "rad"))


def test_time_in_milliseconds(tmp_path: Path) -> None:
    assert "write unit = 'ms'" in implausible(edited(tmp_path, t=1e3 * TABLE[:, 0]))


def test_what_looks_wrong_can_be_confirmed(tmp_path: Path) -> None:
    path = edited(tmp_path, q=35 * np.cos(2 * TABLE[:, 0]), theta=17.5 * np.sin(2 * TABLE[:, 0]))
    q = {"from": "q", "unit": "rad/s", "confirmed": True}
    flight = read_flight(path, {**NAMED, "q": q})
    levels = {m.level for m in flight.messages if m.code == "unit_implausible"}
    assert levels == {"warning"}
    assert flight["q"].values.max() == pytest.approx(35.0, rel=1e-3)


def test_z_axis_up(tmp_path: Path) -> None:
    path = edited(tmp_path, az=-TABLE[:, 1])
    error = refused(path)
    assert codes(error) == ["axes_z_up"]
    assert "sign = -1" in error.messages[0].do
    flight = read_flight(path, {**NAMED, "az": {"from": "az", "unit": "m/s2", "sign": -1}})
    np.testing.assert_array_equal(flight["az"].values, TABLE[:, 1])


def test_attitude_against_its_rate(tmp_path: Path) -> None:
    theta = {"from": "theta", "unit": "deg", "sign": -1}
    flight = read_flight(write_csv(tmp_path), {**NAMED, "theta": theta})
    assert "sign_contradiction" in codes(flight)


def test_real_recordings_with_wrong_units_and_signs() -> None:
    path = data("attas", "fAttasElv1.mat")
    right = {"t": (1, "s"), "az": (4, "m/s2"), "q": (8, "deg/s"), "theta": (11, "deg")}
    assert not [m for m in read_flight(path, right).messages if m.level == "warning"]
    wrong = {**right, "az": {"from": 4, "unit": "m/s2", "sign": -1}, "q": (8, "rad/s")}
    assert set(codes(refused(path, wrong))) == {"axes_z_up", "unit_implausible"}


def test_wrong_and_missing_units(tmp_path: Path) -> None:
    path = write_csv(tmp_path)
    assert codes(refused(path, {**NAMED, "V": ("V", "deg")})) == ["wrong_unit"]
    assert codes(refused(path, {**NAMED, "V": ("V", "knotts")})) == ["unknown_unit"]
    assert codes(refused(path, {**NAMED, "V": {"from": "V"}})) == ["missing_unit"]


def test_no_time(tmp_path: Path) -> None:
    channels = {k: v for k, v in NAMED.items() if k != "t"}
    assert codes(refused(write_csv(tmp_path), channels)) == ["missing_channel"]


@pytest.mark.parametrize("where", [64, 140, 200, 3000])
def test_corrupt_matlab_file(tmp_path: Path, where: int) -> None:
    """Bytes overwritten in header, tag, flags or data: a message, or the right numbers."""
    path = tmp_path / "log.mat"
    columns = {name: TABLE[:, k] for k, name in enumerate(NAMES)}
    scipy.io.savemat(path, columns, do_compression=where == 3000)
    whole = bytearray(path.read_bytes())
    whole[where : where + 40] = b"\xff" * 40
    path.write_bytes(whole)
    if where == 64:  # descriptive text only
        np.testing.assert_array_equal(read_flight(path)["V"].values, TABLE[:, 4])
    else:
        # 200 lies in the numbers of the first variable, t: they become NaN, which is seen
        allowed = {"backward_time"} if where == 200 else {"corrupt_file", "missing_channel"}
        assert set(codes(refused(path))) <= allowed


@pytest.mark.parametrize("kind", ["mat", "npz", "parquet", "h5"])
def test_cut_off_files(tmp_path: Path, kind: str) -> None:
    columns = {name: TABLE[:, k] for k, name in enumerate(NAMES)}
    path = tmp_path / f"log.{kind}"
    if kind == "mat":
        scipy.io.savemat(path, columns)
    elif kind == "npz":
        np.savez(path, **columns)
    elif kind == "h5":
        import h5py

        with h5py.File(path, "w") as file:
            file.update(columns)
    else:
        import pyarrow as pa
        import pyarrow.parquet as pq

        pq.write_table(pa.table(columns), path)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    assert set(codes(refused(path))) <= {"corrupt_file", "missing_channel"}


def test_decoder_that_takes_all_memory_or_crashes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The child is stopped by its limits, and a crash of it is a message."""
    from alula.logs import mat

    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {name: TABLE[:, k] for k, name in enumerate(NAMES)})
    monkeypatch.setattr(mat, "MEMORY", 1 << 20)  # not enough to start in
    error = refused(path)
    assert codes(error) == ["corrupt_file"]
    child = tmp_path / "mat_child.py"
    child.write_text("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)\n")
    monkeypatch.setattr(mat, "__file__", str(tmp_path / "mat.py"))
    error = refused(path)
    assert "crashed (signal 11)" in error.messages[0].found
