"""Filter error through functions: against the linear one, and for the equations of motion."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.identify.flown.extended_filter_error import (
    ExtendedFilter,
    FunctionModel,
    function_filter,
    identify_extended_filter_error,
)
from alula.identify.flown.filter_error import (
    STATES_OF,
    core_filter,
    identify_flight_filter_error,
)
from alula.identify.flown.flight_functions import flight_functions, record_of
from alula.identify.flown.measured_maneuver import OUTPUTS, STATES
from alula.identify.flown.start import measured_coefficients
from alula.identify.likelihood.innovations import InnovationLikelihood
from alula.identify.linear.filter_error import FilterError, identify_filter_error
from alula.identify.linear.model import linear_model, sample
from alula.identify.linear.record import Unknowns, linear_record
from identify.flown_maneuvers import LATERAL, LONGITUDINAL, TRUTH, every_axis, flown
from identify.gusty_maneuver import FORMULAS, TRUE, short_period

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


@pytest.mark.parametrize("form", ["linear", "functions"])
def test_the_likelihood_is_bounded_where_a_sensor_is_perfect(form):
    """An initial state that meets the first reading exactly, and a sensor's noise a thousand times
    smaller, both far below the process noise: nothing that data could tell apart. From an exact
    initial state the cost would fall by ln(1000) = 6.9, and the state's error bar with the noise.
    """
    model, record = roll()
    names = Unknowns(model, [record], (), {}, initial=True)
    first = {"Lp": -3.0, "Lda": -12.0, "p(0)[a]": float(record.outputs[0, 0])}
    if form == "linear":
        problem = FilterError(model, [record], names, ["p"], "varying", {}, first)
    else:
        problem = ExtendedFilter([roll_function()], [record], names, ["p"], {}, first)
    at = problem.first.copy()
    at[list(problem.names).index("F_p")] = np.log(0.2)  # 0.04 in one sample
    cost, error = [], []
    for sigma in (1e-5, 1e-8):
        at[list(problem.names).index("sigma_p")] = np.log(sigma)
        point = InnovationLikelihood(problem.run)(at, True)
        assert point is not None
        cost.append(point.cost)
        error.append(point.information[2, 2] ** -0.5)
    assert cost[1] == pytest.approx(cost[0], abs=1e-3)  # n (sigma / 0.04)^2
    assert error == pytest.approx([0.04, 0.04], rel=0.1)  # what one sample's noise leaves


def test_a_maneuver_is_filtered_with_its_own_parameters_only():
    """The same derivatives as with every filter run on every maneuver."""
    model, record = roll()
    records = [record, replace(roll(seed=1, n=150)[1], id="b")]
    names = Unknowns(model, records, (), {}, initial=True)
    first = {"Lp": -2.0, "Lda": -8.0}
    problem = ExtendedFilter([roll_function()] * 2, records, names, ["p"], {}, first)
    counts = []

    def every(members):
        runs = problem.run(members) or []
        counts.append([len(r.v) for r in runs])
        place = [np.zeros(len(members), dtype=int) for _ in runs]
        for p, r in zip(place, runs, strict=True):
            p[r.members] = np.arange(len(r.v))
        return [
            replace(r, v=r.v[p], S=r.S[p], y=r.y[p], members=None)
            for p, r in zip(place, runs, strict=True)
        ]

    lean = InnovationLikelihood(problem.run)(problem.first, True)
    whole = InnovationLikelihood(every)(problem.first, True)
    assert counts == [[11, 11]]  # of 13: Lp Lda F sigma and one initial state, to either side
    np.testing.assert_allclose(lean.gradient, whole.gradient, rtol=1e-12)
    np.testing.assert_allclose(lean.information, whole.information, rtol=1e-9, atol=1e-12)


STABILITY = {
    "CD": "1 + CL^2", "CL": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de + abs(alpha)",
    "CY": "beta + dr", "Cl": "beta + phat + rhat + da", "Cn": "beta + rhat + (beta - 0.01)+^2",
}  # fmt: skip
CASES = {
    "longitudinal": (LONGITUDINAL, ("V", "alpha", "q", "theta"), ("V", "alpha", "q", "ax", "az")),
    "two states": (LONGITUDINAL, ("alpha", "q"), ("alpha", "q", "theta", "az", "qdot")),
    "lateral": (LATERAL, ("beta", "p", "r", "phi"), ("beta", "p", "r", "phi", "ay", "rdot")),
    "other order": (LATERAL, ("r", "beta", "p"), ("ay", "p", "r", "beta")),
    "six": (LONGITUDINAL | LATERAL, STATES, OUTPUTS),
    "stability axes": (STABILITY, STATES, OUTPUTS),
}


@pytest.mark.parametrize("case", CASES)
def test_the_core_filters_as_the_functions_do(case):
    """Every kernel of the core against the equations in Python, with a reading in ten missing,
    uneven parameters side by side. Slopes by differences of 1e-6 are good to 1e-8 of each size.
    """
    models, states, outputs = CASES[case]
    m = flown(every_axis, seconds=4.0, seed=5)
    m = replace(m, coefficients=measured_coefficients(m))
    random = np.random.default_rng(0)
    readings = {n: np.where(random.random(len(v)) < 0.1, np.nan, v) for n, v in m.outputs.items()}
    m = replace(m, outputs=readings)
    functions = flight_functions(m, models, states, outputs)
    typical = {"CD_0": 0.03, "CD_CL2": 0.05, "CL_0": 0.25, "CL_alpha": 5.0, "CL_q": 6.0}
    values = np.array([TRUTH.get(n, typical.get(n, 0.1)) for n in functions.parameters])
    values = values * (1.0 + 0.05 * random.standard_normal((3, len(values))))
    x0 = np.array([m.motion[s][0] for s in states]) + 0.01 * random.standard_normal(
        (3, len(states))
    )
    intensity = random.uniform(1e-5, 1e-3, (3, len(states)))
    R = random.uniform(1e-6, 1e-3, (3, len(outputs)))
    core = core_filter(m, models, functions)(values, x0, intensity, R)
    slow = function_filter(functions, record_of(m, outputs), values, x0, intensity, R)
    assert core is not None
    assert slow is not None
    size = np.sqrt(np.einsum("mnkk->mnk", slow.S))
    assert (np.abs(slow.v) > 0.1 * size).any()
    np.testing.assert_array_less(np.abs(core.v - slow.v), 1e-6 * size + 1e-9)
    np.testing.assert_array_less(np.abs(core.y - slow.y), 1e-6 * size + 1e-9)
    scale = size[:, :, :, None] * size[:, :, None, :]
    np.testing.assert_array_less(np.abs(core.S - slow.S), 1e-6 * scale)


def test_a_motion_that_diverges_has_no_innovations():
    m = flown(every_axis, seconds=4.0, seed=5)
    functions = flight_functions(m, LONGITUDINAL | LATERAL, STATES, ("V",))
    values = np.array([[TRUTH[n] for n in functions.parameters]])
    values[0, functions.parameters.index("Cm_alpha")] = 400.0
    x0 = np.array([[m.motion[s][0] for s in STATES]])
    run = core_filter(m, LONGITUDINAL | LATERAL, functions)
    assert run(values, x0, np.zeros((1, 8)), np.ones((1, 1))) is None


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
    units = {p.name: p.unit for p in found.parameters}
    assert units["F_alpha"] == "rad/s^0.5"
    assert units["sigma_az"] == "m/s2"
    assert units["q(0)[gusty]"] == "rad/s"
    assert units["Cm_q"] == "1/rad"


def test_a_tied_term_is_its_factor_times_the_other():
    """Along the tie the same likelihood as with the tied term held at what the tie gives it; as an
    estimate it keeps to the other term, and the model knows it.
    """
    m = short_period(3)
    at = {"states": STATES_OF["longitudinal"], "outputs": ["alpha", "q", "az"]}
    at["start"] = {k: 0.7 * v for k, v in TRUE.items()}
    tied = identify_flight_filter_error([m], FORMULAS, tied={"Cm_de": ("Cm_q", 0.06)}, **at)
    assert "Cm_de" not in tied.params.index
    held = {"Cm_de": 0.06 * tied["Cm_q"].value, "Cm_q": tied["Cm_q"].value}
    fixed = identify_flight_filter_error([m], FORMULAS, fixed=held, **at)
    for p in fixed.parameters:  # both searches end within 1e-4 of a standard error
        assert abs(p.value - tied[p.name].value) < 1e-2 * p.se, p.name
    assert tied["Cm_q"].se < identify_flight_filter_error([m], FORMULAS, **at)["Cm_q"].se
    assert tied.tied == {"Cm_de": ("Cm_q", 0.06)}
    for bad in ({"Cm_df": ("Cm_q", 1.0)}, {"Cm_de": ("Cm_de", 1.0)}, {"Cm_de": ("Cm_df", 1.0)}):
        with pytest.raises(BadInput, match="filter_error"):
            identify_flight_filter_error([m], FORMULAS, tied=bad, **at)


def test_functions_and_core_agree_on_ties():
    m = flown(every_axis, seconds=2.0, seed=5)
    m = replace(m, coefficients=measured_coefficients(m))
    ties = {"Cm_q": ("CZ_q", 2.0), "Cm_de": ("Cm_alpha", 1.4)}
    states, outputs = ("alpha", "q"), ("alpha", "q", "az")
    tied = flight_functions(m, LONGITUDINAL, states, outputs, ties)
    free = flight_functions(m, LONGITUDINAL, states, outputs)
    values = {n: TRUTH[n] for n in tied.parameters}
    every = {**values, **{n: k * values[other] for n, (other, k) in ties.items()}}
    at = np.array([[values[n] for n in tied.parameters]])
    spelled = np.array([[every[n] for n in free.parameters]])
    rest = (np.array([[0.05, 0.0]]), np.full((1, 2), 1e-4), np.full((1, 3), 1e-4))
    same = core_filter(m, LONGITUDINAL, free)(spelled, *rest)
    core = core_filter(m, LONGITUDINAL, tied, ties)(at, *rest)
    slow = function_filter(tied, record_of(m, outputs), at, *rest)
    np.testing.assert_allclose(core.v, same.v, rtol=0, atol=1e-12)  # the same sums
    np.testing.assert_allclose(core.v, slow.v, rtol=0, atol=1e-7)  # slopes by differences


def test_unknown_names_are_refused():
    with pytest.raises(BadInput, match="unknown_option"):
        identify_flight_filter_error([short_period(0)], FORMULAS, states=["u"], outputs=["q"])
