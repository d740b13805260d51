"""Maximum likelihood by modified Newton-Raphson steps, which need slopes of the outputs only.

Gauss-Newton with step halving, or Levenberg and Marquardt (Jategaonkar, Flight Vehicle System
Identification, 2nd ed. 2015, Sec. 4.6, 4.10, 4.13; Dittrich 2016, Eq. (3.58) to (3.63) with the
errata). The covariance of the residuals is diagonal; where it is not given it is estimated, and
the cost is half the sum of N ln(variance) over the outputs. Gaussian priors are one more
measurement of the parameters (Dittrich 2016, Eq. (3.11)). Bounds: a parameter at its bound that
wants out is left there for the step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from alula.base.arrays import Array

Algorithm = Literal["gauss-newton", "levenberg-marquardt"]
SMALL_STEP = 3e-4  # of every standard error: then no digit that is told changes any more
ITERATIONS = 60
HALVINGS = 12
RANK = 1e-13  # of the scaled information's eigenvalues, below which a direction stays put
LEAST_SHARE = 1e-10  # of an output's spread, below which its residual counts as exact


@dataclass(frozen=True)
class Sums:
    """One evaluation with m outputs and k parameters; J are the outputs' slopes, e the residuals.

    information: (m, k, k), sums of J J'; gradient: (m, k), of J e; squares: (m,), of e^2; counts:
    (m,). finite: whether the model flew to the end.
    """

    information: Array
    gradient: Array
    squares: Array
    counts: Array
    finite: bool


class Problem(Protocol):
    """What the optimizer needs of an estimation problem."""

    def evaluate(self, theta: Array) -> Sums:
        """The sums at the parameters (k,)."""
        ...


@dataclass(frozen=True)
class Prior:
    """Gaussian knowledge of the parameters: mean (k,) and inverse covariance (k, k)."""

    mean: Array
    information: Array


@dataclass(frozen=True)
class Optimum:
    """Where the search ended and why.

    theta: (k,). variance: (m,) of the residuals, white. information: (k, k), inverse of the
    Cramer-Rao bound. at_bound: (k,) whether a bound holds the parameter. reason: in words.
    """

    theta: Array
    variance: Array
    information: Array
    converged: bool
    reason: str
    iterations: int
    evaluations: int
    cost: float
    at_bound: Array

    @property
    def covariance(self) -> Array:
        """Cramer-Rao bound (k, k); directions without information have none."""
        return _inverse(self.information)


def maximize_likelihood(
    problem: Problem,
    start: Array,
    *,
    variance: Array | None = None,
    prior: Prior | None = None,
    bounds: tuple[Array, Array] | None = None,
    algorithm: Algorithm = "gauss-newton",
    iterations: int = ITERATIONS,
) -> Optimum:
    """Search from `start` (k,). variance: (m,) of the residuals where it is known."""
    search = _Search(problem, variance, prior, bounds, algorithm == "levenberg-marquardt")
    return search.run(np.array(start, dtype=np.float64), iterations)


class _Search:
    def __init__(
        self,
        problem: Problem,
        variance: Array | None,
        prior: Prior | None,
        bounds: tuple[Array, Array] | None,
        damped: bool,
    ) -> None:
        self.problem, self.known, self.prior, self.bounds = problem, variance, prior, bounds
        self.damping = 1e-3 if damped else 0.0
        self.evaluations = 0
        self.least: Array | None = None

    def evaluate(self, theta: Array) -> tuple[Sums, float]:
        self.evaluations += 1
        sums = self.problem.evaluate(theta)
        if not sums.finite:
            return sums, np.inf
        if self.known is None:
            cost = 0.5 * float(sums.counts @ np.log(self.variance(sums)))
        else:
            cost = 0.5 * float(np.sum(sums.squares / self.known))
        if self.prior is not None:
            off = theta - self.prior.mean
            cost += 0.5 * float(off @ self.prior.information @ off)
        return sums, cost if np.isfinite(cost) else np.inf

    def variance(self, sums: Sums) -> Array:
        if self.known is not None:
            return self.known
        mean = sums.squares / np.maximum(sums.counts, 1)
        if self.least is None:  # an output that the model meets exactly must not rule alone
            self.least = np.maximum(LEAST_SHARE**2 * np.max(mean), 1e-300) * np.ones_like(mean)
        return np.maximum(mean, self.least)

    def run(self, theta: Array, iterations: int) -> Optimum:
        if self.bounds is not None:
            theta = np.clip(theta, *self.bounds)
        sums, cost = self.evaluate(theta)
        if not np.isfinite(cost):
            return self.end(
                theta, sums, cost, 0, False,
                "failed: the motion diverges with the start values; give better ones, or pull the "
                "states to their measurements (stabilize)",
            )  # fmt: skip
        for iteration in range(1, iterations + 1):
            matrix, slope = self.normal(theta, sums)
            free = self.free(theta, slope)
            step = self.step(matrix, slope, free)
            moved = self.move(theta, step, cost, slope)
            if moved is None:
                small = float(slope @ step) < SMALL_STEP**2
                return self.end(
                    theta, sums, cost, iteration, small,
                    "converged: the cost is as low as rounding lets it be" if small else
                    "failed: no step along the search direction lowers the cost, not even a "
                    f"{2**HALVINGS}th of it; start elsewhere, or take terms out",
                )  # fmt: skip
            change = moved[0] - theta
            theta, sums, cost = moved
            se = np.sqrt(np.diag(_inverse(matrix)))
            if np.all(np.abs(change) <= SMALL_STEP * se + 1e-15 * np.abs(theta)):
                return self.end(
                    theta, sums, cost, iteration, True,
                    f"converged: the last step is below {SMALL_STEP:g} standard errors of every "
                    "parameter",
                )  # fmt: skip
        return self.end(
            theta, sums, cost, iterations, False,
            f"failed: not converged in {iterations} steps; start closer, or take terms out",
        )  # fmt: skip

    def normal(self, theta: Array, sums: Sums) -> tuple[Array, Array]:
        weight = 1.0 / self.variance(sums)
        matrix: Array = np.tensordot(weight, sums.information, 1)
        slope: Array = weight @ sums.gradient
        if self.prior is not None:
            matrix = matrix + self.prior.information
            slope = slope + self.prior.information @ (self.prior.mean - theta)
        return matrix, slope

    def free(self, theta: Array, slope: Array) -> Array:
        """Which parameters may move: not those at a bound that the slope pushes out."""
        if self.bounds is None:
            return np.ones(len(theta), dtype=bool)
        low, high = self.bounds
        out: Array = ~(((theta <= low) & (slope < 0.0)) | ((theta >= high) & (slope > 0.0)))
        return out

    def step(self, matrix: Array, slope: Array, free: Array) -> Array:
        step = np.zeros_like(slope)
        if not free.any():
            return step
        if free.all():
            return _solve(matrix, slope, self.damping)
        step[free] = _solve(matrix[np.ix_(free, free)], slope[free], self.damping)
        return step

    def move(
        self, theta: Array, step: Array, cost: float, slope: Array
    ) -> tuple[Array, Sums, float] | None:
        """The first point along the step that is no worse; None where there is none."""
        part = 1.0
        for _ in range(HALVINGS + 1):
            trial = theta + part * step
            if self.bounds is not None:
                trial = np.clip(trial, *self.bounds)
            sums, new = self.evaluate(trial)
            if new <= cost + 1e-10 * (1.0 + abs(cost)):
                self.damping = self.damping / 10.0 if self.damping > 1e-12 else self.damping
                return trial, sums, new
            if self.damping:
                return self.damped(theta, cost, slope)
            part *= 0.5
        return None

    def damped(self, theta: Array, cost: float, slope: Array) -> tuple[Array, Sums, float] | None:
        """More and more of Marquardt's damping until the cost falls."""
        base, base_cost = self.evaluate(theta)
        if not np.isfinite(base_cost):
            return None
        matrix, slope = self.normal(theta, base)
        while self.damping < 1e8:
            self.damping *= 10.0
            trial = theta + self.step(matrix, slope, self.free(theta, slope))
            if self.bounds is not None:
                trial = np.clip(trial, *self.bounds)
            sums, new = self.evaluate(trial)
            if new <= cost:
                return trial, sums, new
        return None

    def end(
        self, theta: Array, sums: Sums, cost: float, iterations: int, converged: bool, reason: str
    ) -> Optimum:
        k = len(theta)
        if sums.finite:
            matrix, slope = self.normal(theta, sums)
            variance = self.variance(sums)
        else:
            matrix, slope = np.zeros((k, k)), np.zeros(k)
            variance = np.full(len(sums.counts), np.nan)
        return Optimum(
            theta=theta,
            variance=variance,
            information=matrix,
            converged=converged,
            reason=reason,
            iterations=iterations,
            evaluations=self.evaluations,
            cost=cost,
            at_bound=~self.free(theta, slope),
        )


def _solve(matrix: Array, slope: Array, damping: float) -> Array:
    """The step; nothing along directions that the data say nothing about."""
    scale = np.sqrt(np.diag(matrix))
    scale = np.where(scale > 0.0, scale, 1.0)
    unit = matrix / np.outer(scale, scale)
    values, axes = np.linalg.eigh(unit)
    known = values > RANK * max(float(values[-1]), 1e-300)
    part = (axes[:, known].T @ (slope / scale)) / (values[known] + damping)
    out: Array = (axes[:, known] @ part) / scale
    return out


def _inverse(matrix: Array) -> Array:
    scale = np.sqrt(np.diag(matrix))
    scale = np.where(scale > 0.0, scale, 1.0)
    values, axes = np.linalg.eigh(matrix / np.outer(scale, scale))
    known = values > RANK * max(float(values[-1]), 1e-300)
    half = axes[:, known] / np.sqrt(values[known])
    out: Array = (half @ half.T) / np.outer(scale, scale)
    return out
