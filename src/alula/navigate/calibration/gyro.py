"""Gyro from turns: w = C (w_gyro - w_0) - G f, with sensitivity to specific force.

Pusztai 2018, Eq. (3.21), (3.22): integrated over a turn of known angle about a fixed axis,

    angle u = C (int w_gyro dt - w_0 T) - G int f dt.

The angle is known well, the axis u as well as it was set by hand, or not at all; rest is a turn by
no angle. f is the calibrated specific force: the accelerometer comes first. Eq. (3.22) prints
G f T, which is the same where the axis is vertical; the integral holds for any axis.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import note, refuse
from alula.navigate.calibration.accelerometer import fit_messages, planar_message
from alula.navigate.calibration.ellipsoid import PLANAR
from alula.navigate.calibration.linear_sensor import Coupling, LinearSensor, linear_sensor
from alula.navigate.calibration.result import SensorCalibration, length_errors
from alula.navigate.calibration.vector_fit import fit_vectors

LEAST_TURNS = 3
FURTHER = 2  # equations beyond the unknowns, to judge by


@dataclass(frozen=True)
class Turns:
    """rate: (n, 3) integral of the raw rate, rad. force: (n, 3) integral of the calibrated specific
    force, m/s. time: (n,) s. angle: (n,) rad, 0 at rest. axis: (n, 3) unit vectors in body axes
    (any at rest), or None where unknown."""

    rate: Array
    force: Array
    time: Array
    angle: Array
    axis: Array | None = None


def calibrate_gyro(
    turns: Turns, g_sensitivity: Coupling = "diagonal", *, where: str = "gyro"
) -> SensorCalibration:
    """Matrix, offset and g-sensitivity from turns and rests.

    Without axes the matrix is taken symmetric. Raises BadInput for turns that are no numbers or
    fewer than the unknowns need; turns about axes in one plane give 'not_identifiable'.
    """
    _check(turns, where)
    turned = turns.angle > 0.0
    full = turns.axis is not None
    rate = float(np.mean(turns.angle[turned] / turns.time[turned]))
    pull = float(np.mean(np.linalg.norm(turns.force, axis=1) / turns.time)) or 9.81
    measured = float(np.mean(np.linalg.norm(turns.rate[turned], axis=1) / turns.time[turned]))
    scale = rate / measured
    sensor = linear_sensor(full, g_sensitivity, scale, measured, rate / pull)
    _enough(turns, len(sensor.typical), where)
    problem = sensor.problem(
        turns.rate, turns.angle, turns.axis, time=turns.time,
        e=turns.force if g_sensitivity != "none" else None,
    )  # fmt: skip
    said = []
    axes = turns.axis if turns.axis is not None else turns.rate
    spread = np.linalg.svd(axes[turned] / np.linalg.norm(axes[turned], axis=1)[:, None])
    if spread.S[-1] < PLANAR * spread.S[0]:
        said.append(planar_message(spread.Vh[-1], "axes", where))
    fit = fit_vectors(problem, _start(turns, sensor, scale))
    parameters, covariance = sensor.parameters(fit, ("1", "rad/s", "s/m"))
    C, offset, G = sensor.unpack(fit.values)
    calibrated = (turns.rate - np.outer(turns.time, offset)) @ C.T - turns.force @ G.T
    said += fit_messages(fit, where)
    if not full:
        said.append(
            note(
                "no_alignment",
                where=where,
                expected="axes of the turns",
                found="angles only",
                do="The matrix is taken symmetric; a rotation of the sensor in its housing stays.",
            )
        )
    return SensorCalibration(
        "gyro", frozen(C), frozen(offset), parameters, frozen(covariance),
        length_errors(turns.rate, turns.angle), length_errors(calibrated, turns.angle),
        frozen(turns.rate), frozen(calibrated), frozen(turns.angle), fit.along, fit.across,
        g_sensitivity=frozen(G), messages=tuple(said),
    )  # fmt: skip


def _start(turns: Turns, sensor: LinearSensor, scale: float) -> Array:
    """(P,) linear least squares where the axes are known, else the mean scale and no more."""
    if turns.axis is not None:
        problem = sensor.problem(turns.rate, turns.angle, None, time=turns.time, e=turns.force)
        rows = problem.jacobian.reshape(-1, len(sensor.typical)) * sensor.typical
        wanted = (turns.angle[:, None] * turns.axis).ravel()
        found = np.linalg.lstsq(rows, wanted, rcond=1e-10)[0]
        return np.asarray(found * sensor.typical, dtype=np.float64)
    start = np.zeros(len(sensor.typical))
    start[[0, 3, 5]] = scale
    rest = turns.angle == 0.0
    if rest.any():
        rates = turns.rate[rest].sum(axis=0) / turns.time[rest].sum()
        start[6:9] = scale * rates
    return start


def _check(turns: Turns, where: str) -> None:
    whole = np.column_stack([turns.rate, turns.force, turns.time, turns.angle])
    if turns.axis is not None:
        whole = np.column_stack([whole, turns.axis])
    bad = np.flatnonzero(~np.isfinite(whole).all(axis=1))
    if len(bad):
        raise refuse(
            "not_finite",
            where=f"{where}: turn {int(bad[0]) + 1}",
            expected="numbers over the whole turn",
            found=f"NaN or infinity in {len(bad)} of {len(whole)} turns",
            do="Cut the window short of the hole, or leave this turn out.",
        )
    turned = int((turns.angle > 0.0).sum())
    if turned < LEAST_TURNS:
        raise refuse(
            "too_few_turns",
            where=where,
            expected=f"{LEAST_TURNS} turns or more, about axes in all directions",
            found=str(turned),
            do="Turn by a known angle (180 deg between two stops) about further axes.",
        )
    if not np.all(np.linalg.norm(turns.rate[turns.angle > 0.0], axis=1) > 0.0):
        raise refuse(
            "dead_sensor",
            where=where,
            expected="a rate in every turn",
            found="turns in which the gyro read nothing",
            do="Check the columns, the windows and the sensor.",
        )
    if np.any(turns.time <= 0.0):
        raise refuse(
            "bad_window",
            where=where,
            expected="turns that take time",
            found=f"{float(turns.time.min()):g} s",
            do="Correct the window.",
        )


def _enough(turns: Turns, unknown: int, where: str) -> None:
    rest = int((turns.angle == 0.0).sum())
    turned = len(turns.angle) - rest
    equations = 3 * rest + (3 if turns.axis is not None else 1) * turned
    if equations < unknown + FURTHER:
        raise refuse(
            "too_few_turns",
            where=where,
            expected=f"{unknown + FURTHER} equations or more for {unknown} unknowns",
            found=f"{equations}: {turned} turns, {rest} rests",
            do="Add turns and rests, state the axes of the turns, or ask for less: "
            "g_sensitivity = 'diagonal' or 'none'.",
        )
