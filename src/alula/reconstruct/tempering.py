"""A filter run again close to its own result, with what that adds taken out again.

Upwash and wind multiply: a filter that starts far from both, under a wide prior, linearizes about
estimates that move, and counts the movement as information. An iterated smoother (Bell 1994) cures
this by one fixed line of linearization. So the unknowns start again near the last result under a
narrower prior. Information about constants is additive, so the narrow prior leaves an exact
correction: P^-1 loses its information and gets back that of the stated prior.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array

MOST_PASSES = 6
SETTLED = 0.1  # standard errors: what another pass may still move a constant
NARROW = 0.1  # standard errors of the last pass: what it adds goes, so it may be narrow


@dataclass(frozen=True)
class Start:
    """Mean and standard deviation (constants,) from which the filter starts."""

    mean: Array
    deviation: Array


def nearer(stated: Start, found: Array, se: Array, multiply: np.ndarray) -> Start:
    """The next pass's start: around what was found, never wider than stated. Constants that do not
    multiply with others keep the stated start, and so do those that walk, whose information decays.
    """
    deviation = np.minimum(NARROW * se, stated.deviation)
    return Start(
        np.where(multiply, found, stated.mean), np.where(multiply, deviation, stated.deviation)
    )


def restored(
    x: Array, covariance: Array, motion: int, used: Start, stated: Start
) -> tuple[Array, Array]:
    """States (n, k) and covariances (n, k, k) as under the stated start; constants follow motion.

    With D = stated - used information, P' = P - P_c D (I + P_cc D)^-1 P_c'.
    """
    wide, narrow = stated.deviation**-2.0, used.deviation**-2.0
    D = wide - narrow
    if not np.any(D):
        return x, covariance
    columns = covariance[:, :, motion:]
    inner = np.eye(len(D)) + covariance[:, motion:, motion:] * D
    gain = np.linalg.solve(inner.swapaxes(1, 2), (columns * D).swapaxes(1, 2)).swapaxes(1, 2)
    new = covariance - gain @ columns.swapaxes(1, 2)
    new = 0.5 * (new + new.swapaxes(1, 2))
    pull = wide * stated.mean - narrow * used.mean - D * x[:, motion:]
    return x + np.einsum("nij,nj->ni", new[:, :, motion:], pull), new
