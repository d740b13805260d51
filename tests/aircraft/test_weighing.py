"""The weighing procedure against statics worked out in the Earth's axes."""

from __future__ import annotations

import numpy as np
import pytest

from alula.aircraft import center_of_gravity
from alula.base.arrays import Array
from alula.base.messages import BadInput

MASS = 375.0  # kg
CG = np.array([-0.312, 0.021, -0.164])  # m, body axes
AXLES = np.array([[1.21, 0.0, 0.92], [-0.68, -0.95, 0.88], [-0.66, 0.96, 0.88]])  # m
RADIUS = 0.16  # m, of the wheels


def scales(pitch_deg: float, points: Array) -> Array:
    """The three vertical forces, in kg, that hold the body still at a pitch angle.

    Body-fixed points are turned into Earth axes (x horizontal, y right, z down); forces are
    vertical, so the sum of forces and of their moments about both horizontal axes must vanish.
    """
    c, s = np.cos(np.radians(pitch_deg)), np.sin(np.radians(pitch_deg))
    to_earth = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    lever = points @ to_earth.T - to_earth @ CG
    forces = np.vstack([np.ones(3), lever[:, 0], lever[:, 1]])
    return np.linalg.solve(forces, [MASS, 0.0, 0.0])


def test_recovers_the_center_of_gravity_to_a_millimeter() -> None:
    angles = [0.0, 0.0, 6.0, 9.0, 12.0]
    readings = [scales(a, AXLES).round(2) for a in angles]  # scales that show 10 g
    got = center_of_gravity(readings, angles, AXLES)
    # 10 g in 375 kg over a base of 1.9 m is 0.05 mm, times 1/sin(12 deg) for the height.
    np.testing.assert_allclose(got.cg, CG, atol=1e-3)
    assert got.mass == pytest.approx(MASS, abs=0.02)


def test_one_level_and_one_tilted_determine_it_without_error_bars() -> None:
    angles = [0.0, 10.0]
    got = center_of_gravity([scales(a, AXLES) for a in angles], angles, AXLES)
    np.testing.assert_allclose(got.cg, CG, atol=1e-9)  # rounding, magnified by 1/sin(10 deg)
    assert np.isnan(got.cg_se[[0, 2]]).all()


def test_a_round_wheel_acts_through_its_axle() -> None:
    """The contact wanders around the tire as the aircraft tilts, always below the axle."""
    angles = [0.0, 5.0, 11.0]
    readings = []
    for angle in angles:
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        down_in_body = np.array([-s, 0.0, c])
        readings.append(scales(angle, AXLES + RADIUS * down_in_body))
    got = center_of_gravity(readings, angles, AXLES)
    np.testing.assert_allclose(got.cg, CG, atol=1e-9)


def test_standard_errors_are_those_of_repeated_weighings() -> None:
    angles = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 8.0, 8.0, 12.0, 12.0])
    exact = np.array([scales(a, AXLES) for a in angles])
    rng = np.random.default_rng(20)
    fits = [
        center_of_gravity(exact + rng.normal(0.0, 0.2, exact.shape), angles, AXLES)
        for _ in range(400)
    ]
    spread = np.std([fit.cg - CG for fit in fits], axis=0)
    claimed = np.sqrt(np.mean([fit.cg_se**2 for fit in fits], axis=0))
    # 400 draws give a standard deviation to 3.5 %; four times that.
    np.testing.assert_allclose(claimed / spread, 1.0, atol=0.15)


@pytest.mark.parametrize(
    ("readings", "angles", "code"),
    [
        ([[90.0, 140.0, 145.0]] * 3, [0.0, 0.2, 0.4], "weighing_tilt"),
        ([[90.0, 140.0, 145.0], [0.0, 187.0, 188.0]], [0.0, 10.0], "weighing_reading"),
        ([[90.0, 140.0, float("nan")], [80.0, 147.0, 148.0]], [0.0, 10.0], "weighing_reading"),
        ([[90.0, 140.0], [80.0, 147.0]], [0.0, 10.0], "weighing_shape"),
    ],
)
def test_refuses(readings: list[list[float]], angles: list[float], code: str) -> None:
    with pytest.raises(BadInput) as error:
        center_of_gravity(readings, angles, AXLES)
    assert error.value.messages[0].code == code
