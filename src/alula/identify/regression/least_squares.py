"""Ordinary and weighted least squares (Dittrich 2016, Eq. (3.32) to (3.44)).

Solved by the singular value decomposition of the column-scaled regressors, never by the normal
equations: their condition number is the square of the regressors' own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse

ROUNDING = 10.0  # margin on the rounding error n*eps below which a singular value is zero


@dataclass(frozen=True)
class LeastSquares:
    """A solution with n samples and k parameters, of which r combinations are determined.

    value: (k,), of smallest norm in scaled parameters where r < k. residual: (n,) measured minus
    model, unweighted. dispersion: (k, k) D in value = D X' W z, here (X' W X)^-1 within the
    determined combinations. variance: residual variance of unit weight. null: (k, k - r)
    orthonormal directions of the scaled parameters (value times `scale`) that do not change the fit
    at all. scale: (k,) column norms. spread: (k, k), D X' W X D where the method is biased; None
    where it is D itself.
    """

    value: Array
    residual: Array
    dispersion: Array
    variance: float
    null: Array
    scale: Array
    spread: Array | None = None

    @property
    def covariance(self) -> Array:
        """Covariance (k, k) if residuals were white."""
        return self.variance * (self.dispersion if self.spread is None else self.spread)


def least_squares(regressors: Array, measured: Array, weight: Array | None = None) -> LeastSquares:
    """Minimize the weighted sum of squares of `measured - regressors @ value`.

    regressors: (n, k). measured: (n,). weight: (n,) inverse variances up to a common factor; None
    for ordinary least squares. Raises BadInput where n <= k, or where a number is not finite.
    """
    samples, count = regressors.shape
    if samples <= count:
        raise refuse(
            "too_few_samples",
            where="least squares",
            expected=f"more samples than the {count} parameters",
            found=f"{samples} samples",
            do="Take a longer maneuver or several, or fewer terms.",
        )
    if not (np.isfinite(regressors).all() and np.isfinite(measured).all()):
        raise refuse(
            "not_finite",
            where="least squares",
            expected="finite regressors and measurements",
            found="NaN or infinity",
            do="Choose a window without gaps or invalid samples.",
        )
    root = np.ones(samples) if weight is None else np.sqrt(weight)
    rows = regressors * root[:, None]
    scale = np.linalg.norm(rows, axis=0)
    scale[scale == 0.0] = 1.0
    left, singular, right = np.linalg.svd(rows / scale, full_matrices=False)
    tolerance = ROUNDING * samples * np.finfo(float).eps * max(singular[0], 1e-300)
    rank = int(np.sum(singular > tolerance))
    basis = right[:rank].T / scale[:, None]  # parameters of unit coordinates
    value = basis @ ((left[:, :rank].T @ (measured * root)) / singular[:rank])
    residual = measured - regressors @ value
    half = basis / singular[:rank]
    return LeastSquares(
        value=value,
        residual=residual,
        dispersion=half @ half.T,
        variance=float(np.sum((root * residual) ** 2) / (samples - rank)),
        null=right[rank:].T,
        scale=scale,
    )
