"""Trim: what is held is held, what cannot be is named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import Envelope, load_aircraft
from alula.base.messages import BadInput
from alula.model import AeroModel, Reference, aero_model, load_model
from alula.simulate import Condition, Trim, airframe_of, fly, trim, trim_level
from simulate.light_aircraft import FORMULAS, MASS, VALUES, airframe, light

G = 9.80665
AIRCRAFT = Path(__file__).parents[2] / "aircraft"


def flown(found: Trim, seconds: float = 2.0, **options) -> object:
    t = np.arange(0.0, seconds, 0.01)
    return fly(airframe(), light(), found.state, t, found.inputs, **options).motion


def test_level_flight_balances_forces_written_down_a_second_time() -> None:
    found = trim(airframe(), light(), Condition(45.0, 900.0))
    pressure = 0.5 * 1.1226 * 45.0**2 * 10.6  # rho of the published table at 900 m, 5 digits
    CL = VALUES["CL_0"] + VALUES["CL_alpha"] * found.alpha + VALUES["CL_de"] * found.controls["de"]
    CD = VALUES["CD_0"] + VALUES["CD_alpha"] * found.alpha + VALUES["CD_de"] * found.controls["de"]
    assert pressure * CL + found.thrust * np.sin(found.alpha) == pytest.approx(MASS * G, rel=2e-4)
    assert pressure * CD == pytest.approx(found.thrust * np.cos(found.alpha), rel=2e-4)
    assert found.theta == pytest.approx(found.alpha, abs=1e-12)
    # symmetric aircraft, symmetric flight, to the last bit
    assert (found.beta, found.phi, found.controls["da"], found.controls["dr"]) == (0, 0, 0, 0)


def test_climb_keeps_its_angle() -> None:
    found = trim(airframe(), light(), Condition(45.0, 900.0, "climb", gamma=0.06, psi=1.0))
    m = flown(found)
    # the air gets thinner by 1e-4 a meter: 5 m of climb change the balance by as much
    np.testing.assert_allclose(m.h, 900.0 + 45.0 * np.sin(0.06) * m.t, atol=2e-2)
    np.testing.assert_allclose(m.psi, 1.0, atol=1e-12)


# Without a vertical part: in sinking air a level turn loses height, and the air gets denser.
@pytest.mark.parametrize("wind", [None, np.array([8.0, -5.0, 0.0])], ids=["still", "wind"])
@pytest.mark.parametrize(
    ("asked", "bank"),
    [
        ({"bank": 0.7}, 0.7),
        ({"bank": -0.5}, -0.5),
        ({"load_factor": 1.5}, np.arccos(1 / 1.5)),
        ({"turn_rate": 0.15}, np.arctan(45.0 * 0.15 / G)),
    ],
    ids=str,
)
def test_steady_turn_is_steady_and_coordinated(
    asked: dict[str, float], bank: float, wind: np.ndarray | None
) -> None:
    found = trim(airframe(), light(), Condition(45.0, 1000.0, "turn", **asked), wind=wind)
    m = flown(found, wind=wind)
    for values, steady in (
        (m.V, 45.0), (m.alpha, found.alpha), (m.beta, found.beta), (m.phi, found.phi),
        (m.theta, found.theta), (m.ay, 0.0),
    ):  # fmt: skip
        # RK4 at 0.01 s leaves a few 1e-10 in two seconds; the air is the same all along
        np.testing.assert_allclose(values, steady, atol=1e-8)
    # Euler's angle runs at the turn rate; bank of a coordinated turn by tan(phi) = V rate/g, but
    # for thrust along the body and sideslip: a degree
    turned = np.unwrap(m.psi)
    np.testing.assert_allclose(turned - turned[0], found.turn_rate * m.t, atol=1e-8)
    assert found.phi == pytest.approx(bank, abs=0.02)
    for name, value in asked.items():
        got = {"bank": found.phi, "load_factor": found.load_factor, "turn_rate": found.turn_rate}
        assert got[name] == pytest.approx(value, abs=1e-9)


def test_pull_up_has_its_load_factor_and_no_pitch_acceleration() -> None:
    found = trim(airframe(), light(), Condition(45.0, 1000.0, "pull_up", load_factor=2.5))
    m = flown(found, 0.03)
    assert -m.az[0] / G == pytest.approx(2.5, abs=1e-9)
    assert abs(m.qdot[0]) < 1e-8
    # V gamma_dot = acceleration across the path: (n - 1) g, but for the thrust's and alpha's share
    assert found.q == pytest.approx(1.5 * G / 45.0, rel=0.03)


def test_glide_is_the_drag_over_lift() -> None:
    found = trim(airframe(), light(), Condition(35.0, 1000.0, "glide"))
    de = found.controls["de"]
    CL = VALUES["CL_0"] + VALUES["CL_alpha"] * found.alpha + VALUES["CL_de"] * de
    CD = VALUES["CD_0"] + VALUES["CD_alpha"] * found.alpha + VALUES["CD_de"] * de
    assert found.thrust == 0.0
    assert np.tan(found.gamma) == pytest.approx(-CD / CL, rel=1e-7)


def test_without_a_rudder_the_wings_bank_a_little() -> None:
    """A model without rudder and with an asymmetry still trims: bank is free then."""
    formulas = {c: f.replace(" + dr", "") for c, f in FORMULAS.items()} | {
        "Cn": "1 + beta + phat + rhat + da"
    }
    values = {n: v for n, v in VALUES.items() if not n.endswith("_dr")} | {"Cn_0": 0.001}
    model = aero_model("elevons", formulas, values, Reference(10.6, 8.65, 1.25), axes="stability")
    found = trim(airframe(), model, Condition(45.0, 1000.0))
    assert "dr" not in found.free
    assert found.beta != 0.0
    assert found.phi != 0.0
    assert found.residual < 1e-8
    turning = trim(airframe(), model, Condition(45.0, 1000.0, "turn", bank=0.4))
    assert turning.residual < 1e-8


def refusal(model: AeroModel, condition: Condition, **options) -> str:
    with pytest.raises(BadInput, match=r"no_trim") as caught:
        trim(airframe(), model, condition, **options)
    return caught.value.messages[0].found


def test_missing_thrust_is_named_with_its_size() -> None:
    enough = trim(airframe(), light(), Condition(45.0, 1000.0))
    said = refusal(light(), Condition(45.0, 1000.0), limits={"thrust": (0.0, 400.0)})
    missing = enough.thrust - 400.0  # alpha is nearly zero, so that all of it is along the path
    assert "force along the flight path" in said
    assert "drag and weight exceed the thrust" in said
    assert "thrust at 400 N" in said
    assert float(said.split(" of ")[1].split()[0]) == pytest.approx(missing, rel=0.02)


def test_an_elevator_at_its_stop_is_named_with_the_pitching_moment() -> None:
    enough = trim(airframe(), light(), Condition(28.0, 1000.0))
    said = refusal(light(), Condition(28.0, 1000.0), limits={"de": (-0.05, 0.3)})
    assert "pitching moment" in said
    assert "nose down" in said
    assert "de at -0.05 rad (-2.865 deg)" in said
    # what the elevator would have to add, but for the lift that its own deflection changes
    pressure = 0.5 * 1.1117 * 28.0**2 * 10.6 * 1.25
    missing = pressure * VALUES["Cm_de"] * (enough.controls["de"] + 0.05)
    assert float(said.split(" of ")[1].split()[0]) == pytest.approx(missing, rel=0.1)


def test_missing_lift_is_named() -> None:
    said = refusal(light(), Condition(22.0, 1000.0), limits={"alpha": (-0.1, 0.1)})
    assert "lift is missing" in said
    assert "alpha at 0.1 rad" in said


def test_an_aileron_at_its_stop_is_named() -> None:
    crooked = {**FORMULAS, "Cl": "1 + beta + phat + rhat + da + dr"}
    model = aero_model("crooked", crooked, {**VALUES, "Cl_0": 0.05}, Reference(10.6, 8.65, 1.25),
                       axes="stability")  # fmt: skip
    said = refusal(model, Condition(45.0, 1000.0), limits={"da": (-0.1, 0.1), "dr": (-0.01, 0.01)})
    assert "rolling moment" in said or "yawing moment" in said
    assert "da at 0.1 rad" in said or "dr at" in said


ENVELOPE = Envelope(V=(21.0, 60.0), alpha=(-0.1, 0.2), n=(-1.5, 3.8), h=(0.0, 4000.0))


@pytest.mark.parametrize(
    ("condition", "word"),
    [
        (Condition(80.0, 1000.0), "V = 80 m/s"),
        (Condition(45.0, 9000.0), "h = 9000 m"),
        (Condition(45.0, 1000.0, "pull_up", load_factor=4.5), "n = 4.5"),
        (Condition(45.0, 1000.0, "turn", bank=1.4), "n = "),
    ],
)
def test_outside_of_the_envelope(condition: Condition, word: str) -> None:
    with pytest.raises(BadInput, match="outside_envelope") as caught:
        trim(airframe(), light(), condition, envelope=ENVELOPE)
    assert word in caught.value.messages[0].found
    if condition.kind == "level":
        found = trim(airframe(), light(), condition, envelope=ENVELOPE, in_spite=True)
        assert [m.code for m in found.messages] == ["outside_envelope"]
        assert found.messages[0].level == "warning"


def test_angle_of_attack_stays_in_the_envelope() -> None:
    said = refusal(light(), Condition(22.0, 1000.0), envelope=Envelope(alpha=(-0.05, 0.15)))
    assert "alpha at 0.15 rad" in said


def test_outside_of_the_models_validity_is_said_with_the_value() -> None:
    model = aero_model("narrow", FORMULAS, VALUES, Reference(10.6, 8.65, 1.25), axes="stability",
                       validity={"alpha": (0.05, 0.2)})  # fmt: skip
    (message,) = trim(airframe(), model, Condition(45.0, 1000.0)).messages
    assert message.code == "outside_validity"
    assert message.found.startswith("alpha = -0.00")


@pytest.mark.parametrize(
    "bad",
    [
        {"V": 0.0},
        {"V": np.nan},
        {"kind": "turn"},
        {"kind": "turn", "bank": 0.3, "turn_rate": 0.1},
        {"kind": "pull_up"},
        {"kind": "pull_up", "bank": 0.2},
        {"kind": "turn", "load_factor": 0.8},
        {"kind": "level", "gamma": 0.1},
        {"kind": "level", "bank": 0.1},
        {"kind": "climb", "gamma": 2.0},
        {"kind": "turn", "bank": 1.6},
    ],
    ids=str,
)
def test_a_condition_that_is_none_is_refused(bad: dict[str, object]) -> None:
    with pytest.raises(BadInput, match="bad_condition"):
        Condition(**{"V": 45.0, "h": 1000.0, **bad})


def test_unknown_control_is_refused() -> None:
    with pytest.raises(BadInput, match="unknown_control"):
        trim(airframe(), light(), Condition(45.0, 1000.0), controls={"elevator": 0.1})


@pytest.mark.parametrize(
    "changed",
    [{"mass": -560.0}, {"inertia": np.diag([655.0, 0.0, 1139.0])}],
    ids=["mass", "inertia"],
)
def test_impossible_bodies_are_refused(changed: dict[str, object]) -> None:
    with pytest.raises(BadInput, match="impossible_inertia"):
        trim(airframe(**changed), light(), Condition(45.0, 1000.0))


def test_trim_level_is_the_same_flight() -> None:
    one = trim_level(airframe(), light(), 45.0, 900.0, gamma=-0.05, psi=0.5)
    two = trim(airframe(), light(), Condition(45.0, 900.0, "climb", gamma=-0.05, psi=0.5))
    np.testing.assert_array_equal(one.state, two.state)
    assert one.inputs == two.inputs


def test_held_flaps_stay() -> None:
    model = aero_model("flaps", {**FORMULAS, "CL": FORMULAS["CL"] + " + df"},
                       {**VALUES, "CL_df": 0.8}, Reference(10.6, 8.65, 1.25),
                       axes="stability")  # fmt: skip
    up = trim(airframe(), model, Condition(35.0, 1000.0))
    down = trim(airframe(), model, Condition(35.0, 1000.0), controls={"df": 0.3})
    assert down.controls["df"] == 0.3
    # lift by flaps replaces lift by angle of attack, but for the elevator's share
    assert up.alpha - down.alpha == pytest.approx(0.8 * 0.3 / VALUES["CL_alpha"], rel=0.1)


@pytest.mark.parametrize("V", [11.0, 28.0])
def test_an_electric_drive_is_trimmed_where_it_would_brake_at_half_throttle(V: float) -> None:
    """At 28 m/s the windmilling propeller turns faster than half throttle drives it: no current."""
    aircraft = load_aircraft(AIRCRAFT / "x8.toml")
    assert aircraft.aero is not None
    frame = airframe_of(aircraft, engines="modeled", actuators=True)
    found = trim(frame, load_model(aircraft.aero), Condition(V, 500.0),
                 limits=aircraft.control_limits, envelope=aircraft.envelope)  # fmt: skip
    assert 0.3 < found.controls["dt"] < 1.0
    assert found.thrust == 0.0
    # actuators stand where they are told to
    assert found.further["de"] == pytest.approx(found.controls["de"], abs=1e-9)


def test_a_piston_engine_at_full_throttle_is_named() -> None:
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    assert aircraft.aero is not None
    frame = airframe_of(aircraft, engines="modeled")
    with pytest.raises(BadInput, match="no_trim") as caught:
        trim(frame, load_model(aircraft.aero), Condition(70.0, 500.0),
             limits=aircraft.control_limits)  # fmt: skip
    assert "force along the flight path" in caught.value.messages[0].found
    assert caught.value.messages[0].found.endswith("at its stop: throttle at 1")
