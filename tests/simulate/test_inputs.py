"""Control inputs are pure functions of time."""

from __future__ import annotations

import numpy as np
import pytest

from alula.simulate import Pulse, Steps, Sum, bank_to_bank, doublet, input_3211


def test_pulse() -> None:
    t = np.array([0.9, 1.0, 1.4, 1.5])
    np.testing.assert_array_equal(Pulse(2.0, 1.0, 0.5).value(t), [0.0, 2.0, 2.0, 0.0])


def test_doublet_has_no_mean() -> None:
    t = np.arange(0.0, 4.0, 0.001)
    values = doublet(0.1, 1.0, 0.5).value(t)
    assert values.sum() == pytest.approx(0.0, abs=1e-9)  # 500 samples up, 500 down
    assert set(np.round(values, 12)) == {-0.1, 0.0, 0.1}


def test_3211_has_its_widths() -> None:
    signal = input_3211(1.0, 2.0, 0.5)
    assert signal.end == pytest.approx(2.0 + 7 * 0.5)
    t = 2.0 + 0.5 * (np.arange(8) + 0.5)
    np.testing.assert_allclose(signal.value(t), [1, 1, 1, -1, -1, 1, -1, 0], atol=1e-12)


def test_bank_to_bank_comes_back() -> None:
    signal = bank_to_bank(0.1, 1.0, 0.8, hold=1.0)
    t = np.arange(0.0, 10.0, 0.001)
    bank = np.cumsum(signal.value(t)) * 0.001  # of an aircraft whose roll rate follows at once
    assert bank.max() == pytest.approx(0.08, abs=3e-4)  # three samples of 1e-4
    assert bank.min() == pytest.approx(-0.08, abs=3e-4)
    assert bank[-1] == pytest.approx(0.0, abs=3e-4)


def test_ramps_are_as_steep_as_asked() -> None:
    signal = doublet(1.0, 1.0, 0.5, ramp=0.1)
    t = np.arange(0.0, 3.0, 1e-4)
    # A half cosine through 2 in 0.1 s is steepest in its middle: pi/2 times the mean slope. The
    # chord over 1e-4 s, half a step off the middle, lies below it by (pi 1e-3)^2 / 6 at most.
    assert np.abs(np.diff(signal.value(t))).max() / 1e-4 == pytest.approx(np.pi / 2 * 20, rel=2e-6)
    assert signal.value(np.array([1.0, 1.05, 1.1])) == pytest.approx([0.0, 0.5, 1.0])


def test_sum_adds_a_constant() -> None:
    total = Sum((Pulse(1.0, 0.0, 1.0), Pulse(2.0, 0.5, 1.0)), constant=-1.0)
    np.testing.assert_array_equal(total.value(np.array([0.2, 0.7, 1.2, 2.0])), [0, 2, 1, -1])


def test_widths_and_levels_must_match() -> None:
    with pytest.raises(ValueError, match="widths"):
        Steps(1.0, 0.0, (1.0, 2.0), (1.0,))
