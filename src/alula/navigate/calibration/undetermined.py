"""A calibration that the recording does not give: no values, and why."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse
from alula.navigate.calibration.linear_sensor import LinearSensor
from alula.navigate.calibration.result import Errors, Parameter, SensorCalibration, length_errors


def undetermined(
    name: str,
    sensor: LinearSensor,
    raw: Array,
    length: Array,
    said: Sequence[Message],
    where: str,
    planar: bool,
) -> SensorCalibration:
    """All parameters 'not_identifiable' if the readings lie in one plane.

    Raises BadInput if they do not: then they lie on no ellipsoid, and something else is wrong.
    """
    if not planar:
        raise refuse(
            "not_an_ellipsoid",
            where=where,
            expected="readings on an ellipsoid: one true length, turned in all directions",
            found="a quadric that fits best but is no ellipsoid",
            do="Turn the sensor through all directions, away from iron and magnets, at rest for "
            "an accelerometer; check the axes' order and units.",
        )
    nan = float("nan")
    names = sensor.names()
    parameters = tuple(
        Parameter(n, nan, float("inf"), (nan, nan), "", "not_identifiable") for n in names
    )
    return SensorCalibration(
        name, frozen(np.full((3, 3), nan)), frozen(np.full(3, nan)), parameters,
        frozen(np.full((len(names), len(names)), nan)), length_errors(raw, length),
        Errors(nan, nan), frozen(raw), frozen(np.full(raw.shape, nan)), frozen(length),
        messages=tuple(said),
    )  # fmt: skip
