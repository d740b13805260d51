"""One flight written in the ways that recorders and spreadsheets write text."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from logs.made import NAMED, NAMES, NUMBERED, UNITS, codes, csv_text, flight_table, read_flight

TABLE = flight_table()


def same(flight, table: np.ndarray = TABLE) -> None:
    """The values are exact up to the conversion's own rounding (one ulp or two)."""
    for k, name in enumerate(NAMES[1:], 1):
        factor = np.pi / 180 if UNITS[k].startswith("deg") else 1.0
        np.testing.assert_allclose(flight[name].values, factor * table[:, k], rtol=1e-15)
        np.testing.assert_array_equal(flight[name].t, table[:, 0])


@pytest.mark.parametrize("separator", [",", ";", "\t", "|"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_separators_and_line_ends(tmp_path: Path, separator: str, end: str) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(csv_text(TABLE, separator=separator, end=end).encode())
    flight = read_flight(path)
    same(flight)
    header = len(separator.join(NAMES)) + len(end)
    assert flight.files[0].skipped == header


@pytest.mark.parametrize("separator", [";", "\t", "|"])
def test_decimal_comma(tmp_path: Path, separator: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text(csv_text(TABLE, separator=separator).replace(".", ","))
    same(read_flight(path))


@pytest.mark.parametrize(
    ("encoding", "mark"),
    [
        ("utf-8", b""),
        ("utf-8", b"\xef\xbb\xbf"),
        ("utf-16-le", b"\xff\xfe"),
        ("utf-16-be", b"\xfe\xff"),
        ("utf-16-le", b""),
        ("utf-16-be", b""),
        ("latin-1", b""),
    ],
)
def test_encodings(tmp_path: Path, encoding: str, mark: bytes) -> None:
    path = tmp_path / "log.csv"
    text = csv_text(TABLE, names=("t", "az", "q", "Längsneigung", "V"))
    path.write_bytes(mark + text.encode(encoding))
    flight = read_flight(path, {**NAMED, "theta": ("Längsneigung", "deg")})
    same(flight)
    header = text.splitlines()[0] + "\n"
    assert flight.files[0].skipped == len(mark) + len(header.encode(encoding))


def test_stated_encoding(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(csv_text(TABLE).encode("utf-16"))
    same(read_flight(path, encoding="utf-16"))


def test_unit_row_and_preamble(tmp_path: Path) -> None:
    lines = csv_text(TABLE).splitlines()
    units = ["s", "m/s^2", "°/s", "deg", "m/s"]
    text = "\n".join(["Flight 12; a, test", "", lines[0], ",".join(units), *lines[1:]]) + "\n"
    path = tmp_path / "log.csv"
    path.write_text(text, encoding="utf-8")
    stated = {name: {"from": name} for name in NAMES}
    flight = read_flight(path, stated)  # units from the file
    same(flight)
    head = "\n".join(text.splitlines()[:4]) + "\n"
    assert flight.files[0].skipped == len(head.encode())


def test_units_in_the_header(tmp_path: Path) -> None:
    names = tuple(f"{n} [{u}]" for n, u in zip(NAMES, UNITS, strict=True))
    path = tmp_path / "log.csv"
    path.write_text(csv_text(TABLE, names=names))
    same(read_flight(path, {name: {"from": name} for name in NAMES}))
    flight = read_flight(path, {**NAMED, "V": ("V", "kt")})
    assert "unit_contradiction" in codes(flight)


def test_comments_blank_lines_and_quotes(tmp_path: Path) -> None:
    lines = csv_text(TABLE, names=tuple(f'"{n}"' for n in NAMES)).splitlines()
    lines[3:3] = ["# a remark, with, commas", "", "% another", "// and another"]
    text = "\n".join(lines) + "\n"
    path = tmp_path / "log.csv"
    path.write_text(text)
    flight = read_flight(path)
    same(flight)
    skipped = [lines[0], *lines[3:7]]
    assert flight.files[0].skipped == sum(len(line) + 1 for line in skipped)


def test_header_in_a_comment(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("# made for a test\n#" + csv_text(TABLE))
    same(read_flight(path))


def test_rows_that_end_in_a_separator(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    head, *rows = csv_text(TABLE).splitlines()
    path.write_text("\n".join([head, *(row + "," for row in rows)]) + "\n")
    same(read_flight(path))


def test_no_header(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("\n".join(csv_text(TABLE).splitlines()[1:]))  # no end of the last line either
    same(read_flight(path, NUMBERED))
    same(read_flight(path, columns=list(NAMES)))


def test_stated_layout(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("1,2,3,4,5\nnonsense\n" + csv_text(TABLE).replace("t,az", "T,az"))
    flight = read_flight(path, {**NAMED, "t": ("T", "s")}, header_row=3)
    same(flight)


@pytest.mark.parametrize("blank", [" ", "   ", "\t", " \t "])
def test_ascii_columns(tmp_path: Path, blank: str) -> None:
    path = tmp_path / "log.asc"
    rows = ["  " + blank.join(f"{x:.17e}" for x in row) + " " for row in TABLE]
    path.write_text("\n".join(rows) + "\n")
    same(read_flight(path, NUMBERED))


def test_ascii_with_fortran_exponents_and_header(tmp_path: Path) -> None:
    path = tmp_path / "log.dat"
    head = " ".join(f"{n} [{u}]" for n, u in zip(NAMES, UNITS, strict=True))
    rows = [" ".join(f"{x:.17E}".replace("E", "D") for x in row) for row in TABLE]
    path.write_text("\n".join([head, *rows]) + "\n")
    same(read_flight(path, {name: {"from": name} for name in NAMES}))


def test_numbers_are_read_to_the_last_bit(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    table = TABLE.copy()
    table[:, 4] = rng.normal(50.0, 1.0, len(table)) * (1 + rng.normal(size=len(table)) * 1e-16)
    path = tmp_path / "log.csv"
    path.write_text(csv_text(table))
    np.testing.assert_array_equal(read_flight(path)["V"].values, table[:, 4])


def test_dates_become_seconds(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = ["stamp,q"] + [
        f"2021-03-04 10:00:{s:02d}.{h:02d},{s}.5" for s in range(9) for h in (0, 50)
    ]
    path.write_text("\n".join(rows) + "\n")
    flight = read_flight(path, {"t": ("stamp", "s"), "q": ("q", "deg/s")})
    np.testing.assert_allclose(np.diff(flight["q"].t), 0.5, atol=1e-6)  # float64 at 1.6e9 s
    assert flight["q"].t[0] == 1614852000.0  # 2021-03-04T10:00Z


def test_a_slower_channel_keeps_its_own_rate(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{row[0]!r},{row[2]!r},{row[4]!r}" if k % 5 == 0 else f"{row[0]!r},{row[2]!r},"
            for k, row in enumerate(TABLE.tolist())]  # fmt: skip
    path.write_text("\n".join(["t,q,V", *rows]) + "\n")
    flight = read_flight(path, {k: NAMED[k] for k in ("t", "q", "V")})
    np.testing.assert_array_equal(flight["V"].t, TABLE[::5, 0])
    np.testing.assert_array_equal(flight["V"].values, TABLE[::5, 4])
    assert len(flight["q"].t) == len(TABLE)
    assert "own_rate" in codes(flight)
