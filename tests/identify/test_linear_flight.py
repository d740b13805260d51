"""The linear equations of flight against slopes of the nonlinear ones."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.flight import Maneuver
from alula.identify import Reference
from alula.identify.flown.flight_functions import flight_functions, record_of
from alula.identify.flown.measured_maneuver import STATES, MeasuredManeuver
from alula.identify.linear.flight import SteadyFlight, linear_flight_model

G, V, M, RHO, S, B, C = 9.80665, 55.0, 1100.0, 1.1, 16.0, 11.0, 1.5
INERTIA = np.array([[1500.0, 0.0, -150.0], [0.0, 1900.0, 0.0], [-150.0, 0.0, 3000.0]])
ALPHA, CLIMB, THRUST = 0.06, 0.04, 1800.0
QS = 0.5 * RHO * V**2 * S
DERIVATIVES = {
    "CD_alpha": 0.3, "CD_de": 0.02, "CL_alpha": 5.1, "CL_q": 6.0, "CL_de": 0.35,
    "Cm_alpha": -1.1, "Cm_q": -14.0, "Cm_de": -1.4,
    "CY_beta": -0.6, "CY_p": -0.05, "CY_r": 0.25, "CY_dr": 0.18, "Cl_beta": -0.08, "Cl_p": -0.5,
    "Cl_r": 0.15, "Cl_da": -0.2, "Cl_dr": 0.01, "Cn_beta": 0.07, "Cn_p": -0.06, "Cn_r": -0.12,
    "Cn_da": 0.01, "Cn_dr": -0.08,
}  # fmt: skip
FORMULAS = {
    "CD": "1 + alpha + de", "CL": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de",
    "CY": "beta + phat + rhat + dr", "Cl": "beta + phat + rhat + da + dr",
    "Cn": "beta + phat + rhat + da + dr",
}  # fmt: skip


def nonlinear(states, thrust_z=0.0, push=(0.0, 0.0, 0.0), arm=(0.0, 0.0, 0.0), trim=None):
    """Functions and inputs of a maneuver that is nothing but the steady flight."""
    n = 3
    steady = dict.fromkeys(STATES, 0.0) | {"V": V, "alpha": ALPHA, "theta": ALPHA + CLIMB}
    m = MeasuredManeuver(
        maneuver=Maneuver("steady", "log", "", 0.0, 1.0),
        t=np.arange(n) * 0.1,
        outputs={"q": np.zeros(n)},
        motion={k: np.full(n, v) for k, v in steady.items()},
        controls={k: np.zeros(n) for k in ("de", "da", "dr")},
        rho=np.full(n, RHO),
        reference=Reference(S, B, C, np.zeros(3)),
        mass=M,
        inertia=INERTIA,
        speed_of_sound=np.full(n, 340.0),
        force=np.tile([THRUST, 0.0, thrust_z], (n, 1)),
        moment=np.tile(push, (n, 1)),
        arm=np.array(arm),
    )
    functions = flight_functions(m, FORMULAS, states, ["q"])
    trim = trim or {
        "CD_0": (THRUST * np.cos(ALPHA) - M * G * np.sin(CLIMB)) / QS - 0.3 * ALPHA,
        "CL_0": (M * G * np.cos(CLIMB) - THRUST * np.sin(ALPHA)) / QS - 5.1 * ALPHA,
        "Cm_0": 1.1 * ALPHA,
    }
    values = {**DERIVATIVES, **trim}
    p = np.array([values[name] for name in functions.parameters])
    x = np.array([steady[s] for s in states])
    return functions, x, record_of(m, ["q"]).inputs[0], p


@pytest.mark.parametrize(
    ("states", "names", "controls"),
    [
        (("V", "alpha", "q", "theta"), ("CD", "CL", "Cm"), ("de",)),
        (("beta", "p", "r", "phi"), ("CY", "Cl", "Cn"), ("da", "dr")),
    ],
)
def test_entries_are_the_slopes_of_the_nonlinear_equations(states, names, controls):
    functions, x, u, p = nonlinear(states)
    np.testing.assert_allclose(functions.derivative(x, u, p), 0.0, atol=1e-12)  # it is steady
    steady = SteadyFlight(V, ALPHA, ALPHA + CLIMB, RHO, M, INERTIA, S, B, C, THRUST, G)
    model = linear_flight_model(
        steady, {c: FORMULAS[c] for c in names}, controls=controls, trim=False
    )
    matrices = model.at(np.array([DERIVATIVES[n] for n in model.parameters]))
    h = 1e-6
    for i in range(len(x)):
        step = np.eye(len(x))[i] * h
        slope = functions.derivative(x + step, u, p) - functions.derivative(x - step, u, p)
        # rounding of accelerations of 10 over 2e-6
        np.testing.assert_allclose(matrices.A[:, i], slope / (2 * h), atol=1e-7)
    place = {"de": 8, "da": 9, "dr": 10}
    for j, control in enumerate(controls):
        step = np.zeros(len(u))
        step[place[control]] = h
        slope = functions.derivative(x, u + step, p) - functions.derivative(x, u - step, p)
        np.testing.assert_allclose(matrices.B[:, j], slope / (2 * h), atol=1e-7)


@pytest.mark.parametrize(
    ("states", "names", "controls"),
    [
        (("V", "alpha", "q", "theta"), ("CD", "CL", "Cm"), ("de",)),
        (("beta", "p", "r", "phi"), ("CY", "Cl", "Cn"), ("da", "dr")),
        (("alpha", "q"), ("CL", "Cm"), ("de",)),
    ],
)
def test_total_states_have_the_formulas_constants(states, names, controls):
    """Inclined engines off the center of gravity, moments about another point: the whole rates,
    constants included, are those of the nonlinear equations to first order."""
    z_force, push = -250.0, (0.0, 320.0, 0.0)
    # without a formula the drag is what it was in steady flight: its arm would show
    arm = (0.12, 0.0, -0.07) if len(states) == 4 else (0.0, 0.0, 0.0)
    lift, pull = (THRUST * np.sin(ALPHA) - z_force * np.cos(ALPHA),
                  THRUST * np.cos(ALPHA) + z_force * np.sin(ALPHA))  # fmt: skip
    CD, CL = (pull - M * G * np.sin(CLIMB)) / QS, (M * G * np.cos(CLIMB) - lift) / QS
    CX, CZ = CL * np.sin(ALPHA) - CD * np.cos(ALPHA), -CD * np.sin(ALPHA) - CL * np.cos(ALPHA)
    trim = {
        "CD_0": CD - 0.3 * ALPHA,
        "CL_0": CL - 5.1 * ALPHA,
        # no moment: that of the coefficient, of the arm, of the engines
        "Cm_0": 1.1 * ALPHA - (arm[2] * CX - arm[0] * CZ + push[1] / QS) / C,
    }
    functions, x, u, p = nonlinear(states, z_force, push, arm, trim)
    steady = SteadyFlight(
        V, ALPHA, ALPHA + CLIMB, RHO, M, INERTIA, S, B, C, THRUST, G, z_force, push, arm
    )
    formulas = {c: FORMULAS[c] for c in names}
    model = linear_flight_model(steady, formulas, controls=controls, states=states, total=True)
    values = {**DERIVATIVES, **trim}
    m = model.at(np.array([values[n] for n in model.parameters]))
    assert {f"{c}_0" for c in names if "1" in FORMULAS[c]} <= set(model.parameters)
    held = {"V": V, "theta": ALPHA + CLIMB, "alpha": ALPHA}
    w = np.array([*(held.get(n, 0.0) for n in model.inputs), 1.0])
    np.testing.assert_allclose(m.A @ x + m.B @ w, 0.0, atol=1e-11)  # it is steady
    h = 1e-6
    for i in range(len(x)):
        step = np.eye(len(x))[i] * h
        slope = functions.derivative(x + step, u, p) - functions.derivative(x - step, u, p)
        np.testing.assert_allclose(m.A[:, i], slope / (2 * h), atol=1e-7)  # rounding, as above


def test_a_tie_is_one_parameter_in_two_places():
    steady = SteadyFlight(V, ALPHA, ALPHA, RHO, M, INERTIA, S, B, C)
    formulas = {"Cl": "da + dr", "Cn": "beta"}
    free = linear_flight_model(steady, formulas, controls=["da", "dr"], total=True)
    tied = linear_flight_model(
        steady, formulas, controls=["da", "dr"], total=True, tied={"Cl_dr": ("Cl_da", 0.1)}
    )
    assert tied.parameters == ("Cl_da", "Cn_beta")
    at = dict(zip(free.parameters, (-0.2, -0.02, 0.07), strict=True))
    assert list(at) == ["Cl_da", "Cl_dr", "Cn_beta"]
    np.testing.assert_allclose(
        tied.at(np.array([-0.2, 0.07])).B, free.at(np.array(list(at.values()))).B, rtol=1e-14
    )


def test_constants_and_refusals():
    steady = SteadyFlight(V, ALPHA, ALPHA, RHO, M, INERTIA, S, B, C)
    model = linear_flight_model(steady, {"Cm": "1 + alpha + de"}, controls=["de"])
    assert set(model.parameters) == {"Cm_alpha", "Cm_de", "V_0", "alpha_0", "q_0"}
    assert model.belongs["Cm_alpha"] == "qdot"
    with pytest.raises(BadInput, match="not_linear"):
        linear_flight_model(steady, {"Cm": "alpha^2"}, controls=["de"])
    with pytest.raises(BadInput, match="unknown_coefficient"):
        linear_flight_model(steady, {"Cm": "alpha", "Cn": "beta"}, controls=["de"])
    with pytest.raises(BadInput, match="unknown_state"):
        linear_flight_model(steady, {"Cm": "alpha"}, controls=[], states=["beta"])
    with pytest.raises(BadInput, match="no_state"):
        linear_flight_model(steady, {"CD": "alpha", "Cm": "1"}, controls=[], states=["q"])
