"""Fewer samples for the eye: the extremes of every stretch, never an average."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

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
    if dt.max() <= FACTOR * dt.min():  # so no step is far above the median
        return np.empty(0, dtype=np.intp)
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
    sought = [_Sought.of(column) for column in columns]
    fewest = max((most - len(always)) // (3 * len(columns)), 1)
    too_many = most if n <= 50 * most else fewest
    best = _kept(sought, fewest, always)
    while too_many - fewest > max(fewest // 16, 1):
        middle = (fewest + too_many) // 2
        tried = _kept(sought, middle, always)
        if len(tried) <= most:
            fewest, best = middle, tried
        else:
            too_many = middle
    return best


class _Sought(NamedTuple):
    """A column (n,) as its lowest and its highest samples are sought; None: nothing is missing."""

    low: Array
    high: Array
    missing: NDArray[np.bool_] | None

    @classmethod
    def of(cls, column: Array) -> _Sought:
        missing = np.isnan(column)
        if not missing.any():
            return cls(column, column, None)
        low, high = np.where(missing, np.inf, column), np.where(missing, -np.inf, column)
        return cls(low, high, missing)


def _kept(columns: Sequence[_Sought], stretches: int, always: Indices) -> Indices:
    n = len(columns[0].low)
    length = -(-n // stretches)
    first = length * np.arange(-(-n // length))  # of each stretch

    def pieces(values: NDArray[Any]) -> NDArray[Any]:
        # the last stretch is filled up with its last value, which changes no extreme
        full = np.empty(length * len(first), values.dtype)
        full[:n], full[n:] = values, values[-1]
        return full.reshape(len(first), length)

    keep = np.zeros(n, dtype=bool)
    keep[always] = True
    for low, high, missing in columns:
        lowest, highest = first + pieces(low).argmin(axis=1), first + pieces(high).argmax(axis=1)
        if missing is not None:
            gaps = pieces(missing)
            some, every = gaps.any(axis=1), gaps.all(axis=1)
            keep[(first + gaps.argmax(axis=1))[some]] = True
            lowest, highest = lowest[~every], highest[~every]
        keep[lowest] = keep[highest] = True
    return np.flatnonzero(keep).astype(np.intp)
