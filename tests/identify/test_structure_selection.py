"""Stepwise regression and orthogonal functions on problems whose terms are known."""

from dataclasses import replace

import numpy as np
import pytest
from identify_flights import maneuver, short_period, twin_otter
from scipy import signal

from alula.base.messages import BadInput
from alula.identify import identify_equation_error
from alula.identify.equation_error.choice import RegressionChoice, regression_choice
from alula.identify.regression.orthogonal_functions import (
    gram_schmidt,
    orthogonal_functions,
    physical_values,
)
from alula.identify.regression.stepwise import partial_f, stepwise
from alula.identify.regression.structure import Pool, orthonormal, press
from data import data
from verification.estimation import structure

POOL = "(1, alpha, qhat, de)^2 + (alpha - [0.05])+^2"


@pytest.mark.parametrize("method", structure.METHODS)
@pytest.mark.parametrize("order", [1, 2, 3])
def test_sidpacs_example_gives_the_true_terms_and_only_those(method, order):
    x, z = structure.load(data("regression", "swr_example.mat"))
    _, values = structure.select(method, structure.pool(x, z, order))
    assert set(values) == {"1", *structure.TRUE}
    for name, truth in {"1": structure.CONSTANT, **structure.TRUE}.items():
        assert abs(values[name][0] - truth) < 2.0 * values[name][1]


def random_pool(seed, candidates=12, n=300):
    rng = np.random.default_rng(seed)
    x = rng.standard_normal((n, candidates))
    z = 0.5 + rng.standard_normal(n)
    return Pool(tuple(f"x{i}" for i in range(candidates)), np.ones((n, 1)), x, z, (), 1)


def test_pure_noise_gives_a_false_term_as_rarely_as_the_level_says():
    false = [bool(stepwise(random_pool(s), colour=False).chosen) for s in range(300)]
    assert np.mean(false) < 0.09  # 5 % of 300 draws: 1.3 % by chance, three times that


def test_partial_f_is_that_of_two_fits():
    """Textbook: the drop of the residual sum of squares over the residual variance."""
    work = random_pool(1)
    core = work.columns([0, 1])
    before = np.linalg.lstsq(core, work.measured, rcond=None)[1][0]
    after = np.linalg.lstsq(work.columns([0, 1, 2]), work.measured, rcond=None)[1][0]
    f, _ = partial_f(work, orthonormal(core), work.candidates[:, 2], False)
    assert f == pytest.approx((before - after) / (after / (300 - 4)), rel=1e-9)


def test_press_is_leave_one_out():
    work = random_pool(2, n=40)
    x, z = work.columns([0, 1]), work.measured
    wanted = 0.0
    for i in range(40):
        keep = np.arange(40) != i
        wanted += (z[i] - x[i] @ np.linalg.lstsq(x[keep], z[keep], rcond=None)[0]) ** 2
    assert press(orthonormal(x), z) == pytest.approx(wanted, rel=1e-9)


def test_orthogonal_functions_and_the_way_back():
    """Eq. (32), (33): orthogonal, triangular; values those of least squares on the same terms."""
    rng = np.random.default_rng(3)
    x = rng.standard_normal((200, 5)) @ rng.standard_normal((5, 5)) * [1, 1e-3, 1e3, 1, 1]
    z = rng.standard_normal(200)
    p, g = gram_schmidt(x)
    size = np.linalg.norm(p, axis=0)
    assert np.abs((p / size).T @ (p / size) - np.eye(5)).max() < 1e-13
    np.testing.assert_allclose(p @ g, x, rtol=1e-12, atol=1e-12)
    assert np.all(np.tril(g, -1) == 0.0)
    assert physical_values(x, z) == pytest.approx(
        np.linalg.lstsq(x / np.linalg.norm(x, axis=0), z, rcond=None)[0]
        / np.linalg.norm(x, axis=0),
        rel=1e-9,
    )


def test_predicted_squared_error_by_its_formula():
    x, z = structure.load(data("regression", "swr_example.mat"))
    found = orthogonal_functions(structure.pool(x, z, 1))
    columns = np.column_stack([np.ones(len(z)), x[:, [0, 1, 3]]])
    left = np.linalg.lstsq(columns, z, rcond=None)[1][0]
    wanted = left / len(z) + np.var(z, ddof=1) * 4 / len(z)  # Eq. (35), (36): four terms
    assert found.steps[-1].pse == pytest.approx(wanted, rel=1e-9)
    assert found.steps[-1].pse < min(s.pse for s in found.steps[:-1])


