"""NACA four-digit sections from their names (Jacobs, Ward, Pinkerton 1933, NACA Report 460)."""

from __future__ import annotations

import re

import numpy as np

from alula.base.arrays import Array, frozen

_NAME = re.compile(r"^\s*naca[\s_-]*(\d)(\d)(\d\d)\s*$", re.IGNORECASE)
_POINTS = 100  # of the mean line, cosine spaced: closer together at both edges


def naca_digits(name: str) -> tuple[float, float, float] | None:
    """Camber, its place and the thickness, all over the chord, of 'NACA 2412'; None for others.

    A name without camber or without its place ('NACA 0012', 'NACA 2012') is symmetric or not a
    section: the latter gives None too, as does one without thickness.
    """
    found = _NAME.match(name)
    if found is None:
        return None
    camber, place, thickness = int(found[1]) / 100, int(found[2]) / 10, int(found[3]) / 100
    if thickness == 0.0 or (camber == 0.0) != (place == 0.0):
        return None
    return camber, place, thickness


def naca_camber(camber: float, place: float) -> Array | None:
    """The mean line (k, 2), x/c and z/c: two parabolas that meet at `place`; None where flat.

    NACA Report 460, p. 4: z = m/p^2 (2 p x - x^2) ahead of p, m/(1-p)^2 (1 - 2p + 2 p x - x^2)
    behind.
    """
    if camber == 0.0:
        return None
    x = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _POINTS + 1)))
    x = np.unique(np.append(x, place))  # the curvature jumps there
    ahead = x <= place
    z = np.where(
        ahead,
        camber / place**2 * (2.0 * place * x - x * x),
        camber / (1.0 - place) ** 2 * (1.0 - 2.0 * place + 2.0 * place * x - x * x),
    )
    z[[0, -1]] = 0.0
    return frozen(np.column_stack([x, z]))
