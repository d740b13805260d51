"""A calibration project from its files to what `alula calibrate` writes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse
from alula.base.units import G0, to_si
from alula.flight import SourceFile
from alula.navigate.calibration.accelerometer import calibrate_accelerometer
from alula.navigate.calibration.columns import Columns
from alula.navigate.calibration.current import current_field
from alula.navigate.calibration.gyro import calibrate_gyro
from alula.navigate.calibration.magnetometer import calibrate_magnetometer
from alula.navigate.calibration.noise import AxisNoise, axis_noise
from alula.navigate.calibration.project import (
    AccelerometerSpec,
    CalibrationProject,
    GyroSpec,
    MagnetometerSpec,
    StillSpec,
    load_calibration_project,
)
from alula.navigate.calibration.result import AXES, UNITS, SensorCalibration
from alula.navigate.calibration.samples import usable
from alula.navigate.calibration.stillness import still_parts
from alula.navigate.calibration.turns import Turn, turns_of


@dataclass(frozen=True)
class Calibrated:
    """All sensors of a project. noise: of each sensor, its three axes."""

    project: CalibrationProject
    sensors: Mapping[str, SensorCalibration] = field(default_factory=dict)
    noise: Mapping[str, tuple[AxisNoise, ...]] = field(default_factory=dict)
    files: tuple[SourceFile, ...] = ()
    messages: tuple[Message, ...] = ()

    @property
    def determined(self) -> bool:
        """Whether every parameter of every sensor is."""
        return all(s.determined for s in self.sensors.values())


def calibrate(path: Path | str, progress: Callable[[str], None] = lambda text: None) -> Calibrated:
    """Calibrate the sensors that a project names; raises BadInput for what cannot be used."""
    project = load_calibration_project(path)
    columns = Columns(project.logs)
    sensors: dict[str, SensorCalibration] = {}
    said: list[Message] = []
    if project.accelerometer is not None:
        progress("accelerometer")
        sensors["accelerometer"] = _accelerometer(project.accelerometer, columns, said)
    if project.gyro is not None:
        progress("gyro")
        sensors["gyro"] = _gyro(project.gyro, columns, sensors.get("accelerometer"), said)
    if project.magnetometer is not None:
        progress("magnetometer")
        sensors["magnetometer"] = _magnetometer(project.magnetometer, columns)
    noise: dict[str, tuple[AxisNoise, ...]] = {}
    for k, still in enumerate(project.still):
        progress(f"noise of the {still.sensor}")
        noise[still.sensor] = _noise(still, columns, f"still[{k + 1}]")
    said = [*columns.messages, *said]
    for sensor in sensors.values():
        said += sensor.messages
    for axes in noise.values():
        said += [m for axis in axes for m in axis.messages]
    unique = tuple(dict.fromkeys(said))
    return Calibrated(project, sensors, noise, columns.files(), unique)


def _accelerometer(
    spec: AccelerometerSpec, columns: Columns, said: list[Message]
) -> SensorCalibration:
    where = "accelerometer"
    gravity = spec.gravity
    if gravity is None:
        gravity = G0
        said.append(
            note(
                "standard_gravity",
                where=f"{where}.gravity",
                expected="the local gravity, which differs by up to 0.3 %",
                found="none",
                do=f"{G0} m/s2 was taken; scale factors are relative to it.",
            )
        )
    source = spec.positions or spec.recording
    assert source is not None
    limit = None
    if source.limit is not None:
        limit = source.limit * columns.unit(source, "m/s2", where).scale
    if spec.recording is not None:
        t, f = columns.recording(spec.recording, "m/s2", f"{where}.recording")
        good, more = usable(f, f"{where}.recording", limit)
        said += more
        windows = spec.recording.windows
        found = (
            still_parts(t[good], f[good], spec.recording.least_s)
            if windows is None
            else [(w[0], w[1]) for w in windows]
        )
        positions = _means(t[good], f[good], found, where)
        said.append(
            note(
                "positions_found",
                where=f"{where}.recording",
                expected="rests",
                found=f"{len(found)} positions: "
                + ", ".join(f"{a:.1f} to {b:.1f} s" for a, b in found),
                do="The mean of each was taken.",
            )
        )
    else:
        positions = columns.vectors(source, "m/s2", f"{where}.positions")
    directions: Array | str | None
    if isinstance(spec.directions, list):
        directions = np.array(spec.directions)
    else:
        directions = None if spec.directions == "none" else spec.directions
    return calibrate_accelerometer(positions, gravity, directions, limit=limit)


def _means(t: Array, f: Array, windows: list[tuple[float, float]], where: str) -> Array:
    out = np.full((len(windows), 3), np.nan)
    for k, (start, end) in enumerate(windows):
        inside = (t >= start) & (t <= end)
        if not inside.any():
            raise refuse(
                "bad_window",
                where=f"{where}.recording.windows[{k + 1}]",
                expected="a window with samples",
                found=f"none from {start:g} to {end:g} s",
                do="Correct it.",
            )
        out[k] = f[inside].mean(axis=0)
    return out


def _gyro(
    spec: GyroSpec, columns: Columns, accelerometer: SensorCalibration | None, said: list[Message]
) -> SensorCalibration:
    t, rate = columns.recording(spec.recording, "rad/s", "gyro.recording")
    force, coupling = None, spec.g_sensitivity
    if spec.force is not None:
        at = spec.recording.model_dump(by_alias=True, include={"time", "time_unit", "start", "end"})
        columns_of = spec.force.model_dump(by_alias=True)
        _, raw = columns.recording(type(spec.recording)(**columns_of, **at), "m/s2", "gyro.force")
        if accelerometer is None or not accelerometer.determined:
            force = raw
            said.append(
                note(
                    "force_not_calibrated",
                    where="gyro.force",
                    expected="an accelerometer calibrated in the same project (Eq. 3.21)",
                    found="none",
                    do="Its readings were taken as they are.",
                )
            )
        else:
            force = accelerometer.correct(raw)
    elif coupling != "none":
        raise refuse(
            "missing_force",
            where="gyro.force",
            expected="the accelerometer's columns, for the g-sensitivity",
            found="none",
            do="Add [gyro.force], or set g_sensitivity = 'none'.",
        )
    windows = [
        Turn(
            w.start, w.end, float(np.radians(w.angle_deg)),
            None if w.axis is None else (w.axis[0], w.axis[1], w.axis[2]),
        )
        for w in spec.turns
    ]  # fmt: skip
    turns, more = turns_of(t, rate, force, windows)
    said += more
    return calibrate_gyro(turns, coupling)


def _magnetometer(spec: MagnetometerSpec, columns: Columns) -> SensorCalibration:
    where = "magnetometer"
    unit = to_si(spec.field_unit, where=f"{where}.field_unit")
    if unit.si != "T":
        raise refuse(
            "wrong_unit",
            where=f"{where}.field_unit",
            expected="a unit that converts to T",
            found=f"'{spec.field_unit}'",
            do="Correct it.",
        )
    readings = columns.vectors(spec.readings, "T", f"{where}.readings")
    level = [columns.vectors(s, "T", f"{where}.level[{k + 1}]") for k, s in enumerate(spec.level)]
    means = np.array([v.mean(axis=0) for v in level]).reshape(-1, 3)
    heading = np.radians([s.heading_deg for s in spec.level])
    amperes = np.array([s.amperes for s in spec.level])
    current = None
    if np.any(amperes != 0.0):
        standing = np.unique(np.round(heading, 9), return_inverse=True)[1]
        current = current_field(means, amperes, standing.astype(np.int64))
    quiet = amperes == 0.0
    limit = spec.readings.limit
    if limit is not None:
        limit *= columns.unit(spec.readings, "T", where).scale
    return calibrate_magnetometer(
        readings, np.asarray(spec.field) * unit.scale,
        means[quiet] if quiet.any() else None, list(heading[quiet]),
        current=current, limit=limit,
    )  # fmt: skip


def _noise(spec: StillSpec, columns: Columns, where: str) -> tuple[AxisNoise, ...]:
    si = UNITS[spec.sensor]
    t, y = columns.recording(spec, si, where)
    dt = np.diff(t)
    if dt.max() > 1.5 * np.median(dt):
        raise refuse(
            "gaps",
            where=where,
            expected=f"a sample every {np.median(dt):.4g} s: averages have no holes",
            found=f"{int((dt > 1.5 * np.median(dt)).sum())} gaps, the longest {dt.max():.4g} s",
            do="State 'start' and 'end' of a part without gaps.",
        )
    rate = float((len(t) - 1) / (t[-1] - t[0]))
    return tuple(
        axis_noise(y[:, k], rate, si, name=f"{axis}_", where=f"{where}: {axis}")
        for k, axis in enumerate(AXES)
    )
