"""A calibration as lines of a project's [channels]: weighted sums of the raw columns.

`value = unit (sum_k weight_k column_k + offset)` is what every log's mapping does already, so that
a calibrated channel needs nothing else than these lines.
"""

from __future__ import annotations

import json

import numpy as np

from alula.base.arrays import Array
from alula.base.units import to_si
from alula.navigate.calibration.calibrate import Calibrated
from alula.navigate.calibration.project import VectorsSpec
from alula.navigate.calibration.result import SensorCalibration

NAMES = {
    "accelerometer": ("ax", "ay", "az"),
    "gyro": ("p", "q", "r"),
    "magnetometer": ("mag_x", "mag_y", "mag_z"),
}


def channel_lines(found: Calibrated) -> list[str]:
    """The lines, for sensors whose raw columns are named one by one and state their unit.

    A magnetometer's lines leave out the motor current, which a log may not have.
    """
    specs = _specs(found)
    lines = []
    for name, spec in specs.items():
        sensor = found.sensors.get(name)
        if sensor is None or not sensor.determined or not isinstance(spec.source, list):
            continue
        if spec.unit is None:
            continue
        scale = to_si(spec.unit).scale
        sources, weights = list(spec.source), sensor.matrix * np.array(spec.signs)
        constant = -sensor.matrix @ sensor.offset / scale
        if sensor.g_sensitivity.any():
            more = _force(found, sensor, scale)
            if more is None:
                continue
            sources += more[0]
            weights = np.hstack([weights, more[1]])
            constant = constant + more[2]
        for k, channel in enumerate(NAMES[name]):
            lines.append(
                f"{channel} = {{from = {json.dumps(sources)}, "
                f"weights = {json.dumps(weights[k].tolist())}, "
                f"offset = {float(constant[k])!r}, unit = {json.dumps(spec.unit)}}}"
            )
    return ["", "[channels]  # for a project whose logs have these columns", *lines] * bool(lines)


def _specs(found: Calibrated) -> dict[str, VectorsSpec]:
    project, out = found.project, {}
    if project.accelerometer is not None:
        out["accelerometer"] = project.accelerometer.positions or project.accelerometer.recording
    if project.gyro is not None:
        out["gyro"] = project.gyro.recording
    if project.magnetometer is not None:
        out["magnetometer"] = project.magnetometer.readings
    return {name: spec for name, spec in out.items() if spec is not None}


def _force(
    found: Calibrated, gyro: SensorCalibration, scale: float
) -> tuple[list[int | str], Array, Array] | None:
    """Sources, weights (3, 3) and constants (3,) by which the gyro's lines take G f away."""
    spec = found.project.gyro.force if found.project.gyro is not None else None
    if spec is None or not isinstance(spec.source, list) or spec.unit is None:
        return None
    matrix, offset = np.eye(3), np.zeros(3)
    accelerometer = found.sensors.get("accelerometer")
    if accelerometer is not None and accelerometer.determined:
        matrix, offset = accelerometer.matrix, accelerometer.offset
    coupled = gyro.g_sensitivity @ matrix
    weights = -coupled * to_si(spec.unit).scale / scale * np.array(spec.signs)
    return list(spec.source), weights, coupled @ offset / scale
