"""Designs stay inside the limits, tell what they excite, and predict the scatter that comes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput
from alula.campaign import run_project
from alula.model import load_model
from alula.plan import Design, design, limits_of, outside, planned
from alula.plan.design import SENSORS
from alula.simulate.virtual_campaign import fly_plan
from alula.simulate.virtual_flight import fly_maneuver, trimmed
from alula.simulate.virtual_loading import loadings_of
from alula.simulate.virtual_maneuvers import maneuvers_of

AIRCRAFT = Path(__file__).parents[2] / "aircraft"
FILE, MODEL_FILE = AIRCRAFT / "sportstar.toml", AIRCRAFT / "sportstar_aero.toml"
MODEL = load_model(MODEL_FILE)
WHITE = {
    name: {key: value for key, value in table.items() if key in ("sigma", "unit")}
    for name, table in SENSORS.items()
}


def designed(**more: object) -> Design:
    return design(FILE, MODEL, MODEL_FILE, 45.0, 915.0, **more)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def usual() -> Design:
    return designed()


def test_flown_as_planned_it_stays_inside(usual: Design) -> None:
    plan = planned(usual.tree)
    loading = loadings_of(plan)[""]
    limits = limits_of(load_aircraft(FILE), MODEL)
    for item in maneuvers_of(plan):
        trim = trimmed(plan, loading, MODEL, item.condition)
        flight = fly_maneuver(plan, item, loading, MODEL, trim)
        assert not outside(flight, limits)
        for name, (low, high) in loading.aircraft.control_limits.items():
            values = flight.motion.controls[name]
            assert low <= values.min() <= values.max() <= high


def test_it_uses_the_room_there_is(usual: Design) -> None:
    """Half as much again leaves the limits: the amplitude is near the largest."""
    plan = planned(usual.tree)
    loading, item = loadings_of(plan)[""], maneuvers_of(plan)[0]
    tree = {**usual.tree, "maneuvers": [dict(usual.tree["maneuvers"][0])]}
    inputs = [dict(i) for i in tree["maneuvers"][0]["inputs"]]
    inputs[0]["amplitude_deg"] *= 1.5
    tree["maneuvers"][0]["inputs"] = inputs
    more = planned(tree)
    trim = trimmed(more, loading, MODEL, item.condition)
    flight = fly_maneuver(more, maneuvers_of(more)[0], loading, MODEL, trim)
    assert outside(flight, limits_of(load_aircraft(FILE), MODEL))


def test_an_elevator_tells_nothing_lateral(usual: Design) -> None:
    elevator = next(m for m in usual.maneuvers if m.id == "elevator")
    names = {p.coefficient for p in elevator.predictions}
    assert names == {"CD", "CL", "Cm"}
    told = {p.name for p in elevator.predictions if p.verdict == "told"}
    assert {"CL_alpha", "Cm_alpha", "Cm_q", "Cm_de"} <= told


def test_a_rudder_alone_does_not_tell_the_aileron() -> None:
    found = {p.name: p for p in designed(requests=[("dr", "doublet")]).together}
    assert found["Cl_da"].verdict == found["Cn_da"].verdict == "not told"
    assert not np.isfinite(found["Cl_da"].se)
    assert found["Cn_beta"].verdict == "told"


def test_more_amplitude_tells_more(usual: Design) -> None:
    """Noise is the same and regressors shrink: so do their standard errors, in proportion."""
    from alula.plan.information import Flown, predict
    from alula.simulate.virtual_flight import airframe

    loading = loadings_of(planned(usual.tree))[""]
    found = []
    for factor in (1.0, 0.5):
        table = dict(usual.tree["maneuvers"][0])
        table["inputs"] = [
            {**i, "amplitude_deg": factor * i["amplitude_deg"]} for i in table["inputs"]
        ]
        plan = planned({**usual.tree, "maneuvers": [table]})
        item = maneuvers_of(plan)[0]
        trim = trimmed(plan, loading, MODEL, item.condition)
        flight = fly_maneuver(plan, item, loading, MODEL, trim)
        frame = airframe(plan, loading)
        flown = [Flown(flight.motion, frame.mass, frame.inertia)]
        sigma = {n: plan.sensors[n].in_si(plan.sensors[n].sigma) for n in plan.sensors}
        found.append(
            {p.name: p.se for p in predict(flown, MODEL, {"Cm": "1 + alpha + qhat + de"}, sigma)}
        )
    for name in ("Cm_alpha", "Cm_q", "Cm_de"):
        # The response is not quite linear in the amplitude: 10 %.
        assert found[1][name] == pytest.approx(2.0 * found[0][name], rel=0.1)


def test_a_3211_tells_the_damping_better_than_a_doublet() -> None:
    """The wider band separates alpha, q and de (Jategaonkar 2015, Chap. 2)."""
    se = {}
    for kind in ("3211", "doublet"):
        one = designed(requests=[("de", kind)])
        se[kind] = {p.name: p.se for p in one.together}
    assert se["3211"]["Cm_q"] < se["doublet"]["Cm_q"]
    assert se["3211"]["CL_q"] < se["doublet"]["CL_q"]


def test_force_errors_are_those_of_least_squares() -> None:
    """With only accelerometer noise, se is sigma m / (q S) times the root of (X'X)^-1."""
    from alula.identify.coefficients import Reference, regressor_variables
    from alula.plan.information import Flown, predict
    from alula.simulate.virtual_flight import airframe

    plan = planned(designed(requests=[("dr", "doublet")]).tree)
    loading, item = loadings_of(plan)[""], maneuvers_of(plan)[0]
    trim = trimmed(plan, loading, MODEL, item.condition)
    m = fly_maneuver(plan, item, loading, MODEL, trim).motion
    frame = airframe(plan, loading)
    formula = {"CY": "1 + beta + phat + rhat + dr"}
    found = predict([Flown(m, frame.mass, frame.inertia)], MODEL, formula, {"ay": 0.03})
    r = MODEL.reference
    v = regressor_variables(m, Reference(r.S, r.b, r.c, MODEL.reference_point))
    X = np.column_stack([np.ones(len(m.t)), v["beta"], v["phat"], v["rhat"], v["dr"]])
    noise = 0.03 * frame.mass / (0.5 * m.rho * m.V**2 * r.S)
    se = np.sqrt(np.diag(np.linalg.inv(X.T @ X))) * np.mean(noise)
    names = ["CY_0", "CY_beta", "CY_p", "CY_r", "CY_dr"]
    for p in found:
        # The dynamic pressure changes by some percent in the maneuver.
        assert p.se == pytest.approx(se[names.index(p.name)], rel=0.05), p.name


def test_unknown_control_is_refused() -> None:
    with pytest.raises(BadInput, match="'dx'"):
        designed(requests=[("dx", "doublet")])


@pytest.mark.slow
def test_predicted_errors_are_the_scatter_of_identifications(tmp_path: Path) -> None:
    """30 virtual flights with other noise, reconstructed and identified as any log.

    White noise only: what `predict` says it assumes. The scatter of 30 has a standard error of
    13 %; what is left is the smoother's error, which is colored, within a factor of two.
    """
    found = designed(sensors=WHITE)
    formulas = {c: f for c, f in MODEL.formulas.items() if c != "CD"}
    lateral = {c: f"1 + {f}" for c, f in formulas.items() if not f.startswith("1")}
    tree = {
        **found.tree,
        "engines": "given",
        "identify": {**formulas, **lateral, "CD": "1 + alpha"},
    }
    values: dict[str, list[float]] = {}
    for seed in range(30):
        flown = fly_plan(planned(tree), tmp_path / "out", seed=seed)
        for p in run_project(str(flown.project)).identification.parameters:
            values.setdefault(p.name, []).append(p.value)
    checked = 0
    for p in found.together:
        if p.verdict == "told" and p.name in values and not p.name.startswith("CD"):
            ratio = np.std(values[p.name], ddof=1) / p.se
            assert 0.4 < ratio < 2.0, (p.name, ratio)
            checked += 1
    assert checked >= 18


def test_output_error_is_predicted_sharper_of_the_same_maneuvers(usual: Design) -> None:
    """It needs no derivative of the rates; of forces it knows no more than the accelerometers."""
    found = designed(method="oe")
    assert (usual.method, found.method) == ("ee", "oe")
    assert found.tree == usual.tree
    by = {p.name: p for p in usual.together}
    assert {p.name for p in found.together} == by.keys()
    for p in found.together:
        if np.isfinite(p.se):
            assert 0.2 * by[p.name].se < p.se < 1.02 * by[p.name].se, p.name
    elevator, lateral = found.maneuvers
    assert {p.coefficient for p in elevator.predictions} == {"CD", "CL", "Cm"}
    assert {p.coefficient for p in lateral.predictions} == {"CY", "Cl", "Cn"}


def test_output_error_takes_the_sensors_there_are() -> None:
    inertial = {n: t for n, t in SENSORS.items() if n in ("ax", "ay", "az", "p", "q", "r")}
    whole, few = (
        {p.name: p.se for p in designed(method="oe", sensors=s).together}
        for s in (SENSORS, inertial)
    )
    assert all(few[n] >= 0.99 * whole[n] for n in whole)
    with pytest.raises(BadInput, match="sigma for at least one of"):
        designed(method="oe", sensors={"h": SENSORS["h"]})
