"""Coefficients and derivatives of the lattice in the axes that others use.

- 'body': CX CY CZ Cl Cm Cn and rates along body axes.
- 'model': CD CY CL, moments and rates along body axes: what an aerodynamic model of Alula with
  stability axes holds.
- 'stability': forces, moments and rates along stability axes (x into the wind's projection on the
  plane of symmetry), as AVL's derivative file.

Angles and controls per rad, rates per hat (p b/2V, q c/2V, r b/2V).
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from alula.base.arrays import Array

LatticeAxes = Literal["body", "model", "stability"]
BODY = ("CX", "CY", "CZ", "Cl", "Cm", "Cn")
STABILITY = ("CD", "CY", "CL", "Cl", "Cm", "Cn")
MOTIONS = ("alpha", "beta", "p", "q", "r")


def coefficient_names(axes: LatticeAxes) -> tuple[str, ...]:
    """The six coefficients of these axes, in order."""
    return BODY if axes == "body" else STABILITY


def turned(
    coefficients: Array, derivatives: Array, alpha: float, axes: LatticeAxes
) -> tuple[Array, Array]:
    """Body coefficients (6,) and derivatives (6, 5 + controls) in other axes.

    The derivatives to alpha count that the axes turn with it; rates about stability axes are held
    where these turn.
    """
    if axes == "body":
        return coefficients, derivatives
    c, s = np.cos(alpha), np.sin(alpha)
    turn = np.eye(6)
    turn[0, 0], turn[0, 2], turn[2, 0], turn[2, 2] = -c, -s, s, -c
    slope = np.zeros((6, 6))
    slope[0, 0], slope[0, 2], slope[2, 0], slope[2, 2] = s, -c, c, s
    if axes == "stability":
        turn[3, 3], turn[3, 5], turn[5, 3], turn[5, 5] = c, s, -s, c
        slope[3, 3], slope[3, 5], slope[5, 3], slope[5, 5] = -s, c, -c, -s
    out = turn @ derivatives
    out[:, 0] += slope @ coefficients
    if axes == "stability":
        p, r = out[:, 2].copy(), out[:, 4].copy()
        out[:, 2], out[:, 4] = c * p + s * r, c * r - s * p
    return turn @ coefficients, out
