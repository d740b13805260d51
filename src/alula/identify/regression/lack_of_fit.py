"""Lack of fit against the scatter of near-repeated conditions.

Where the same condition (angle of attack, rate, controls) is met more than once, the scatter of the
measured coefficient between the encounters is pure error, which no model of these variables could
explain. The classical F test sets the model's misfit against it (Draper and Smith, Applied
Regression Analysis, 1998, section 2.1; near replicates: Daniel and Wood, 1980, section 7.5).

Flight data never repeat exactly and neighboring samples are no independent repetitions. So the
space of the variables is cut into cells; one passage of the motion through a cell counts once, by
the sample in its middle (means would differ in their variance); and passages count only if they lie
further apart than the residuals remember. Slopes within a cell are left to the model. Too few
repetitions are said, not tested.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import fdtrc

from alula.base.arrays import Array
from alula.identify.regression.regress import Regression
from alula.identify.regression.structure import orthonormal, without

WIDTHS = (0.5, 0.75, 1.0, 1.5)  # of cells, in standard deviations of the variables
REPEATS, SPARE = 5, 3  # least degrees of freedom of pure error and of lack of fit
FORGOTTEN = 0.2  # autocorrelation below which residuals count as independent


@dataclass(frozen=True)
class LackOfFit:
    """F test of misfit against pure error. NaN and the reason in `words` where it was not made."""

    f: float
    dof: tuple[int, int]
    p: float
    words: str

    @property
    def tested(self) -> bool:
        """Whether there were enough repetitions."""
        return bool(np.isfinite(self.p))


def lack_of_fit(fit: Regression, conditions: Sequence[Array]) -> LackOfFit:
    """The test for a fitted model; conditions: (n, d) variables per maneuver."""
    spread = np.sqrt(np.mean(np.vstack([(c - c.mean(axis=0)) ** 2 for c in conditions]), axis=0))
    moving = spread > 0.0
    if not moving.any():
        return LackOfFit(np.nan, (0, 0), np.nan, "lack of fit not tested: nothing varies")
    best = (0, 0)
    for width in WIDTHS:
        x, z, cells = _passages(fit, [c[:, moving] for c in conditions], width * spread[moving])
        basis = orthonormal(x)
        count = len(np.unique(cells)) if len(cells) else 0
        best = (count - basis.shape[1], len(z) - count)
        if best[1] >= REPEATS and best[0] >= SPARE:
            return _test(without(basis, z), cells, best)
    return LackOfFit(
        np.nan,
        best,
        np.nan,
        "lack of fit not tested: too few repetitions of the same condition",
    )


def _test(left: Array, cells: Array, dof: tuple[int, int]) -> LackOfFit:
    pure = sum(
        float(np.sum((v - v.mean()) ** 2)) for v in (left[cells == c] for c in np.unique(cells))
    )
    misfit = max(float(left @ left) - pure, 0.0)
    f = misfit / dof[0] / (pure / dof[1]) if pure > 0.0 else np.inf
    p = float(fdtrc(*dof, f))
    words = (
        f"the model misses something that repeats (F {f:.2g}, p {p:.2g})"
        if p < 0.05
        else f"no lack of fit beyond the scatter of repeated conditions (F {f:.2g}, p {p:.2g})"
    )
    return LackOfFit(f, dof, p, words)


def _passages(
    fit: Regression, conditions: Sequence[Array], width: Array
) -> tuple[Array, Array, Array]:
    """Regressors (m, k), measured (m,) and cell (m,) of every independent passage."""
    x, z, keys = [], [], []
    for weight, block, v, c in zip(fit.weights, fit.blocks, fit.residuals, conditions, strict=True):
        gap = _memory(v)
        place = np.floor(c / width).astype(int)
        changes = np.flatnonzero(np.any(np.diff(place, axis=0) != 0, axis=1)) + 1
        last = -gap
        for start, end in zip([0, *changes.tolist()], [*changes.tolist(), len(v)], strict=True):
            middle = (start + end) // 2
            if middle - last < gap:
                continue
            last = middle
            root = np.sqrt(weight)
            x.append(root * block.regressors[middle])
            z.append(root * float(block.measured[middle]))
            keys.append(tuple(place[middle].tolist()))
    if not keys:
        return np.zeros((0, len(fit.names))), np.zeros(0), np.zeros(0)
    cells = np.unique(np.array(keys), axis=0, return_inverse=True)[1].ravel()
    return np.array(x), np.array(z), cells.astype(float)


def _memory(residual: Array) -> int:
    """Samples after which the autocorrelation has fallen below FORGOTTEN."""
    v = residual - residual.mean()
    power = float(v @ v)
    for k in range(1, len(v) // 4):
        if v[k:] @ v[:-k] < FORGOTTEN * power:
            return k
    return max(len(v) // 4, 1)
