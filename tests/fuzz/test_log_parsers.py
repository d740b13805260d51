"""Parsers on damaged and random files: a Flight or a BadInput, never anything else.

The examples are few enough for every run; raise max_examples and set derandomize=False for a while
when a parser changes.
"""

from __future__ import annotations

import io
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from alula.base.messages import BadInput
from alula.flight import Flight
from alula.logs import new_project, read
from logs.made import NAMED, NAMES, NUMBERED, csv_text, flight_table, log, specs

TABLE = flight_table(60)
COLUMNS = {name: TABLE[:, k] for k, name in enumerate(NAMES)}
FAST = settings(
    max_examples=60,
    deadline=None,
    derandomize=True,  # the same examples in every run
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
SLOW = settings(FAST, max_examples=8)  # each starts a child process


def outcome(path: Path, content: bytes, channels: dict = NAMED, **options: object) -> None:
    path.write_bytes(content)
    try:
        flight = read(log(path, **options), specs(**channels))
    except BadInput as error:
        complete = [m.where and m.expected and m.found and m.do for m in error.messages]
        if not complete or not all(complete):
            raise  # a message without its parts
        return
    assert isinstance(flight, Flight)
    (file,) = flight.files
    assert file.decoded + file.skipped + file.unknown == file.bytes == len(content)
    assert min(file.decoded, file.skipped, file.unknown) >= 0
    for channel in flight.channels.values():
        assert len(channel.t) == len(channel.values)
        assert (np.diff(channel.t) > 0).all()


def npz() -> bytes:
    out = io.BytesIO()
    np.savez_compressed(out, **COLUMNS)
    return out.getvalue()


def mat5() -> bytes:
    out = io.BytesIO()
    scipy.io.savemat(out, COLUMNS, do_compression=True)
    return out.getvalue()


def hdf5() -> bytes:
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        for name, values in COLUMNS.items():
            file[name] = values
    return out.getvalue()


def parquet() -> bytes:
    out = io.BytesIO()
    pq.write_table(pa.table(COLUMNS), out)
    return out.getvalue()


def mutated(whole: bytes) -> st.SearchStrategy[bytes]:
    """The file with a few stretches overwritten, removed or put in, or cut off."""
    place = st.integers(0, len(whole) - 1)
    edit = st.tuples(place, st.integers(0, 40), st.binary(max_size=40))

    def apply(edits: list[tuple[int, int, bytes]]) -> bytes:
        out = whole
        for at, removed, put in edits:
            out = out[:at] + put + out[at + removed :]
        return out

    return st.lists(edit, min_size=1, max_size=4).map(apply)


@FAST
@given(st.binary(max_size=600))
def test_random_bytes(tmp_path: Path, content: bytes) -> None:
    outcome(tmp_path / "log.csv", content, NUMBERED)


@FAST
@given(st.text(alphabet="0123456789.,;|\t \n\r\"'eE+-#naNt[]/°_", max_size=400))
def test_random_tables(tmp_path: Path, text: str) -> None:
    outcome(tmp_path / "log.txt", text.encode(), NUMBERED)


@FAST
@given(mutated(csv_text(TABLE).encode()))
def test_damaged_csv(tmp_path: Path, content: bytes) -> None:
    repair = ["drop_ragged_rows", "drop_duplicate_times", "drop_backward_times"]
    outcome(tmp_path / "log.csv", content, repair=repair)


@FAST
@given(mutated(csv_text(TABLE).replace(",", "  ").encode("utf-16")))
def test_damaged_utf_16_columns(tmp_path: Path, content: bytes) -> None:
    outcome(tmp_path / "log.asc", content)


@FAST
@given(mutated(npz()))
def test_damaged_npz(tmp_path: Path, content: bytes) -> None:
    outcome(tmp_path / "log.npz", content)


@FAST
@given(mutated(parquet()))
def test_damaged_parquet(tmp_path: Path, content: bytes) -> None:
    outcome(tmp_path / "log.parquet", content)


@SLOW
@given(mutated(mat5()))
def test_damaged_matlab_5(tmp_path: Path, content: bytes) -> None:
    outcome(tmp_path / "log.mat", content)


@SLOW
@given(mutated(hdf5()))
def test_damaged_hdf5(tmp_path: Path, content: bytes) -> None:
    outcome(tmp_path / "log.h5", content)


@FAST
@given(mutated(csv_text(TABLE).encode()))
def test_new_project_of_damaged_csv(tmp_path: Path, content: bytes) -> None:
    """What `alula new` writes can be read as a project, whatever the columns are called."""
    from alula.base.project import load_project

    path = tmp_path / "log.csv"
    path.write_bytes(content)
    try:
        text = new_project(path)
    except BadInput:
        return
    (tmp_path / "project.toml").write_text(text, encoding="utf-8")
    assert load_project(tmp_path / "project.toml").logs[0].path == path


@pytest.mark.parametrize("make", [npz, mat5, hdf5, parquet])
def test_the_whole_files_can_be_read(tmp_path: Path, make) -> None:
    """The positive control: what is damaged above is readable before."""
    path = tmp_path / "log.bin"
    path.write_bytes(make())
    assert read(log(path), specs(**NAMED))["V"].values.tolist() == TABLE[:, 4].tolist()
