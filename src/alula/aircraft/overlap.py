"""Whether two flat quadrilaterals lie in one another."""

from __future__ import annotations

import math

import numpy as np

from alula.base.arrays import Array

_SHARE = 1e-6  # of the smaller area: less is a common edge in rounded numbers
_PARALLEL = 0.02  # sine of the angle between planes: 1.1 deg


def overlap(one: Array, other: Array, near: float) -> bool:
    """Whether the quadrilaterals, corners (4, 3) in order, share area in nearly one plane.

    near: m, how far apart planes may be to count as one. Planes at an angle cross along a line,
    which is no shared area.
    """
    extents = zip(one.T.tolist(), other.T.tolist(), strict=True)
    if any(max(min(a), min(b)) - near > min(max(a), max(b)) for a, b in extents):
        return False  # boxes around them are apart
    normal, size = _normal(one)
    normal_b, size_b = _normal(other)
    if min(size, size_b) == 0.0 or np.linalg.norm(_cross(normal, normal_b)) > _PARALLEL:
        return False
    first = one[1] - one[0]
    first = first - normal * (first @ normal)
    if np.linalg.norm(first) == 0.0:
        return False
    e1 = first / np.linalg.norm(first)
    e2 = _cross(normal, e1)
    flat = np.column_stack([(one - one[0]) @ e1, (one - one[0]) @ e2])
    flat_b = np.column_stack([(other - one[0]) @ e1, (other - one[0]) @ e2])
    shared = _clip(_turned(flat_b), _turned(flat))
    if abs(_area(shared)) <= _SHARE * min(size, size_b):
        return False
    # How far apart the planes are where the two lie over each other.
    middle = one[0] + e1 * shared[:, 0].mean() + e2 * shared[:, 1].mean()
    return bool(abs((middle - other.mean(axis=0)) @ normal_b) <= near)


def _normal(corners: Array) -> tuple[Array, float]:
    """Unit normal and area: half the cross product of the diagonals."""
    normal = 0.5 * _cross(corners[2] - corners[0], corners[3] - corners[1])
    size = math.sqrt(normal @ normal)
    return (normal / size if size > 0.0 else normal), size


def _cross(a: Array, b: Array) -> Array:
    """Cross product of two vectors; NumPy's own takes several times as long on single ones."""
    (u, v, w), (x, y, z) = a.tolist(), b.tolist()
    return np.array([v * z - w * y, w * x - u * z, u * y - v * x])


def _area(polygon: Array) -> float:
    if len(polygon) < 3:
        return 0.0
    x, y = polygon.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _turned(polygon: Array) -> Array:
    return polygon if _area(polygon) > 0.0 else polygon[::-1]


def _clip(subject: Array, window: Array) -> Array:
    """What of a convex polygon lies in another, both counterclockwise.

    Sutherland and Hodgman 1974, Communications of the ACM 17(1).
    """
    for a, b in zip(window, np.roll(window, -1, axis=0), strict=True):
        if len(subject) == 0:
            break
        d = b - a
        inside = d[0] * (subject[:, 1] - a[1]) - d[1] * (subject[:, 0] - a[0])
        kept = []
        for p, q, s, t in zip(
            subject, np.roll(subject, -1, axis=0), inside, np.roll(inside, -1), strict=True
        ):
            if s >= 0.0:
                kept.append(p)
            if s * t < 0.0:
                kept.append(p + (q - p) * s / (s - t))
        subject = np.array(kept).reshape(-1, 2)
    return subject
