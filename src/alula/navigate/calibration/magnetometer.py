"""Magnetometer: B = C (B_M - B_0 - I B_I), by ellipsoid, level headings and motor current.

Pusztai 2018, Eq. (3.17) to (3.20); NXP AN4246. Turned through all directions, the readings lie on
an ellipsoid: its center is the hard iron B_0, its shape the symmetric soft-iron scale. Readings in
known attitudes turn it into body axes. The motor's current adds a field of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy import stats

from alula.base.arrays import Array, frozen
from alula.base.messages import note, refuse
from alula.navigate.calibration.accelerometer import fit_messages, planar_message
from alula.navigate.calibration.current import CurrentField
from alula.navigate.calibration.ellipsoid import PLANAR, ellipsoid, flatness
from alula.navigate.calibration.linear_sensor import linear_sensor
from alula.navigate.calibration.procrustes import align
from alula.navigate.calibration.result import (
    AXES,
    Parameter,
    SensorCalibration,
    Verdict,
    length_errors,
)
from alula.navigate.calibration.samples import usable
from alula.navigate.calibration.undetermined import undetermined
from alula.navigate.calibration.vector_fit import fit_vectors

LEAST = 50  # readings of the turned sensor; several hundred are usual
UNITS = ("1", "T", "1")


def calibrate_magnetometer(
    readings: Array,
    field: Array | float,
    level: Array | None = None,
    headings: Sequence[float] = (),
    *,
    current: CurrentField | None = None,
    limit: float | None = None,
    where: str = "magnetometer",
) -> SensorCalibration:
    """Matrix, hard iron and the current's field.

    readings: (n, 3) T, in the order of time, motor off. field: the Earth's, NED, T (3,), or its
    length. level: (k, 3) T, readings of the level aircraft at those true headings (rad); None: the
    matrix stays symmetric.

    Raises BadInput for too few readings, for readings on no ellipsoid, and for levels without a
    field vector. A recording in one plane gives 'not_identifiable'.
    """
    vector = np.atleast_1d(np.asarray(field, dtype=np.float64))
    length = float(np.linalg.norm(vector))
    if vector.size not in (1, 3) or not np.isfinite(length) or length <= 0.0:
        raise refuse(
            "bad_field",
            where=where,
            expected="the Earth's field as north, east, down, or its length, in T",
            found=str(field),
            do="Take it from the World Magnetic Model for the place and date.",
        )
    good, said = usable(readings, where, limit)
    B = readings[good]
    if len(B) < LEAST:
        raise refuse(
            "too_few_readings",
            where=where,
            expected=f"{LEAST} readings or more, turned through all directions",
            found=str(len(B)),
            do="Record longer.",
        )
    flat, normal = flatness(B)
    planar = flat < PLANAR
    if planar:
        said.append(planar_message(normal, "readings", where))
    first = None if planar else ellipsoid(B, length)
    size = float(np.sqrt(np.sum(np.var(B, axis=0))))
    sensor = linear_sensor(False, "none", length / size, size)
    lengths = np.full(len(B), length)
    if first is None:
        return undetermined("magnetometer", sensor, B, lengths, said, where, planar)
    start = np.concatenate([first[0][np.triu_indices(3)], first[0] @ first[1]])
    fit = fit_vectors(sensor.problem(B, lengths, None, ordered=True), start)
    said += fit_messages(fit, where)
    across = float("nan")
    if level is not None and len(level):
        reference = _level_field(vector, headings, level, where)
        C, offset, parameters, covariance, rotation = align(
            sensor, fit, level, reference, UNITS, where
        )
        across = rotation.sigma
    else:
        C, offset, _ = sensor.unpack(fit.values)
        parameters, covariance = sensor.parameters(fit, UNITS)
        said.append(
            note(
                "no_alignment",
                where=where,
                expected="readings of the level aircraft at known headings",
                found="none",
                do="The matrix is taken symmetric; a rotation of the sensor in the aircraft stays.",
            )
        )
    calibrated = (B - offset) @ C.T
    result = SensorCalibration(
        "magnetometer", frozen(C), frozen(offset), parameters, frozen(covariance),
        length_errors(B, lengths), length_errors(calibrated, lengths), frozen(B),
        frozen(calibrated), frozen(lengths), fit.along, across, messages=tuple(said),
    )  # fmt: skip
    return result if current is None else _with_current(result, current)


def level_field(field: Array, heading: float) -> Array:
    """(3,) the Earth's field (NED) in the axes of a level aircraft of that true heading."""
    c, s = np.cos(heading), np.sin(heading)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ field


def _level_field(vector: Array, headings: Sequence[float], level: Array, where: str) -> Array:
    finite = np.asarray(np.isfinite(level).all(axis=1))
    if vector.size != 3 or len(headings) != len(level) or not finite.all():
        raise refuse(
            "bad_level_readings",
            where=where,
            expected="a field vector (NED), and a heading for each level reading",
            found=f"{vector.size} component(s) of the field, {len(headings)} headings, "
            f"{len(level)} readings of which {int(finite.sum())} are numbers",
            do="Give the field as [north, east, down] and 'heading_deg' with each reading.",
        )
    return np.array([level_field(vector, h) for h in headings])


def _with_current(result: SensorCalibration, found: CurrentField) -> SensorCalibration:
    """The calibration with B_I beside it."""
    t = float(stats.t.ppf(0.975, found.dof)) if found.dof >= 1.0 else float("inf")
    more = []
    for k, axis in enumerate(AXES):
        value, se = float(found.value[k]), float(np.sqrt(found.covariance[k, k]))
        verdict: Verdict = "ok" if abs(value) > 2.0 * se else "weak"
        if not np.isfinite(se):
            verdict = "not_identifiable"
        interval = (value - t * se, value + t * se)
        more.append(Parameter(f"current_{axis}", value, se, interval, "T/A", verdict))
    n = len(result.parameters)
    covariance = np.zeros((n + 3, n + 3))
    covariance[:n, :n] = result.covariance
    covariance[n:, n:] = found.covariance
    said = note(
        "current_compensated",
        where="magnetometer: current",
        expected="the same field with and without current",
        found=f"a change of {1e6 * found.before:.2f} uT rms",
        do=f"{1e6 * found.after:.2f} uT rms are left after compensation.",
    )
    return replace(
        result,
        parameters=(*result.parameters, *more),
        covariance=frozen(covariance),
        current=frozen(found.value),
        messages=(*result.messages, said),
    )
