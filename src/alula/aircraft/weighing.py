"""The center of gravity from three scales, level and tilted.

Source: Dittrich 2016, Eq. (4.1) to (4.3); the last with its sign corrected (see the deviations).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse


@dataclass(frozen=True)
class Weighing:
    """What the scales say: mass kg and CG (3,) m from the datum, with standard errors.

    Standard errors are from the scatter of the repetitions; NaN where there are none to spare.
    residuals: (k,) m, how far each weighing's balance point lies from the fitted CG, fore and aft.
    """

    mass: float
    mass_se: float
    cg: Array
    cg_se: Array
    residuals: Array


def center_of_gravity(
    readings: Sequence[Sequence[float]],
    pitch_deg: Sequence[float],
    supports: Sequence[Sequence[float]],
) -> Weighing:
    """Mass and center of gravity from weighings on three scales, wings level.

    readings: (k, 3) kg, rows of (front, left, right). pitch_deg: (k,) deg, nose up, 0 for the
    level ones; at least one level and one tilted. supports: (3, 3) m, rows of front, left and
    right support in body axes from the datum (x forward, y right, z down).

    A scale's force is vertical, so a support is any body-fixed point on the vertical through the
    contact: for a round wheel the axle, in every attitude; for a jack its tip.

    Each weighing's balance point fore and aft must be below the CG:
    `sum m_i X_i = m X_G` with `X = x cos(theta) + z sin(theta)`, the coordinate along the floor.
    Level this is Eq. (4.1), tilted Eq. (4.3); all are solved together by least squares, which
    weighs a tilt by its sine. Raises BadInput where the tilt does not determine the height.
    """
    scales = np.asarray(readings, dtype=np.float64)
    theta = np.radians(np.asarray(pitch_deg, dtype=np.float64))
    points = np.asarray(supports, dtype=np.float64)
    _check(scales, theta, points)
    totals = scales.sum(axis=1)
    along = np.cos(theta)[:, None] * points[:, 0] + np.sin(theta)[:, None] * points[:, 2]
    balance = np.sum(scales * along, axis=1) / totals
    A = np.column_stack([np.cos(theta), np.sin(theta)])
    xz, *_ = np.linalg.lstsq(A, balance, rcond=None)
    residuals = balance - A @ xz
    spare = len(theta) - 2
    variance = residuals @ residuals / spare if spare > 0 else np.nan
    x_se, z_se = np.sqrt(variance * np.diag(np.linalg.inv(A.T @ A)))
    y, y_se = _mean(scales @ points[:, 1] / totals)
    mass, mass_se = _mean(totals)
    return Weighing(
        mass=mass,
        mass_se=mass_se,
        cg=frozen([xz[0], y, xz[1]]),
        cg_se=frozen([x_se, y_se, z_se]),
        residuals=frozen(residuals),
    )


def _mean(values: Array) -> tuple[float, float]:
    """Mean and its standard error."""
    n = len(values)
    se = float(values.std(ddof=1) / np.sqrt(n)) if n > 1 else float("nan")
    return float(values.mean()), se


def _check(scales: Array, theta: Array, points: Array) -> None:
    k = len(theta)
    if scales.shape != (k, 3) or points.shape != (3, 3):
        raise refuse(
            "weighing_shape",
            where="weighing",
            expected="readings (k, 3), pitch_deg (k,), supports (3, 3)",
            found=f"{scales.shape}, {theta.shape}, {points.shape}",
            do="Give one row of front, left, right and one pitch angle for each weighing.",
        )
    if not (np.isfinite(scales).all() and (scales > 0.0).all() and np.isfinite(theta).all()):
        raise refuse(
            "weighing_reading",
            where="weighing",
            expected="positive readings of all three scales and finite angles",
            found=f"least reading {np.min(scales):g} kg",
            do="Leave out a weighing in which a wheel was off its scale.",
        )
    spread = float(np.degrees(np.ptp(theta)))
    if spread < 1.0:
        raise refuse(
            "weighing_tilt",
            where="weighing",
            expected="weighings at pitch angles that differ by a degree at least, better five",
            found=f"{spread:.3g} deg between the lowest and the highest",
            do="Put a block under the front wheel: without tilt the height is not determined.",
        )
