"""The calibration file, `alula.imu_calibration/1`: TOML that a person can read and a log can use.

calibrated = matrix (raw - offset - I current) - g_sensitivity f        (SI)
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from alula.base.arrays import Array, frozen
from alula.base.file_schema import Strict
from alula.base.messages import Message, note, refuse
from alula.base.project_messages import read_toml, validated
from alula.flight import Channel, Flight
from alula.navigate.calibration.calibrate import Calibrated
from alula.navigate.calibration.channels import channel_lines
from alula.navigate.calibration.noise import AxisNoise
from alula.navigate.calibration.result import AXES, SensorCalibration, corrected

SCHEMA = "alula.imu_calibration/1"
CHANNELS = {
    "accelerometer": ("ax", "ay", "az"),
    "gyro": ("p", "q", "r"),
    "magnetometer": ("mag_x", "mag_y", "mag_z"),
}
Row = Annotated[list[float], Field(min_length=3, max_length=3)]
Square = Annotated[list[Row], Field(min_length=3, max_length=3)]


class SensorTable(Strict):
    """One sensor."""

    unit: str
    matrix: Square
    offset: Row
    g_sensitivity: Square | None = None
    current: Row | None = None
    matrix_se: Square | None = None
    offset_se: Row | None = None
    g_sensitivity_se: Square | None = None
    current_se: Row | None = None


class NoiseTable(Strict):
    """Noise of one sensor's three axes: sqrt of the spectral density, instability, random walk."""

    unit: str
    rate_hz: float
    white_noise: Row
    white_noise_se: Row
    bias_instability: Row
    bias_instability_se: Row
    random_walk: Row
    random_walk_se: Row
    random_walk_upper95: Row


class CalibrationFile(Strict):
    """The file as it is written."""

    schema_: Literal["alula.imu_calibration/1"] = Field(alias="schema")
    name: str
    accelerometer: SensorTable | None = None
    gyro: SensorTable | None = None
    magnetometer: SensorTable | None = None
    noise: dict[str, NoiseTable] = Field(default_factory=dict)
    reconstruct: dict[str, dict[str, dict[str, float | str]]] = Field(default_factory=dict)
    channels: dict[str, dict[str, Any]] = Field(default_factory=dict)
    provenance: dict[str, str] = Field(default_factory=dict)


@dataclass(frozen=True)
class SensorCorrection:
    """matrix (3, 3), offset (3,), g_sensitivity (3, 3) s/m, current (3,) T/A."""

    matrix: Array
    offset: Array
    g_sensitivity: Array
    current: Array

    def apply(self, raw: Array, force: Array | None = None, amperes: Array | None = None) -> Array:
        """Calibrated (n, 3) of raw (n, 3), SI; see `SensorCalibration.correct`."""
        return corrected(
            raw, self.matrix, self.offset, self.g_sensitivity, self.current, force, amperes
        )


@dataclass(frozen=True)
class ImuCalibration:
    """A calibration file as it was read."""

    name: str
    sensors: Mapping[str, SensorCorrection]
    noise: Mapping[str, NoiseTable] = field(default_factory=dict)

    def apply(self, flight: Flight, current: str = "current") -> Flight:
        """The flight with its ax .. az, p .. r, mag_x .. mag_z calibrated where they are there.

        The axes of a sensor need one time base; specific force and current are interpolated to
        the gyro's and the magnetometer's. Raises BadInput where an axis is missing.
        """
        channels, said = dict(flight.channels), list(flight.messages)
        for sensor, correction in self.sensors.items():
            names = CHANNELS[sensor]
            there = [n for n in names if n in channels]
            if not there:
                continue
            raw = _together([flight[n] for n in names], f"log {flight.id}: {sensor}")
            t = flight[names[0]].t
            force = amperes = None
            if correction.g_sensitivity.any():
                force = np.column_stack(
                    [np.interp(t, (c := channels[n]).t, c.values) if n in channels else _missing(n)
                     for n in CHANNELS["accelerometer"]]
                )  # fmt: skip
            if correction.current.any() and current in channels:
                amperes = np.interp(t, channels[current].t, channels[current].values)
            values = correction.apply(raw, force, amperes)
            for k, n in enumerate(names):
                words = f"{channels[n].source}; calibrated by '{self.name}'"
                channels[n] = replace(channels[n], values=frozen(values[:, k]), source=words)
            said.append(
                note(
                    "calibrated",
                    where=f"log {flight.id}: {sensor}",
                    expected="readings as recorded",
                    found=", ".join(names),
                    do=f"Matrix and offset of '{self.name}' were applied.",
                )
            )
        return replace(flight, channels=channels, messages=tuple(said))


def load_imu_calibration(path: Path | str) -> ImuCalibration:
    """Read a calibration file; raises BadInput naming file, key, expected and found."""
    path = Path(path)
    text, tree, _ = read_toml(path)
    file = validated(CalibrationFile, tree, path, text)
    sensors = {}
    for name in CHANNELS:
        table: SensorTable | None = getattr(file, name)
        if table is not None:
            sensors[name] = SensorCorrection(
                frozen(table.matrix), frozen(table.offset),
                frozen(np.zeros((3, 3)) if table.g_sensitivity is None else table.g_sensitivity),
                frozen(np.zeros(3) if table.current is None else table.current),
            )  # fmt: skip
    return ImuCalibration(file.name, sensors, file.noise)


