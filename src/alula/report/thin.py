"""Fewer samples for the eye: the extremes of every stretch, never an average."""

from __future__ import annotations

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
    stretches = max((most - 2) // (3 * len(columns)), 1)
    length = -(-n // stretches)
    first = length * np.arange(-(-n // length))  # of each stretch
    keep = [np.array([0, n - 1])]
    for column in columns:
        # the last stretch is filled up with its last value, which changes no extreme
        pieces = np.pad(column, (0, length * len(first) - n), "edge").reshape(len(first), length)
        missing = np.isnan(pieces)
        keep += [
            (first + np.argmin(np.where(missing, np.inf, pieces), axis=1))[~missing.all(axis=1)],
            (first + np.argmax(np.where(missing, -np.inf, pieces), axis=1))[~missing.all(axis=1)],
            (first + np.argmax(missing, axis=1))[missing.any(axis=1)],
        ]
    return np.unique(np.concatenate(keep)).astype(np.intp)
