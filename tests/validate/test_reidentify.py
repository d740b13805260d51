"""Flights of a model identified again: known noise gives back its own standard errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.identify import CoefficientData, identify_equation_error
from alula.validate import reidentify
from alula.validate.reidentify import coloured_like
from validate.flights import aileron, changed, elevator, truth

MODELS = {"Cm": "1 + alpha + qhat + de", "CL": "1 + alpha + qhat + de"}


def noisy(case, seed, size=2e-3):
    """Coefficients of a flight of the truth with white noise; n of them."""
    random = np.random.default_rng(seed)
    return CoefficientData(
        maneuver=case.motion.maneuver,
        t=case.motion.t,
        coefficients={
            c: case.coefficients[c] + size * random.standard_normal(len(case.motion.t))
            for c in MODELS
        },
        variables=case.variables,
    )


@pytest.fixture(scope="module")
def once():
    case = elevator()
    data = [noisy(case, 1)]
    result = identify_equation_error(data, MODELS)
    model = truth()
    values = dict(zip(model.names, model.values, strict=True)) | {
        p.name: p.value for p in result.parameters
    }
    model = replace(model, values=np.array([values[n] for n in model.names]))

    def identify(other, readings):
        assert not readings
        return identify_equation_error(other, MODELS)

    return model, result, case, data, identify


def test_scatter_is_the_stated_error_and_nothing_is_biased(once):
    """Of 60 draws a deviation is known to 9 %, a mean to 0.13 of it: three of each."""
    model, result, case, data, identify = once
    found, said = reidentify(
        model, result, [case], data, [], identify, gravity=9.80665, draws=60, seed=3
    )
    assert said == ()
    assert {r.name for r in found} == {p.name for p in result.parameters}
    for r in found:
        assert r.draws == 60
        assert r.truth == pytest.approx(result[r.name].value)
        assert abs(r.mean - r.truth) < 0.4 * r.scatter, r.name
        assert r.inside >= 0.85
        if not r.name.endswith("_0"):  # a constant's own coloured error is known to few freedoms
            assert r.scatter == pytest.approx(result[r.name].se_white, rel=0.3), r.name
    again, _ = reidentify(
        model, result, [case], data, [], identify, gravity=9.80665, draws=60, seed=3
    )
    assert again == found


def test_a_model_that_does_not_fly_its_own_maneuver_is_said(once):
    model, result, case, data, identify = once
    wild = changed(model, Cm_alpha=-8.0)
    with pytest.raises(BadInput, match="flies at least one"):
        reidentify(wild, result, [case], data, [], identify, gravity=9.80665, draws=10)
    with pytest.raises(BadInput, match="at least 10 draws"):
        reidentify(model, result, [case], data, [], identify, gravity=9.80665, draws=2)


def test_noise_has_the_residual_s_size_colour_and_gaps():
    random = np.random.default_rng(0)
    white = random.standard_normal(4000)
    slow = np.convolve(white, np.ones(20) / 20.0, "same")
    slow[100:140] = np.nan
    drawn = np.array([coloured_like(slow, random) for _ in range(200)])
    assert np.isnan(drawn[:, 100:140]).all()
    assert np.isfinite(drawn[:, 140:]).all()
    good = slow[140:]
    # 200 draws of some 200 independent values each: half a percent, and what the gap takes
    assert np.std(drawn[:, 140:]) == pytest.approx(np.std(good), rel=0.03)
    lag = np.mean(drawn[:, 140:-10] * drawn[:, 150:]) / np.var(drawn[:, 140:])
    assert lag == pytest.approx(np.mean(good[:-10] * good[10:]) / np.var(good), abs=0.05)


def test_a_lateral_maneuver_flies_too():
    case = aileron()
    data = [replace(noisy(case, 2), coefficients={"Cl": case.coefficients["Cl"]})]
    models = {"Cl": "1 + beta + phat + rhat + da"}
    data[0].coefficients["Cl"] = data[0].coefficients["Cl"] + 1e-4 * np.random.default_rng(
        4
    ).standard_normal(len(case.motion.t))
    result = identify_equation_error(data, models)
    found, _ = reidentify(
        truth(), result, [case], data, [], lambda d, _: identify_equation_error(d, models),
        gravity=9.80665, draws=10,
    )  # fmt: skip
    assert {r.name for r in found} >= {"Cl_beta", "Cl_p", "Cl_r", "Cl_da"}
