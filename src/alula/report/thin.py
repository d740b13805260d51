"""Fewer samples for the eye: the extremes of every stretch, never an average."""

from __future__ import annotations

from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.flight.gaps import FACTOR

Indices = np.ndarray[Any, np.dtype[np.intp]]


def breaks(t: Array) -> Indices:
    """Indices (k,) of the samples of t (n,) before which time was lost: no curve leads there.

    To be found in the data's own times, before any are left out for the eye.
    """
    if len(t) < 3:
        return np.empty(0, dtype=np.intp)
    dt = np.diff(t)
    return np.flatnonzero(dt > FACTOR * np.median(dt)).astype(np.intp) + 1


def kept_breaks(at: Indices, keep: Indices) -> Indices:
    """Where the breaks `at` (k,) lie among the samples that are kept: indices into `keep`."""
    return np.unique(np.searchsorted(keep, at)).astype(np.intp)


def kept_samples(
    columns: tuple[Array, ...], most: int, at: Indices | None = None
) -> Indices | None:
    """Indices (k,), increasing, k <= most or None where all samples of the columns (n,) are kept.

    Each stretch keeps the sample where each column is lowest and where it is highest, so a spike
    of one sample is still seen; the first and last sample are always kept, and those on either
    side of the breaks `at` unless these are very many. Only recorded samples are chosen, nothing
    is averaged. A stretch with a missing value keeps its first missing one, so a gap is still
    seen as a gap.
    """
    n = len(columns[0])
    if n <= most:
        return None
    always = np.array([0, n - 1])
    if at is not None and 8 * len(at) <= most:
        always = np.concatenate([always, at - 1, at])
    # Columns often have their extremes at the same sample, so more stretches fit than could be
    # promised: the most of them that stay within `most` are searched for, unless so many samples
    # are left out that the search would take longer than its gain is worth.
    fewest = max((most - len(always)) // (3 * len(columns)), 1)
    too_many = most if n <= 50 * most else fewest
    best = _kept(columns, fewest, always)
    while too_many - fewest > max(fewest // 16, 1):
        middle = (fewest + too_many) // 2
        tried = _kept(columns, middle, always)
        if len(tried) <= most:
            fewest, best = middle, tried
        else:
            too_many = middle
    return best


def _kept(columns: tuple[Array, ...], stretches: int, always: Indices) -> Indices:
    n = len(columns[0])
    length = -(-n // stretches)
    first = length * np.arange(-(-n // length))  # of each stretch
    keep = [always]
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
