"""What every fit is asked: false alarms as rare as stated, and each fault found where it is."""

import numpy as np
import pytest
from identify_flights import maneuver, short_period
from scipy import signal

from alula.identify import identify_equation_error
from alula.identify.regression.lack_of_fit import lack_of_fit
from alula.identify.regression.regress import Block, regress
from alula.identify.regression.residual_tests import input_correlations, ljung_box
from alula.identify.trust.feedback import feedback

MODEL = {"Cm": "1 + alpha + qhat + de"}


def coloured(rng, n, pole=0.9):
    x = signal.lfilter([np.sqrt(1 - pole**2)], [1.0, -pole], rng.standard_normal(n + 300))
    return x[300:]


def test_ljung_box_by_its_formula():
    v = np.random.default_rng(0).standard_normal(200)
    v = v - v.mean()
    r = [np.sum(v[k:] * v[:-k]) / np.sum(v * v) for k in range(1, 11)]
    wanted = 200 * 202 * sum(r[k - 1] ** 2 / (200 - k) for k in range(1, 11))
    got = ljung_box([v], lags=10)
    assert got.statistic == pytest.approx(wanted)
    assert got.dof == 10
    assert ljung_box([v, v], lags=10).statistic == pytest.approx(2 * wanted)  # maneuvers add up


def test_whiteness_is_denied_as_rarely_as_stated_and_where_it_should():
    rng = np.random.default_rng(1)
    white = [ljung_box([rng.standard_normal(400)]).white for _ in range(300)]
    assert 0.9 < np.mean(white) < 0.985  # 95 % and three standard deviations of 300 draws
    assert not any(ljung_box([coloured(rng, 400, 0.5)]).white for _ in range(50))


def test_a_delayed_response_is_found_at_its_lag():
    rng = np.random.default_rng(2)
    de = short_period(1000, 0.02)[:, 3]
    v = 0.3 * coloured(rng, 1000, 0.5)
    v[12:] += 0.1 * np.diff(de, prepend=0.0)[:-12] * 10.0
    (found,) = input_correlations([v], {"de": [np.diff(de, prepend=0.0)]})
    assert found.significant
    assert found.lag == 12


def test_unrelated_colours_are_no_correlation():
    rng = np.random.default_rng(3)
    alarms = [
        input_correlations([coloured(rng, 600)], {"de": [coloured(rng, 600, 0.95)]})[0].significant
        for _ in range(200)
    ]
    assert np.mean(alarms) < 0.03  # 1 % is meant for all lags


def blocks(seed, curve, pole):
    rng = np.random.default_rng(seed)
    out = []
    for size in (1.0, 0.7, -0.9, 1.2):
        x = short_period(1000, 0.02) * [1.0, size, size, size]
        noise = 0.05 * (coloured(rng, 1000, pole) if pole else rng.standard_normal(1000))
        out.append(Block(x, x @ [0.1, -1.2, -0.5, -1.5] + curve * x[:, 1] ** 2 + noise))
    return out


def test_lack_of_fit_rejects_the_wrong_model_and_not_the_right_one():
    def p(seed, curve, pole):
        data = blocks(seed, curve, pole)
        fit = regress(["0", "a", "q", "e"], data)
        return lack_of_fit(fit, [b.regressors[:, 1:] for b in data]).p

    for pole in (0.0, 0.9):
        right = [p(seed, 0.0, pole) < 0.05 for seed in range(40)]
        assert np.mean(right) <= 0.2  # 5 % is meant; four standard deviations of 40 draws
        assert np.mean([p(seed, 1.0, pole) < 0.05 for seed in range(10)]) >= 0.9


def test_too_few_repetitions_are_said():
    x = short_period(150, 0.02)
    fit = regress(["0", "a", "q", "e"], [Block(x, x[:, 1] + 0.0)])
    got = lack_of_fit(fit, [x[:, 1:]])
    assert not got.tested
    assert "too few" in got.words


def with_cm(item, extra):
    item.coefficients["Cm"] = item.coefficients["Cm"] + extra
    return item


def test_linearity():
    plain = identify_equation_error([maneuver()], MODEL).fits["Cm"].diagnostics.linearity
    assert plain.linear
    assert "linear is enough" in plain.words
    assert {c.term for c in plain.tried} == {
        "alpha^2", "alpha*qhat", "alpha*de", "qhat^2", "qhat*de", "de^2",
    }  # fmt: skip
    item = maneuver()
    curved = with_cm(item, 10.0 * item.variables["alpha"] ** 2)
    got = identify_equation_error([curved], MODEL).fits["Cm"].diagnostics.linearity
    assert not got.enough
    assert got.tried[0].term == "alpha^2"
    assert got.gain > 0.01
    item = maneuver()
    slightly = with_cm(item, 0.4 * item.variables["alpha"] ** 2)
    got = identify_equation_error([slightly], MODEL).fits["Cm"].diagnostics.linearity
    assert not got.linear  # significant
    assert got.enough  # but small


def test_linearity_false_alarms_in_coloured_noise():
    alarms = []
    for seed in range(60):
        item = with_cm(maneuver(seed=seed), 2e-3 * coloured(np.random.default_rng(seed), 600))
        fit = identify_equation_error([item], MODEL).fits["Cm"]
        alarms.append(not fit.diagnostics.linearity.linear)
    assert np.mean(alarms) < 0.17  # 5 % is meant; four standard deviations of 60 draws


def test_feedback_is_named_with_its_gains():
    """Elevator held by a law of alpha and pitch rate with a little of its own: the law is found."""
    item = maneuver()
    rng = np.random.default_rng(5)
    law = 0.8 * item.variables["alpha"] + 2.0 * item.variables["qhat"]
    follows = maneuver(de=law + 0.01 * law.std() * rng.standard_normal(600))
    got = identify_equation_error([follows], MODEL)
    (found,) = got.fits["Cm"].diagnostics.feedback
    assert found.gains["alpha"] == pytest.approx(0.8, rel=0.01)
    assert found.gains["qhat"] == pytest.approx(2.0, rel=0.01)
    assert found.r2 > 0.999
    (message,) = [m for m in got.messages if m.code == "control_follows_states"]
    assert "de = 0.8 alpha + 2 qhat" in message.found
    free = identify_equation_error([maneuver()], MODEL)
    assert not [m for m in free.messages if m.code == "control_follows_states"]


def test_feedback_leaves_out_controls_that_stand_still():
    item = maneuver()
    assert [f.control for f in feedback([item.variables], ["alpha", "qhat", "de", "df"])] == ["de"]


def test_summary_answers_whether_the_model_is_enough():
    text = identify_equation_error([maneuver()], MODEL).summary()
    assert "residuals white" in text
    assert "linear is enough" in text
