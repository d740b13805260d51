"""The motor current's field in a magnetometer: B_M grows by I B_I (Pusztai 2018, Eq. (3.17)).

Readings with and without current while the aircraft stands still; each standing (heading) has a
field of its own, so that only its change with the current counts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.base.messages import refuse

LEAST = 3.0  # A, range of the current


@dataclass(frozen=True)
class CurrentField:
    """value: (3,) T/A as the sensor reads it. covariance: (3, 3). dof: of it.

    before, after: rms over the standings of |dB| and of |dB - I B_I|, T.
    """

    value: Array
    covariance: Array
    dof: float
    before: float
    after: float


def current_field(
    field: Array, current: Array, standing: NDArray[np.int64], where: str = "current"
) -> CurrentField:
    """B_I by regression within the standings. field: (n, 3) T. current: (n,) A. standing: (n,).

    Of three standings or more the standard error is that between them (they do not agree better
    than iron in the floor and the leads' bending allow), else that of the readings. Raises BadInput
    where the current does not vary.
    """
    slopes, weights, left = [], [], np.zeros((0, 3))
    change, rest = [], []
    for k in np.unique(standing):
        mine = standing == k
        x = current[mine] - current[mine].mean()
        y = field[mine] - field[mine].mean(axis=0)
        weight = float(x @ x)
        if np.ptp(current[mine]) < LEAST:
            continue
        slope = x @ y / weight
        slopes.append(slope)
        weights.append(weight)
        left = np.vstack([left, y - np.outer(x, slope)])
        change.append(np.ptp(current[mine]) * slope)
        rest.append(float(np.ptp(current[mine])))
    if not slopes or not np.all(np.isfinite(slopes)):
        raise refuse(
            "current_does_not_vary",
            where=where,
            expected=f"readings with and without current, {LEAST:g} A apart, in one standing",
            found="none" if not slopes else "readings that are no numbers",
            do="Hold the aircraft, record with the motor off and on, the propeller taken off or "
            "the aircraft tied down.",
        )
    w = np.array(weights) / sum(weights)
    table = np.array(slopes)
    value = w @ table
    if len(table) >= 3:
        away = table - value
        dof = float(len(table) - 1)
        covariance = (away.T * w**2) @ away * len(table) / dof
    else:
        dof = float(len(left) - 2 * len(table))
        spread = left.T @ left / dof if dof > 0.0 else np.full((3, 3), np.inf)
        covariance = spread / sum(weights)
    moved, stepped = np.array(change), np.array(rest)
    after = moved - np.outer(stepped, value)
    rms = [float(np.sqrt(np.mean(np.sum(v**2, axis=1)))) for v in (moved, after)]
    return CurrentField(value, covariance, dof, rms[0], rms[1])
