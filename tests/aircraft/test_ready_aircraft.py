"""The ready aircraft fly as what they are named after: envelope, stall, top speed, modes."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io
from ready import (
    coefficients,
    full_throttle,
    lateral_modes,
    level,
    longitudinal_modes,
    ready,
    stall_speed,
)
from scipy.interpolate import RegularGridInterpolator

from alula.aircraft import ElectricMotor, PistonEngine, Turbofan
from alula.simulate import Airframe, trim_level
from data import data

RHO = {
    0.0: 1.2250,
    915.0: 1.1210,
    2438.0: 0.9626,
    3000.0: 0.9091,
    6000.0: 0.6597,
}  # standard, kg/m3

# The envelope's ends and between: speed, height. The SportStar's are those of the campaign its
# values come from (Dittrich 2016, section 4.3): 1.2 V_S1 to V_H at 3000 and 8000 ft; V_S1 is an
# equivalent airspeed, here the true one.
POINTS = [
    *[("sportstar", V, 0.0) for V in (24.7, 35.0, 45.0, 59.0)],
    *[(n, V, 915.0) for n in ("sportstar", "sportstar_aft") for V in (25.9, 45.0)],
    *[("sportstar", V, 2438.0) for V in (27.9, 45.0)],
    *[("x8", V, 0.0) for V in (11.0, 18.0, 28.0)],
    ("x8", 14.0, 3000.0),
    *[("citation2", V, 0.0) for V in (65.0, 90.0, 125.0)],
    *[("citation2", V, 6000.0) for V in (95.0, 125.0)],
]


def available(name: str, V: float, h: float) -> float:
    """Full throttle's thrust, N."""
    aircraft, _ = ready(name)
    total = 0.0
    for engine in aircraft.engines:
        machine = engine.machine
        if isinstance(machine, Turbofan):
            table = RegularGridInterpolator((machine.mach, machine.height), machine.military)
            sound = np.sqrt(1.4 * 287.053 * (288.15 - 0.0065 * h))
            total += float(table((V / sound, h)))
        else:
            assert isinstance(machine, PistonEngine | ElectricMotor)
            total += full_throttle(machine, V, RHO[h])[0]
    return total


@pytest.mark.parametrize(("name", "V", "h"), POINTS)
def test_trims_within_limits_and_power(name: str, V: float, h: float) -> None:
    aircraft, model = ready(name)
    s = level(aircraft, model, V, RHO[h])
    low, high = model.validity["alpha"]
    assert low < s.alpha < high
    low, high = aircraft.control_limits["de"]
    assert low < s.de < high
    # At V_H the SportStar has nothing to spare, by 2 % of thrust.
    assert 0.0 < s.T < 1.02 * available(name, V, h)
    # The simulator finds the same flight: the formulas above have neither quaternions nor a core.
    assert aircraft.mass is not None
    mean = np.mean([e.position for e in aircraft.engines], axis=0)
    airframe = Airframe(aircraft.mass.mass, aircraft.mass.inertia, aircraft.mass.cg, mean)
    trim = trim_level(airframe, model, V, h)
    # Density by four digits, and stall that takes a 1000th of the lift near its range.
    assert trim.alpha == pytest.approx(s.alpha, abs=1e-3)
    assert trim.controls["de"] == pytest.approx(s.de, abs=1e-3)
    assert trim.thrust == pytest.approx(s.T, rel=5e-3)


@pytest.mark.parametrize(("name", "V", "h"), POINTS)
def test_modes_are_those_of_an_airplane(name: str, V: float, h: float) -> None:
    aircraft, model = ready(name)
    s = level(aircraft, model, V, RHO[h])
    modes = longitudinal_modes(aircraft, model, s)
    order = np.argsort(np.abs(modes))
    phugoid, short = modes[order[:2]], modes[order[2:]]
    assert (short.real < 0.0).all()
    damping = -short.real / np.abs(short)
    assert (damping > 0.3).all()  # MIL-F-8785C level 1, category B, paragraph 3.2.2.1.2
    # Lanchester's sqrt(2) g/V, less by the root of static over maneuver margin: strong pitch
    # damping (SportStar) and a center of gravity aft lower it.
    assert 0.4 < np.abs(phugoid[0]) / (np.sqrt(2.0) * 9.81 / V) < 1.1
    assert (phugoid.real < 0.01).all()

    modes = lateral_modes(aircraft, model, s)
    dutch = modes[np.abs(modes.imag) > 1e-6]
    roll, spiral = sorted(modes[np.abs(modes.imag) < 1e-6].real)
    assert len(dutch) == 2
    assert (-dutch.real / np.abs(dutch) > 0.08).all()  # level 1, category B
    assert 1.0 / -roll < 1.4  # s, level 1
    assert spiral < np.log(2.0) / 8.0  # level 2: doubles in 8 s or more


