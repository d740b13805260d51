"""The core's 18 integrals, derived from the element's slopes, against those that Pusztai prints."""

from __future__ import annotations

import numpy as np
import pytest

from alula.core import core

HUB, HELIX, ALPHA_MAX = 0.15, 1.2, 0.25  # over the radius; rad
NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


def chord(r: np.ndarray) -> np.ndarray:
    """A straight taper from 0.15 to 0.06 of the radius."""
    return 0.15 - 0.09 * (r - HUB) / (1.0 - HUB)


def printed(J: float) -> np.ndarray:
    """Pusztai 2018, Eqs. (B.4), (B.5), in sin and cos, by one rule of 400 points a piece."""
    slope = HELIX - 2.0 * np.pi * J
    root = slope**2 - 8.0 * np.pi * HELIX * J * np.tan(ALPHA_MAX) ** 2
    stall = (slope + np.sqrt(root)) / (4.0 * np.pi * np.tan(ALPHA_MAX)) if root > 0.0 else 0.0
    edge = min(1.0, max(HUB, stall))
    out = np.zeros((6, 3))
    for column, (a, b) in enumerate(((HUB, edge), (edge, 1.0), (HUB, 1.0))):
        r = a + 0.5 * (NODES + 1.0) * (b - a)
        w = 0.25 * (b - a) * WEIGHTS * chord(r)  # the 1/2 before each integrand included
        u = np.arctan2(J, r)
        s, c, x = np.sin(u), np.cos(u), np.arctan2(HELIX / (2.0 * np.pi), r) - u
        q = J**2 + r**2
        terms = (
            (q * c, -r * s + J * c / 2, r * J * s + r**2 * c / 2,
             -q * s, -r * c - J * s / 2, r * J * c - r**2 * s / 2),
            (q * x * c, (-r * x - J / 2) * s + J * x * c / 2,
             (r * J * x - r**2 / 2) * s + r**2 * x * c / 2,
             -q * x * s, (-r * x - J / 2) * c - J * x * s / 2,
             (r * J * x - r**2 / 2) * c - r**2 * x * s / 2),
            (-q * x**2 * s, (-r * x**2 - J * x) * c - J * x**2 * s / 2,
             (r * J * x**2 - r**2 * x) * c - r**2 * x**2 * s / 2,
             -q * x**2 * c, -((-r * x**2 - J * x) * s + J * x**2 * c / 2),
             -((r * J * x**2 - r**2 * x) * s + r**2 * x**2 * c / 2)),
        )[column]  # fmt: skip
        for i, term in enumerate(terms):
            out[i, column] = np.sum(w * term * (r if i >= 3 else 1.0))
    return out


@pytest.mark.parametrize("J", [0.02, 0.06, 0.1, 0.25])
def test_all_eighteen(J: float) -> None:
    blade = core.BladeShape(
        2, 0.25, HUB, HELIX, np.array([HUB, 1.0]), np.array([0.15, 0.06]), np.zeros(2)
    )
    found = np.zeros((1, 18))
    core.blade_integrals(blade, ALPHA_MAX, np.array([J]), found)
    # Gauss's rules of both sides are converged: rounding is left
    assert found.reshape(6, 3) == pytest.approx(printed(J), rel=1e-9, abs=1e-13)
