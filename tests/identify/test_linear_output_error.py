"""Output error for linear models, on motions whose truth is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from alula.base.messages import BadInput
from alula.identify.likelihood.parameters import Prior
from alula.identify.linear.model import linear_model
from alula.identify.linear.output_error import (
    OutputError,
    identify_linear_output_error,
    simulate,
)
from alula.identify.linear.record import Unknowns, linear_record
from data import data

TRUE = {"Lp": -5.8, "Lda": -16.0, "L0": 0.05, "Np": -0.6, "Nr": -0.7, "Ndr": -2.8}
NOISE = {"p": 0.01, "r": 0.005, "pdot": 0.1}


def roll_yaw():
    return linear_model(
        {"p": "Lp*p + Lda*da + L0", "r": "Np*p + Nr*r + Ndr*dr"},
        ["p", "r", "pdot"],
        ["da", "dr"],
    )


def inputs(t, flip=1.0):
    """Doublets of aileron and rudder, straight between samples."""
    da = flip * 0.05 * (((t > 1) & (t < 2)) * 1.0 - ((t >= 2) & (t < 3)))
    dr = 0.08 * (((t > 4) & (t < 5)) * 1.0 - ((t >= 5) & (t < 6)))
    return da, dr


def flown(seed, n=250, L0=0.05, id="a", held_out=False, noise=1.0, flip=1.0):
    """A maneuver integrated by SciPy, not by the model under test, with white noise."""
    t = 0.04 * np.arange(n)
    da, dr = inputs(t, flip)
    v = TRUE

    def rate(s, x):
        a, r = np.interp(s, t, da), np.interp(s, t, dr)
        return [v["Lp"] * x[0] + v["Lda"] * a + L0, v["Np"] * x[0] + v["Nr"] * x[1] + v["Ndr"] * r]

    x = solve_ivp(rate, (0, t[-1]), [0.02, -0.01], t_eval=t, rtol=1e-9, atol=1e-11, max_step=0.04).y
    rng = np.random.default_rng(seed)
    clean = {"p": x[0], "r": x[1], "pdot": v["Lp"] * x[0] + v["Lda"] * da + L0}
    measured = {k: c + noise * NOISE[k] * rng.standard_normal(n) for k, c in clean.items()}
    return linear_record(id, t, {**measured, "da": da, "dr": dr}, roll_yaw(), held_out)


def test_recovers_the_truth_without_noise():
    found = identify_linear_output_error(roll_yaw(), [flown(0, noise=1e-6)])
    for name, value in TRUE.items():
        # noise of 1e-8 and the integrator's 1e-9
        assert found[name].value == pytest.approx(value, rel=1e-5), name


def test_intervals_hold_and_deviations_are_the_scatter():
    """40 draws: coverage of 95 % intervals, and standard errors against the scatter.

    240 intervals: 95 % within 3 standard deviations of a binomial is 91 to 99 %. The scatter of 40
    draws is known to 11 %, so that the ratio pooled over six parameters stays within 0.85 to 1.15.
    """
    results = [identify_linear_output_error(roll_yaw(), [flown(s)]) for s in range(40)]
    assert all(r.status.startswith("converged") for r in results)
    inside = [r[n].ci95[0] < v < r[n].ci95[1] for r in results for n, v in TRUE.items()]
    assert 0.91 <= np.mean(inside) <= 0.99
    ratios = [
        np.std([r[n].value for r in results], ddof=1) / np.mean([r[n].se_white for r in results])
        for n in TRUE
    ]
    assert 0.85 < np.mean(ratios) < 1.15


def test_sensitivities_agree_with_central_differences():
    model, record = roll_yaw(), flown(1)
    values, x0 = np.array(list(TRUE.values())), np.array([0.02, -0.01])
    order = [list(TRUE).index(p) for p in model.parameters]
    values = values[order]
    S = simulate(model, record, values, x0, "linear", True)[2]
    both, h = np.concatenate([values, x0]), 1e-5
    for j in range(len(both)):
        up, down = both.copy(), both.copy()
        up[j] += h
        down[j] -= h
        k = len(values)
        rough = (
            simulate(model, record, up[:k], up[k:], "linear")[1]
            - simulate(model, record, down[:k], down[k:], "linear")[1]
        ) / (2 * h)
        np.testing.assert_allclose(S[:, :, j], rough, atol=1e-9)  # h^2 and rounding over h


def test_gradient_is_that_of_the_cost():
    """With R at its best for each p, the cost's own slope: R's share vanishes."""
    model, record = roll_yaw(), flown(2)
    problem = OutputError(model, [record], Unknowns(model, [record], (), {}, True), "linear")
    p = np.array([-5.0, -15.0, 0.0, -0.5, -0.6, -2.5, 0.0, 0.0])
    point = problem.likelihood(p, True)
    for j in range(len(p)):
        step = np.eye(len(p))[j] * 1e-5
        up, down = problem.likelihood(p + step, False), problem.likelihood(p - step, False)
        assert point.gradient[j] == pytest.approx((up.cost - down.cost) / 2e-5, rel=1e-5, abs=1e-4)


def test_several_maneuvers_share_derivatives_and_keep_their_own_constants():
    records = [flown(3, L0=0.05, id="a"), flown(4, L0=-0.2, id="b", flip=-1.0)]
    found = identify_linear_output_error(roll_yaw(), records, own=["L0"])
    for name, true in (("L0[a]", 0.05), ("L0[b]", -0.2), ("Lp", -5.8)):
        assert abs(found[name].value - true) < 4.0 * found[name].se  # 4 of its own errors
        assert found[name].verdict == "ok"
    assert found["Lda"].se < identify_linear_output_error(roll_yaw(), records[:1])["Lda"].se


def test_held_out_maneuver_is_predicted_not_learned_from():
    learn, held = flown(3, id="a"), flown(4, L0=-0.2, id="b", held_out=True, flip=-1.0)
    found = identify_linear_output_error(roll_yaw(), [learn, held], own=["L0"])
    alone = identify_linear_output_error(roll_yaw(), [learn], own=["L0"])
    assert found["Lp"].value == alone["Lp"].value
    assert found.fits["p"].n_held_out == 250
    assert found.fits["p"].r2_held_out > 0.95  # noise is 3 % of the motion's variance


def test_missing_samples_are_left_out():
    whole = flown(5)
    holes = whole.outputs.copy()
    holes[50:150, 2] = np.nan
    found = identify_linear_output_error(roll_yaw(), [replace(whole, outputs=holes)])
    assert found.fits["pdot"].n == 150
    assert abs(found["Lp"].value + 5.8) < 4.0 * found["Lp"].se


def test_fixed_bounded_and_prior():
    record = flown(6)
    fixed = identify_linear_output_error(roll_yaw(), [record], fixed={"Nr": -0.7})
    with pytest.raises(KeyError):
        fixed["Nr"]
    bounded = identify_linear_output_error(roll_yaw(), [record], bounds={"Lp": (-5.0, 0.0)})
    assert bounded["Lp"].value == -5.0
    assert bounded["Lp"].verdict == "weak"
    assert "at_bound" in [m.code for m in bounded.messages]
    free = identify_linear_output_error(roll_yaw(), [record])
    sure = identify_linear_output_error(roll_yaw(), [record], priors={"Np": Prior(-0.6, 1e-4)})
    assert sure["Np"].value == pytest.approx(-0.6, abs=5e-4)
    assert sure["Np"].se == pytest.approx(1e-4, rel=0.01)  # the data add next to nothing
    assert free["Np"].se > 10.0 * sure["Np"].se


def test_control_that_stands_still_is_named():
    record = flown(7)
    still = record.inputs.copy()
    still[:, 1] = 0.0
    found = identify_linear_output_error(roll_yaw(), [replace(record, inputs=still)])
    assert found["Ndr"].verdict == "not_identifiable"
    assert np.isnan(found["Ndr"].value)
    assert found["Lp"].verdict == "ok"
    assert not found.identifiable


def test_multiples_are_tied():
    """Rudder that follows the aileron: only the sum of both effects is determined."""
    model = linear_model({"p": "Lp*p + Lda*da + Ldr*dr"}, ["p"], ["da", "dr"])
    t = 0.04 * np.arange(250)
    da = inputs(t)[0]
    values = np.array([-5.8, -16.0, 1.0])
    record = linear_record("a", t, {"p": 0 * t, "da": da, "dr": 0.5 * da}, model)
    clean = simulate(model, record, values, np.zeros(1), "linear")[1]
    noisy = clean + 0.005 * np.random.default_rng(0).standard_normal(clean.shape)
    found = identify_linear_output_error(model, [replace(record, outputs=noisy)])
    tie = found["Lda"].tied_to[0]
    assert (tie.name, tie.weight) == ("Ldr", pytest.approx(0.5, rel=1e-6))
    assert "Lda + 0.5 Ldr = -15." in found.messages[0].found


def test_failed_search_is_no_success():
    """First values that blow up: the status says so, and no parameter has a value."""
    found = identify_linear_output_error(roll_yaw(), [flown(8)], start={"Lp": 500.0})
    assert found.status.startswith("failed")
    assert not found.identifiable
    assert all(np.isnan(p.value) for p in found.parameters)


def test_refusals():
    record = flown(9)
    with pytest.raises(BadInput, match="not_finite"):
        linear_record("a", record.t, {"da": record.t * np.nan, "dr": record.t, "p": record.t,
                                      "r": record.t, "pdot": record.t}, roll_yaw())  # fmt: skip
    t = record.t.copy()
    t[5] += 0.01
    with pytest.raises(BadInput, match="uneven_time"):
        linear_record("a", t, dict.fromkeys(("da", "dr", "p", "r", "pdot"), t), roll_yaw())
    with pytest.raises(BadInput, match="unknown_parameter"):
        identify_linear_output_error(roll_yaw(), [record], fixed={"Lq": 1.0})
    with pytest.raises(BadInput, match="no_maneuver"):
        identify_linear_output_error(roll_yaw(), [replace(record, held_out=True)])


def test_dhc2_without_turbulence():
    """Columns 2 to 9 (Jategaonkar 2006): the published truth within two standard errors."""
    table = np.loadtxt(data("dhc2", "y13aus_da1.asc"))
    row = "{0}p*p + {0}r*r + {0}da*da + {0}dr*dr + {0}v*v + {0}0"
    model = linear_model(
        {"p": row.format("L"), "r": row.format("N")},
        {"pdot": "", "rdot": "", "ay": row.format("Y"), "p": "", "r": ""},
        ["da", "dr", "v"],
    )
    names = ("pdot", "rdot", "ay", "p", "r", "da", "dr", "v")
    channels = {n: table[:, 1 + i] for i, n in enumerate(names)}
    found = identify_linear_output_error(model, [linear_record("a", table[:, 0], channels, model)])
    true = {
        "Lp": -5.820, "Lr": 1.782, "Lda": -16.434, "Ldr": 0.4435, "Lv": -0.0969, "Np": -0.6649,
        "Nr": -0.7119, "Nda": -0.4287, "Ndr": -2.8243, "Nv": 0.0084, "Yp": -0.2784, "Yr": 1.4099,
        "Yda": -0.4471, "Ydr": 2.6571, "Yv": -0.1799,
    }  # fmt: skip
    for name, value in true.items():
        assert abs(found[name].value - value) < 2.0 * found[name].se, name
