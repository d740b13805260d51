"""Attitude from two vectors, wind, power train, field model."""

from __future__ import annotations

from datetime import date
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.aircraft.propulsion import ElectricMotor
from alula.base.messages import BadInput
from alula.navigate import (
    air_from_wind,
    attitude_from_vectors,
    gravity_seen,
    power_train,
    quaternion,
    rotations,
    wind_from,
)
from alula.navigate.field import world_magnetic_model
from alula.navigate.result import euler_angles
from navigate.recordings import FIELD, G, turning

AIRCRAFT = Path(__file__).parents[2] / "aircraft"


def test_attitude_from_vectors_in_a_turn() -> None:
    motion = turning(40.0, rate=10.0)
    R = rotations(motion.q)
    v = np.einsum("nij,nj->ni", R, motion.velocity)
    seen = attitude_from_vectors(
        gravity_seen(motion.force, motion.rate, v), np.einsum("nij,j->ni", R, FIELD), FIELD
    )
    assert seen.valid.all()
    assert seen.heading.all()
    d = seen.euler - motion.euler
    assert np.abs((d + np.pi) % (2.0 * np.pi) - np.pi).max() < 1e-9
    np.testing.assert_allclose(seen.gain, 1.0, atol=1e-9)
    # not corrected, gravity lies along the body's z: level, and too strong
    plain = attitude_from_vectors(-motion.force, np.einsum("nij,j->ni", R, FIELD), FIELD)
    assert np.all(plain.gain == 0.0)


@pytest.mark.parametrize("theta", [0.5 * np.pi, -0.5 * np.pi, 1.5707, -1.5, 0.3, 0.0])
def test_angles_of_any_attitude_are_that_attitude(theta: float) -> None:
    """At 90 deg of pitch too, whatever the quaternion's sign; beside the matrix of three turns."""
    for phi, psi in ((0.3, 0.7), (-2.9, 3.0), (0.0, -1.2), (3.1, 0.1)):
        q = quaternion(phi, theta, psi)
        for sign in (1.0, -1.0):
            euler = euler_angles(sign * q[None])[0]
            back = rotations(quaternion(*euler)[None])[0]
            # rounding of a quaternion's components, which angles near the vertical do not widen
            np.testing.assert_allclose(back, rotations(q[None])[0], atol=5e-15)
            assert np.abs(euler).max() <= np.pi
            if abs(theta) < 1.51:
                np.testing.assert_allclose(euler, (phi, theta, psi), atol=1e-13)


def test_sign_of_a_quaternion_means_nothing() -> None:
    q = np.array([quaternion(0.2, 0.1, 1.0)] * 3)
    flipped = q * np.array([[1.0], [-1.0], [1.0]])
    velocity, air = np.tile([20.0, 5.0, 1.0], (3, 1)), np.tile([25.0, 0.05, 0.0], (3, 1))
    one, other = wind_from(velocity, q, air), wind_from(velocity, flipped, air)
    np.testing.assert_array_equal(one.wind, other.wind)
    np.testing.assert_array_equal(one.covariance, other.covariance)
    cov = np.diag([0.1, 0.1, 0.1])
    for a, b in zip(
        (air_from_wind(velocity, q, one.mean, cov)).__dict__.values(),
        (air_from_wind(velocity, flipped, one.mean, cov)).__dict__.values(),
        strict=True,
    ):
        np.testing.assert_array_equal(a, b)


def test_wind_with_its_covariance() -> None:
    """What it says of its errors is what they are, over drawn ones."""
    random = np.random.default_rng(3)
    n = 4000
    q = np.tile(np.array([np.cos(0.4), 0.0, 0.0, np.sin(0.4)]), (n, 1))
    air = np.tile([25.0, 0.06, 0.03], (n, 1))
    v = air[:, :1] * np.column_stack(
        [np.cos(air[:, 1]) * np.cos(air[:, 2]), np.sin(air[:, 2]),
         np.sin(air[:, 1]) * np.cos(air[:, 2])]
    )  # fmt: skip
    wind = np.array([4.0, -6.0, 0.5])
    velocity = np.einsum("nji,nj->ni", rotations(q), v) + wind
    sv, st, sa = (0.2, 0.2, 0.4), (0.01, 0.02, 0.03), (0.5, 0.01, 0.02)
    turn = 0.5 * random.standard_normal((n, 3)) * st
    small = np.column_stack([np.ones(n), turn])
    w, x, y, z = q.T
    a, b, c, d = small.T
    turned = np.column_stack(
        [w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
         w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a]
    )  # fmt: skip
    found = wind_from(
        velocity + random.standard_normal((n, 3)) * sv, turned,
        air + random.standard_normal((n, 3)) * sa,
        sigma_velocity=sv, sigma_turn=st, sigma_air=sa,
    )  # fmt: skip
    error = found.wind - wind
    nees = np.einsum("ni,ni->n", error, np.linalg.solve(found.covariance, error[..., None])[..., 0])
    # mean of 4000 chi-squares of 3: standard error 0.04; second order of the angles besides
    assert abs(nees.mean() - 3.0) < 0.2
    assert np.all(np.abs(found.mean - wind) < 4.0 * np.sqrt(np.diag(found.mean_covariance)))
    back = air_from_wind(velocity, q, wind, np.diag([0.01, 0.01, 0.01]))
    np.testing.assert_allclose(np.column_stack([back.V, back.alpha, back.beta]), air, atol=1e-9)
    assert np.all(back.se_V > 0.1)


