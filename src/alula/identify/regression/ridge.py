"""Ridge regression (Hoerl and Kennard, Technometrics 12, 1970).

A multiple k of the unit matrix is added to the correlation matrix of the regressors, so that small
singular values no longer blow up noise: factors s^2/(s^2 + k). Constant terms are not shrunk.

k is given, or chosen by Hoerl, Kennard and Baldwin (Communications in Statistics 4, 1975),
k = m s^2/(b'b) with the ordinary estimates b of the m scaled parameters and their residual variance
s^2, or by generalized cross-validation (Golub, Heath and Wahba, Technometrics 21, 1979). Both take
residuals as white; in coloured ones they shrink too little rather than too much.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.regression.regress import Regression, solve_again
from alula.identify.regression.shrinkage import Components, Flags, Shrunk, components

Choice = Literal["hkb", "gcv"]


@dataclass(frozen=True)
class RidgeFactors:
    """s^2/(s^2 + k)."""

    k: float

    def __call__(self, singular: Array) -> Array:
        """Factors (m,) of singular values (m,)."""
        out: Array = singular**2 / (singular**2 + self.k)
        return out


def ridge(ordinary: Regression, free: Flags, k: float | Choice = "hkb") -> tuple[Regression, float]:
    """The ridge estimate and its k.

    ordinary: the unbiased fit of the same model. free: (p,) flags of the columns that are not
    shrunk. k: of scaled regressors, or how to choose it. Raises BadInput where k is negative.
    """
    if isinstance(k, str):
        if k not in ("hkb", "gcv"):
            raise _bad(repr(k))
        chosen = _choose(ordinary, free, k)
    else:
        chosen = float(k)
    if not (np.isfinite(chosen) and chosen >= 0.0):
        raise _bad(f"{chosen:g}")
    return solve_again(ordinary, Shrunk(free, RidgeFactors(chosen))), chosen


def _choose(ordinary: Regression, free: Flags, how: Choice) -> float:
    root = np.repeat(np.sqrt(ordinary.weights), [len(b.measured) for b in ordinary.blocks])
    rows = np.vstack([b.regressors for b in ordinary.blocks]) * root[:, None]
    parts = components(rows, free)
    if not len(parts.singular):
        return 0.0
    if how == "gcv":
        measured = np.concatenate([b.measured for b in ordinary.blocks]) * root
        return _generalized_cross_validation(rows, measured, parts, free)
    scaled = ordinary.solution.value[~free] * parts.scale
    size = float(scaled @ scaled)
    return len(parts.singular) * ordinary.solution.variance / size if size > 0.0 else 0.0


def _generalized_cross_validation(
    rows: Array, measured: Array, parts: Components, free: Flags
) -> float:
    """The k of the least n |z - X b|^2 / (n - trace)^2, over sixteen decades."""
    from scipy.optimize import minimize_scalar  # slow to import, for this choice only

    n = len(measured)
    fixed = rows[:, free]
    rest = measured - fixed @ (parts.free_inverse @ (fixed.T @ measured))
    share = parts.along(rows, free).T @ rest
    left = float(rest @ rest - share @ share)

    def score(log_k: float) -> float:
        lost = 1.0 - RidgeFactors(float(np.exp(log_k)))(parts.singular)
        freedom = n - fixed.shape[1] - float(np.sum(1.0 - lost))
        return float((left + np.sum((lost * share) ** 2)) / freedom**2)

    grid = np.log(10.0) * np.linspace(-12.0, 4.0, 65)
    best = int(np.argmin([score(x) for x in grid]))
    lower, upper = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    found = minimize_scalar(score, bounds=(lower, upper), method="bounded")
    return float(np.exp(found.x))


def _bad(found: str) -> Exception:
    return refuse(
        "bad_option",
        where="ridge",
        expected="a number of 0 or more, 'hkb' or 'gcv'",
        found=found,
        do="State the ridge parameter of scaled regressors, or let it be chosen.",
    )
