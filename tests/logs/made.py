"""A short flight that is written in many formats, and helpers to read it back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.base.project import ChannelSpec, LogSpec
from alula.flight import Flight
from alula.logs import read

NAMES = ("t", "az", "q", "theta", "V")
UNITS = ("s", "m/s2", "deg/s", "deg", "m/s")


def flight_table(n: int = 400, dt: float = 0.02) -> np.ndarray:
    """(n, 5): t, az, q, theta, V of a gentle pitching motion; q is the derivative of theta."""
    t = np.round(np.arange(n) * dt, 6)
    theta = 3.0 + 2.0 * np.sin(2.0 * t)
    q = 4.0 * np.cos(2.0 * t)
    az = -9.81 - 0.8 * np.sin(2.0 * t)
    speed = 50.0 + 0.3 * np.sin(0.5 * t)
    return np.column_stack([t, az, q, theta, speed])


def specs(**channels: Any) -> dict[str, ChannelSpec]:
    """ChannelSpecs from (source, unit) pairs or mappings."""
    out = {}
    for name, value in channels.items():
        entry = {"from": value[0], "unit": value[1]} if isinstance(value, tuple) else value
        out[name] = ChannelSpec.model_validate(entry)
    return out


NAMED = {name: (name, unit) for name, unit in zip(NAMES, UNITS, strict=True)}
NUMBERED = {name: (k + 1, unit) for k, (name, unit) in enumerate(zip(NAMES, UNITS, strict=True))}


def log(path: Path, **options: Any) -> LogSpec:
    """A LogSpec of id 'log'."""
    return LogSpec.model_validate({"id": "log", "path": path, **options})


def read_flight(path: Path, channels: dict[str, Any] | None = None, **options: Any) -> Flight:
    """Read with every byte accounted for, which holds for every file that can be read."""
    flight = read(log(path, **options), specs(**(channels or NAMED)))
    (file,) = flight.files
    assert file.bytes == path.stat().st_size
    assert file.decoded + file.skipped + file.unknown == file.bytes
    assert min(file.decoded, file.skipped, file.unknown) >= 0
    return flight


def refused(path: Path, channels: dict[str, Any] | None = None, **options: Any) -> BadInput:
    """The refusal of a log; every message says where, expected, found and what to do."""
    with pytest.raises(BadInput) as caught:
        read(log(path, **options), specs(**(channels or NAMED)))
    for message in caught.value.messages:
        assert message.level == "error"
        assert all((message.code, message.where, message.expected, message.found, message.do))
    return caught.value


def codes(source: Flight | BadInput) -> list[str]:
    """The codes of all messages."""
    return [message.code for message in source.messages]


def csv_text(
    table: np.ndarray, names: tuple[str, ...] = NAMES, separator: str = ",", end: str = "\n"
) -> str:
    """CSV with one header line; numbers in Python's shortest exact form."""
    lines = [separator.join(names)]
    lines += [separator.join(repr(float(x)) for x in row) for row in table]
    return end.join(lines) + end


def write_csv(folder: Path, table: np.ndarray | None = None, name: str = "log.csv") -> Path:
    """A plain CSV file of the flight."""
    path = folder / name
    path.write_text(csv_text(flight_table() if table is None else table))
    return path
