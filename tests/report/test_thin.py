"""Thinning for the eye keeps what the eye must see."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from alula.report.figures import Figure, FigureStore, Line, Panel
from alula.report.thin import breaks, kept_breaks, kept_samples


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


def test_a_break_stays_between_the_same_two_samples() -> None:
    t = np.concatenate([np.arange(0.0, 40.0, 0.01), np.arange(45.0, 90.0, 0.01)])
    at = breaks(t)
    assert at.tolist() == [4000]  # the first sample after the five seconds without any
    keep = kept_samples((np.sin(t),), 300, at)
    assert keep is not None
    (k,) = kept_breaks(at, keep)
    assert keep[k - 1 : k + 1].tolist() == [3999, 4000]


def test_one_lost_sample_is_no_break() -> None:
    t = np.delete(np.arange(0.0, 10.0, 0.01), [300, 301])  # two intervals are bridged by a line
    assert breaks(t).tolist() == []


def test_what_is_left_out_for_the_eye_is_no_gap() -> None:
    """Steps between the samples of a thinned curve differ widely; none of them is a gap."""
    t = np.linspace(0.0, 20.0, 2001)
    store = FigureStore(300)
    panel = Panel("y", (Line("y", np.sin(t) * np.exp(-t / 5), "estimate"),))
    assert "samples" in store.add(Figure("smooth", "m", t, (panel,)))
    carried = store._figures[0]["t"]
    assert carried["breaks"] == []


def test_the_budget_is_used() -> None:
    random = np.random.default_rng(3)
    keep = kept_samples(tuple(random.standard_normal((6, 20_000))), 2000)
    assert keep is not None
    assert len(keep) > 1500  # the promise alone, three samples per column, would keep about 1300
