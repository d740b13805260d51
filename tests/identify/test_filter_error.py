"""Filter error: a motion in turbulence, with process and measurement noise estimated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from alula.base.messages import BadInput
from alula.identify.likelihood.innovations import InnovationLikelihood
from alula.identify.likelihood.riccati import steady_covariance
from alula.identify.linear.filter_error import FilterError, identify_filter_error
from alula.identify.linear.model import linear_model
from alula.identify.linear.record import Unknowns, linear_record
from data import data
from verification.estimation import dhc2

TRUE = {"Lp": -3.0, "Lda": -12.0, "L0": 0.05}
F, SIGMA, DT = 0.2, 0.02, 0.02


def roll():
    return linear_model({"p": "Lp*p + Lda*da + L0"}, ["p"], ["da"])


def flown(seed, n=600, F=F):
    """Roll in turbulence by Euler-Maruyama at 20 steps a sample, not by the model under test."""
    rng = np.random.default_rng(seed)
    t = DT * np.arange(n)
    da = 0.06 * np.sign(np.sin(2.0 * np.pi * t / 3.0)) * (t > 1.0)
    fine, p, out = DT / 20, 0.0, np.empty(n)
    for i in range(n):
        out[i] = p
        drive = da[i], da[min(i + 1, n - 1)]
        for k in range(20):
            u = drive[0] + (drive[1] - drive[0]) * (k + 0.5) / 20
            p += fine * (TRUE["Lp"] * p + TRUE["Lda"] * u + TRUE["L0"])
            p += F * fine**0.5 * rng.standard_normal()
    return linear_record("a", t, {"p": out + SIGMA * rng.standard_normal(n), "da": da}, roll())


def test_doubling_agrees_with_scipy():
    rng = np.random.default_rng(0)
    A, C = rng.standard_normal((5, 3, 3)) * 0.4, rng.standard_normal((5, 2, 3))
    Q = np.einsum("iab,icb->iac", A, A) + np.eye(3)
    R = np.broadcast_to(np.diag([0.5, 2.0]), (5, 2, 2))
    P = steady_covariance(A, C, Q, R)
    for i in range(5):
        right = solve_discrete_are(A[i].T, C[i].T, Q[i], R[i])
        np.testing.assert_allclose(P[i], right, rtol=1e-9)  # SciPy's own residual is about 1e-10


def test_mode_that_no_output_sees_has_no_steady_state():
    A, C = np.diag([0.5, 1.2])[None], np.array([[[1.0, 0.0]]])
    assert np.isnan(steady_covariance(A, C, np.eye(2)[None], np.eye(1)[None])).all()


def test_intervals_hold_and_noises_are_found():
    """30 draws of turbulence and noise: 90 intervals, 95 % within 3 binomial deviations is 88 to
    100 %. The noises' mean is known to 1 to 2 % of 30 draws; Euler's steps cost F 0.2 %.
    """
    results = [identify_filter_error(roll(), [flown(s)]) for s in range(30)]
    assert all(r.status.startswith("converged") for r in results)
    inside = [r[n].ci95[0] < v < r[n].ci95[1] for r in results for n, v in TRUE.items()]
    assert np.mean(inside) >= 0.88
    assert np.mean([r["F_p"].value for r in results]) == pytest.approx(F, rel=0.06)
    assert np.mean([r["sigma_p"].value for r in results]) == pytest.approx(SIGMA, rel=0.06)


def test_steady_and_varying_gain_agree_on_a_long_record():
    """The gains differ over the first samples only; so do the estimates, by a part of an error."""
    record = flown(1)
    steady, varying = (
        identify_filter_error(roll(), [record], gain=g) for g in ("steady", "varying")
    )
    for name in TRUE:
        assert abs(steady[name].value - varying[name].value) < 0.2 * steady[name].se


def test_missing_samples_are_bridged():
    record = flown(2)
    holes = record.outputs.copy()
    holes[100:160] = np.nan
    gap = replace(record, outputs=holes)
    found = identify_filter_error(roll(), [gap])
    assert found.fits["p"].n == 540
    for name, value in TRUE.items():
        assert abs(found[name].value - value) < 4.0 * found[name].se
    with pytest.raises(BadInput, match="missing_samples"):
        identify_filter_error(roll(), [gap], gain="steady")


@pytest.mark.parametrize("gain", ["steady", "varying"])
def test_gradient_is_that_of_the_cost(gain):
    """The share of the covariance's own slope included."""
    model, record = roll(), flown(3)
    problem = FilterError(
        model, [record], Unknowns(model, [record], (), {}, True), ["p"], gain, {}, {}
    )
    likelihood = InnovationLikelihood(problem.run)
    p = problem.first + 0.1
    point = likelihood(p, True)
    for j in range(len(p)):
        step = np.eye(len(p))[j] * 1e-4
        slope = (likelihood(p + step, False).cost - likelihood(p - step, False).cost) / 2e-4
        assert point.gradient[j] == pytest.approx(slope, rel=1e-4, abs=1e-3)


def test_without_turbulence_it_says_so_and_keeps_the_derivatives():
    """No process noise: F falls to where it cannot be told from none, and the result says so."""
    found = identify_filter_error(roll(), [flown(4, F=0.0)])
    assert "noise_too_small" in [m.code for m in found.messages] or (
        found["F_p"].value < 0.1 * F and found["F_p"].ci95[0] < 0.02 * F
    )
    for name, value in TRUE.items():
        assert abs(found[name].value - value) < 4.0 * found[name].se


def test_noise_on_its_way_to_zero_does_not_stop_the_search():
    """DHC-2 with a draw that shows no noise of r, whose logarithm falls one a step: it arrives.

    The other parameters' joint steps must count on that one and not on the hundreds that Newton
    would make. One of 18 errors is beyond four standard errors in one of 900 draws.
    """
    found = dhc2.channels(data("dhc2", "y13aus_da1.asc"))
    result = identify_filter_error(dhc2.model(), [dhc2.draw(found, 37)], truth=dhc2.TRUTH)
    codes = {m.code: m.where for m in result.messages}
    assert "no_convergence" not in codes
    assert codes["noise_too_small"] == "sigma_r"
    for name, true in dhc2.TRUTH.items():
        assert abs(result[name].value - true) < 4.0 * result[name].se, name


def test_known_noise_can_be_held():
    found = identify_filter_error(roll(), [flown(5)], fixed={"sigma_p": SIGMA})
    assert {p.name for p in found.parameters} == {"Lp", "Lda", "L0", "p(0)[a]", "F_p"}
    assert found["F_p"].value == pytest.approx(F, rel=0.2)  # one draw: 5 % deviation, 4 of them


def test_control_that_stands_still_is_named():
    record = flown(7)
    still = np.zeros_like(record.inputs)
    found = identify_filter_error(roll(), [replace(record, inputs=still)])
    assert found["Lda"].verdict == "not_identifiable"
    assert np.isnan(found["Lda"].value)
    assert not found.identifiable


def test_held_out_maneuver_is_left_aside_and_said():
    held = replace(flown(8), id="b", held_out=True)
    found = identify_filter_error(roll(), [flown(1), held])
    assert "held_out" in [m.code for m in found.messages]
    assert found["Lp"].value == identify_filter_error(roll(), [flown(1)])["Lp"].value


def test_unknown_state_is_refused():
    with pytest.raises(BadInput, match="unknown_option"):
        identify_filter_error(roll(), [flown(6)], noisy=["q"])
