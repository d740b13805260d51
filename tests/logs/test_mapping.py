"""Channels from columns: sums, tables, signs, delays, constants, times of their own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.logs import read
from logs.made import (
    NAMED,
    codes,
    flight_table,
    log,
    read_flight,
    refused,
    specs,
    write_csv,
)

TABLE = flight_table()
T = TABLE[:, 0]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return write_csv(tmp_path)


def mapped(path: Path, **entry: object):
    return read_flight(path, {"t": ("t", "s"), "x": entry})["x"]


def test_scale_and_offset_are_in_the_source_s_unit(path: Path) -> None:
    """value_SI = unit(sign (scale x + offset)): 2 deg offset, doubled, turned."""
    channel = mapped(path, **{"from": "theta", "unit": "deg", "scale": 2, "offset": 1, "sign": -1})
    np.testing.assert_allclose(channel.values, np.radians(-(2 * TABLE[:, 3] + 1)), rtol=1e-14)
    assert "'theta' in deg, times 2, plus 1, sign turned" in channel.source


def test_temperature_offset_comes_after_the_sign(path: Path) -> None:
    channel = mapped(path, **{"from": "theta", "unit": "degC", "sign": -1})
    np.testing.assert_allclose(channel.values, 273.15 - TABLE[:, 3], rtol=1e-15)


def test_weighted_sum(path: Path) -> None:
    channel = mapped(path, **{"from": ["theta", 5], "weights": [0.5, -0.25], "unit": "1"})
    np.testing.assert_allclose(channel.values, 0.5 * TABLE[:, 3] - 0.25 * TABLE[:, 4], rtol=1e-14)


def test_delay_moves_the_stamps(path: Path) -> None:
    channel = mapped(path, **{"from": "V", "unit": "m/s", "delay_s": 0.05})
    np.testing.assert_allclose(channel.t, T - 0.05, atol=1e-15)
    np.testing.assert_array_equal(channel.values, TABLE[:, 4])


def test_calibration_table(path: Path) -> None:
    """49.8 to 50.2 of the 49.7 to 50.3 are in the table; the rest is NaN and said."""
    table = [[49.8, 10.0], [50.0, 20.0], [50.2, 40.0]]
    entry = {"from": "V", "unit": "m/s", "table": table}
    flight = read_flight(path, {"t": ("t", "s"), "x": entry})
    speed = TABLE[:, 4]
    low, high = (speed >= 49.8) & (speed <= 50), (speed > 50) & (speed <= 50.2)
    values = flight["x"].values
    np.testing.assert_allclose(values[low], 10 + 50 * (speed[low] - 49.8), rtol=1e-9)
    np.testing.assert_allclose(values[high], 20 + 100 * (speed[high] - 50), rtol=1e-9)
    assert np.isnan(values[~low & ~high]).all()
    assert (~low & ~high).sum() > 0
    assert "outside_table" in codes(flight)


def test_constant(path: Path) -> None:
    channel = mapped(path, constant=10, unit="deg")
    np.testing.assert_allclose(channel.values, np.radians([10, 10]))
    np.testing.assert_array_equal(channel.t, [T[0], T[-1]])


def test_times_of_their_own(tmp_path: Path) -> None:
    path = tmp_path / "log.npz"
    slow = np.arange(0.0, 8.0, 0.2)
    np.savez(path, t=T, V=TABLE[:, 4], t_gps_ms=1e3 * slow, h=100 + slow)
    h = {"from": "h", "unit": "m", "time": {"from": "t_gps_ms", "unit": "ms"}}
    flight = read_flight(path, {"t": ("t", "s"), "V": ("V", "m/s"), "h_gps": h})
    np.testing.assert_allclose(flight["h_gps"].t, slow, rtol=1e-15)
    named = {"t": ("t", "s"), "tg": ("t_gps_ms", "ms"), "V": ("V", "m/s")}
    named["h_gps"] = {"from": "h", "unit": "m", "time": "tg"}
    flight = read_flight(path, named)
    np.testing.assert_allclose(flight["h_gps"].t, slow, rtol=1e-15)
    assert flight["V"].rate == pytest.approx(50.0)
    assert set(flight.channels) == {"V", "h_gps"}
    assert codes(refused(path, {"t": ("t", "s"), "h": ("h", "m")})) == ["length_mismatch"]


def test_held_values_are_said_and_dropped_on_request(tmp_path: Path) -> None:
    table = TABLE.copy()
    table[:, 4] = np.repeat(TABLE[::5, 4], 5)
    path = write_csv(tmp_path, table)
    flight = read_flight(path)
    (message,) = [m for m in flight.messages if m.code == "held_values"]
    assert "every 5 samples" in message.found
    assert len(flight["V"].t) == len(T)
    channel = mapped(path, **{"from": "V", "unit": "m/s", "repeats": "drop"})
    np.testing.assert_array_equal(channel.t, T[::5])
    np.testing.assert_array_equal(channel.values, TABLE[::5, 4])


def test_log_s_own_channels_take_precedence(path: Path) -> None:
    own = log(path, channels={"V": {"from": "V", "unit": "kt"}})
    flight = read(own, specs(**NAMED))
    np.testing.assert_allclose(flight["V"].values, TABLE[:, 4] * 1852 / 3600, rtol=1e-15)


def test_every_conversion_is_said(path: Path) -> None:
    flight = read_flight(path)
    said = {m.where.rsplit(" ", 1)[-1] for m in flight.messages if m.code == "converted"}
    assert said == {"q", "theta"}  # the others are SI in the file


def test_arrays_cannot_be_written_to(path: Path) -> None:
    channel = read_flight(path)["V"]
    with pytest.raises(ValueError, match="read-only"):
        channel.values[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        channel.t[0] = 1.0


def test_the_log_is_not_touched(path: Path) -> None:
    before = (path.read_bytes(), path.stat().st_mtime_ns)
    path.chmod(0o400)
    read_flight(path)
    assert (path.read_bytes(), path.stat().st_mtime_ns) == before
