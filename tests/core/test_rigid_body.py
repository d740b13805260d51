"""Rigid-body motion against closed forms, conservation laws and NASA's check case 2."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from alula.model import Reference, aero_model
from alula.simulate import Airframe, fly, initial_state
from data import data

NOTHING = aero_model("no aerodynamics", {}, {}, Reference(1.0, 1.0, 1.0))
FULL = np.array([[900.0, 60.0, -80.0], [60.0, 1000.0, 30.0], [-80.0, 30.0, 1700.0]])


def test_ballistic_drop_is_a_parabola() -> None:
    t = np.arange(0.0, 5.0, 0.01)
    x0 = initial_state(40.0, 0.0, 0.3, 1000.0)
    flight = fly(Airframe(600.0, FULL), NOTHING, x0, t, {})
    g = 9.80665
    # RK4 is exact for a parabola; only rounding of 1000 m remains.
    np.testing.assert_allclose(
        flight.motion.h, 1000.0 + 40.0 * np.sin(0.3) * t - 0.5 * g * t**2, atol=1e-9
    )
    np.testing.assert_allclose(flight.position[:, 0], 40.0 * np.cos(0.3) * t, atol=1e-9)
    np.testing.assert_allclose(flight.motion.az, 0.0, atol=1e-12)


def test_torque_free_rotation_conserves_energy_and_angular_momentum() -> None:
    t = np.arange(0.0, 20.0, 0.01)
    x0 = initial_state(40.0, 0.05, 0.0, 1000.0, rates=(1.0, -2.0, 1.5))
    m = fly(Airframe(600.0, FULL), NOTHING, x0, t, {}).motion
    w = np.stack([m.p, m.q, m.r], axis=1)
    body = w @ FULL
    cos, sin = np.cos, np.sin
    # R_BE from the Euler angles, built here a second time: Earth to body is roll pitch yaw.
    one, zero = np.ones_like(t), np.zeros_like(t)
    roll = _rows([one, zero, zero], [zero, cos(m.phi), sin(m.phi)], [zero, -sin(m.phi), cos(m.phi)])
    pitch = _rows(
        [cos(m.theta), zero, -sin(m.theta)], [zero, one, zero], [sin(m.theta), zero, cos(m.theta)]
    )
    yaw = _rows([cos(m.psi), sin(m.psi), zero], [-sin(m.psi), cos(m.psi), zero], [zero, zero, one])
    momentum = np.einsum("nji,nj->ni", roll @ pitch @ yaw, body)
    energy = 0.5 * np.einsum("ni,ni->n", w, body)
    # RK4 at 2.7 rad/s and 0.01 s: (w dt)^5 / 120 a step, 2000 steps, about 1e-6 at worst.
    np.testing.assert_allclose(energy, energy[0], rtol=1e-7)
    np.testing.assert_allclose(momentum, momentum[:1].repeat(len(t), 0), atol=1e-6 * 5000.0)


def _rows(*rows: list[np.ndarray]) -> np.ndarray:
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=1)


def test_symmetric_top_precesses_at_the_closed_form_rate() -> None:
    # Euler's free top with Iyy = Izz: q + i r turns at (Ixx - Iyy)/Iyy p in body axes.
    Iyy, Ixx, p = 2000.0, 900.0, 3.0
    t = np.arange(0.0, 10.0, 0.005)
    x0 = initial_state(30.0, 0.0, 0.0, 1000.0, rates=(p, 0.4, 0.0))
    m = fly(Airframe(600.0, np.diag([Ixx, Iyy, Iyy])), NOTHING, x0, t, {}).motion
    turn = (Ixx - Iyy) / Iyy * p * t
    np.testing.assert_allclose(m.p, p, rtol=1e-12)
    # Truncation: (1.65 * 0.005)^5 / 120 * 2000 steps * 0.4 rad/s, below 1e-9
    np.testing.assert_allclose(m.q, 0.4 * np.cos(turn), atol=1e-8)
    np.testing.assert_allclose(m.r, 0.4 * np.sin(turn), atol=1e-8)


def test_tumbling_brick_without_damping_turns_as_nasa_says() -> None:
    # NESC check case 2: body rates against inertial space do not depend on the Earth's model.
    table = pd.read_csv(data("nesc_6dof", "Atmos_02_TumblingBrickNoDamping", "Atmos_02_sim_01.csv"))
    slug_ft2 = 1.3558179483314004  # kg m2
    inertia = np.diag([0.00189422, 0.006211019, 0.007194665]) * slug_ft2
    brick = Airframe(0.155404754 * 14.593902937, inertia)
    x0 = initial_state(0.0, 0.0, 0.0, 9144.0, rates=tuple(np.deg2rad([10.0, 20.0, 30.0])))
    t = table["time"].to_numpy()
    m = fly(brick, NOTHING, x0, t, {}, substeps=20).motion
    for name, values in (("Roll", m.p), ("Pitch", m.q), ("Yaw", m.r)):
        published = table[f"bodyAngularRateWrtEi_deg_s_{name}"].to_numpy()
        # Two of NASA's simulators agree to 3e-9 deg; the brick's inertia has 6 to 7 digits.
        np.testing.assert_allclose(np.rad2deg(values), published, atol=1e-6)


def test_steady_wind_moves_a_body_that_the_air_carries() -> None:
    # With nothing but drag and no gravity, a body at rest in the moving air stays at rest in it.
    drag = aero_model("drag", {"CX": "1"}, {"CX_0": -0.5}, Reference(1.0, 1.0, 1.0))
    wind = np.array([5.0, -2.0, 0.5])
    x0 = initial_state(0.0, 0.0, 0.0, 1000.0, wind=wind)
    flight = fly(
        Airframe(1.0, np.eye(3)), drag, x0, np.arange(0.0, 2.0, 0.1), {}, wind=wind, gravity=0.0
    )
    np.testing.assert_allclose(flight.velocity, np.tile(wind, (20, 1)), atol=1e-12)
    np.testing.assert_allclose(flight.motion.V, 0.0, atol=1e-12)


def test_thrust_off_the_center_of_gravity_pitches() -> None:
    airframe = Airframe(100.0, np.diag([50.0, 80.0, 90.0]), thrust_point=np.array([1.0, 0.0, -0.2]))
    m = fly(
        airframe, NOTHING, initial_state(0.0, 0.0, 0.0, 0.0), np.array([0.0, 0.1]), {"thrust": 40.0}
    ).motion
    # 40 N at 0.2 m above: M = z Fx = -8 N m
    assert m.qdot[0] == pytest.approx(-8.0 / 80.0, rel=1e-12)
    assert m.ax[0] == pytest.approx(0.4, rel=1e-12)


def test_tumbling_brick_with_damping_slows_as_nasa_says() -> None:
    # NESC check case 3: all six coefficients, the normalization of the rates, the growing air
    # density and the full rotation at once; coefficients from the case's DAVE-ML model.
    table = pd.read_csv(data("nesc_6dof", "Atmos_03_TumblingBrickDamping", "Atmos_03_sim_04.csv"))
    ft = 0.3048
    model = aero_model(
        "brick",
        {"CD": "1", "Cl": "phat", "Cm": "qhat", "Cn": "rhat"},
        {"CD_0": 0.01, "Cl_p": -1.0, "Cm_q": -1.0, "Cn_r": -1.0},
        Reference(0.22222 * ft**2, 0.33333 * ft, 0.66667 * ft),
        axes="stability",
    )
    inertia = np.diag([0.00189422, 0.006211019, 0.007194665]) * 1.3558179483314004
    brick = Airframe(0.155404754 * 14.593902937, inertia)
    x0 = initial_state(0.0, 0.0, 0.0, 9144.0, rates=tuple(np.deg2rad([10.0, 20.0, 30.0])))
    t = table["time"].to_numpy()
    # Gravity of the case less the Earth's rotation, 31.995 to 32.04 ft/s2 on the way down.
    m = fly(brick, model, x0, t, {}, gravity=32.0 * ft, substeps=20).motion
    for name, values in (("Roll", m.p), ("Pitch", m.q), ("Yaw", m.r)):
        published = table[f"bodyAngularRateWrtEi_deg_s_{name}"].to_numpy()
        # Of 30 deg/s; 0.1 % of gravity, and so of dynamic pressure, that a flat Earth does not have
        np.testing.assert_allclose(np.rad2deg(values), published, atol=0.05)
