"""Fewer samples for the eye: the extremes of every stretch, never an average."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from alula.base.arrays import Array


def kept_samples(
    columns: tuple[Array, ...], most: int
) -> np.ndarray[Any, np.dtype[np.intp]] | None:
    """Indices (k,), increasing, k <= most or None where all samples of the columns (n,) are kept.

    Each stretch keeps the sample where each column is lowest and where it is highest, so a spike
    of one sample is still seen; the first and last sample are always kept. Only recorded samples
    are chosen, nothing is averaged. A stretch with a missing value keeps its first missing one,
    so a gap is still seen as a gap.
    """
    n = len(columns[0])
    if n <= most:
        return None
    per_stretch = 3 * len(columns)
    stretches = max((most - 2) // per_stretch, 1)
    edges = np.linspace(0, n, stretches + 1).astype(np.intp)
    keep = {0, n - 1}
    for low, high in pairwise(edges.tolist()):
        for column in columns:
            piece = column[low:high]
            missing = np.isnan(piece)
            if missing.any():
                keep.add(int(low + np.argmax(missing)))
            if not missing.all():
                keep.update((int(low + np.nanargmin(piece)), int(low + np.nanargmax(piece))))
    return np.array(sorted(keep), dtype=np.intp)
