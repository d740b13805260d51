"""Sensors: errors with their stated size, places, own rates."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.simulate import (
    SensorError,
    every,
    flow_angles,
    readings,
    specific_force_at,
    velocity_at,
)


def test_noise_has_its_size_and_its_seed() -> None:
    truth, error = np.full(20000, 10.0), SensorError(scale=0.02, bias=0.3, sigma=0.5)
    a = readings(truth, error, np.random.default_rng(1))
    assert a.mean() == pytest.approx(10.5, abs=5 * 0.5 / np.sqrt(20000))  # five sigma of a mean
    assert a.std() == pytest.approx(0.5, rel=5 / np.sqrt(2 * 20000))  # five sigma of a deviation
    assert a.tobytes() == readings(truth, error, np.random.default_rng(1)).tobytes()


def test_quantization_rounds_to_steps() -> None:
    truth = np.linspace(-1.0, 1.0, 101)
    out = readings(truth, SensorError(step=0.25), np.random.default_rng(0))
    np.testing.assert_allclose(out / 0.25, np.round(out / 0.25), atol=1e-12)
    assert np.abs(out - truth).max() <= 0.125 + 1e-12


def test_accelerometer_away_from_the_center_of_gravity() -> None:
    # Against the second derivative of a position: p_S = R r for a body that turns about its CG,
    # here in yaw by psi(t) = sin t, where a = -psi'^2 r along it and psi'' r across.
    t = np.linspace(0.0, 6.0, 50)
    w, w_dot = np.zeros((50, 3)), np.zeros((50, 3))
    w[:, 2], w_dot[:, 2] = np.cos(t), -np.sin(t)
    f = specific_force_at(np.zeros((50, 3)), w, w_dot, [2.0, 0.0, 0.0])
    np.testing.assert_allclose(f[:, 0], -2.0 * np.cos(t) ** 2, atol=1e-14)
    np.testing.assert_allclose(f[:, 1], -2.0 * np.sin(t), atol=1e-14)


def test_vane_on_the_wing_feels_roll() -> None:
    # Rolling right (p > 0), the left wing (y < 0) rises: its vane sees a smaller angle.
    air, rates = np.array([[50.0, 0.0, 2.0]]), np.array([[1.0, 0.0, 0.0]])
    V, alpha, beta = flow_angles(velocity_at(air, rates, [0.0, -3.0, 0.0]))
    assert alpha[0] == pytest.approx(np.arctan2(2.0 - 3.0, 50.0), rel=1e-12)
    assert beta[0] == 0.0
    assert V[0] == pytest.approx(np.hypot(50.0, 1.0), rel=1e-12)


def test_own_rate() -> None:
    t = np.arange(0.0, 1.0, 0.01)
    np.testing.assert_array_equal(every(t, 10.0), np.arange(0, 100, 10))
    for rate in (200.0, 30.0):
        with pytest.raises(BadInput, match="sensor_rate"):
            every(t, rate)


def test_lag_follows_a_ramp_by_its_time_constant() -> None:
    t = np.arange(0.0, 10.0, 0.02)
    truth = np.where(t > 2.0, 3.0 * (t - 2.0), 0.0)
    out = readings(truth, SensorError(lag=0.5), np.random.default_rng(1), t)
    expected = np.where(t > 2.0, 3.0 * ((t - 2.0) - 0.5 * (1.0 - np.exp(-(t - 2.0) / 0.5))), 0.0)
    np.testing.assert_allclose(out, expected, atol=1e-12)  # exact where linear between samples


def test_lost_and_stuck_readings() -> None:
    t = np.arange(0.0, 100.0, 0.01)
    error = SensorError(sigma=0.1, loss=0.05, stuck=(20.0, 30.0))
    out = readings(t, error, np.random.default_rng(2), t)
    lost = np.isnan(out)
    # Binomial: 10000 trials of 0.05, five sigma.
    assert abs(lost.mean() - 0.05) < 5 * np.sqrt(0.05 * 0.95 / len(t))
    held = out[(t >= 20.0) & (t < 30.0 - 1e-9)]
    assert len(set(held[~np.isnan(held)])) == 1
    assert np.nanstd(out[t < 20.0] - t[t < 20.0]) > 0.08


def test_a_lag_without_time_is_refused() -> None:
    with pytest.raises(BadInput, match="time stamps"):
        readings(np.zeros(5), SensorError(lag=0.1), np.random.default_rng(1))
