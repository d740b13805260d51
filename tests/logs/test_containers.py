"""NPZ, MATLAB, HDF5 and Parquet made by the libraries that own these formats."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io

from logs.made import NAMED, NAMES, NUMBERED, UNITS, codes, flight_table, read_flight, refused

TABLE = flight_table()
COLUMNS = {name: TABLE[:, k] for k, name in enumerate(NAMES)}


def same(flight) -> None:
    for k, name in enumerate(NAMES[1:], 1):
        factor = np.pi / 180 if UNITS[k].startswith("deg") else 1.0
        np.testing.assert_allclose(flight[name].values, factor * TABLE[:, k], rtol=1e-15)
        np.testing.assert_array_equal(flight[name].t, TABLE[:, 0])


def test_npz(tmp_path: Path) -> None:
    path = tmp_path / "log.npz"
    np.savez_compressed(path, **COLUMNS, extra=np.zeros((3, 4, 5)), words=np.array(["a"]))
    flight = read_flight(path)
    same(flight)
    assert "array_not_read" in codes(flight)
    assert flight.files[0].unknown == 0


def test_npz_of_a_matrix_in_rows(tmp_path: Path) -> None:
    path = tmp_path / "log.npz"
    np.savez(path, data=TABLE.T)
    same(read_flight(path, NUMBERED))


def test_npz_bytes_are_those_of_the_members(tmp_path: Path) -> None:
    path = tmp_path / "log.npz"
    np.savez(path, **COLUMNS, unmapped=np.arange(10.0))
    file = read_flight(path).files[0]
    assert file.decoded == len(NAMES) * (8 * len(TABLE) + 128)  # .npy headers of 128 bytes
    assert file.unknown == 0


def test_npz_bytes_before_the_archive_are_unknown(tmp_path: Path) -> None:
    """Zip readers find an archive from its end; what stands before it nobody explains."""
    path = tmp_path / "log.npz"
    np.savez(path, **COLUMNS)
    clean = read_flight(path).files[0]
    gap = b"PK\x03\x04" + bytes(96)
    path.write_bytes(gap + path.read_bytes())
    file = read_flight(path).files[0]
    assert (file.decoded, file.unknown) == (clean.decoded, len(gap))


def test_npz_never_unpickles(tmp_path: Path) -> None:
    class Bomb:
        def __reduce__(self):
            return (Path(tmp_path / "exploded").touch, ())

    path = tmp_path / "log.npz"
    np.savez(path, **COLUMNS, bomb=np.array([Bomb()], dtype=object))
    flight = read_flight(path)
    same(flight)
    assert "array_not_read" in codes(flight)
    refused(path, {**NAMED, "alpha": ("bomb", "rad")})
    assert not (tmp_path / "exploded").exists()


def test_matlab_5_with_structures(tmp_path: Path) -> None:
    path = tmp_path / "log.mat"
    flight = {"imu": {name: COLUMNS[name] for name in ("az", "q")}, "label": "a text"}
    rest = {name: COLUMNS[name] for name in ("t", "theta", "V")}
    scipy.io.savemat(path, {"flight": flight, **rest, "cell": np.array([1, "x"], dtype=object)})
    channels = {**NAMED, "az": ("flight.imu.az", "m/s2"), "q": ("flight.imu.q", "deg/s")}
    same(read_flight(path, channels))
    inside = {**NAMED, "az": ("az", "m/s2"), "q": ("q", "deg/s")}
    same(read_flight(path, inside, variable="flight.imu"))  # the others by their whole names
    assert set(codes(refused(path, inside, variable="flight.mui"))) == {"missing_channel"}


def test_matlab_5_compressed_and_cut_tail(tmp_path: Path) -> None:
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"data": TABLE, "other": np.eye(3)}, do_compression=True)
    size = path.stat().st_size
    flight = read_flight(path, NUMBERED, variable="data")
    same(flight)
    assert flight.files[0].unknown == 0
    assert 128 < flight.files[0].skipped < size - flight.files[0].decoded + 1
    assert flight.files[0].decoded < TABLE.nbytes  # as stored, compressed


def test_hdf5_groups(tmp_path: Path) -> None:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name, values in COLUMNS.items():
            file[f"flight/{name}"] = values
        file["note"] = "text"
    same(read_flight(path, variable="flight"))
    by_path = {name: (f"flight/{name}", unit) for name, unit in zip(NAMES, UNITS, strict=True)}
    same(read_flight(path, by_path))


def test_parquet(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    columns = dict(COLUMNS)
    columns["mode"] = np.array(["auto"] * len(TABLE))
    pq.write_table(pa.table(columns), path)
    flight = read_flight(path)
    same(flight)
    assert codes(refused(path, {**NAMED, "alpha": ("mode", "rad")})) == ["not_numeric"]


def test_parquet_with_units_and_missing_values(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    speed = pa.array([None if k % 50 == 0 else v for k, v in enumerate(COLUMNS["V"])])
    columns = {"t": COLUMNS["t"], "V [kt]": speed}
    pq.write_table(pa.table(columns), path)
    flight = read_flight(path, {"t": ("t", "s"), "V": {"from": "V"}})
    assert np.isnan(flight["V"].values).sum() == len(TABLE) // 50
    np.testing.assert_allclose(flight["V"].values[1], COLUMNS["V"][1] * 1852 / 3600, rtol=1e-15)


def test_content_decides_over_extension(tmp_path: Path) -> None:
    path = tmp_path / "log.mat"
    with path.open("wb") as file:
        np.savez(file, **COLUMNS)
    flight = read_flight(path)
    same(flight)
    assert codes(flight)[0] == "wrong_type"
    assert codes(refused(path, format="mat")) == ["wrong_type"]
