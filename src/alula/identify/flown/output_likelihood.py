"""The likelihood of a problem's outputs under white noise, whose covariance R may be asked for.

R at its best for the parameters, R = mean of e e' (Dittrich 2016, Eq. (3.51)): the cost becomes
N/2 ln det R (Eq. (3.58)). Diagonal R takes readings one sensor at a time, so that gaps and rates
need no thought; full R needs samples at which every sensor spoke.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.flown.problem import Sums
from alula.identify.likelihood.optimizer import Point
from alula.identify.likelihood.parameters import Whitened

SMALLEST = 1e-24  # of an output's variance over its mean square: below it is rounding


class Problem(Protocol):
    """What a likelihood needs of a problem of k parameters and m outputs."""

    @property
    def readings(self) -> Sequence[Array]:
        """(n, m) of each maneuver, NaN where a sensor says nothing."""
        ...

    def evaluate(self, theta: Array) -> Sums:
        """The sums at the parameters (k,)."""
        ...

    def flight(self, theta: Array, i: int) -> tuple[Array, Array]:
        """Outputs (n, m) of maneuver i and slopes (n, m, k); NaN behind a divergence."""
        ...


class OutputErrorLikelihood:
    """Diagonal R. variance: (m,) where the noise is known."""

    def __init__(self, problem: Problem, variance: Array | None = None) -> None:
        self.problem, self.known = problem, variance
        self.least = np.zeros(0)
        if variance is None:
            squares = [np.nanmean(r**2, axis=0) for r in problem.readings]
            self.least = np.maximum(SMALLEST * np.mean(squares, axis=0), 1e-300)
        self._at: tuple[Array, Point | None] | None = None

    def __call__(self, theta: Array, derivatives: bool) -> Point | None:
        """Cost, gradient and information; one flight gives them all, so they are kept."""
        if self._at is None or not np.array_equal(self._at[0], theta):
            self._at = theta.copy(), self._point(theta)
        return self._at[1]

    def variance(self, sums: Sums) -> Array:
        """(m,) R of every output."""
        if self.known is not None:
            return self.known
        out: Array = np.maximum(sums.squares / np.maximum(sums.counts, 1), self.least)
        return out

    def weights(self, theta: Array) -> Array:
        """(m, m) R^-1."""
        return np.diag(1.0 / self.variance(self.problem.evaluate(theta)))

    def counted(self, i: int) -> NDArray[np.bool_]:
        """(n, m) which readings of maneuver i count."""
        return np.isfinite(self.problem.readings[i])

    def blocks(self, theta: Array) -> list[Whitened]:
        """One block per output and maneuver, missing samples left out."""
        deviation = np.sqrt(self.variance(self.problem.evaluate(theta)))
        out = []
        for i, z in enumerate(self.problem.readings):
            y, slopes = self.problem.flight(theta, i)
            for o, size in enumerate(deviation):
                good = np.isfinite(z[:, o])
                if good.any():
                    error = (z[good, o] - y[good, o]) / size
                    out.append(Whitened(slopes[good, o] / size, error))
        return out

    def _point(self, theta: Array) -> Point | None:
        sums = self.problem.evaluate(theta)
        if not sums.finite:
            return None
        r = self.variance(sums)
        if self.known is None:
            cost = 0.5 * float(sums.counts @ np.log(r))
        else:
            cost = 0.5 * float(np.sum(sums.squares / r))
        k = len(theta)
        information = ((1.0 / r) @ sums.information.reshape(len(r), -1)).reshape(k, k)
        return Point(cost, -(1.0 / r) @ sums.gradient, information)


class FullCovarianceLikelihood(OutputErrorLikelihood):
    """Full R, from the samples at which every output was measured."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self._good: list[NDArray[np.bool_]] = [
            np.asarray(np.isfinite(z).all(axis=1)) for z in problem.readings
        ]
        count, outputs = sum(int(g.sum()) for g in self._good), problem.readings[0].shape[1]
        if count <= 2 * outputs:
            raise refuse(
                "too_few_samples",
                where="output error, covariance = 'full'",
                expected="samples at which every output was measured",
                found=f"{count}",
                do="Use covariance = 'diagonal', or put the outputs on one time base.",
            )

    def weights(self, theta: Array) -> Array:
        """(m, m) R^-1."""
        R = self._covariance([v for v, _ in self._runs(theta)])
        return np.asarray(np.linalg.inv(R), dtype=np.float64)

    def counted(self, i: int) -> NDArray[np.bool_]:
        """(n, m) which readings of maneuver i count: those of samples that have all."""
        return np.broadcast_to(self._good[i][:, None], self.problem.readings[i].shape)

    def blocks(self, theta: Array) -> list[Whitened]:
        """Outputs whitened together, their residuals' correlation over time included."""
        runs = self._runs(theta)
        root = np.linalg.cholesky(np.linalg.inv(self._covariance([v for v, _ in runs]))).T
        out = []
        for i, (v, J) in enumerate(runs):
            white = np.einsum("po,noi->npi", root, J)
            for o in range(len(root)):
                out.append(Whitened(white[:, o], v @ root[o], together=i))
        return out

    def _runs(self, theta: Array) -> list[tuple[Array, Array]]:
        """Residuals (n, m) and slopes (n, m, k) of every maneuver."""
        out = []
        for i, (z, good) in enumerate(zip(self.problem.readings, self._good, strict=True)):
            y, J = self.problem.flight(theta, i)
            out.append(((z - y)[good], J[good]))
        return out

    def _covariance(self, residuals: Sequence[Array]) -> Array:
        every = np.vstack(residuals)
        out: Array = every.T @ every / len(every) + np.diag(self.least)
        return out

    def _point(self, theta: Array) -> Point | None:
        runs = self._runs(theta)
        if not all(np.isfinite(v).all() for v, _ in runs):
            return None
        R = self._covariance([v for v, _ in runs])
        sign, log = np.linalg.slogdet(R)
        if sign <= 0.0:
            return None
        inverse = np.linalg.inv(R)
        k = len(theta)
        gradient, information = np.zeros(k), np.zeros((k, k))
        for v, J in runs:
            weighted = np.einsum("op,npi->noi", inverse, J)
            gradient -= np.einsum("noi,no->i", weighted, v)
            information += np.tensordot(weighted, J, axes=([0, 1], [0, 1]))
        return Point(0.5 * float(log) * sum(len(v) for v, _ in runs), gradient, information)


def likelihood_of(problem: Problem, variance: Array | None, full: bool) -> OutputErrorLikelihood:
    """The likelihood; variance: (m,) where it is known, and then R is diagonal."""
    if full and variance is None:
        return FullCovarianceLikelihood(problem)
    return OutputErrorLikelihood(problem, variance)
