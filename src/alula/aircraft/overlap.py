"""Whether two flat quadrilaterals lie in one another."""

from __future__ import annotations

import math

import numpy as np

from alula.base.arrays import Array

# Corners in order. A few at a time: plain numbers are several times as quick as arrays.
Polygon = list[tuple[float, float]]

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
    flat = _turned([(float(p @ e1), float(p @ e2)) for p in one - one[0]])
    flat_b = _turned([(float(p @ e1), float(p @ e2)) for p in other - one[0]])
    shared = _clip(flat_b, flat)
    if abs(_area(shared)) <= _SHARE * min(size, size_b):
        return False
    # How far apart the planes are where the two lie over each other.
    x, y = (sum(p[k] for p in shared) / len(shared) for k in (0, 1))
    middle = one[0] + e1 * x + e2 * y
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


def _area(polygon: Polygon) -> float:
    return 0.5 * sum(x * v - y * u for (x, y), (u, v) in zip(polygon, _next(polygon), strict=True))


def _next(polygon: Polygon) -> Polygon:
    """The corner after each."""
    return polygon[1:] + polygon[:1]


def _turned(polygon: Polygon) -> Polygon:
    return polygon if _area(polygon) > 0.0 else polygon[::-1]


def _clip(subject: Polygon, window: Polygon) -> Polygon:
    """What of a convex polygon lies in another, both counterclockwise.

    Sutherland and Hodgman 1974, Communications of the ACM 17(1).
    """
    for (ax, ay), (bx, by) in zip(window, _next(window), strict=True):
        kept: Polygon = []
        for (px, py), (qx, qy) in zip(subject, _next(subject), strict=True):
            s = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
            t = (bx - ax) * (qy - ay) - (by - ay) * (qx - ax)
            if s >= 0.0:
                kept.append((px, py))
            if s * t < 0.0:
                kept.append((px + (qx - px) * s / (s - t), py + (qy - py) * s / (s - t)))
        subject = kept
    return subject
