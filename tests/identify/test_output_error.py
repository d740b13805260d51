"""Nonlinear output error against motions flown by equations and an integrator of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.identify import identified_model
from alula.identify.flown.output_error import identify_output_error
from alula.identify.likelihood.parameters import Prior
from alula.model import Reference
from identify.flown_maneuvers import (
    CHORD,
    LATERAL,
    LONGITUDINAL,
    SPAN,
    TRUTH,
    S,
    every_axis,
    flown,
    names,
    pitch_3211,
)

PITCH = ("V", "alpha", "theta", "q", "ax", "az")
ROLL = ("beta", "p", "r", "phi", "ay")
# RK4 at 50 Hz against steps a third as long: differences of 1e-7 of the motion, which the
# weakest of the derivatives (CX_alpha2) sees a thousandfold.
NUMERICAL = 2e-4


@pytest.fixture(scope="module")
def clean():
    return flown(pitch_3211)


@pytest.fixture(scope="module")
def noisy():
    return flown(pitch_3211, seed=1)


def test_longitudinal_truth_comes_back(clean) -> None:
    result = identify_output_error([clean], LONGITUDINAL, outputs=PITCH)
    for name, value in names(LONGITUDINAL).items():
        assert result[name].value == pytest.approx(value, rel=NUMERICAL), name
    assert result["alpha(0)[one]"].value == pytest.approx(0.05, abs=1e-5)
    assert result.status.startswith("converged")


def test_six_degrees_of_freedom_truth_comes_back() -> None:
    m = flown(every_axis)
    models = LONGITUDINAL | LATERAL
    result = identify_output_error([m], models, states="six", outputs=PITCH + ROLL)
    for name, value in TRUTH.items():
        assert result[name].value == pytest.approx(value, rel=10 * NUMERICAL, abs=1e-5), name


def test_lateral_truth_comes_back_with_the_rest_as_measured() -> None:
    m = flown(every_axis)
    result = identify_output_error([m], LATERAL, states="lateral", outputs=ROLL)
    for name, value in names(LATERAL).items():
        # V, alpha, theta, q enter as straight lines between samples: 1e-4 of the motion
        assert result[name].value == pytest.approx(value, rel=5e-3, abs=2e-4), name


def test_estimates_scatter_as_their_errors_say() -> None:
    hits, total = 0, 0
    for seed in range(12):
        m = flown(pitch_3211, seed=seed, seconds=12.0)
        result = identify_output_error([m], LONGITUDINAL, outputs=PITCH)
        for name, value in names(LONGITUDINAL).items():
            p = result[name]
            assert abs(p.value - value) < 5.0 * p.se, name
            hits += p.ci95[0] <= value <= p.ci95[1]
            total += 1
    # 132 draws of 95 %, correlated in groups of 11: 0.88 is five standard deviations of a
    # binomial of half that number below
    assert hits / total > 0.85


def test_both_algorithms_end_at_one_place(noisy) -> None:
    a = identify_output_error([noisy], LONGITUDINAL, outputs=PITCH)
    b = identify_output_error([noisy], LONGITUDINAL, outputs=PITCH, algorithm="levenberg_marquardt")
    difference = (a.params - b.params).abs() / a.bse
    assert difference.max() < 1e-2  # each stops within 1e-4 standard errors of the maximum


def test_biases_and_several_maneuvers() -> None:
    one = flown(pitch_3211, seed=1)
    two = flown(lambda t: {"de": -0.012 + 0.03 * np.sin(2.0 * t)}, id="two", seed=2, theta0=0.02)
    shifted = replace(two, outputs={**two.outputs, "theta": two.outputs["theta"] + 0.02})
    result = identify_output_error([one, shifted], LONGITUDINAL, outputs=PITCH, biases=("theta",))
    assert result["b_theta[two]"].value == pytest.approx(0.02, abs=4 * result["b_theta[two]"].se)
    for name, value in names(LONGITUDINAL).items():
        assert abs(result[name].value - value) < 4.5 * result[name].se, name


def test_gaps_in_one_sensor_leave_the_others(noisy) -> None:
    alpha = noisy.outputs["alpha"].copy()
    alpha[100:400] = np.nan
    gappy = replace(noisy, outputs={**noisy.outputs, "alpha": alpha})
    result = identify_output_error([gappy], LONGITUDINAL, outputs=PITCH)
    assert result.fits["alpha"].n == len(alpha) - 300
    for name, value in names(LONGITUDINAL).items():
        assert abs(result[name].value - value) < 4.5 * result[name].se, name


def test_fixed_tied_bounded_and_prior(noisy) -> None:
    result = identify_output_error(
        [noisy],
        LONGITUDINAL,
        outputs=PITCH,
        fixed={"CX_0": -0.03},
        tied={"CZ_q": ("Cm_q", 0.5)},
        bounds={"Cm_de": (-1.0, 0.0)},
        priors={"CX_alpha2": Prior(2.5, 1e-3)},
    )
    known = [p.name for p in result.parameters]
    assert not {"CX_0", "CZ_q"} & set(known)
    assert result["Cm_de"].value == -1.0
    assert any(m.code == "at_bound" for m in result.messages)
    assert result["CX_alpha2"].value == pytest.approx(2.5, abs=4e-3)
    assert result["CX_alpha2"].se <= 1.01e-3
    assert "not estimated: CX_0 = -0.03, CZ_q = 0.5 Cm_q" in result.summary()
    model = identified_model(result, "held", Reference(S, SPAN, CHORD))
    assert model.params["CX_0"] == -0.03  # the model has all terms of the formulas
    assert model.params["CZ_q"] == pytest.approx(0.5 * model.params["Cm_q"])
    assert set(model.names) == set(names(LONGITUDINAL))
    spread = dict(zip(model.names, np.sqrt(np.diag(model.covariance)), strict=True))
    assert spread["CX_0"] == 0.0
    assert spread["CZ_q"] == pytest.approx(0.5 * spread["Cm_q"])


def test_an_unexcited_control_is_not_identifiable(noisy) -> None:
    still = replace(noisy, controls={**noisy.controls, "df": np.zeros_like(noisy.t)})
    models = {**LONGITUDINAL, "Cm": "1 + alpha + qhat + de + df"}
    result = identify_output_error([still], models, outputs=PITCH)
    assert result["Cm_df"].verdict == "not_identifiable"
    assert np.isnan(result["Cm_df"].value)
    assert result["Cm_de"].verdict == "ok"
    assert not result.identifiable


def test_collinear_controls_name_their_combination(noisy) -> None:
    twin = replace(noisy, controls={**noisy.controls, "df": 2.0 * noisy.controls["de"]})
    models = {**LONGITUDINAL, "Cm": "1 + alpha + qhat + de + df"}
    result = identify_output_error([twin], models, outputs=PITCH)
    p = result["Cm_de"]
    assert p.verdict == "not_identifiable"
    tie = {t.name: t.weight for t in p.tied_to}
    assert tie["Cm_df"] == pytest.approx(2.0, rel=1e-6)


def test_an_unstable_aircraft_held_by_its_pilot() -> None:
    truth = {**TRUTH, "Cm_alpha": 0.35}
    m = flown(pitch_3211, truth=truth, feedback=1.5, seed=4)
    models = LONGITUDINAL
    start = {n: 0.8 * v for n, v in names(models).items()}
    result = identify_output_error(
        [m], models, outputs=PITCH, start=start, stabilize={"alpha": 2.0, "q": 2.0, "theta": 1.0}
    )
    assert any(x.code == "stabilized" for x in result.messages)
    for name in ("Cm_alpha", "Cm_q", "Cm_de", "CZ_alpha"):
        p = result[name]
        # the pull lets the sensors' noise into the model: a bias of under 3 % beside the scatter
        assert abs(p.value - truth[name]) < 4.0 * p.se + 0.03 * abs(truth[name]), name


def test_first_values_that_diverge_are_survived(noisy) -> None:
    start = {**names(LONGITUDINAL), "Cm_alpha": 4.0, "Cm_q": 20.0}
    result = identify_output_error([noisy], LONGITUDINAL, outputs=PITCH, start=start)
    assert any(x.code == "start_diverges" for x in result.messages)
    assert abs(result["Cm_alpha"].value + 0.8) < 4.5 * result["Cm_alpha"].se


def test_a_failed_search_has_no_values(noisy) -> None:
    reversed_time = replace(
        noisy, outputs={**noisy.outputs, "q": np.random.default_rng(0).normal(size=len(noisy.t))}
    )
    start = {**names(LONGITUDINAL), "Cm_alpha": 50.0, "Cm_q": 500.0}
    result = identify_output_error(
        [reversed_time], {"Cm": LONGITUDINAL["Cm"]}, states=("q",), outputs=("q",),
        start={n: v for n, v in start.items() if n.startswith("Cm")},
        stabilize={}, bounds={"Cm_q": (400.0, 600.0)},
    )  # fmt: skip
    assert result.status.startswith("failed")
    assert not result.identifiable
    assert all(np.isnan(p.value) for p in result.parameters)


def test_held_out_maneuver_is_predicted_not_learned_from(noisy) -> None:
    other = flown(
        lambda t: {"de": -0.012 + 0.03 * np.sin(2.0 * t)}, id="two", seed=2, held_out=True
    )
    with_it = identify_output_error([noisy, other], LONGITUDINAL, outputs=PITCH)
    without = identify_output_error([noisy], LONGITUDINAL, outputs=PITCH)
    assert with_it["Cm_de"].value == without["Cm_de"].value
    assert with_it.fits["q"].n_held_out == len(other.t)
    assert with_it.fits["q"].r2_held_out > 0.97


def test_full_covariance_agrees_where_sensors_are_independent(noisy) -> None:
    a = identify_output_error([noisy], LONGITUDINAL, outputs=PITCH)
    b = identify_output_error([noisy], LONGITUDINAL, outputs=PITCH, covariance="full")
    # chance correlations of 1/sqrt(1000) move the estimate by that share of its error, times a few
    assert ((a.params - b.params).abs() / a.bse).max() < 0.5


def test_result_becomes_a_model(noisy) -> None:
    result = identify_output_error([noisy], LONGITUDINAL, outputs=PITCH)
    model = identified_model(result, "flown", Reference(S, SPAN, CHORD))
    assert model.params["Cm_de"] == result["Cm_de"].value
    assert model.covariance is not None


def test_refusals(noisy) -> None:
    with pytest.raises(BadInput, match="outputs"):
        identify_output_error([noisy], LONGITUDINAL, outputs=("nz",))
    with pytest.raises(BadInput, match="no df"):
        identify_output_error(
            [noisy], {"Cm": "1 + df"}, outputs=PITCH, start={"Cm_0": 0, "Cm_df": 0}
        )
    with pytest.raises(BadInput, match="at least one maneuver"):
        identify_output_error([], LONGITUDINAL, outputs=PITCH)
    with pytest.raises(BadInput, match="bounds"):
        identify_output_error([noisy], LONGITUDINAL, outputs=PITCH, bounds={"Cm_x": (0, 1)})