def test_wind_needs_an_airspeed() -> None:
    q = np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))
    air = np.array([[0.0, 0.0, 0.0], [np.nan, 0.0, 0.0], [20.0, 0.0, 0.0]])
    found = wind_from(np.zeros((3, 3)), q, air)
    assert np.isnan(found.wind[:2]).all()
    np.testing.assert_allclose(found.wind[2], [-20.0, 0.0, 0.0])
    assert np.isfinite(found.mean).all()
    assert np.isnan(air_from_wind(np.zeros((3, 3)), q, np.zeros(3), np.eye(3)).V).all()


def motor() -> ElectricMotor:
    aircraft = load_aircraft(AIRCRAFT / "x8.toml")
    return next(e.machine for e in aircraft.engines if isinstance(e.machine, ElectricMotor))


def test_power_train_books_what_the_motor_draws() -> None:
    m = motor()
    t = np.arange(0.0, 60.0, 0.02)
    throttle = 0.6 + 0.1 * np.sin(t)
    omega = 0.8 * throttle * m.U_empty * m.k_V
    random = np.random.default_rng(1)
    speed = omega + 5.0 * random.standard_normal(len(t))
    speed[::50] *= 2.0  # a pulse counted twice
    speed[7::10] = np.nan
    found = power_train(m, t, throttle, speed, sigma=5.0)
    assert found.counts["gated"] >= len(t) // 50 - 1
    late = t > 1.0
    # the filter is better than the sensor, and says so
    error = (found.omega - omega)[late]
    assert 0.5 < np.sqrt(np.mean(error**2)) / np.mean(found.se_omega[late]) < 1.5
    assert np.sqrt(np.mean(error**2)) < 5.0
    # Eq. (3.41) to (3.43) integrated here, with the true speed
    charge, volts, amperes = 0.0, np.full(len(t), np.nan), np.full(len(t), np.nan)
    for k in range(1, len(t)):
        left = 1.0 - charge / m.capacity
        U = m.U_empty + (m.U_full - m.U_empty) * left
        I = (throttle[k] * U - omega[k] / m.k_V) / (m.R_battery + m.R_esc + m.R_motor)  # noqa: E741
        volts[k], amperes[k] = U, min(max(I, -m.I_regen), m.I_max)
        charge += throttle[k] * amperes[k] * 0.02
    assert found.charge[-1] == pytest.approx(charge, rel=0.02)
    assert found.left[-1] == pytest.approx(1.0 - found.charge[-1] / m.capacity)
    np.testing.assert_allclose(found.voltage[late], volts[late], rtol=1e-4)
    # a speed that is off by what the filter leaves moves the current by that over k_V and R
    slack = 5.0 * np.mean(found.se_omega[late]) / m.k_V / (m.R_battery + m.R_esc + m.R_motor)
    assert np.abs(found.motor_current - amperes)[late].max() < slack
    np.testing.assert_allclose(
        found.current[late], throttle[late] * found.motor_current[late], rtol=1e-9
    )


def test_power_train_refuses_what_is_none() -> None:
    m = motor()
    with pytest.raises(BadInput):
        power_train(m, np.arange(3.0), np.zeros(2), np.zeros(3))
    t = np.array([0.0, 0.1, 0.05, 0.2])
    found = power_train(m, t, np.array([0.5, 0.5, 0.5, np.nan]), np.full(4, 100.0))
    assert found.counts == {"taken": 2, "backwards": 1, "not_finite": 1}


def test_world_magnetic_model() -> None:
    pytest.importorskip("wmm", reason="wmm-calculator, an extra, is not installed")
    # NOAA's test values of WMM2025: 2025.0, 0 km, 80 N, 0 E: X 6521.6, Y 145.9, Z 54791.5 nT
    field = world_magnetic_model(np.radians(80.0), 0.0, 0.0, date(2025, 1, 1))
    # height above mean sea level, not the ellipsoid: some nT
    np.testing.assert_allclose(1e9 * np.array(field), [6521.6, 145.9, 54791.5], atol=20.0)
    with pytest.raises(BadInput):
        world_magnetic_model(2.0, 0.0, 0.0, date(2025, 1, 1))
    with pytest.raises(BadInput):
        world_magnetic_model(0.0, 0.0, 0.0, date(2050, 1, 1))


def test_gravity_is_what_is_left() -> None:
    still = gravity_seen(np.array([[0.0, 0.0, -G]]), np.zeros((1, 3)), np.zeros((1, 3)))
    np.testing.assert_allclose(still, [[0.0, 0.0, G]])
