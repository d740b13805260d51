"""How far noise in the regressors has pulled the estimate (the bias of equation error).

Least squares takes regressors as exact. White noise in them with covariance C per sample biases the
estimate by -(X' X)^-1 n C value to first order (Fuller, Measurement Error Models, 1987, ch. 1),
usually toward zero. C is estimated from third differences, which leave noise and take away motion;
a column whose differences are rare and large (a control that steps) counts with their median.
Noise that a filter has smoothed does not show in it: reconstruct first, then this is small.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, warn
from alula.identify.regression.regress import Regression

DIFFERENCE = 3
GAIN = 20.0  # variance of the third difference of white noise: 1 + 9 + 9 + 1
NORMAL = 1.4826  # standard deviation of a normal variable over its median absolute value


def rough_part(x: Array) -> Array:
    """Third differences (m, k) of columns (n, k), sized so that white noise keeps its sum of
    squares; (0, k) where there are too few samples to tell.
    """
    n, count = x.shape
    if n <= 2 * DIFFERENCE:
        return np.zeros((0, count))
    out: Array = np.diff(x, n=DIFFERENCE, axis=0) * np.sqrt(n / (n - DIFFERENCE) / GAIN)
    return out


def noise_bias(fit: Regression) -> Array:
    """(k,) first-order bias of the estimate by white noise in its regressors."""
    noise = np.zeros_like(fit.solution.dispersion)
    for weight, block in zip(fit.weights, fit.blocks, strict=True):
        rough = rough_part(block.regressors)
        if len(rough):
            total = np.mean(rough**2, axis=0)
            typical = (NORMAL * np.median(np.abs(rough), axis=0)) ** 2
            share = np.sqrt(np.minimum(1.0, typical / np.where(total > 0.0, total, 1.0)))
            noise += weight * (rough.T @ rough) * np.outer(share, share)
    out: Array = -fit.solution.dispersion @ noise @ fit.solution.value
    return out


def warn_of_bias(coefficient: str, fit: Regression, se: Array) -> tuple[Message, ...]:
    """A warning for each parameter whose bias by noise exceeds its standard error (k,)."""
    bias = noise_bias(fit)
    return tuple(
        warn(
            "noisy_regressor",
            where=f"{coefficient}, {name}",
            expected="regressors whose noise shifts the estimate by less than its standard error",
            found=f"a shift of about {shift:.2g} at a standard error of {error:.2g}",
            do="Let reconstruction smooth the motion first (filter other than 'none'), or give "
            "its sensors their true noise.",
        )
        for name, shift, error in zip(fit.names, bias, se, strict=True)
        if abs(shift) > error
    )
