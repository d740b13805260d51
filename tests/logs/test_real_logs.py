"""Real recordings, each against an independent reading of the same file."""

from __future__ import annotations

import h5py
import numpy as np
import scipy.io

from alula.base.units import FT, KT
from data import data
from logs.made import codes, read_flight

DEG = np.pi / 180


def test_attas_matlab_5() -> None:
    path = data("attas", "fAttasElv1.mat")
    flight = read_flight(
        path,
        {
            "t": (1, "s"),
            "az": (4, "m/s2"),
            "q": (8, "deg/s"),
            "theta": (11, "deg"),
            "h": (16, "ft"),
            "da": {"from": [29, 28], "weights": [0.5, -0.5], "unit": "deg"},
        },
    )
    raw = scipy.io.loadmat(path)["fAttasElv1"]
    np.testing.assert_array_equal(flight["az"].t, raw[:, 0])
    np.testing.assert_array_equal(flight["az"].values, raw[:, 3])
    np.testing.assert_allclose(flight["q"].values, raw[:, 7] * DEG, rtol=1e-15)
    np.testing.assert_allclose(flight["h"].values, raw[:, 15] * FT, rtol=1e-15)
    da = DEG * 0.5 * (raw[:, 28] - raw[:, 27])
    np.testing.assert_allclose(flight["da"].values, da, rtol=1e-12, atol=1e-17)
    # one matrix in the file: all but the 128 bytes of the header are its element
    assert (flight.files[0].decoded, flight.files[0].skipped) == (path.stat().st_size - 128, 128)
    assert not [m for m in flight.messages if m.level != "info"]


def test_armhawk_matlab_73() -> None:
    path = data("armhawk", "flight", "state.mat")
    flight = read_flight(
        path,
        {
            "t": (1, "s"),
            "phi": {"from": "state", "column": 5, "unit": "rad"},
            "V": ("state[10]", "m/s"),
        },
    )
    with h5py.File(path) as file:
        raw = file["state"][()]
        stored = file["state"].id.get_storage_size()
    np.testing.assert_array_equal(flight["phi"].values, raw[:, 4])
    np.testing.assert_array_equal(flight["V"].values, raw[:, 9])
    assert flight.files[0].decoded == stored >= raw.nbytes  # whole chunks, not compressed


def test_armhawk_rows_as_channels() -> None:
    path = data("armhawk", "flight", "v_rel_V.mat")
    flight = read_flight(path, {"t": (1, "s"), "u": (2, "m/s"), "w": (4, "m/s")})
    raw = scipy.io.loadmat(path)["v_rel_V"]
    np.testing.assert_array_equal(flight["w"].values, raw[3])
    assert "turned" in codes(flight)


def test_citation_npz() -> None:
    path = data("citation_ph_lab", "flight.npz")
    channels = {"t": ("time", "s"), "q": ("Ahrs1_bPitchRate", "deg/s"), "V": ("Dadc1_tas", "kt")}
    channels["az"] = {"from": "Ahrs1_bNormAcc", "unit": "g", "sign": -1, "offset": 1}
    flight = read_flight(path, channels)
    with np.load(path) as raw:
        np.testing.assert_allclose(flight["V"].values, raw["Dadc1_tas"] * KT, rtol=1e-15)
        az = -9.80665 * (raw["Ahrs1_bNormAcc"] + 1)
        np.testing.assert_allclose(flight["az"].values, az, rtol=1e-14)
    assert flight["V"].rate == 10.0 or abs(flight["V"].rate - 10.0) < 1e-6


def test_gravity_taken_out_is_asked_about() -> None:
    """The same channel without its 1 g: level flight reads zero."""
    from logs.made import refused

    path = data("citation_ph_lab", "flight.npz")
    error = refused(path, {"t": ("time", "s"), "az": ("Ahrs1_bNormAcc", "g")})
    assert codes(error) == ["gravity_removed"]


def test_dhc2_ascii() -> None:
    path = data("dhc2", "y13aus_da1.asc")
    flight = read_flight(path, {"t": (1, "s"), "pdot": (2, "rad/s2"), "ay": (4, "m/s2")})
    raw = np.loadtxt(path)
    np.testing.assert_array_equal(flight["pdot"].values, raw[:, 1])
    np.testing.assert_array_equal(flight["ay"].values, raw[:, 3])
    assert flight.files[0].decoded == path.stat().st_size


def test_twin_otter_one_variable_of_many() -> None:
    path = data("twin_otter", "totter_lon_020213f1_018.mat")
    flight = read_flight(
        path,
        {"t": (1, "s"), "V": (2, "ft/s"), "CZ": (63, "1"), "x_cg": (45, "in")},
        variable="fdata",
    )
    raw = scipy.io.loadmat(path)["fdata"]
    np.testing.assert_array_equal(flight["CZ"].values, raw[:, 62])
    np.testing.assert_allclose(flight["V"].values, raw[:, 1] * 0.3048, rtol=1e-15)
    # an uncompressed element: its tag, flags, dimensions and name are under 100 bytes
    assert raw.nbytes < flight.files[0].decoded < raw.nbytes + 100


def test_nesc_csv() -> None:
    path = data("nesc_6dof", "Atmos_11_TrimCheckSubsonicF16", "Atmos_11_sim_04.csv")
    flight = read_flight(
        path, {"t": ("time", "s"), "h": ("altitudeMsl_ft", "ft"), "lat": ("latitude_deg", "deg")}
    )
    raw = np.genfromtxt(path, delimiter=",", names=True)
    np.testing.assert_allclose(flight["h"].values, raw["altitudeMsl_ft"] * FT, rtol=1e-15)
    np.testing.assert_allclose(flight["lat"].values, raw["latitude_deg"] * DEG, rtol=1e-15)
