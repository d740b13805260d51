"""The ARM-Hawk by strip theory: corrections, symmetry, propwash, what is sampled."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import Aircraft, ElectricMotor, load_aircraft
from alula.aircraft.mass import check_inertia
from alula.aircraft.sampled import sampled
from alula.base.messages import BadInput
from alula.predict.strip_model import StripModel, strip_model
from alula.predict.wake import wake_of

FILE = Path(__file__).resolve().parents[2] / "aircraft" / "armhawk.toml"


@pytest.fixture(scope="module")
def aircraft() -> Aircraft:
    return load_aircraft(FILE)


@pytest.fixture(scope="module")
def strips(aircraft: Aircraft) -> StripModel:
    return strip_model(aircraft, downwash=0.48)


def slope(strips: StripModel, c: str, name: str, **at: float) -> float:
    step = 1e-3
    given = {k: np.full(2, v) for k, v in at.items()}
    given[name] = given.get(name, np.zeros(2)) + np.array([step, -step])
    y = strips.evaluate(given)[c]
    return float((y[0] - y[1]) / (2.0 * step))


def test_the_file_is_the_published_aircraft(aircraft: Aircraft) -> None:
    assert aircraft.mass is not None
    assert aircraft.mass.mass == pytest.approx(6.5, abs=1e-9)  # Pusztai 2018, 3.1
    assert aircraft.geometry is not None
    assert aircraft.geometry.drag_area / aircraft.S == pytest.approx(0.029, abs=5e-4)  # C.4


def test_lift_and_control_slopes_in_closed_form(strips: StripModel) -> None:
    wing, tail, _ = strips.surfaces
    S_tail = tail.plan.area / strips.S
    S_wing = wing.plan.area / strips.S  # 0.446 is rounded
    tail_part = S_tail * tail.k * tail.c_l_alpha
    expected = S_wing * wing.k * wing.c_l_alpha + tail_part * (1.0 - tail.downwash)
    # Sweep of 2.6 deg takes 0.1 %, turned lift and the wing's drag on it less than 1 %.
    assert slope(strips, "CL", "alpha") == pytest.approx(expected, rel=0.012)
    # Printed: c_l_delta 4.0, k 0.639.
    assert slope(strips, "CL", "de") == pytest.approx(S_tail * tail.k * 4.0, rel=0.01)
    arm = -(tail.plan.quarter_chord[0] + 0.32) / strips.c
    # The flap's own moment about the quarter chord adds to lift times arm.
    flap = -0.645 * S_tail * tail.plan.chord / strips.c
    assert slope(strips, "Cm", "de") == pytest.approx(-S_tail * tail.k * 4.0 * arm + flap, rel=0.01)


def test_roll_damping_in_closed_form(strips: StripModel) -> None:
    wing, tail, fin = strips.surfaces
    t = wing.plan.taper
    expected = -wing.k * wing.c_l_alpha * (1.0 + 3.0 * t) / (12.0 * (1.0 + t)) * 2.0 * 0.5
    # Tailplane: its own as a rectangle, by the square of the spans; the fin turns with its height.
    expected -= (
        tail.k * tail.c_l_alpha / 6.0 * tail.plan.area / strips.S
        * (tail.plan.span / strips.b) ** 2
    )  # fmt: skip
    height = 0.5 * fin.plan.span
    z2 = height**2 * (1.0 + 3.0 * fin.plan.taper) / (6.0 * (1.0 + fin.plan.taper))
    expected -= 2.0 * fin.k * fin.c_l_alpha * fin.plan.area / strips.S * z2 / strips.b**2
    # Strips of finite width, sweep, drag, and the center of gravity below the wing: 3 %.
    assert slope(strips, "Cl", "phat") == pytest.approx(expected, rel=0.03)


def test_symmetric_flight_has_no_lateral_loads(strips: StripModel) -> None:
    C = strips.evaluate(
        {"alpha": np.radians(np.arange(-90.0, 91.0, 7.0)), "de": 0.1, "df": 0.3, "qhat": 0.01}
    )
    for name in ("CY", "Cl", "Cn"):
        np.testing.assert_allclose(C[name], 0.0, atol=1e-12)


def test_positive_controls_give_negative_moments(strips: StripModel) -> None:
    for wash in (0.0, 1.0):
        for c, name in (("Cm", "de"), ("Cl", "da"), ("Cn", "dr")):
            assert slope(strips, c, name, alpha=0.05, wash=wash) < -0.1


def test_the_tail_in_the_slipstream_works_harder(strips: StripModel) -> None:
    calm, blown = (slope(strips, "Cn", "dr", wash=w) for w in (0.0, 1.0))
    # The part of the fin inside sees (1 + wash)^2 = 4 times the pressure, and all of it is near.
    assert 2.0 < blown / calm < 4.0
    assert slope(strips, "Cl", "da", wash=1.0) == pytest.approx(slope(strips, "Cl", "da"))


def test_the_propeller_turned_the_other_way_mirrors_the_loads(aircraft: Aircraft) -> None:
    engine = aircraft.engines[0]
    machine = engine.machine
    assert isinstance(machine, ElectricMotor)
    other = replace(machine, propeller=replace(machine.propeller, sense=-1.0))
    mirror = replace(aircraft, engines=(replace(engine, machine=other),))
    a, b = strip_model(aircraft), strip_model(mirror)
    here = {"alpha": np.array([0.1]), "wash": np.array([0.8]), "qhat": np.array([0.01])}
    lateral = {"beta": 0.15, "phat": 0.03, "rhat": -0.02, "da": 0.1, "dr": -0.2}
    C = a.evaluate({**here, **{k: np.array([v]) for k, v in lateral.items()}})
    D = b.evaluate({**here, **{k: np.array([-v]) for k, v in lateral.items()}})
    for name in ("CD", "CL", "Cm"):
        np.testing.assert_allclose(C[name], D[name], atol=1e-12)
    for name in ("CY", "Cl", "Cn"):
        np.testing.assert_allclose(C[name], -D[name], atol=1e-12)


def test_the_wake_keeps_momentum_and_angular_momentum(aircraft: Aircraft) -> None:
    machine = aircraft.engines[0].machine
    assert isinstance(machine, ElectricMotor)
    p = machine.propeller
    wake = wake_of(p)
    n, rho, V, D = 100.0, 1.2, 0.3 * 100.0 * 0.508, 0.508  # J = 0.3, a knot of the curves
    thrust = float(p.CT[3]) * rho * n**2 * D**4
    torque = float(p.CP[3]) * rho * n**2 * D**5 / (2.0 * np.pi)
    U = np.sqrt(V**2 + 2.0 * thrust / (rho * np.pi * (0.5 * D) ** 2))
    excess, swirl, radius = (float(x[0]) for x in wake.at(np.array([1.0]), np.array([U / V - 1.0])))
    flux = rho * np.pi * radius**2 * U
    assert excess == pytest.approx(U / V - 1.0, rel=1e-12)
    assert flux * (U - V) == pytest.approx(thrust, rel=1e-12)
    # 400 advance ratios with straight lines between them.
    assert 0.5 * flux * swirl * V * radius**2 == pytest.approx(torque, rel=1e-4)


def test_both_laws_of_downwash_agree_where_flow_is_attached(aircraft: Aircraft) -> None:
    by_lift, by_angle = (
        strip_model(aircraft, downwash=0.48, downwash_by=law)  # type: ignore[arg-type]
        for law in ("lift", "angle")
    )
    at = {"alpha": np.radians(np.arange(-4.0, 4.1))}
    # The polar's lift bends by 1 % within 4 deg; 0.48 of that at the tail.
    np.testing.assert_allclose(by_lift.evaluate(at)["Cm"], by_angle.evaluate(at)["Cm"], atol=2e-3)
    stalled = {"alpha": np.radians([22.0])}
    assert by_lift.evaluate(stalled)["Cm"] < by_angle.evaluate(stalled)["Cm"]


def test_an_aircraft_without_geometry_is_refused() -> None:
    with pytest.raises(BadInput, match="geometry"):
        strip_model(load_aircraft(FILE.with_name("x8.toml")))


def test_an_unknown_variable_is_refused(strips: StripModel) -> None:
    with pytest.raises(BadInput, match="gamma"):
        strips.evaluate({"gamma": np.zeros(1)})


def test_samples_scatter_as_the_file_says(aircraft: Aircraft) -> None:
    rng = np.random.default_rng(5)
    n = 400
    drawn = [sampled(aircraft, rng) for _ in range(n)]
    u, mass = aircraft.uncertainty, aircraft.mass
    assert u is not None
    assert mass is not None
    cg = np.array([a.mass.cg for a in drawn if a.mass is not None])
    hub = np.array([a.engines[0].position for a in drawn])
    total = np.array([a.mass.mass for a in drawn if a.mass is not None])
    # A standard deviation of n normal numbers scatters by 1/sqrt(2 n), 3.5 %; four times that.
    near = 4.0 / np.sqrt(2.0 * n)
    np.testing.assert_allclose(cg.std(axis=0), u.cg, rtol=near)
    np.testing.assert_allclose(hub.std(axis=0), u.hub, rtol=near)
    np.testing.assert_allclose(np.log(total / mass.mass).std(), u.mass, rtol=near)
    for a in drawn:
        assert a.mass is not None
        assert check_inertia(a.mass.inertia, "sample") == ()
    assert sampled(load_aircraft(FILE.with_name("x8.toml")), rng).mass is not None


def test_an_aircraft_that_states_no_uncertainty_stays_what_it_is() -> None:
    plain = load_aircraft(FILE.with_name("x8.toml"))
    assert sampled(plain, np.random.default_rng(1)) is plain
