"""The steady-state Kalman filter's covariance, for many parameter vectors at once.

P = Phi (P - P C' (C P C' + R)^-1 C P) Phi' + Q by the structure-preserving doubling algorithm
(Anderson 1978, Int. J. Control 28, p. 295; Chu, Fan, Lin, Wang 2004): each pass doubles the number
of steps that the difference equation has run from P = 0, so that a dozen passes are thousands of
steps. One eigenvalue decomposition per parameter vector would cost more.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array

PASSES = 40
SETTLED = 1e-13  # relative change of P


def steady_covariance(phi: Array, C: Array, Q: Array, R: Array) -> Array:
    """P (..., s, s) before the update, for phi, Q (..., s, s), C (..., k, s), R (..., k, k).

    NaN where the passes do not settle: an unstable mode that no output sees.
    """
    turned = np.swapaxes(C, -1, -2)
    A = np.swapaxes(phi, -1, -2)
    G = turned @ np.linalg.solve(R, C)
    H = Q
    one = np.eye(phi.shape[-1])
    change = np.full(phi.shape[:-2], np.inf)
    with np.errstate(all="ignore"):
        for _ in range(PASSES):
            W = one + G @ H
            if not np.isfinite(W).all():
                break
            inverse_A = np.linalg.solve(W, A)
            inverse_G = np.linalg.solve(W, G)
            turned_A = np.swapaxes(A, -1, -2)
            step = turned_A @ H @ inverse_A
            G = G + A @ inverse_G @ turned_A
            A = A @ inverse_A
            H = H + 0.5 * (step + np.swapaxes(step, -1, -2))
            size = np.abs(H).max(axis=(-1, -2))
            change = np.abs(step).max(axis=(-1, -2)) / np.maximum(size, 1e-300)
            if (change < SETTLED).all():
                break
    out: Array = np.where((change < 1e-9)[..., None, None], H, np.nan)
    return out
