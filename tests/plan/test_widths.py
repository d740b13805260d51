"""Step lengths: against the spectra of the inputs themselves."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.plan.widths import DOUBLET, STEPS_3211, timing
from alula.simulate import doublet, input_3211
from alula.simulate.modes import Mode


def spectrum(values: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
    n = 64 * len(values)
    return 2 * np.pi * np.fft.rfftfreq(n, dt), np.abs(np.fft.rfft(values, n)) ** 2


def test_a_doublet_has_its_peak_at_the_mode() -> None:
    dt = 1e-3
    w, power = spectrum(doublet(1.0, 0.0, 1.0).value(np.arange(0.0, 3.0, dt)), dt)
    # The grid of frequencies is 0.03 rad/s fine.
    assert w[np.argmax(power)] == pytest.approx(DOUBLET, abs=0.04)


def test_a_3211_is_strong_about_the_mode() -> None:
    dt = 1e-3
    w, power = spectrum(input_3211(1.0, 0.0, 1.0).value(np.arange(0.0, 9.0, dt)), dt)
    strong = w[power > 0.5 * power.max()]
    low, high = strong.min(), strong.max()
    assert low == pytest.approx(0.28, abs=0.02)
    assert high == pytest.approx(2.65, abs=0.02)
    # In the upper part of the band, where a third of error either way stays in it.
    assert low < 0.67 * STEPS_3211 < 1.33 * STEPS_3211 < high


MODES = (
    Mode("roll", "roll", complex(-8.0, 0.0)),
    Mode("short_period", "short_period", complex(-3.0, 4.0)),
    Mode("dutch_roll", "dutch_roll", complex(-0.5, 2.0)),
)


def test_the_control_chooses_the_mode() -> None:
    assert timing("de", "doublet", MODES).width == pytest.approx(DOUBLET / 5.0)
    assert timing("de", "3211", MODES).width == pytest.approx(STEPS_3211 / 5.0)
    assert timing("dr", "doublet", MODES).frequency == pytest.approx(np.hypot(0.5, 2.0))
    assert timing("da", "bank_to_bank", MODES).width == pytest.approx(3.0 / 8.0)


def test_a_mode_in_two_parts_has_the_frequency_of_its_polynomial() -> None:
    parts = (
        Mode("short_period_1", "short_period", complex(-8.0, 0.0)),
        Mode("short_period_2", "short_period", complex(-2.0, 0.0)),
    )
    assert timing("de", "doublet", parts).frequency == pytest.approx(4.0)


def test_no_mode_no_width() -> None:
    with pytest.raises(BadInput, match="dutch_roll"):
        timing("dr", "doublet", MODES[:2])
