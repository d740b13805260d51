"""Kirchhoff parameters from simulated stalls: right where they can be told, else not told."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from alula.base.messages import BadInput
from alula.identify import identified_model
from alula.identify.flown.stall import identify_stall, separation
from alula.model import load_model, save_model

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from verification.estimation.stall_identification import FORMULAS, identified, stall_data, wing


def test_dynamic_stall_tells_all_four():
    found = identified(("dynamic",), 50)
    for name, share in (("a1", 0.1), ("alpha_star", 0.1), ("tau1", 0.2), ("tau2", 0.2)):
        p = found[name]
        assert p.verdict == "ok"
        assert p.value == pytest.approx(p.truth, rel=share), name  # as the verification asks
        assert abs(p.value - p.truth) < 4.0 * p.se  # by chance one in 16 000


def test_units():
    found = identified(("dynamic",), 50)
    units = {p.name: p.unit for p in found.parameters}
    assert [units[n] for n in ("a1", "alpha_star", "tau1", "tau2")] == ["1/rad", "rad", "s", "s"]
    assert (units["CL_alpha"], units["CL_0"], units["Cm_X"]) == ("1/rad", "1", "1")


def test_quasi_steady_stall_tells_the_angle_and_not_the_delay():
    found = identified(("quasi-steady",), 50, gentle=True)
    assert found["alpha_star"].value == pytest.approx(0.374, rel=0.1)
    assert found["tau2"].verdict == "not_identifiable"
    assert "tau2" in found.status
    assert np.isnan(found["tau2"].value)


def test_attached_flow_tells_no_stall_parameter():
    """The first second of the maneuver, before the pull: no flow separates."""
    d = stall_data(wing(), "dynamic", 3)
    early = replace(
        d,
        t=d.t[:60],
        coefficients={k: v[:60] for k, v in d.coefficients.items()},
        variables={k: v[:60] for k, v in d.variables.items()},
    )
    found = identify_stall([early], FORMULAS)
    assert all(found[n].verdict == "not_identifiable" for n in ("a1", "tau1", "tau2"))


def test_separation_solves_its_equation():
    """Against SciPy on a smooth motion; lines between samples of 0.01 s lack its curvature."""
    t = np.arange(401) / 100.0
    alpha, dot = 0.35 + 0.1 * np.sin(2.0 * t), 0.2 * np.cos(2.0 * t)

    def rate(s, x):
        a, d = 0.35 + 0.1 * np.sin(2.0 * s), 0.2 * np.cos(2.0 * s)
        return (0.5 * (1.0 - np.tanh(25.0 * (a - 0.06 * d - 0.374))) - x) / 0.24

    X = separation(t, alpha, dot, 25.0, 0.374, 0.24, 0.06)
    exact = solve_ivp(rate, (0.0, 4.0), [X[0]], t_eval=t, rtol=1e-9, atol=1e-11).y[0]
    np.testing.assert_allclose(X, exact, atol=3e-4)  # h^2/8 times the curvature of X0, about 20


def test_lift_of_the_attached_flow_is_asked_for():
    with pytest.raises(BadInput, match="CL"):
        identify_stall([stall_data(wing(), "dynamic", 0)], {"Cm": "1 + alpha"})


def test_held_out_stalls_are_predicted_not_learned_from():
    """The held-out one is of an aircraft whose stall is another: learning from it would show."""
    learn = stall_data(wing(), "dynamic", 7)
    other = stall_data(wing(), "dynamic", 8)
    spoiled = replace(
        other,
        maneuver=replace(other.maneuver, id="unseen", held_out=True),
        coefficients={**other.coefficients, "CL": other.coefficients["CL"] + 0.3},
    )
    alone, both = identify_stall([learn], FORMULAS), identify_stall([learn, spoiled], FORMULAS)
    assert both.params.to_dict() == alone.params.to_dict()
    assert both.fits["CL"].n_held_out == len(other.t)
    assert both.fits["CL"].r2_held_out < both.fits["CL"].r2 - 0.1
    good = replace(spoiled, coefficients=other.coefficients)
    assert identify_stall([learn, good], FORMULAS).fits["CL"].r2_held_out > 0.9
    with pytest.raises(BadInput, match="no_maneuver"):
        identify_stall([good], FORMULAS)


def test_what_is_known_is_fixed():
    data = [stall_data(wing(), "dynamic", 7)]
    free, fixed = (
        identify_stall(data, FORMULAS),
        identify_stall(data, FORMULAS, fixed={"tau1": 0.24}),
    )
    assert "tau1" not in fixed.params.index
    assert fixed.fixed == {"tau1": 0.24}
    for name in ("a1", "alpha_star", "tau2"):
        # knowing more never widens; 5 %: residuals' colour is estimated from each fit
        assert fixed[name].se < 1.05 * free[name].se
        assert abs(fixed[name].value - free[name].value) < 2.0 * free[name].se
    assert fixed["tau2"].se < 0.8 * free["tau2"].se  # the two go together
    for bad in ({"tau1": -1.0}, {"tau3": 1.0}):
        with pytest.raises(BadInput, match="bad_option"):
            identify_stall(data, FORMULAS, fixed=bad)


def test_uneven_samples_are_refused():
    d = stall_data(wing(), "dynamic", 7)
    kept = np.delete(np.arange(len(d.t)), np.arange(100, 130))
    holed = replace(
        d,
        t=d.t[kept],
        coefficients={k: v[kept] for k, v in d.coefficients.items()},
        variables={k: v[kept] for k, v in d.variables.items()},
    )
    with pytest.raises(BadInput, match="uneven_time"):
        identify_stall([holed], FORMULAS)


def test_the_model_of_a_stall_is_read_back_and_flies_its_separation(tmp_path):
    found = identified(("dynamic",), 50)
    reference = wing().model.reference
    model = identified_model(found, "stalled", reference)
    save_model(model, tmp_path / "stalled.toml")
    stall = load_model(tmp_path / "stalled.toml").stall
    assert stall is not None
    assert (stall.a1, stall.alpha_star) == (found["a1"].value, found["alpha_star"].value)
    assert stall.Cm_X == found["Cm_X"].value
    # the attached lift is none at alpha_0
    assert found["CL_0"].value + stall.CL_alpha * stall.alpha_0 == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(BadInput, match="tau2"):
        identified_model(identified(("quasi-steady",), 50, gentle=True), "slow", reference)
