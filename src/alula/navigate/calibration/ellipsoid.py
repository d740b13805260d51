"""The ellipsoid through vectors of one true length, as start of the fit.

Least squares of the quadric's coefficients; the quadric is an ellipsoid if the matrix of its
second-order part is positive definite (NXP AN4246; Pusztai 2018, Eq. (3.19)).
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array

PLANAR = 0.05  # thinnest over thickest spread of the points, below which they lie in a plane


def ellipsoid(points: Array, length: float) -> tuple[Array, Array] | None:
    """Symmetric C (3, 3) and center o (3,) with |C (x - o)| about `length`; None if the quadric
    that fits best is no ellipsoid. points: (n, 3), nine or more."""
    middle = points.mean(axis=0)
    size = float(np.sqrt(np.mean((points - middle) ** 2))) or 1.0
    x = (points - middle) / size
    square = np.column_stack(
        [x**2, 2.0 * x[:, 0] * x[:, 1], 2.0 * x[:, 0] * x[:, 2], 2.0 * x[:, 1] * x[:, 2], 2.0 * x]
    )
    c, _, rank, _ = np.linalg.lstsq(square, np.ones(len(x)), rcond=1e-10)
    A = np.array([[c[0], c[3], c[4]], [c[3], c[1], c[5]], [c[4], c[5], c[2]]])
    if rank < 9 or np.linalg.cond(A) > 1e8:
        return None
    center = -np.linalg.solve(A, c[6:])
    level = 1.0 + center @ A @ center
    root, vectors = np.linalg.eigh(A / level)
    if root.min() <= 0.0:
        return None
    C = (vectors * np.sqrt(root)) @ vectors.T * (length / size)
    return C, center * size + middle


def flatness(points: Array) -> tuple[float, Array]:
    """Thinnest over thickest spread of the points about their mean, and the thin direction."""
    _, s, vt = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    return float(s[-1] / s[0]) if s[0] > 0.0 else 0.0, vt[-1]
