"""Biased least squares: the principal components of the regressors, each with a factor of its own.

With the constant terms taken out and every other column scaled to unit length, X = U diag(s) V'.
Ordinary least squares divides component j of U'z by s_j, so the small ones spread their noise over
all that is collinear. Shrinkage divides by s_j/f_j instead, 0 <= f_j <= 1:

    value = D X'Wz,   variance = sigma^2 D X'WX D,   bias = (D X'WX - I) truth        (closed form)

Ridge regression has f = s^2/(s^2 + k) (Hoerl and Kennard, Technometrics 12, 1970), principal
components f of 1 or 0 (Massy, J. Am. Stat. Assoc. 60, 1965). The bias needs the truth; what is
reported takes the ordinary estimates for it, which are unbiased but, where shrinkage is wanted,
uncertain.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.identify.regression.least_squares import ROUNDING, LeastSquares, least_squares

# Singular values (m,) of the scaled regressors -> factors (m,) from 0 to 1.
Factors = Callable[[Array], Array]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Components:
    """The regressors without what the free columns explain, in principal components.

    projection: (f, m), what of the m shrunk columns the f free ones explain. scale: (m,) lengths of
    the rest. singular: (r,), those above rounding. axes: (m, r), their directions in scaled
    parameters. free_inverse: (f, f).
    """

    projection: Array
    scale: Array
    singular: Array
    axes: Array
    free_inverse: Array

    def dispersion(self, factors: Array, free: Flags) -> Array:
        """D (k, k) in value = D X' W z. factors: (r,). free: (k,) flags, in the columns' order."""
        half = self.axes / self.scale[:, None]
        shrunk = (half * (factors / self.singular**2)) @ half.T
        out = np.empty((len(free), len(free)))
        out[np.ix_(~free, ~free)] = shrunk
        out[np.ix_(free, ~free)] = -self.projection @ shrunk
        out[np.ix_(~free, free)] = out[np.ix_(free, ~free)].T
        out[np.ix_(free, free)] = self.free_inverse + self.projection @ shrunk @ self.projection.T
        return out

    def along(self, rows: Array, free: Flags) -> Array:
        """(n, r) orthonormal components of the rows (n, k)."""
        rest = rows[:, ~free] - rows[:, free] @ self.projection
        out: Array = (rest / self.scale) @ self.axes / self.singular
        return out

    def solve(self, factors: Array, free: Flags, rows: Array, measured: Array) -> Array:
        """D X' z (k,), not by D itself, whose condition is the square of the regressors' own."""
        out = np.zeros(len(free))
        share = self.along(rows, free).T @ measured
        out[~free] = (self.axes @ (factors / self.singular * share)) / self.scale
        left = measured - rows[:, ~free] @ out[~free]
        out[free] = self.free_inverse @ (rows[:, free].T @ left)
        return out


def components(rows: Array, free: Flags) -> Components:
    """Principal components of weighted regressors (n, k) beside the columns flagged `free`."""
    fixed, moving = rows[:, free], rows[:, ~free]
    inverse = np.zeros((fixed.shape[1],) * 2)
    if free.any():
        inverse[:] = np.linalg.pinv(fixed.T @ fixed)
    projection = inverse @ (fixed.T @ moving)
    rest = moving - fixed @ projection
    scale = np.linalg.norm(rest, axis=0)
    still = scale <= 1e-12 * np.linalg.norm(moving, axis=0)  # as constant as the free columns
    rest[:, still] = 0.0
    scale[still] = 1.0
    _, singular, right = np.linalg.svd(rest / scale, full_matrices=False)
    largest = max(float(singular.max(initial=0.0)), 1e-300)
    kept = singular > ROUNDING * len(rows) * np.finfo(float).eps * largest
    return Components(projection, scale, singular[kept], right[kept].T, inverse)


@dataclass(frozen=True)
class Shrunk:
    """A solver with the given factors; free: (k,) columns that are never shrunk."""

    free: Flags
    factors: Factors

    def __call__(self, regressors: Array, measured: Array, weight: Array | None) -> LeastSquares:
        """The biased solution; its `variance` is that of the ordinary fit, which is unbiased."""
        ordinary = least_squares(regressors, measured, weight)
        root = np.ones(len(measured)) if weight is None else np.sqrt(weight)
        rows = regressors * root[:, None]
        parts = components(rows, self.free)
        factors = self.factors(parts.singular)
        dispersion = parts.dispersion(factors, self.free)
        value = parts.solve(factors, self.free, rows, root * measured)
        normal = rows.T @ rows
        return replace(
            ordinary,
            value=value,
            residual=measured - regressors @ value,
            dispersion=dispersion,
            spread=dispersion @ normal @ dispersion,
        )


def bias_matrix(solution: LeastSquares, regressors: Array, weight: Array | None = None) -> Array:
    """(k, k) B with bias = B truth: D X'WX - I."""
    rows = regressors if weight is None else regressors * np.sqrt(weight)[:, None]
    out: Array = solution.dispersion @ (rows.T @ rows) - np.eye(rows.shape[1])
    return out
