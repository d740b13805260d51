"""What coloured innovations add to a filter's error bars.

A filter takes its innovations for white. Where they are not, because the sensors' errors are not
noise but a slow wandering, the constants are less certain than it says. To first order the
innovations are linear in the constants, so the constants are their least-squares estimate, and its
covariance with coloured residuals is that of any other (alula.base.coloured; prediction-error
methods: Ljung 1999, Sec. 9.4). The sensitivities come from filters run beside the estimate.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from alula.base.arrays import Array
from alula.base.coloured import coloured_covariance
from alula.reconstruct.tempering import Start

BESIDE = 0.5  # standard errors: small against nonlinearity, large against rounding
HELD = 1e-4  # standard errors: what a constant that is held may still give way
WHITE = 4.0  # of the deviation 1/sqrt(n) of a lag-one autocorrelation of white noise


def white(normalized: Sequence[Array]) -> bool:
    """Whether no sensor's innovations (n, sensors), by record, are correlated from one to the next.

    NaN where there was no reading.
    """
    for column in range(normalized[0].shape[1]):
        product, power, count = 0.0, 0.0, 0
        for record in normalized:
            e = record[:, column]
            e = e[np.isfinite(e)]
            product += float(e[1:] @ e[:-1])
            power += float(e @ e)
            count += len(e)
        if count > 2 and abs(product) * np.sqrt(count) > WHITE * power:
            return False
    return True


def lift(
    innovations: Callable[[Start], Sequence[Array]],
    found: Array,
    se: Array,
    prior: Array,
    free: Sequence[int],
) -> Array:
    """Factors (constants,), at least 1, on the standard errors of the constants.

    innovations(start): normalized, by record (n, sensors), of a filter started so. found, se,
    prior: (constants,) estimate, its standard error and that before the data. free: the constants
    that count as constant; those that walk keep their error bars.
    """
    out = np.ones(len(found))
    if not len(free):
        return out
    columns = []
    for j in free:
        shift = np.zeros(len(found))
        shift[j] = BESIDE * se[j]
        up, down = (innovations(Start(found + s, HELD * se)) for s in (shift, -shift))
        columns.append([(b - a) / (2.0 * BESIDE) for a, b in zip(up, down, strict=True)])
    at = innovations(Start(found, HELD * se))
    blocks = []
    for k, residual in enumerate(at):
        X = np.stack([c[k] for c in columns], axis=2)  # in standard errors
        for i in range(residual.shape[1]):
            valid = np.isfinite(residual[:, i])
            regressors = np.where(valid[:, None], X[:, i, :], 0.0)
            blocks.append((regressors, np.where(valid, residual[:, i], 0.0)))
    information = sum((x.T @ x for x, _ in blocks), np.zeros((len(free), len(free))))
    index = list(free)
    dispersion = np.linalg.inv(information + np.diag((se[index] / prior[index]) ** 2))
    coloured = coloured_covariance(blocks, dispersion).corrected
    ratio = np.diagonal(coloured) / np.diagonal(dispersion)
    out[index] = np.sqrt(np.maximum(ratio, 1.0))
    return out
