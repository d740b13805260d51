"""Filter error through functions: against the linear one, and for the equations of motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.flight import Maneuver
from alula.identify import Reference
from alula.identify.flown.extended_filter_error import (
    ExtendedFilter,
    FunctionModel,
    identify_extended_filter_error,
)
from alula.identify.flown.filter_error import STATES_OF, identify_flight_filter_error
from alula.identify.flown.measured_maneuver import STATES, MeasuredManeuver
from alula.identify.linear.filter_error import identify_filter_error
from alula.identify.linear.model import linear_model, sample
from alula.identify.linear.record import Unknowns, linear_record

DT = 0.04


def roll(seed=0, n=250):
    rng = np.random.default_rng(seed)
    t = DT * np.arange(n)
    da = 0.06 * np.sin(1.5 * t) * (t > 1.0)
    p = np.zeros(n)
    phi = np.exp(-3.0 * DT)
    for i in range(n - 1):
        p[i + 1] = phi * p[i] + (1.0 - phi) / 3.0 * (-12.0 * 0.5 * (da[i] + da[i + 1]))
        p[i + 1] += 0.03 * rng.standard_normal()
    model = linear_model({"p": "Lp*p + Lda*da"}, ["p"], ["da"])
    record = linear_record("a", t, {"p": p + 0.03 * rng.standard_normal(n), "da": da}, model)
    return model, record


def roll_function():
    return FunctionModel(
        states=("p",),
        outputs=("p",),
        parameters=("Lp", "Lda"),
        derivative=lambda x, u, p: p[..., :1] * x + p[..., 1:] * u,
        output=lambda x, u, p: x + 0.0 * p[..., :1],
        size=(0.1,),
    )


def test_inputs_run_straight_between_samples():
    """Samples as long as the mode, an input that jumps: without noise the filter only flies,
    as the exact sampled model does. Slopes by differences are good to 1e-9.
    """
    model, _ = roll()
    t = DT * 8.0 * np.arange(40)
    u = np.sign(np.sin(2.0 * t))
    coarse = linear_record("a", t, {"p": 0.0 * t, "da": u}, model)
    Lp, Lda = -3.0, -12.0
    step = sample(model.at(np.array([Lp, Lda])), coarse.dt)
    w = np.column_stack([u, np.ones(len(u))])
    p = [np.array([0.1])]
    for now, after in pairwise(w):
        p.append(step.phi @ p[-1] + step.now @ now + step.next @ after)
    names = Unknowns(model, [coarse], (), {}, initial=True)
    noises = {"F_p": 1e-9, "sigma_p": 1.0}
    first = {"Lp": Lp, "Lda": Lda, "p(0)[a]": 0.1}
    filter_ = ExtendedFilter([roll_function()], [coarse], names, ["p"], noises, first)
    (flown,) = filter_.run(filter_.first[None, :]) or []
    np.testing.assert_allclose(flown.y[0, :, 0], np.array(p)[:, 0], atol=1e-7)


def test_agrees_with_the_linear_filter():
    """The same model as functions: the same likelihood, but for Q by the trapezoidal rule, which
    errs by (Lp dt)^2 / 6 = 0.2 %.
    """
    model, record = roll()
    function = roll_function()
    linear = identify_filter_error(model, [record], gain="varying")
    start = {"Lp": -2.0, "Lda": -8.0}
    extended = identify_extended_filter_error(function, [record], start=start)
    for name in ("Lp", "Lda", "F_p", "sigma_p"):
        assert extended[name].value == pytest.approx(linear[name].value, rel=0.01)
        assert extended[name].se_white == pytest.approx(linear[name].se_white, rel=0.02)
    with pytest.raises(BadInput, match="no_start"):
        identify_extended_filter_error(function, [record], start={"Lp": -2.0})


TRUE = {
    "CZ_0": -0.45,
    "CZ_alpha": -5.5,
    "Cm_0": 0.02,
    "Cm_alpha": -1.2,
    "Cm_q": -25.0,
    "Cm_de": -1.5,
}
FORMULAS = {"CZ": "1 + alpha", "Cm": "1 + alpha + qhat + de"}


def short_period(seed, n=200):
    """Alpha and q of a light airplane in turbulence, by Euler's rule at 20 steps a sample and
    equations written out here: 60 m/s, S 16 m2, c 1.5 m, 1100 kg, Iyy 1800 kg m2.
    """
    rng = np.random.default_rng(seed)
    t = DT * np.arange(n)
    de = 0.03 * np.sign(np.sin(2.0 * np.pi * t / 2.5)) * (t > 1.0) + 0.005
    V, qS, m, Iyy, g = 60.0, 0.5 * 1.2 * 60.0**2 * 16.0, 1100.0, 1800.0, 9.80665
    alpha, q = np.empty(n), np.empty(n)
    az = np.empty(n)
    a, w = 0.012, 0.0
    v, fine = TRUE, DT / 20
    for i in range(n):
        alpha[i], q[i] = a, w
        az[i] = qS * (v["CZ_0"] + v["CZ_alpha"] * a) / m
        for k in range(20):
            d = de[i] + (de[min(i + 1, n - 1)] - de[i]) * (k + 0.5) / 20
            CZ = v["CZ_0"] + v["CZ_alpha"] * a
            Cm = v["Cm_0"] + v["Cm_alpha"] * a + v["Cm_q"] * w * 1.5 / (2 * V) + v["Cm_de"] * d
            # theta = 0 and CX = 0 as 'measured'
            rate = w + (np.cos(a) * (qS * CZ / m + g)) / V
            a += fine * rate + 0.01 * fine**0.5 * rng.standard_normal()
            w += fine * qS * 1.5 * Cm / Iyy + 0.05 * fine**0.5 * rng.standard_normal()
    zero = np.zeros(n)
    noisy = {
        "alpha": alpha + 0.002 * rng.standard_normal(n),
        "q": q + 0.004 * rng.standard_normal(n),
        "az": az + 0.2 * rng.standard_normal(n),
    }
    motion = dict.fromkeys(STATES, zero) | {"V": np.full(n, V)}
    motion |= {k: noisy[k] for k in ("alpha", "q")}
    return MeasuredManeuver(
        maneuver=Maneuver("gusty", "log", "3211", 0.0, t[-1], "longitudinal"),
        t=t,
        outputs=noisy,
        motion=motion,
        controls={"de": de},
        rho=np.full(n, 1.2),
        reference=Reference(16.0, 11.0, 1.5, np.zeros(3)),
        mass=m,
        inertia=np.diag([1500.0, Iyy, 3000.0]),
        speed_of_sound=np.full(n, 340.0),
        force=np.zeros((n, 3)),
        moment=np.zeros((n, 3)),
        arm=np.zeros(3),
        coefficients=dict.fromkeys(("CX", "CY", "CZ", "Cl", "Cm", "Cn"), zero),
    )


def test_equations_of_motion_in_turbulence():
    """One gusty maneuver: every derivative within 4 of its errors and known to a third at least."""
    found = identify_flight_filter_error(
        [short_period(3)],
        FORMULAS,
        states=STATES_OF["longitudinal"],
        outputs=["alpha", "q", "az"],
        start={**dict.fromkeys(TRUE, 0.0), **{k: 0.7 * v for k, v in TRUE.items()}},
        truth=TRUE,
    )
    assert found.status.startswith("converged")
    for name, value in TRUE.items():
        assert abs(found[name].value - value) < 4.0 * found[name].se, name
    for name in ("CZ_alpha", "Cm_alpha", "Cm_q", "Cm_de"):
        assert found[name].se < abs(TRUE[name]) / 3.0
    assert found["F_q"].value == pytest.approx(0.05, rel=0.5)
    assert found["Cm_q"].coefficient == "Cm"


def test_unknown_names_are_refused():
    with pytest.raises(BadInput, match="unknown_option"):
        identify_flight_filter_error([short_period(0)], FORMULAS, states=["u"], outputs=["q"])
