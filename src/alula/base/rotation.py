"""Vectors from Earth to body axes by Euler angles."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array


def rotated(phi: Array, theta: Array, psi: Array, v_E: Array) -> Array:
    """v_B = R_BE v_E for each sample, (n, 3); v_E (n, 3), Euler angles 3-2-1 (n,), rad."""
    sp, cp, st, ct, sy, cy = (f(a) for a in (phi, theta, psi) for f in (np.sin, np.cos))
    along, across = v_E[:, 0] * cy + v_E[:, 1] * sy, v_E[:, 1] * cy - v_E[:, 0] * sy
    tilted = along * st + v_E[:, 2] * ct
    return np.column_stack(
        [along * ct - v_E[:, 2] * st, across * cp + tilted * sp, tilted * cp - across * sp]
    )