def test_sportstar_stalls_and_tops_out_where_published() -> None:
    """Dittrich 2016, Table 4.3: V_S1 = 20.6 m/s, V_H = 59 m/s."""
    aircraft, model = ready("sportstar")
    assert stall_speed(aircraft, model) == pytest.approx(20.6, abs=0.1)  # figures of three digits
    engine = aircraft.engines[0].machine
    assert isinstance(engine, PistonEngine)
    spare = {
        V: available("sportstar", V, 0.0) - level(aircraft, model, V, 1.225).T for V in (57, 61)
    }
    assert spare[57] > 0.0 > spare[61]
    # There it turns at take-off speed and gives take-off power: 73.5 kW at 5800 rpm (Table 4.2).
    _, omega = full_throttle(engine, 59.0, 1.225)
    rpm = omega * engine.reduction * 30.0 / np.pi
    assert rpm == pytest.approx(5800.0, rel=0.01)
    torque = np.interp(omega * engine.reduction, engine.omega, engine.torque)
    assert torque * omega * engine.reduction == pytest.approx(73.5e3, rel=0.01)
    assert engine.torque.max() == 128.0
    # At rest: below the speed of take-off power, with a thrust that a light airplane has.
    thrust, omega = full_throttle(engine, 0.1, 1.225)
    assert omega * engine.reduction * 30.0 / np.pi < 5800.0
    assert 1500.0 < thrust < 2300.0
    # Gravity's center at 30 and 32 % of the chord, by baggage.
    aft, _ = ready("sportstar_aft")
    assert aircraft.mass is not None
    assert aft.mass is not None
    assert aft.mass.mass == pytest.approx(aircraft.mass.mass)
    assert aft.mass.cg[0] - aircraft.mass.cg[0] == pytest.approx(-0.02 * aircraft.c, abs=1e-9)


def test_sportstar_drag_is_the_published_line_where_it_was_found() -> None:
    aircraft, model = ready("sportstar")
    for alpha in np.linspace(-0.06, 0.19, 6):
        assert coefficients(model, {"alpha": alpha})["CD"] == pytest.approx(
            0.0510 + 0.6908 * alpha, abs=1e-15
        )
    low, high = model.validity["alpha"]
    assert 0.0510 + 0.6908 * low > 0.0  # beyond -0.074 rad the line is negative
    for V in (24.7, 59.0):
        assert low < level(aircraft, model, V, 1.225).alpha < high


@pytest.mark.parametrize("name", ["sportstar", "x8"])
def test_separated_flow_is_a_flat_plate(name: str) -> None:
    """Full separation at 0.6 rad: drag of 2 sin2, lift below the attached flow's maximum."""
    _, model = ready(name)
    assert model.stall is not None
    drag = coefficients(model, {"alpha": 0.6})["CD"] + model.stall.CD_X
    assert drag == pytest.approx(2.0 * np.sin(0.6) ** 2, rel=0.02)  # values of two digits
    assert {n for n in model.assumed if n.startswith("stall.")} >= {"stall.a1", "stall.alpha_star"}


def test_x8_has_the_published_values_with_the_aileron_turned() -> None:
    published = scipy.io.loadmat(data("parameters", "x8_param.mat"))
    aircraft, model = ready("x8")
    assert aircraft.mass is not None
    for ours, theirs in (("S", "S_wing"), ("b", "b"), ("c", "c")):
        assert getattr(aircraft, ours) == pytest.approx(published[theirs].item(), rel=1e-4)
    assert aircraft.mass.mass == pytest.approx(published["mass"].item(), rel=1e-6)
    named = {"0": "0", "alpha": "alpha", "alpha2": "alpha2", "beta": "beta", "beta2": "beta2"}
    named |= {"q": "q", "p": "p", "r": "r", "de": "delta_e", "da": "delta_a", "de2": "delta_e"}
    checked = 0
    for parameter, value in model.params.items():
        coefficient, variable = parameter.split("_")
        key = f"C_{coefficient[1]}_{named[variable]}"
        if coefficient == "CD" and variable in ("alpha", "beta"):
            key += "1"
        turned = -1.0 if variable == "da" else 1.0
        # Five digits in the file.
        assert value == pytest.approx(turned * published[key].item(), rel=5e-5), parameter
        checked += 1
    assert checked == len(model.params) > 20
    # Positive deflection, negative moment: the right elevon down rolls left.
    assert model.params["Cl_da"] < 0.0
    assert "dr" not in aircraft.control_limits


def test_citation_keeps_published_means_but_for_those_it_names() -> None:
    """Van den Hoek et al. 2017, Tables 2 to 7."""
    _, model = ready("citation2")
    published = {
        "CX_0": -0.051, "CX_de": -0.172, "CY_beta": -0.794, "CY_p": -0.159, "CZ_0": -0.213,
        "CZ_alpha": -4.037, "CZ_de": -0.836, "Cl_beta": -0.073, "Cl_p": -0.494, "Cl_r": 0.376,
        "Cl_da": -0.178, "Cm_0": 0.021, "Cm_alpha": -0.488, "Cm_de": -1.250, "Cn_beta": 0.079,
        "Cn_r": -0.295, "Cn_da": -0.025, "Cn_dr": -0.065,
    }  # fmt: skip
    for name, value in model.params.items():
        assert (name in model.assumed) != (model.params[name] == published.get(name)), name
        assert np.isfinite(value)
    for alpha in np.linspace(*model.validity["alpha"], 8):
        assert coefficients(model, {"alpha": alpha})["CD"] > 0.0
