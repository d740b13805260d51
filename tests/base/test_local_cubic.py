"""The cubic through every sample's window: exact on cubics, whatever the stamps."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from alula.base.local_cubic import LocalCubic


def stamps(kind: str, n: int = 300) -> np.ndarray:
    t = 50.0 + 0.01 * np.arange(n)
    if kind == "gap":
        t[n // 2 :] += 0.04
    if kind == "jitter":
        t += 1e-3 * np.random.default_rng(0).uniform(-1, 1, n)
    return t


@pytest.mark.parametrize("kind", ["even", "gap", "jitter"])
def test_derivative_of_a_cubic_is_exact(kind: str) -> None:
    t = stamps(kind)
    s = t - 51.0
    found = LocalCubic(t).derivative(1e4 + s - 2 * s**2 + 3 * s**3)
    # 1e4 leaves 1e-12 in a reading, divided by the window's 0.08 s
    np.testing.assert_allclose(found, 1 - 4 * s + 9 * s**2, rtol=0, atol=1e-9)


@pytest.mark.parametrize("kind", ["even", "gap", "jitter"])
def test_matched_is_the_derivative_of_the_integral(kind: str) -> None:
    """What stands beside a derivative passed the same filter: both sides of dx/dt = y agree."""
    t = stamps(kind)
    y = np.cos(40.0 * t)
    x = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(t))])
    cubic = LocalCubic(t, 0.2)
    np.testing.assert_allclose(cubic.matched(y), cubic.derivative(x), rtol=0, atol=1e-10)


def test_shared_weights_are_those_of_each_window() -> None:
    """Stamps a little uneven take weights of their own: the same numbers, by the other way."""
    even = stamps("even")
    own = even + 3e-8 * np.random.default_rng(1).uniform(-1, 1, len(even))  # 3e-6 of an interval
    x = np.sin(3.0 * even)
    a, b = LocalCubic(even, 0.3), LocalCubic(own, 0.3)
    # the weights themselves change by as much as the stamps
    np.testing.assert_allclose(a.derivative(x), b.derivative(x), rtol=0, atol=1e-5)
    assert a.derivative_se(x) == pytest.approx(b.derivative_se(x), rel=1e-4)


def test_one_missing_reading_spoils_only_its_windows() -> None:
    t = stamps("even")
    x = np.sin(t)
    x[100] = np.nan
    found = LocalCubic(t).derivative(x)
    assert np.flatnonzero(np.isnan(found)).tolist() == list(range(94, 107))  # 0.12 s


def test_a_long_record_takes_memory_by_its_length() -> None:
    """A minute at 800 Hz with windows of 401 samples: weights for each would take 600 MB."""
    t = np.arange(48_000) / 800.0
    x = np.sin(t)
    tracemalloc.start()
    cubic = LocalCubic(t, 0.5)
    cubic.derivative(x)
    cubic.derivative_se(x)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 50e6
