"""One linear model fitted to several maneuvers: the regression that every method here shares.

Maneuvers are weighted by the inverse of their residual variance (feasible weighted least squares,
Dittrich 2016, Eq. (3.35)), found from an unweighted fit. The ratio of variances is bounded, so that
one quiet maneuver cannot silence the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.coloured import Coloured, coloured_covariance
from alula.identify.regression.least_squares import LeastSquares, least_squares

Weighting = Literal["residual", "equal"]
# (regressors (n, k), measured (n,), weight (n,) or None) -> solution
Solver = Callable[[Array, Array, Array | None], LeastSquares]
LARGEST_RATIO = 10.0  # of the maneuvers' residual variances, as weights see them


@dataclass(frozen=True)
class Block:
    """One maneuver's share: regressors (n, k) and measured coefficient (n,).

    sharp: the regressors before any smoothing, where they passed one; noise is judged by these.
    """

    regressors: Array
    measured: Array
    sharp: Array | None = None

    @property
    def unsmoothed(self) -> Array:
        """The regressors (n, k) as noisy as they were."""
        return self.regressors if self.sharp is None else self.sharp


@dataclass(frozen=True)
class Regression:
    """A fitted linear model. weights: per block. residuals: per block, unweighted.

    ordinary: of a biased method, the unbiased fit that says what the data determine; None where
    the fit is that itself. solver: what solved it, where that was not ordinary least squares.
    """

    names: tuple[str, ...]
    blocks: tuple[Block, ...]
    weights: tuple[float, ...]
    solution: LeastSquares
    residuals: tuple[Array, ...]
    coloured: Coloured
    ordinary: Regression | None = None
    solver: Solver | None = None

    @property
    def bias(self) -> Array | None:
        """(k,) estimated bias of a biased method, None of an unbiased one.

        The bias is a known matrix times the true values; with the ordinary estimates in their
        place, which are unbiased, it is the difference of the two estimates.
        """
        if self.ordinary is None:
            return None
        return self.solution.value - self.ordinary.solution.value

    def refit(self, blocks: Sequence[Block]) -> Array:
        """The value (k,) that other data of the same shape give under the same weights.

        Combinations that this fit did not resolve stay at zero.
        """
        if self.solver is not None:
            lengths = [len(b.measured) for b in blocks]
            weight = np.repeat(np.asarray(self.weights), lengths)
            x = np.vstack([b.regressors for b in blocks])
            return self.solver(x, np.concatenate([b.measured for b in blocks]), weight).value
        scale, null = self.solution.scale, self.solution.null
        rows = _stack([b.regressors for b in blocks], self.weights) / scale
        measured = _stack([b.measured for b in blocks], self.weights)
        basis = np.linalg.svd(null, full_matrices=True)[0][:, null.shape[1] :]
        unit = np.linalg.lstsq(rows @ basis, measured, rcond=None)[0]
        value: Array = (basis @ unit) / scale
        return value


def regress(
    names: Sequence[str], blocks: Sequence[Block], weighting: Weighting = "residual"
) -> Regression:
    """Fit one model to all blocks by least squares.

    names: (k,) of the parameters. Raises BadInput where there are no more samples than parameters.
    """
    equal = (1.0,) * len(blocks)
    solution, residuals = _solve(blocks, equal)
    weights = equal
    if weighting == "residual" and len(blocks) > 1:
        weights = _weights(residuals, len(names))
        solution, residuals = _solve(blocks, weights)
    return _regression(names, blocks, weights, solution, residuals)


def solve_again(ordinary: Regression, solver: Solver) -> Regression:
    """The same data under the same weights by a biased solver."""
    solution, residuals = _solve(ordinary.blocks, ordinary.weights, solver)
    fit = _regression(ordinary.names, ordinary.blocks, ordinary.weights, solution, residuals)
    return replace(fit, ordinary=ordinary, solver=solver)


def _regression(
    names: Sequence[str],
    blocks: Sequence[Block],
    weights: tuple[float, ...],
    solution: LeastSquares,
    residuals: tuple[Array, ...],
) -> Regression:
    weighted = [
        (np.sqrt(w) * b.regressors, np.sqrt(w) * v)
        for w, b, v in zip(weights, blocks, residuals, strict=True)
    ]
    return Regression(
        names=tuple(names),
        blocks=tuple(blocks),
        weights=weights,
        solution=solution,
        residuals=residuals,
        coloured=coloured_covariance(weighted, solution.dispersion),
    )


def _solve(
    blocks: Sequence[Block], weights: Sequence[float], solver: Solver = least_squares
) -> tuple[LeastSquares, tuple[Array, ...]]:
    lengths = [len(b.measured) for b in blocks]
    solution = solver(
        np.vstack([b.regressors for b in blocks]),
        np.concatenate([b.measured for b in blocks]),
        np.repeat(np.asarray(weights), lengths),
    )
    return solution, tuple(np.split(solution.residual, np.cumsum(lengths)[:-1]))


def _weights(residuals: Sequence[Array], count: int) -> tuple[float, ...]:
    """Inverse residual variances, the smallest variance's being 1."""
    samples = sum(len(v) for v in residuals)
    share = 1.0 - count / samples  # each block gives up parameters in proportion to its length
    variances = np.array([float(v @ v) / (len(v) * share) for v in residuals])
    if not (variances > 0.0).all():
        return (1.0,) * len(residuals)
    ratio = np.minimum(variances / variances.min(), LARGEST_RATIO)
    return tuple(float(1.0 / r) for r in ratio)


def residual_weights(regressors: Sequence[Array], measured: Sequence[Array]) -> tuple[float, ...]:
    """The maneuvers' weights by the residuals of an unweighted fit, (n, k) and (n,) each.

    All the same where the model leaves no residual to judge by.
    """
    x, z = np.vstack(regressors), np.concatenate(measured)
    rank = int(np.linalg.matrix_rank(x / np.maximum(np.linalg.norm(x, axis=0), 1e-300)))
    if len(regressors) < 2 or len(z) <= 2 * rank:
        return (1.0,) * len(regressors)
    left = z - x @ np.linalg.lstsq(x, z, rcond=None)[0]
    ends = np.cumsum([len(m) for m in measured])[:-1]
    return _weights(np.split(left, ends), rank)


def _stack(parts: Sequence[Array], weights: Sequence[float]) -> Array:
    return np.concatenate([np.sqrt(w) * x for w, x in zip(weights, parts, strict=True)])
