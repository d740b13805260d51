"""Thinning for the eye keeps what the eye must see."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from alula.report.thin import kept_samples


@given(st.integers(0, 2**32 - 1), st.integers(20, 3000), st.integers(10, 400))
def test_extremes_ends_and_count(seed: int, n: int, most: int) -> None:
    random = np.random.default_rng(seed)
    columns = (random.standard_normal(n), random.standard_normal(n).cumsum())
    keep = kept_samples(columns, most)
    if n <= most:
        assert keep is None
        return
    assert keep is not None
    assert len(keep) <= most
    assert np.all(np.diff(keep) > 0)
    assert keep[0] == 0
    assert keep[-1] == n - 1
    for column in columns:
        assert column[keep].min() == column.min()
        assert column[keep].max() == column.max()


def test_one_spike_and_a_hole_are_still_seen() -> None:
    smooth = np.sin(np.linspace(0, 9, 100_000))
    smooth[54_321] = 40.0
    smooth[70_000:80_000] = np.nan
    keep = kept_samples((smooth,), 700)
    assert keep is not None
    assert 54_321 in keep
    inside = keep[(keep > 70_000) & (keep < 80_000)]
    assert len(inside) > 10
    assert np.isnan(smooth[inside]).all()


def test_a_column_without_a_value() -> None:
    keep = kept_samples((np.full(5000, np.nan), np.arange(5000.0)), 100)
    assert keep is not None
    assert {0, 4999} <= set(keep.tolist())
