"""Fourier integrals of samples, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.identify.frequency.fourier import detrended, fourier_integral, harmonics


def closed_form(a, w, T):
    """Integral of exp(a t) exp(-j w t) over 0 to T."""
    s = a - 1j * w
    return (np.exp(s * T) - 1.0) / s


@pytest.mark.parametrize("frequencies", [np.linspace(0.05, 4.0, 40), np.array([0.01, 0.3, 2.2])])
def test_decaying_oscillation(frequencies):
    """exp(-0.4 t) cos(5 t) at 50 Hz. Cubics err by (5 rad/s dt)^4 / 20 = 5e-6 of the signal."""
    dt, n = 0.02, 501
    t = dt * np.arange(n)
    x = np.exp(-0.4 * t) * np.cos(5.0 * t)
    w = 2.0 * np.pi * frequencies
    T = t[-1]
    right = 0.5 * (closed_form(-0.4 + 5j, w, T) + closed_form(-0.4 - 5j, w, T))
    got = fourier_integral(x, dt, frequencies)
    np.testing.assert_allclose(got, right, atol=5e-6)
    plain = dt * np.exp(-1j * np.outer(w, t)) @ x
    assert np.abs(got - right).max() < 0.01 * np.abs(plain - right).max()


def test_cubic_is_exact_at_every_frequency_even_the_smallest():
    dt, n = 0.1, 31
    t = dt * np.arange(n)
    x = 1.0 - 2.0 * t + 0.5 * t**2 - 0.1 * t**3
    T = t[-1]
    zero = T - T**2 + T**3 / 6.0 - 0.025 * T**4
    assert fourier_integral(x, dt, np.array([0.0]))[0] == pytest.approx(zero, rel=1e-13)
    fine = np.linspace(0.0, T, 200_001)
    y = 1.0 - 2.0 * fine + 0.5 * fine**2 - 0.1 * fine**3
    for f in (1e-6, 0.3, 4.9):
        right = np.trapezoid(y * np.exp(-2j * np.pi * f * fine), fine)
        got = fourier_integral(x, dt, np.array([f]))[0]
        assert got == pytest.approx(right, abs=1e-8)  # of the trapezoidal rule


def test_derivative_and_ends():
    """The transform of dx/dt is j w X plus the ends: what estimation relies on."""
    dt, n = 0.02, 401
    t = dt * np.arange(n)
    x, rate = np.sin(3.0 * t + 0.4), 3.0 * np.cos(3.0 * t + 0.4)
    f = harmonics(t[-1], 0.2, 3.0)
    w = 2.0 * np.pi * f
    ends = x[-1] * np.exp(-1j * w * t[-1]) - x[0]
    np.testing.assert_allclose(
        fourier_integral(rate, dt, f), 1j * w * fourier_integral(x, dt, f) + ends, atol=2e-5
    )


def test_harmonics_see_no_constant():
    x = np.full(301, 3.0)
    f = harmonics(3.0, 0.0, 5.0)
    assert f[0] == pytest.approx(1.0 / 3.0)
    np.testing.assert_allclose(fourier_integral(x, 0.01, f), 0.0, atol=1e-12)


@pytest.mark.parametrize("how", ["ends", "line"])
def test_detrending_takes_a_line_and_is_linear(how):
    rng = np.random.default_rng(0)
    t = np.arange(50.0)
    np.testing.assert_allclose(detrended(2.0 + 0.3 * t, how), 0.0, atol=1e-12)
    x, y = rng.standard_normal((2, 50))
    np.testing.assert_allclose(
        detrended(2.0 * x - y, how), 2.0 * detrended(x, how) - detrended(y, how), atol=1e-12
    )


def test_too_high_a_frequency_is_refused():
    with pytest.raises(BadInput, match="half the sample rate"):
        fourier_integral(np.zeros(100), 0.02, np.array([30.0]))
