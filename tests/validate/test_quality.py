"""Measures of match: Theil's parts on signals whose error is of one kind only."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from alula.validate import quality

T = np.linspace(0.0, 2.0 * np.pi, 1000, endpoint=False)
WAVE = np.sin(3.0 * T)  # whole periods: mean zero, mean square one half


@given(
    st.integers(0, 2**32 - 1),
    st.floats(0.1, 10.0),
    st.floats(-5.0, 5.0),
    st.floats(1e-3, 3.0),
    st.floats(-1e3, 1e3),
)
def test_parts_sum_to_one(seed: int, gain: float, bias: float, noise: float, level: float) -> None:
    random = np.random.default_rng(seed)
    measured = level + WAVE
    q = quality(measured, level + gain * WAVE + bias + noise * random.standard_normal(len(T)))
    # cancellation of the level in the variances: 1e6 times the machine's precision at most
    assert q.bias + q.variance + q.covariance == pytest.approx(1.0, abs=1e-6)
    assert min(q.bias, q.variance, q.covariance) >= -1e-6
    assert 0.0 <= q.theil <= 1.0


def test_a_bias_is_all_bias() -> None:
    q = quality(WAVE, WAVE + 0.3)
    assert (q.bias, q.variance, q.covariance) == pytest.approx((1.0, 0.0, 0.0), abs=1e-12)
    assert q.rms == pytest.approx(0.3)
    assert q.r2 == pytest.approx(1.0 - 0.09 / 0.5)
    assert q.rrmse == pytest.approx(0.3 / np.ptp(WAVE))
    # by hand: rms(e) over the sum of the rms about the measured mean, sqrt(1/2) and sqrt(0.59)
    assert q.theil == pytest.approx(0.3 / (math.sqrt(0.5) + math.sqrt(0.59)))


def test_a_wrong_amplitude_is_all_variance() -> None:
    q = quality(WAVE, 1.5 * WAVE)
    assert (q.bias, q.variance, q.covariance) == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)


def test_a_quarter_period_late_is_all_covariance() -> None:
    q = quality(WAVE, -np.cos(3.0 * T))
    assert (q.bias, q.variance, q.covariance) == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)
    assert q.theil == pytest.approx(math.sqrt(0.5))  # rms(e) = 1 over twice sqrt(1/2)


def test_perfect_and_opposite() -> None:
    assert quality(WAVE, WAVE).theil == 0.0
    assert math.isnan(quality(WAVE, WAVE).bias)
    assert quality(WAVE, -WAVE).theil == pytest.approx(1.0)


def test_a_trim_value_does_not_hide_an_error() -> None:
    """Airspeed: 1 m/s of error on 1 m/s of motion at 100 m/s is no match."""
    assert quality(100.0 + WAVE, 100.0 - WAVE).theil == pytest.approx(1.0)


def test_a_channel_without_variation_has_no_share_to_explain() -> None:
    q = quality(np.ones(10), np.zeros(10))
    assert math.isnan(q.r2)
    assert math.isnan(q.rrmse)
    assert q.rms == 1.0
