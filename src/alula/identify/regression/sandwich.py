"""Covariance of a least-squares estimate whose residuals differ in size from row to row.

Eicker 1963, White 1980: D [ sum x_i x_i' v_i^2 ] D. In frequency this is the correction for
coloured residuals: a coloured residual's ordinates are independent, with variances that follow
its spectrum. `corrected` divides squares by 1 - leverage (MacKinnon and White 1985, HC2): a row
that the fit bends toward shows too small a residual.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from alula.base.arrays import Array
from alula.base.coloured import Coloured

_LARGEST = 0.95  # leverage: beyond it a residual tells nothing


def sandwich(blocks: Sequence[tuple[Array, Array]], dispersion: Array, as_is: int = 0) -> Coloured:
    """Covariance (k, k) by pairs of rows.

    blocks: (rows (n, k), residual (n,)), weighted; rows 2i and 2i + 1 are the real and imaginary
    part of one ordinate and count as two degrees of freedom together. dispersion: (k, k). as_is:
    first rows of each block whose residual is given from elsewhere and needs no correction.
    """
    plain = np.zeros_like(dispersion)
    better = np.zeros_like(dispersion)
    squares = np.zeros(len(dispersion))
    for rows, residual in blocks:
        leverage = np.minimum(np.einsum("nk,kl,nl->n", rows, dispersion, rows), _LARGEST)
        leverage[:as_is] = 0.0
        power = _paired(residual**2)
        fair = _paired(residual**2 / (1.0 - leverage))
        plain += rows.T @ (rows * power[:, None])
        better += rows.T @ (rows * fair[:, None])
        share = (rows @ dispersion) ** 2 * fair[:, None]
        squares += np.sum((share[0::2] + share[1::2]) ** 2, axis=0)
    covariance, corrected = dispersion @ plain @ dispersion, dispersion @ better @ dispersion
    mean = np.diag(corrected)
    # an ordinate's power varies as its square, so that the mean of squares is twice the square
    dof = np.where(squares > 0.0, 4.0 * mean**2 / np.where(squares > 0.0, squares, 1.0), 1.0)
    return Coloured(covariance=covariance, corrected=corrected, dof=np.maximum(dof, 1.0))


def _paired(squares: Array) -> Array:
    """The mean of each pair, at both of its places."""
    return np.repeat(0.5 * (squares[0::2] + squares[1::2]), 2)
