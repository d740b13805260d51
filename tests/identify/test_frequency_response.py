"""Frequency responses against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

from alula.base.messages import BadInput
from alula.identify.frequency.response import frequency_responses, multisine_responses

DT, N = 0.02, 6000
NUM, DEN = [3.0, 6.0], [1.0, 1.6, 9.0]  # 3 (s + 2) / (s^2 + 1.6 s + 9)


def exact(f):
    s = 2j * np.pi * f
    return np.polyval(NUM, s) / np.polyval(DEN, s)


def through(u, t):
    return signal.lsim((NUM, DEN), u, t)[1]


def sweep(t):
    return signal.chirp(t, 0.05, t[-1], 2.5, method="linear")


def test_sweep_without_noise_is_the_closed_form():
    """Segments of 40 s resolve 0.05 Hz against a mode 0.25 Hz wide: some per cent near it. Below
    0.6 Hz the sweep lies within the first segment's taper and is seen less well.
    """
    t = DT * np.arange(N)
    u = sweep(t)
    (found,) = frequency_responses(
        t, {"de": u}, "q", through(u, t), segment_s=40.0, band_hz=(0.6, 2.2)
    )
    error = np.abs(found.response / exact(found.frequency) - 1.0)
    assert np.median(error) < 0.01
    assert error.max() < 0.05
    assert found.coherence.min() > 0.98


def test_error_bars_are_the_scatter():
    """40 draws of white noise: Bendat and Piersol's formula against the scatter of gain and phase.

    Pooled over 60 frequencies, many of them correlated, the ratio is known to about 5 %.
    """
    t = DT * np.arange(N)
    u = sweep(t)
    y = through(u, t)
    gains, phases, errors = [], [], []
    for seed in range(40):
        noise = 0.5 * np.random.default_rng(seed).standard_normal(N)
        (found,) = frequency_responses(t, {"de": u}, "q", y + noise, segment_s=12.0,
                                       band_hz=(0.2, 2.0))  # fmt: skip
        gains.append(np.log(np.abs(found.response)))
        phases.append(found.phase)
        errors.append(found.gain_error**2)
    formula = np.mean(errors, axis=0)
    for drawn in (gains, phases):
        ratio = np.mean(np.var(drawn, axis=0, ddof=1)) / np.mean(formula)
        assert 0.75 < ratio < 1.25


def test_noise_alone_has_little_coherence_and_wide_bars():
    rng = np.random.default_rng(0)
    t = DT * np.arange(N)
    x, y = rng.standard_normal((2, N))
    (found,) = frequency_responses(t, {"de": x}, "q", y, segment_s=6.0)
    # 39 half-overlapped segments: the coherence of independent noise is 1 / 37 on average
    assert np.mean(found.coherence) == pytest.approx(found.segments**-1, rel=0.2)
    assert np.median(found.gain_error) > 0.5
    assert not found.usable().any()


def test_two_inputs_at_once_are_separated():
    t = DT * np.arange(N)
    rng = np.random.default_rng(1)
    low = signal.butter(2, 0.1)
    a, b = signal.lfilter(*low, rng.standard_normal((2, N)))
    b = b + 0.5 * a  # correlated, yet no multiple
    y = through(a, t) - 2.0 * b
    both = frequency_responses(t, {"da": a, "dr": b}, "p", y, segment_s=20.0, band_hz=(0.2, 2.0))
    found = {r.input: r for r in both}
    gain = found["da"].response / exact(found["da"].frequency)
    assert np.median(np.abs(gain - 1.0)) < 0.03  # leakage of the window on random input
    np.testing.assert_allclose(found["dr"].response, -2.0, atol=0.2)


def test_multisines_are_exact_at_their_harmonics():
    """Settled response over whole periods: nothing leaks; sampled input held straight, as lsim."""
    period, per = 20.0, 1000
    t = DT * np.arange(5 * per)
    own = {"da": [3, 7, 11, 15], "dr": [5, 9, 13]}
    make = {k: sum(np.cos(2.0 * np.pi * h * t / period + h**2) for h in v) for k, v in own.items()}
    y = through(make["da"], t) + 0.4 * make["dr"]
    late = t >= 2.0 * period  # 40 s of the mode's 1.25 s time constant: settled to 1e-14
    found = multisine_responses(
        t[late], {k: v[late] for k, v in make.items()}, "p", y[late], period_s=period, harmonics=own
    )
    first, second = found
    # straight lines between samples weaken a harmonic by (w dt)^2 / 12 = 7e-4 at most
    np.testing.assert_allclose(first.response, exact(first.frequency), rtol=1e-3)
    np.testing.assert_allclose(second.response, 0.4, rtol=1e-9)
    assert first.segments == 3.0


def test_multisine_error_bars_are_the_scatter():
    period, per = 10.0, 500
    t = DT * np.arange(6 * per)
    own = [2, 4, 6, 8, 10, 12]
    u = sum(np.cos(2.0 * np.pi * h * t / period + h**2) for h in own)
    drawn, formula = [], []
    for seed in range(60):
        y = 2.0 * u + 2.0 * np.random.default_rng(seed).standard_normal(len(t))
        (r,) = multisine_responses(t, {"de": u}, "q", y, period_s=period, harmonics={"de": own})
        drawn.append(np.log(np.abs(r.response)))
        formula.append(r.gain_error**2)
    ratio = np.mean(np.var(drawn, axis=0, ddof=1)) / np.mean(formula)
    assert (
        0.75 < ratio < 1.3
    )  # 360 values know a variance to 8 %, five segments of each to 3 % more


def test_refusals():
    t = DT * np.arange(1000)
    u = np.sin(t)
    with pytest.raises(BadInput, match="too_few_segments"):
        frequency_responses(t, {"de": u}, "q", u, segment_s=19.0)
    with pytest.raises(BadInput, match="no_excitation"):
        frequency_responses(t, {"da": u, "dr": 2.0 * u}, "q", u, segment_s=2.0)
    with pytest.raises(BadInput, match="bad_signals"):
        frequency_responses(t**1.5, {"de": u}, "q", u)
    with pytest.raises(BadInput, match="bad_multisine"):
        multisine_responses(t, {"de": u}, "q", u, period_s=15.0, harmonics={"de": [1]})
