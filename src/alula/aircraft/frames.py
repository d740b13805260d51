"""From the axes of drawings to body axes."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array, frozen

# Drawings measure x aft, y right, z up: body axes turned by half a revolution about y.
# Its own inverse; moments of inertia and Ixz stay, Ixy and Iyz change sign.
DESIGN_TO_BODY: Array = np.diag([-1.0, 1.0, -1.0])


def rotation(frame: str) -> Array:
    """The matrix (3, 3) from the frame 'body' or 'design' to body axes."""
    return DESIGN_TO_BODY if frame == "design" else np.eye(3)


def to_body(values: list[float], turn: Array) -> Array:
    """A vector (3,) of the file in body axes; turn: (3, 3) of `rotation`."""
    return frozen(turn @ np.array(values, dtype=np.float64))