def calibration_text(found: Calibrated, provenance: Mapping[str, str] | None = None) -> str:
    """The file's text. A sensor whose parameters are not all determined is left out."""
    lines = [
        "# Written by `alula calibrate`. SI units;",
        "# calibrated = matrix (raw - offset - I current) - g_sensitivity f",
        f'schema = "{SCHEMA}"',
        f"name = {json.dumps(found.project.name)}",
    ]
    for name, sensor in found.sensors.items():
        if sensor.determined:
            lines += ["", f"[{name}]", *_sensor(sensor)]
    for name, axes in found.noise.items():
        lines += ["", f"[noise.{name}]", *_noise(axes)]
    lines += _reconstruct(found.noise)
    lines += channel_lines(found)
    lines += ["", "[provenance]", f'project_sha256 = "{found.project.sha256}"']
    lines += [f'"{Path(f.path).name}" = "{f.sha256}"' for f in found.files]
    lines += [f"{k} = {json.dumps(v)}" for k, v in (provenance or {}).items()]
    return "\n".join(lines) + "\n"


def _sensor(sensor: SensorCalibration) -> list[str]:
    se = {p.name: p.se for p in sensor.parameters}
    square = [[se[f"C_{i}{j}"] for j in AXES] for i in AXES]
    lines = [
        f'unit = "{sensor.unit}"',
        f"matrix = {_numbers(sensor.matrix)}",
        f"matrix_se = {_numbers(square)}",
        f"offset = {_numbers(sensor.offset)}",
        f"offset_se = {_numbers([se[f'offset_{i}'] for i in AXES])}",
    ]
    if any(n.startswith("G_") for n in se):
        names = [[f"G_{i}{j}" for j in AXES] for i in AXES]
        if "G_x" in se:
            names = [[f"G_{i}" if i == j else "" for j in AXES] for i in AXES]
        error = [[se.get(n, 0.0) for n in row] for row in names]
        lines.append(f"g_sensitivity = {_numbers(sensor.g_sensitivity)}  # rad/s per m/s2")
        lines.append(f"g_sensitivity_se = {_numbers(error)}")
    if "current_x" in se:
        lines.append(f"current = {_numbers(sensor.current)}  # T/A")
        lines.append(f"current_se = {_numbers([se[f'current_{i}'] for i in AXES])}")
    return lines


def _noise(axes: tuple[AxisNoise, ...]) -> list[str]:
    lines = [f'unit = "{axes[0]["bias_instability"].unit}"', f"rate_hz = {axes[0].rate!r}"]
    for name, words in (
        ("white_noise", "unit/sqrt(Hz)"), ("bias_instability", "unit"),
        ("random_walk", "unit/s/sqrt(Hz)"),
    ):  # fmt: skip
        lines.append(f"{name} = {_numbers([a[name].value for a in axes])}  # {words}")
        lines.append(f"{name}_se = {_numbers([a[name].se for a in axes])}")
    lines.append(f"random_walk_upper95 = {_numbers([a.upper[2] for a in axes])}")
    return lines


def _reconstruct(noise: Mapping[str, tuple[AxisNoise, ...]]) -> list[str]:
    """The same as a project's [reconstruct] takes it, to be copied there."""
    imu, unknowns = [], []
    for name in ("accelerometer", "gyro"):
        for channel, axis in zip(CHANNELS[name], noise.get(name, ()), strict=False):
            unit = axis["bias_instability"].unit
            imu.append(f'{channel} = {{sigma = {axis.sigma!r}, unit = "{unit}"}}')
            walk = axis["random_walk"]
            if walk.verdict == "ok":
                unknowns.append(
                    f'b_{channel} = {{state = "walk", walk = {walk.value!r}, unit = "{unit}"}}'
                )
    if not imu:
        return []
    rate = next(iter(noise.values()))[0].rate
    lines = ["", f"[reconstruct.imu]  # white noise per sample at {rate:.6g} Hz", *imu]
    return lines + (["", "[reconstruct.unknowns]", *unknowns] if unknowns else [])


def _numbers(values: object) -> str:
    return json.dumps(np.asarray(values, dtype=np.float64).tolist())


def _together(channels: list[Channel], where: str) -> Array:
    if any(not np.array_equal(c.t, channels[0].t) for c in channels):
        raise refuse(
            "different_times",
            where=where,
            expected="three axes with the same time stamps",
            found=", ".join(f"{c.name}: {len(c.t)} samples" for c in channels),
            do="Give the three axes one time base.",
        )
    return np.column_stack([c.values for c in channels])


def _missing(name: str) -> Array:
    raise refuse(
        "missing_channel",
        where="gyro",
        expected=f"'{name}', for the gyro's g-sensitivity",
        found="none",
        do="Map the accelerometer as well.",
    )


def not_written(found: Calibrated) -> list[Message]:
    """A note for each sensor that the file leaves out."""
    return [
        note(
            "sensor_left_out",
            where=name,
            expected="parameters that the data determine",
            found=", ".join(p.name for p in s.parameters if p.verdict == "not_identifiable"),
            do="The calibration file has no entry for it.",
        )
        for name, s in found.sensors.items()
        if not s.determined
    ]
