"""Allan variance: closed forms, parameters of simulated noise, still logs that move."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.navigate.calibration import axis_noise
from alula.navigate.calibration.allan import (
    allan_variance,
    averaging_lengths,
    expected,
    frequencies,
    transfer,
)
from alula.navigate.calibration.stillness import still_parts

RATE = 100.0


def sensor(seed: int, n: int, N: float, B: float = 0.0, K: float = 0.0) -> np.ndarray:
    """White noise, flicker noise (by its spectrum B^2/(2 pi f)) and a random walk."""
    rng = np.random.default_rng(seed)
    y = N * np.sqrt(RATE) * rng.standard_normal(n)
    y += np.cumsum(K / np.sqrt(RATE) * rng.standard_normal(n))
    f = np.fft.rfftfreq(2 * n)
    flicker = np.zeros_like(f)
    flicker[1:] = B / np.sqrt(2.0 * np.pi * f[1:])
    return y + np.fft.irfft(np.fft.rfft(rng.standard_normal(2 * n)) * flicker, 2 * n)[:n]


def test_allan_variance_by_its_definition() -> None:
    y = np.random.default_rng(0).standard_normal(64)
    (found,) = allan_variance(y, np.array([4.0]))
    means = np.convolve(y, np.ones(4) / 4, "valid")
    assert found == pytest.approx(0.5 * np.mean((means[4:] - means[:-4]) ** 2), rel=1e-12)


def test_expected_variances_are_the_closed_forms() -> None:
    """White N2/tau; a random walk's K2 tau/3 (1 + 1/(2 m2)), exact in samples."""
    m = averaging_lengths(1 << 14)
    f, dt = frequencies(1 << 14), 1.0 / RATE
    gain, tau = transfer(m, f), m * dt
    white = expected(gain, np.ones_like(f) / dt, f)
    walk = expected(gain, dt / (2.0 * np.sin(np.pi * f)) ** 2, f)
    # 16000 frequencies on an integrand that swings: 2 %, a fifth of the best estimate's error
    np.testing.assert_allclose(white, 1.0 / tau, rtol=0.02)
    np.testing.assert_allclose(walk, tau / 3.0 * (1.0 + 0.5 / m**2), rtol=0.02)
    flicker = expected(gain, 0.5 / (np.pi * f), f)
    np.testing.assert_allclose(flicker[4:], 2.0 * np.log(2.0) / np.pi, rtol=0.02)


@pytest.mark.parametrize(
    ("N", "B", "K"),
    [(1e-3, 0.0, 0.0), (1e-3, 3e-3, 0.0), (1e-3, 0.0, 2e-4)],
    ids=["white", "flicker", "walk"],
)
def test_noise_inside_its_intervals(N: float, B: float, K: float) -> None:
    found = [axis_noise(sensor(s, 1 << 15, N, B, K), RATE, "rad/s") for s in range(20)]
    for k, truth in enumerate((N, B, K)):
        inside = [a.parameters[k].ci95[0] <= truth <= a.parameters[k].ci95[1] for a in found]
        # 95 % intervals: 15 or fewer of 20 inside has probability 0.003
        assert sum(inside) > 15, a_name(k)
    assert np.mean([a["white_noise"].value for a in found]) == pytest.approx(N, rel=0.02)
    assert found[0].sigma == pytest.approx(N * np.sqrt(RATE), rel=0.05)


def a_name(k: int) -> str:
    return ("white noise", "bias instability", "random walk")[k]


def test_what_the_record_does_not_show_has_a_bound() -> None:
    found = axis_noise(sensor(1, 1 << 15, 1e-3), RATE, "rad/s")
    walk = found["random_walk"]
    assert walk.verdict == "weak"
    assert walk.value <= found.upper[2] < 2e-4


def test_sensor_with_a_low_pass_is_a_misfit() -> None:
    y = sensor(0, 1 << 15, 1e-3)
    found = axis_noise(np.convolve(y, np.ones(6) / 6, "valid"), RATE, "rad/s")
    assert [m.code for m in found.messages] == ["allan_misfit"]


def test_still_log_that_moves_is_refused() -> None:
    y = sensor(0, 6000, 1e-3)
    knocked, turned, holed = y.copy(), y.copy(), y.copy()
    knocked[3000:3050] += 0.5
    turned[4000:] += 1.0
    holed[17] = np.nan
    for bad in (knocked, turned):
        with pytest.raises(BadInput, match="still_log_moves"):
            axis_noise(bad, RATE, "rad/s")
    with pytest.raises(BadInput, match="not_finite"):
        axis_noise(holed, RATE, "rad/s")
    with pytest.raises(BadInput, match="too_few_samples"):
        axis_noise(y[:300], RATE, "rad/s")
    with pytest.raises(BadInput, match="dead_sensor"):
        axis_noise(np.zeros(6000), RATE, "rad/s")


def test_rests_are_found_between_the_turns() -> None:
    """Three positions of 5 s, with 2 s of handling between."""
    rng = np.random.default_rng(0)
    t = np.arange(0.0, 19.0, 0.01)
    f = np.zeros((len(t), 3))
    f[t < 5] = [0, 0, -9.81]
    f[(t >= 7) & (t < 12)] = [9.81, 0, 0]
    f[t >= 14] = [0, 9.81, 0]
    moving = ((t >= 5) & (t < 7)) | ((t >= 12) & (t < 14))
    f[moving] = 5.0 * rng.standard_normal((moving.sum(), 3))
    f += 0.02 * rng.standard_normal(f.shape)
    found = still_parts(t, f, 2.0)
    assert len(found) == 3
    for (start, end), (low, high) in zip(found, ((0, 5), (7, 12), (14, 19)), strict=True):
        assert low <= start < end <= high
        assert end - start > 2.5
