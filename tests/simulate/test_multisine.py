"""Multisines: orthogonal over the period, of low peak, and with power where it was asked for."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.simulate.multisine import multisines, relative_peak_factor, schroeder

PERIOD, RATE = 20.0, 100.0
T = np.arange(0.0, PERIOD, 1.0 / RATE)


def test_orthogonal_over_the_period() -> None:
    signals = [s.value(T) for s in multisines((0.02, 0.05, 0.03), PERIOD, (0.1, 2.0))]
    power = np.array([[a @ b for b in signals] for a in signals])
    scale = np.sqrt(np.outer(np.diag(power), np.diag(power)))
    off = (power / scale)[~np.eye(3, dtype=bool)]
    assert np.max(np.abs(off)) < 1e-12  # 2000 products of rounding 1e-16


def test_orthogonal_in_frequency_too() -> None:
    signals = multisines((1.0, 1.0), PERIOD, (0.1, 2.0))
    spectra = [np.abs(np.fft.rfft(s.value(T))) / (len(T) / 2) for s in signals]
    for signal, spectrum in zip(signals, spectra, strict=True):
        own = np.zeros(len(spectrum), dtype=bool)
        own[list(signal.harmonics)] = True
        np.testing.assert_allclose(spectrum[own], signal.amplitudes, rtol=1e-9)
        assert np.max(spectrum[~own]) < 1e-12  # rounding
    assert not set(signals[0].harmonics) & set(signals[1].harmonics)
    assert set(signals[0].harmonics) | set(signals[1].harmonics) == set(range(2, 41))


def test_a_single_sine_is_the_reference_of_the_peak_factor() -> None:
    values = np.sin(2 * np.pi * T / PERIOD)
    assert relative_peak_factor(values) == pytest.approx(1.0, abs=1e-6)  # (1 - cos(pi/1000)) / 2
    assert np.max(np.abs(values)) / np.std(values) == pytest.approx(np.sqrt(2), abs=1e-5)


@pytest.mark.parametrize("controls", [1, 2, 3])
def test_phases_lower_the_peak(controls: int) -> None:
    for signal in multisines((1.0,) * controls, PERIOD, (0.1, 2.0)):
        k = np.array(signal.harmonics)
        fine = np.linspace(0.0, PERIOD, 20000, endpoint=False)
        begin = np.sin(2 * np.pi * np.outer(fine / PERIOD, k) + schroeder(len(k))).sum(axis=1)
        zero_phases = np.sin(2 * np.pi * np.outer(fine / PERIOD, k)).sum(axis=1)
        found = relative_peak_factor(signal.value(fine))
        assert found < relative_peak_factor(begin) < relative_peak_factor(zero_phases)
        # Morelli reaches 1.05 to 1.15 with five or more harmonics; a little room for the fewest.
        assert found < 1.2


def test_begins_and_ends_at_zero_within_its_amplitude() -> None:
    for signal in multisines((0.03, 0.06), PERIOD, (0.1, 2.0), start=2.0, cycles=2):
        ends = signal.value(np.array([1.99, 2.0, signal.end, signal.end + 0.01]))
        np.testing.assert_allclose(ends, 0.0, atol=1e-12)
        assert signal.end == 42.0
        top = np.max(np.abs(signal.value(np.arange(0.0, 45.0, 0.001))))
        peak = 0.03 if signal.harmonics[0] == 2 else 0.06
        assert top == pytest.approx(peak, rel=0.02)  # 16 points per period: (pi/16)^2/2 at most
        again = signal.value(T + 2.0)
        np.testing.assert_allclose(signal.value(T + 2.0 + PERIOD)[1:], again[1:], atol=1e-12)


def test_same_every_time() -> None:
    assert multisines((1.0, 2.0), 15.0, (0.1, 1.5)) == multisines((1.0, 2.0), 15.0, (0.1, 1.5))


def test_a_band_too_narrow_is_refused() -> None:
    with pytest.raises(BadInput) as refused:
        multisines((1.0, 1.0, 1.0), 10.0, (0.2, 0.3))
    assert "2 from 0.2 to 0.3 Hz" in str(refused.value)
