"""A body between its cross-sections: areas, volume, surface, center line."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.special import ellipe

from alula.aircraft.geometry import Body
from alula.base.arrays import Array

Inside = NDArray[np.bool_]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


class BodyShape:
    """A body of elliptic cross-sections, s m aft of the first one.

    The area and the squares of width and height are monotone cubics between the stations (Fritsch
    and Butland 1984). Squares, because they grow in proportion to s behind a rounded nose, where
    widths have an infinite slope; monotone, so that no bulge arises which is not in the table.
    The center line is straight between stations.
    """

    def __init__(self, body: Body) -> None:
        self.name = body.name
        self.stations = np.array([s.position for s in body.sections])  # (k, 3)
        self.s = self.stations[0, 0] - self.stations[:, 0]
        self.width = np.array([c.width for c in body.sections])
        self.height = np.array([c.height for c in body.sections])
        self._area = PchipInterpolator(self.s, 0.25 * np.pi * self.width * self.height)
        self._width2 = PchipInterpolator(self.s, self.width**2)
        self._height2 = PchipInterpolator(self.s, self.height**2)

    @property
    def x_nose(self) -> float:
        """x of the first station, m, body axes."""
        return float(self.stations[0, 0])

    @property
    def length(self) -> float:
        """First to last station, m."""
        return float(self.s[-1])

    @property
    def diameter(self) -> float:
        """Of the circle with the largest cross-section's area, m."""
        return float(np.sqrt((self.width * self.height).max()))

    def area(self, s: Array) -> Array:
        """Cross-section, m2."""
        return np.asarray(self._area(s))

    def width2(self, s: Array) -> Array:
        """Width squared, m2."""
        return np.asarray(self._width2(s))

    def height2(self, s: Array) -> Array:
        """Height squared, m2."""
        return np.asarray(self._height2(s))

    def center(self, s: Array) -> Array:
        """y and z of the center line, (n, 2) m."""
        yz = [np.interp(s, self.s, self.stations[:, k]) for k in (1, 2)]
        return np.column_stack(yz)

    def integral(
        self, f: Callable[[Array], Array], low: float = 0.0, high: float = np.inf
    ) -> float:
        """Integral of f(s) over the length, or from low to high, m.

        Gauss-Legendre with 8 nodes between neighboring stations: exact for the cubics above times
        any polynomial up to degree 12.
        """
        low, high = max(low, 0.0), min(high, self.length)
        if high <= low:
            return 0.0
        inner = self.s[(self.s > low) & (self.s < high)]
        edges = np.concatenate([[low], inner, [high]])
        half = 0.5 * np.diff(edges)[:, None]
        nodes = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * _NODES
        return float(np.sum(half * _WEIGHTS * f(nodes.ravel()).reshape(nodes.shape)))

    @property
    def volume(self) -> float:
        """m3."""
        return self.integral(self.area)

    @property
    def wetted_area(self) -> float:
        """The skin from nose to tail without a base, m2: perimeter times length along the skin.

        The skin's slope is that of the circle of equal area between stations; ellipse by the
        complete elliptic integral.
        """
        radius = np.sqrt(0.25 * self.width * self.height)
        slant = np.hypot(np.diff(self.s), np.diff(radius)) / np.diff(self.s)

        def skin(s: Array) -> Array:
            piece = np.clip(np.searchsorted(self.s, s) - 1, 0, len(slant) - 1)
            a, b = np.sqrt(self.width2(s)), np.sqrt(self.height2(s))
            long, short = np.maximum(a, b), np.minimum(a, b)
            share = np.divide(short, long, out=np.ones_like(long), where=long > 0.0)
            return np.asarray(2.0 * long * ellipe(1.0 - share**2) * slant[piece])

        return self.integral(skin)

    def contains(self, points: Array) -> Inside:
        """Whether points (n, 3) m, body axes, lie inside: (n,) bool."""
        s = self.x_nose - points[:, 0]
        within = (s >= 0.0) & (s <= self.length)
        at = np.clip(s, 0.0, self.length)
        off = points[:, 1:] - self.center(at)
        w2, h2 = self.width2(at), self.height2(at)
        inside = off[:, 0] ** 2 * h2 + off[:, 1] ** 2 * w2 < 0.25 * w2 * h2
        return np.asarray(within & inside)