def test_terms_that_explain_little_are_left_out_on_request():
    x, z = structure.load(data("regression", "swr_example.mat"))
    work = structure.pool(x, z, 1)
    kept = orthogonal_functions(work, least_share=0.1).chosen
    assert {work.names[j] for j in kept} == {"x1", "x2"}  # x4 explains 6 % of the variation


def curved(seed, curve, n=600):
    """Cm of a short period with a term in alpha^2 and coloured noise, correlation 0.2 s."""
    x = short_period(n, 0.02)
    item = maneuver(seed=seed)
    noise = signal.lfilter([0.43], [1.0, -0.905], np.random.default_rng(seed).normal(size=n + 300))
    alpha = item.variables["alpha"]
    cm = item.coefficients["Cm"] + curve * alpha**2 + 1e-3 * noise[300:]
    assert len(x) == len(cm)
    return replace(item, coefficients={"Cm": cm})


def test_slow_noise_does_not_bring_terms_in():
    """Coloured noise lets a white F take in what a coloured one takes out again."""
    choice = RegressionChoice("stepwise", POOL)
    model = {"Cm": "1 + alpha + qhat + de"}
    false = []
    for seed in range(40):
        fit = identify_equation_error([curved(seed, 0.0)], model, regression=choice).fits["Cm"]
        false.append(fit.formula != model["Cm"])
    assert np.mean(false) < 0.2  # 5 % are meant; 20 % is four standard deviations of 40 draws
    got = identify_equation_error([curved(0, 5.0)], model, regression=choice)
    assert got.fits["Cm"].formula == "1 + alpha + qhat + de + alpha^2"
    assert abs(got["Cm_alpha2"].value - 5.0) < 3.0 * got["Cm_alpha2"].se
    steps = [(s.action, s.term) for s in got.fits["Cm"].structure.steps]
    assert ("in", "alpha^2") in steps
    assert ("out", "alpha^2") not in steps
    assert any(m.code == "structure_selected" for m in got.messages)


@pytest.mark.parametrize("kind", ["stepwise", "orthogonal"])
def test_the_core_stays_and_maneuvers_share_the_terms(kind):
    """Two maneuvers with constants of their own; the core has a term that does nothing."""
    pair = [curved(1, 5.0), curved(2, 5.0)]
    pair[1] = replace(pair[1], maneuver=replace(pair[1].maneuver, id="m2"))
    got = identify_equation_error(
        pair, {"Cm": "1 + alpha + qhat + de + alpha*qhat"}, regression=RegressionChoice(kind, POOL)
    )
    names = [p.name for p in got.parameters]
    assert names[:2] == ["Cm_0[m1]", "Cm_0[m2]"]
    assert "Cm_alpha_q" in names
    if kind == "stepwise":
        assert "Cm_alpha2" in names


def test_twin_otter_is_linear_enough_for_the_predicted_squared_error():
    """The published model is linear; orthogonal functions add nothing to it from 18 candidates."""
    got = identify_equation_error(
        [twin_otter()],
        {"Cm": "1 + alpha + qhat + de"},
        regression=RegressionChoice("orthogonal", POOL),
    )
    assert got.fits["Cm"].formula == "1 + alpha + qhat + de"


@pytest.mark.parametrize(
    "options",
    [
        {"regression": "lasso"},
        {"regression": "stepwise"},  # without candidates
        {"regression": 3.0},
        {"regression": "ridge", "ridge": "best"},
        {"regression": "ridge", "ridge": -1.0},
        {"regression": "pcr", "components": 1.5},
        {"regression": "pcr", "components": 9.0},
        {"regression": "stepwise", "candidates": {"Cm": 3.0}},
        {"regression": "stepwise", "candidates": POOL, "level": 2.0},
        {"window": 3.0},
    ],
)
def test_options_that_do_not_fit_are_refused(options):
    with pytest.raises(BadInput, match="bad_option"):
        identify_equation_error(
            [maneuver()], {"Cm": "1 + alpha + qhat + de"}, regression=regression_choice(options)
        )


def test_biased_methods_say_so():
    for kind in ("ridge", "pcr"):
        options = regression_choice({"regression": kind})
        got = identify_equation_error(
            [maneuver()], {"Cm": "1 + alpha + qhat + de"}, regression=options
        )
        assert "biased" in got.method
        assert all(p.bias is not None for p in got.parameters)
        assert any(m.code == "biased_estimate" for m in got.messages)
        assert "biased estimates" in got.summary()
