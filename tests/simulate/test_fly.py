"""Flying: trim, refusals, and what the flight gives back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput
from alula.model import AeroModel, Reference, aero_model, load_model
from alula.simulate import Airframe, airframe_of, fly, initial_state, trim_level

AIRCRAFT = Path(__file__).parents[2] / "aircraft"


@pytest.fixture(scope="module")
def model() -> AeroModel:
    return load_model(AIRCRAFT / "sportstar_aero.toml")


@pytest.fixture(scope="module")
def airframe() -> Airframe:
    return airframe_of(load_aircraft(AIRCRAFT / "sportstar.toml"))


@pytest.mark.parametrize("gamma", [0.0, -0.05])
def test_trim_holds(airframe: Airframe, model: AeroModel, gamma: float) -> None:
    wind = np.array([4.0, -3.0, 0.0])
    trim = trim_level(airframe, model, 45.0, 900.0, gamma=gamma, psi=0.5, wind=wind)
    # Force balance, written down a second time: lift and thrust against weight along the lift.
    q_bar = 0.5 * 1.1226 * 45.0**2  # rho of the published table at 900 m, 5 digits
    CL = 0.4879 + 5.0702 * trim.alpha + 0.4730 * trim.controls["de"]
    across = q_bar * 10.6 * CL + trim.thrust * np.sin(trim.alpha)
    assert across == pytest.approx(560.0 * 9.80665 * np.cos(gamma), rel=2e-4)
    t = np.arange(0.0, 5.0, 0.01)
    m = fly(
        airframe, model, trim.state, t, {**trim.controls, "thrust": trim.thrust}, wind=wind
    ).motion
    np.testing.assert_allclose(m.V, 45.0, atol=1e-2 if gamma else 1e-9)  # density changes below
    np.testing.assert_allclose(m.h, 900.0 + 45.0 * np.sin(gamma) * t, atol=2e-2 if gamma else 1e-8)
    np.testing.assert_allclose(m.q, 0.0, atol=1e-4 if gamma else 1e-12)


def test_trim_that_does_not_exist_names_the_limit(airframe: Airframe, model: AeroModel) -> None:
    with pytest.raises(BadInput, match=r"no_trim") as caught:
        trim_level(airframe, model, 45.0, 900.0, limits={"thrust": (0.0, 100.0)})
    assert "thrust" in caught.value.messages[0].found


def test_motion_is_consistent_with_itself(airframe: Airframe, model: AeroModel) -> None:
    trim = trim_level(airframe, model, 45.0, 900.0)
    t = np.arange(0.0, 10.0, 0.01)
    de = trim.controls["de"] + 0.03 * np.sin(2.0 * t)
    da = 0.05 * np.sin(1.5 * t)
    controls = {**trim.controls, "de": de, "da": da, "thrust": trim.thrust}
    # Without the stall, whose increments are no terms of the model.
    flight = fly(airframe, model, trim.state[:13], t, controls, stall=False)
    m = flight.motion
    # Rates of change of the states against central differences: h^2 / 6 of the third derivative,
    # 4e-4 of the amplitude at 5 rad/s; five times that at the start, where the inputs set in.
    for state, rate in ((m.p, m.pdot), (m.q, m.qdot), (m.r, m.rdot)):
        np.testing.assert_allclose(
            np.gradient(state, t)[1:-1], rate[1:-1], atol=2e-3 * np.abs(rate).max()
        )
    # Kinematics, Dittrich 2016, Eq. (2.54): Euler rates from body rates.
    phi_rate = m.p + (m.q * np.sin(m.phi) + m.r * np.cos(m.phi)) * np.tan(m.theta)
    np.testing.assert_allclose(np.gradient(m.phi, t)[1:-1], phi_rate[1:-1], atol=1e-3)
    # Inertial acceleration is specific force turned to Earth axes plus gravity, along down.
    sx, cx, sy, cy = np.sin(m.phi), np.cos(m.phi), np.sin(m.theta), np.cos(m.theta)
    down = -m.ax * sy + m.ay * sx * cy + m.az * cx * cy + 9.80665
    np.testing.assert_allclose(np.gradient(flight.velocity[:, 2], t)[1:-1], down[1:-1], atol=2e-3)
    # Coefficients are the model's at this motion.
    variables = {
        **m.controls, "V": m.V, "alpha": m.alpha, "beta": m.beta,
        "phat": m.p * 8.65 / (2 * m.V), "qhat": m.q * 1.25 / (2 * m.V),
        "rhat": m.r * 8.65 / (2 * m.V), "mach": flight.mach,
    }  # fmt: skip
    for name, values in model.evaluate(variables).items():
        np.testing.assert_allclose(m.recorded[name], values, atol=1e-13)


def test_steps_do_not_matter(airframe: Airframe, model: AeroModel) -> None:
    trim = trim_level(airframe, model, 45.0, 900.0)
    t = np.arange(0.0, 5.0, 0.02)
    controls = {**trim.controls, "de": trim.controls["de"] - 0.02, "thrust": trim.thrust}
    coarse = fly(airframe, model, trim.state, t, controls).motion
    fine = fly(airframe, model, trim.state, t, controls, substeps=8).motion
    # RK4 at 0.02 s with the short period at 5 rad/s: (0.1)^5 / 120 a step
    np.testing.assert_allclose(coarse.alpha, fine.alpha, atol=1e-7)


def test_impossible_inertia_is_refused(model: AeroModel) -> None:
    with pytest.raises(BadInput, match="impossible_inertia"):
        fly(
            Airframe(560.0, np.diag([655.0, 400.0, 1139.0])),
            model,
            initial_state(45.0, 0.0, 0.0, 900.0),
            np.arange(3.0),
            {},
        )


def test_divergence_is_told(airframe: Airframe) -> None:
    wild = aero_model(
        "wild", {"Cm": "qhat + alpha"}, {"Cm_q": 3e4, "Cm_alpha": 50.0}, Reference(10.6, 8.65, 1.25)
    )
    x0 = initial_state(45.0, 0.1, 0.0, 900.0)
    with pytest.raises(BadInput, match="diverged"):
        fly(airframe, wild, x0, np.arange(0.0, 60.0, 0.05), {}, check=False)


@pytest.mark.parametrize(
    ("t", "controls", "code"),
    [
        (np.array([0.0, 1.0, 3.0]), {}, "uneven_time"),
        (np.array([0.0]), {}, "uneven_time"),
        (np.arange(3.0), {"elevator": 0.1}, "unknown_control"),
        (np.arange(3.0), {"de": np.array([0.0, 1.0])}, "bad_control"),
        (np.arange(3.0), {"de": np.nan}, "bad_control"),
    ],
)
def test_bad_input_is_refused(
    airframe: Airframe, model: AeroModel, t: np.ndarray, controls: dict[str, object], code: str
) -> None:
    with pytest.raises(BadInput, match=code):
        fly(airframe, model, initial_state(45.0, 0.0, 0.0, 900.0), t, controls)  # type: ignore[arg-type]
