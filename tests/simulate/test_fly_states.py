"""Flights with engines, actuators, stall, fuel, gusts, turbulence, a pilot, on a turning Earth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import Aircraft, load_aircraft
from alula.aircraft.actuators import Actuator
from alula.base.messages import BadInput
from alula.model import AeroModel, load_model
from alula.simulate import Airframe, airframe_of, fly, initial_state
from alula.simulate.airframe import core_model
from alula.simulate.condition import Condition
from alula.simulate.flight_check import check_step
from alula.simulate.pilot import Pilot
from alula.simulate.trim import trim
from alula.simulate.wind import CosineGust, Turbulence, Wind

AIRCRAFT = Path(__file__).parents[2] / "aircraft"
T = np.arange(0.0, 10.0, 0.02)


@pytest.fixture(scope="module")
def aircraft() -> Aircraft:
    return load_aircraft(AIRCRAFT / "sportstar.toml")


@pytest.fixture(scope="module")
def airframe(aircraft: Aircraft) -> Airframe:
    return airframe_of(aircraft, engines="modeled")


@pytest.fixture(scope="module")
def model() -> AeroModel:
    return load_model(AIRCRAFT / "sportstar_aero.toml")


def controls_of(level: object) -> dict[str, float]:
    return dict(level.controls)  # type: ignore[attr-defined]


def test_engine_holds_level_flight_with_its_rotor_at_rest(
    airframe: Airframe, model: AeroModel
) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    flight = fly(airframe, model, level.state, T, controls_of(level))
    np.testing.assert_allclose(flight.motion.V, 45.0, atol=1e-6)
    omega = flight.states["omega"]
    np.testing.assert_allclose(omega, omega[0], rtol=1e-8)
    # Thrust is what is left: mass times specific force less the aerodynamic one.
    m = flight.motion
    q_bar_S = 0.5 * m.rho * m.V**2 * model.reference.S
    CX = m.recorded["CL"] * np.sin(m.alpha) - m.recorded["CD"] * np.cos(m.alpha)
    np.testing.assert_allclose(
        airframe.mass * m.ax - q_bar_S * CX, flight.engine_force[:, 0], rtol=1e-9
    )
    np.testing.assert_allclose(flight.engine_force[:, 0], m.thrust, rtol=1e-12)


def test_thirteen_states_settle_the_others(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    start = fly(airframe, model, level.state[:13], T[:2], controls_of(level))
    np.testing.assert_allclose(start.plant_states[0], level.state, rtol=1e-7)


def test_actuator_lags_as_its_closed_form(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    slow = replace(airframe, actuators={"de": Actuator(0.2, np.inf, -0.4, 0.3, 0.0)})
    de = np.full(len(T), level.controls["de"] - 0.02)
    de[0] = level.controls["de"]
    flight = fly(slow, model, level.state[:13], T, {**controls_of(level), "de": de}, hold=True)
    # A step at the second sample through a lag of 0.2 s; RK4: (0.1)^5 / 120 a step.
    expected = level.controls["de"] - 0.02 * (1.0 - np.exp(-np.maximum(T - T[1], 0.0) / 0.2))
    np.testing.assert_allclose(flight.states["de"], expected, atol=1e-8)
    np.testing.assert_array_equal(flight.motion.controls["de"], flight.states["de"])
    assert flight.inputs[5, 0] == de[5]


def test_fuel_burns_and_mass_follows(aircraft: Aircraft, model: AeroModel) -> None:
    burning = airframe_of(aircraft, engines="modeled", burn=True)
    level = trim(airframe_of(aircraft, engines="modeled"), model, Condition(45.0, 900.0))
    flight = fly(burning, model, level.state[:13], T, controls_of(level))
    used = flight.states["fuel_used"]
    # 285 g/kWh of the shaft's power, which is the propeller's: CP rho n^3 D^5 within the table.
    assert 1e-3 < used[-1] / T[-1] < 8e-3
    later = fly(burning, model, flight.plant_states[-1], T[:2], controls_of(level))
    m, q_bar_S = later.motion, 0.5 * later.motion.rho * later.motion.V**2 * model.reference.S
    CX = m.recorded["CL"] * np.sin(m.alpha) - m.recorded["CD"] * np.cos(m.alpha)
    mass = (q_bar_S * CX + later.engine_force[:, 0]) / m.ax
    np.testing.assert_allclose(mass, burning.mass - later.states["fuel_used"], rtol=1e-6)


def test_gust_is_felt_as_an_angle_of_attack(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    gust = CosineGust(np.array([0.0, 0.0, -3.0]), 1.0, 30.0, 45.0).value(T)
    assert gust[-1, 2] == -3.0  # it stays
    np.testing.assert_allclose(gust[T < 1.0], 0.0)
    flight = fly(airframe, model, level.state, T, controls_of(level), gusts=gust)
    np.testing.assert_array_equal(flight.inputs[:, 6:], gust)
    k = int(np.argmin(np.abs(T - 1.06)))
    # At first the aircraft has hardly moved (its lift takes 0.5 s to do so): alpha grows by -wg/V.
    assert flight.motion.alpha[k] - level.alpha == pytest.approx(-gust[k, 2] / 45.0, rel=0.1)


def test_turbulence_is_the_seeds(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))

    def flown(seed: int) -> np.ndarray:
        turbulence = Turbulence(W20=8.0, sigma=1.5, seed=seed)
        flight = fly(
            airframe, model, level.state, T, controls_of(level), turbulence=turbulence, substeps=2
        )
        return flight.inputs

    first = flown(1)
    assert first.tobytes() == flown(1).tobytes()
    assert np.abs(first[:, 6:] - flown(2)[:, 6:]).max() > 0.1
    assert first[:, 6:].std(axis=0).min() > 0.0


def test_pilot_holds_height_and_heading_in_turbulence(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    t = np.arange(0.0, 60.0, 0.02)
    pilot = Pilot(
        gains={
            ("de", "theta"): -1.0, ("de", "q"): -0.3, ("de", "h"): -0.004,
            ("da", "phi"): -0.6, ("da", "p"): -0.1, ("da", "psi"): -0.5,
        },
        references={"theta": level.theta, "q": 0.0, "h": 900.0, "phi": level.phi, "p": 0.0,
                    "psi": 0.0},
        limits={"de": (-0.4, 0.3), "da": (-0.3, 0.3)},
    )  # fmt: skip
    rough = {"turbulence": Turbulence(sigma=1.5, W20=5.0, seed=3)}
    held = fly(airframe, model, level.state, t, controls_of(level), pilot=pilot, **rough)
    alone = fly(airframe, model, level.state, t, controls_of(level), **rough)
    assert np.abs(held.motion.h - 900.0).max() < 15.0
    assert np.abs(np.degrees(held.motion.psi)).max() < 10.0
    assert np.abs(np.degrees(alone.motion.psi)).max() > 10.0  # or the pilot had nothing to do
    assert np.abs(held.inputs[:, 1]).max() <= 0.3
    with pytest.raises(BadInput, match="unknown_sight"):
        fly(airframe, model, level.state, T, {}, pilot=Pilot({("de", "gamma"): 1.0}, {}))


def test_wind_with_shear_moves_the_air(airframe: Airframe, model: AeroModel) -> None:
    still = initial_state(45.0, 0.05, 0.05, 900.0)
    shear = Wind(np.array([0.0, 5.0, 0.0]), np.array([0.01, 0.0, 0.0]), reference_height=400.0)
    flight = fly(airframe, model, still, T[:2], {"dt": 0.7}, wind=shear)
    # 5 m/s to the east, 5 m/s to the north at 500 m above the reference height
    v = flight.velocity[0] - np.array([5.0, 5.0, 0.0])
    assert flight.motion.V[0] == pytest.approx(float(np.linalg.norm(v)), rel=1e-12)


def test_a_turning_earth_is_flat_for_ten_seconds(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    state = initial_state(
        45.0, level.alpha, level.theta, 900.0, beta=level.beta, earth="wgs84", latitude=0.8,
        longitude=0.3, rates=(7.292e-5 * np.cos(0.8), 0.0, -7.292e-5 * np.sin(0.8)),
    )  # fmt: skip
    round_ = fly(replace(airframe, earth="wgs84"), model, state, T, controls_of(level))
    flat = fly(airframe, model, level.state, T, controls_of(level))
    # Gravity there is 9.8059, not 9.80665 (1e-4), Coriolis' acceleration 5e-3 m/s2.
    np.testing.assert_allclose(round_.motion.h, flat.motion.h, atol=0.1)
    np.testing.assert_allclose(round_.motion.V, flat.motion.V, atol=0.05)
    north = (round_.position[-1, 0] - 0.8) * (6.378e6 + 900.0)
    assert north == pytest.approx(flat.position[-1, 0], rel=5e-3)  # radius of the meridian: 0.2 %


def test_stall_states_are_there_and_can_be_left_out(airframe: Airframe, model: AeroModel) -> None:
    assert model.stall is not None
    names = core_model(airframe, model).further_states
    assert names == ["omega", "X_left", "X_right"]
    assert core_model(airframe, model, stall=False).further_states == ["omega"]


def test_a_step_too_large_names_the_step_to_use(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    coarse = np.arange(0.0, 10.0, 1.0)
    with pytest.raises(BadInput, match="step_too_large") as caught:
        fly(airframe, model, level.state, coarse, controls_of(level), check=True)
    step = float(caught.value.messages[0].expected.split()[2])
    fine = fly(
        airframe, model, level.state, coarse, controls_of(level), check=True,
        substeps=int(np.ceil(1.0 / step)),
    )  # fmt: skip
    assert not [m for m in fine.messages if m.code == "coarse_step"]
    assert check_step(np.diag([-2.0, -40.0]), 0.02)[0].code == "coarse_step"
    assert check_step(np.diag([-2.0, -40.0]), 0.01) == ()


def test_leaving_the_models_range_is_said_once(airframe: Airframe, model: AeroModel) -> None:
    level = trim(airframe, model, Condition(45.0, 900.0))
    de = np.where((T > 1.0) & (T < 2.0), level.controls["de"] - 0.15, level.controls["de"])
    flight = fly(airframe, model, level.state, T, {**controls_of(level), "de": de})
    said = [m for m in flight.messages if m.where.endswith(", alpha")]
    assert len(said) == 1
    assert f"{np.degrees(flight.motion.alpha.max()):.4g} deg" in said[0].found
    quiet = fly(airframe, model, level.state, T, controls_of(level))
    assert quiet.messages == ()


def test_wrong_states_are_refused(airframe: Airframe, model: AeroModel) -> None:
    with pytest.raises(BadInput, match="initial_state"):
        fly(airframe, model, np.zeros(12), T, {})
    with pytest.raises(BadInput, match="bad_gust"):
        fly(airframe, model, initial_state(45.0, 0.0, 0.0, 900.0), T, {}, gusts=np.zeros((3, 6)))
    with pytest.raises(BadInput, match="actuator"):
        core_model(replace(airframe, actuators={"flap": Actuator(0.1, 1.0, -1.0, 1.0, 0.0)}), model)
