"""Smoothed local differentiation: exact for cubics, honest about noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from alula.reconstruct import differentiate

number = st.floats(-100.0, 100.0)


@settings(max_examples=50, deadline=None)
@given(st.tuples(number, number, number, number), st.integers(7, 60), st.integers(0, 2**31))
def test_cubic_is_exact_on_uneven_stamps(c, n, seed):
    rng = np.random.default_rng(seed)
    t = 1000.0 + np.cumsum(rng.uniform(0.015, 0.025, n))
    tau = t - t[0]
    x = c[0] + c[1] * tau + c[2] * tau**2 + c[3] * tau**3
    found = differentiate(t, x)
    # Rounding of the normal equations (condition 1e4 at the ends) and of x over 0.02 s.
    scale = 1e-9 * (1.0 + np.abs(c).sum())
    exact = c[1] + 2.0 * c[2] * tau + 3.0 * c[3] * tau**2
    np.testing.assert_allclose(found.rates, exact, atol=100.0 * scale, rtol=1e-7)
    assert found.se < 100.0 * scale


@pytest.mark.parametrize("window_s", [0.0, 0.3, 1.0])
def test_stated_error_is_that_of_white_noise(window_s):
    rng = np.random.default_rng(3)
    t = np.arange(4000) * 0.02
    found = differentiate(t, 2.0 + 0.5 * t + 0.1 * rng.standard_normal(len(t)), window_s)
    # 4000 samples in windows of 9 to 51: at least 80 independent ones, deviation of rms 8 %.
    assert np.std(found.rates - 0.5) == pytest.approx(found.se, rel=0.25)


def test_wider_window_less_noise():
    rng = np.random.default_rng(4)
    t = np.arange(1000) * 0.02
    x = rng.standard_normal(len(t))
    errors = [differentiate(t, x, w) for w in (0.2, 0.5, 1.0)]
    assert errors[0].se > errors[1].se > errors[2].se
    for asked, found in zip((0.2, 0.5, 1.0), errors, strict=True):
        assert found.window_s == pytest.approx(asked, abs=0.03)  # odd number of samples


def test_follows_motion_below_its_bandwidth():
    t = np.arange(500) * 0.02
    rate = differentiate(t, np.sin(2.0 * np.pi * t)).rates
    exact = 2.0 * np.pi * np.cos(2.0 * np.pi * t)
    inner = slice(5, -5)
    # 1 Hz in a window of 0.18 s: the cubic's error is of order (2 pi 0.09)^4/280 = 4e-4.
    assert np.abs(rate - exact)[inner].max() < 2e-3 * 2.0 * np.pi


def test_few_samples_fall_back_on_differences():
    found = differentiate(np.arange(3.0), np.array([0.0, 2.0, 4.0]))
    np.testing.assert_allclose(found.rates, 2.0)
    assert np.isnan(found.se)
    assert differentiate(np.zeros(1), np.ones(1)).rates.tolist() == [0.0]
