"""The array type that every stage passes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def frozen(values: Any) -> Array:
    """A float64 copy that cannot be written to, so that a value handed on stays what it was."""
    out = np.array(values, dtype=np.float64)
    out.setflags(write=False)
    return out
