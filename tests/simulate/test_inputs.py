"""Control inputs are pure functions of time."""

from __future__ import annotations

import numpy as np
import pytest

from alula.simulate import Pulse, Steps, Sum, bank_to_bank, doublet, input_3211
from alula.simulate.inputs import Delay, Sweep


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


def test_pulse_with_ramps() -> None:
    t = np.array([0.9, 1.05, 1.2, 1.55, 1.8])
    np.testing.assert_allclose(Pulse(2.0, 1.0, 0.5, ramp=0.1).value(t), [0, 1, 2, 1, 0], atol=1e-12)


@pytest.mark.parametrize("logarithmic", [False, True])
def test_sweep_runs_from_the_first_to_the_last_frequency(logarithmic: bool) -> None:
    sweep = Sweep(0.5, 2.0, 30.0, 0.2, 3.0, logarithmic)
    t = np.arange(2.0, 32.0, 1e-3)
    frequency = np.diff(sweep.cycles(t)) / 1e-3
    middle = np.sqrt(0.2 * 3.0) if logarithmic else 1.6  # at half of the time
    # The frequency changes by under 0.3 Hz/s; the last is that of 1.5 steps before the end.
    np.testing.assert_allclose(frequency[[0, 15000, -1]], [0.2, middle, 3.0], atol=5e-4)
    assert np.max(np.abs(sweep.value(t))) == pytest.approx(0.5, abs=1e-4)
    assert np.all(sweep.value(np.array([1.9, 2.0, 32.1])) == 0.0)


def test_sweep_has_its_power_in_its_band() -> None:
    t = np.arange(0.0, 100.0, 0.01)
    power = np.abs(np.fft.rfft(Sweep(1.0, 0.0, 100.0, 0.5, 2.0, fade=5.0).value(t))) ** 2
    f = np.fft.rfftfreq(len(t), 0.01)
    inside = power[(f >= 0.5) & (f <= 2.0)].sum() / power.sum()
    assert inside > 0.99  # what leaks is Fresnel's ripple beyond the ends


def test_sweep_fades() -> None:
    whole, faded = Sweep(1.0, 0.0, 20.0, 1.0, 2.0), Sweep(1.0, 0.0, 20.0, 1.0, 2.0, fade=4.0)
    t = np.arange(0.0, 20.0, 0.001)
    inside = (t >= 4.0) & (t <= 16.0)
    np.testing.assert_array_equal(whole.value(t)[inside], faded.value(t)[inside])
    first = t < 1.0  # a quarter of the fade: (1 - cos(pi/4))/2
    assert np.max(np.abs(faded.value(t)[first])) < 0.15
    assert faded.value(np.array([20.0]))[0] == pytest.approx(0.0, abs=1e-12)


def test_sweep_that_cannot_be_is_refused() -> None:
    with pytest.raises(ValueError, match="fades"):
        Sweep(1.0, 0.0, 5.0, 1.0, 2.0, fade=3.0)
    with pytest.raises(ValueError, match="above zero"):
        Sweep(1.0, 0.0, 5.0, 0.0, 2.0)


def test_delay_and_sum() -> None:
    t = np.arange(0.0, 10.0, 0.01)
    one = doublet(1.0, 1.0, 0.5)
    late = Delay(one, 2.0).value(t)
    np.testing.assert_allclose(late, doublet(1.0, 3.0, 0.5).value(t), atol=1e-12)
    both = Sum((one, Delay(one, 2.0)), 0.25).value(t)
    np.testing.assert_allclose(both, 0.25 + one.value(t) + late, atol=1e-12)
