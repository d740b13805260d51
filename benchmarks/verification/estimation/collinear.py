"""Principal components and ridge on a collinear set: bias and variance against their closed form.

Three regressors of which the third is nearly the sum of the other two, beside a constant, as alpha,
pitch rate and an elevator under feedback are. The closed form is written out here anew, by the
normal equations of the scaled regressors: it shares no line with what it judges. The ridge
parameter and the number of components are fixed, as the closed form asks for. A variance from 2000
seeds is itself uncertain by 3.2 %; the seeds are fixed.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.identify.regression.principal_components import principal_components
from alula.identify.regression.regress import Block, regress
from alula.identify.regression.ridge import ridge
from alula.identify.regression.shrinkage import bias_matrix

SEEDS = 2000
N, NOISE, K = 200, 0.5, 0.02
TRUTH = np.array([0.3, 1.0, -2.0, 1.5])  # constant first
FREE = np.array([True, False, False, False])
NAMES = ("0", "a", "b", "c")


def design() -> Array:
    """(N, 4) regressors; the scaled ones have a condition index of about 40."""
    t = np.linspace(0.0, 1.0, N)
    a, b, c = (1.4 * np.sin(2.0 * np.pi * f * t + f) for f in (2.3, 3.7, 5.1))
    return np.column_stack([np.ones(N), a, 2.0 * b, a + b + 0.05 * c])


def closed_form(method: str) -> tuple[Array, Array]:
    """Bias (3,) and variance (3,) of the three slopes, from the centered and scaled regressors."""
    x = design()[:, 1:]
    x = x - x.mean(axis=0)
    scale = np.sqrt(np.sum(x**2, axis=0))
    correlation = (x / scale).T @ (x / scale)
    if method == "ridge":
        inverse = np.linalg.inv(correlation + K * np.eye(3))
    else:
        values, axes = np.linalg.eigh(correlation)
        kept = axes[:, np.argsort(values)[1:]]  # all but the smallest
        inverse = kept @ np.linalg.inv(kept.T @ correlation @ kept) @ kept.T
    truth = TRUTH[1:] * scale
    bias = (inverse @ correlation - np.eye(3)) @ truth / scale
    variance = NOISE**2 * np.diag(inverse @ correlation @ inverse) / scale**2
    return bias, variance


def scatter(method: str, seeds: int) -> tuple[Array, Array, Array, Array]:
    """Mean error and variance of the estimates over the seeds, and the stated bias and variance.

    The stated bias takes the truth in place of the estimates; the stated variance is the mean over
    the seeds of the one with the residuals' own sigma. All (3,).
    """
    x = design()
    errors, stated = [], []
    for seed in range(seeds):
        noise = NOISE * np.random.default_rng([11, seed]).standard_normal(N)
        ordinary = regress(NAMES, [Block(x, x @ TRUTH + noise)])
        if method == "ridge":
            fit, _ = ridge(ordinary, FREE, K)
        else:
            fit, _, _ = principal_components(ordinary, FREE, 2)
        errors.append(fit.solution.value[1:] - TRUTH[1:])
        stated.append(np.diag(fit.solution.covariance)[1:])
    bias = (bias_matrix(fit.solution, x) @ TRUTH)[1:]
    return np.mean(errors, axis=0), np.var(errors, axis=0, ddof=1), bias, np.mean(stated, axis=0)


def check(quick: bool = False) -> tuple[str, bool]:
    """Bias and variance of the scatter and as stated, over those of the closed form."""
    words, good = [], True
    tolerance = 0.25 if quick else 0.05  # a variance from 300 seeds: 8 % by chance
    for method in ("ridge", "principal components"):
        bias, variance = closed_form(method)
        mean, var, said_bias, said_variance = scatter(method, 300 if quick else SEEDS)
        off = {
            "bias": np.max(np.abs(mean / bias - 1.0)),
            "variance": np.max(np.abs(var / variance - 1.0)),
            "stated bias": np.max(np.abs(said_bias / bias - 1.0)),
            "stated variance": np.max(np.abs(said_variance / variance - 1.0)),
        }
        good &= all(x < tolerance for x in off.values())
        words.append(f"{method}: " + ", ".join(f"{k} off {x:.1%}" for k, x in off.items()))
    return "; ".join(words) + " (largest of three slopes)", bool(good)
