"""Ridge and principal-components regression against linear algebra and their closed form."""

import numpy as np
import pytest
from scipy import optimize

from alula.base.messages import BadInput
from alula.identify.regression.principal_components import principal_components
from alula.identify.regression.regress import Block, regress
from alula.identify.regression.ridge import ridge
from alula.identify.regression.shrinkage import bias_matrix
from alula.identify.trust.verdict import assess
from verification.estimation.collinear import (
    FREE,
    NAMES,
    NOISE,
    TRUTH,
    K,
    check,
    closed_form,
    design,
)


def fitted(seed=0, sigma=NOISE):
    x = design()
    noise = sigma * np.random.default_rng(seed).standard_normal(len(x))
    return regress(NAMES, [Block(x, x @ TRUTH + noise)])


def test_scatter_has_the_bias_and_variance_of_the_closed_form():
    found, good = check(quick=True)
    assert good, found


def test_ridge_is_the_minimum_of_the_penalized_sum_of_squares():
    """Its definition: |z - X b|^2 + k |scaled b|^2, the constant free, found by a minimizer."""
    ordinary = fitted()
    block = ordinary.blocks[0]
    scale = np.linalg.norm(block.regressors - block.regressors.mean(axis=0), axis=0)

    def cost(b):
        penalty = (b * scale)[1:]
        return np.sum((block.measured - block.regressors @ b) ** 2) + K * penalty @ penalty

    wanted = optimize.minimize(cost, ordinary.solution.value, tol=1e-12, method="BFGS").x
    # the minimizer's own accuracy with finite differences
    assert ridge(ordinary, FREE, K)[0].solution.value == pytest.approx(wanted, abs=1e-4)


@pytest.mark.parametrize("shrunk", [0.0, None])
def test_without_shrinkage_both_are_ordinary_least_squares(shrunk):
    ordinary = fitted()
    fit = (
        ridge(ordinary, FREE, 0.0)[0]
        if shrunk == 0.0
        else principal_components(ordinary, FREE, 3)[0]
    )
    assert fit.solution.value == pytest.approx(ordinary.solution.value, rel=1e-9)
    np.testing.assert_allclose(fit.solution.covariance, ordinary.solution.covariance, rtol=1e-8)
    np.testing.assert_allclose(fit.coloured.covariance, ordinary.coloured.covariance, rtol=1e-8)


def test_maneuvers_keep_their_own_constants_and_weights():
    """Two maneuvers, the second three times as noisy: the closed form with weights, written out."""
    rng = np.random.default_rng(5)
    x = design()
    own = [np.hstack([np.eye(2)[[i] * len(x)], x[:, 1:]]) for i in range(2)]
    truth = np.array([0.3, -0.7, *TRUTH[1:]])
    blocks = [
        Block(m, m @ truth + s * rng.standard_normal(len(x)))
        for m, s in zip(own, (0.5, 1.5), strict=True)
    ]
    ordinary = regress(["0[a]", "0[b]", "a", "b", "c"], blocks)
    assert ordinary.weights[0] > 5.0 * ordinary.weights[1]
    fit, _ = ridge(ordinary, np.array([True, True, False, False, False]), K)
    root = np.sqrt(np.repeat(ordinary.weights, len(x)))[:, None]
    rows, z = root * np.vstack(own), root[:, 0] * np.concatenate([b.measured for b in blocks])
    fixed = rows[:, :2]
    rest = rows[:, 2:] - fixed @ np.linalg.lstsq(fixed, rows[:, 2:], rcond=None)[0]
    penalty = np.diag([0.0, 0.0, *np.sum(rest**2, axis=0)]) * K
    wanted = np.linalg.solve(rows.T @ rows + penalty, rows.T @ z)
    assert fit.solution.value == pytest.approx(wanted, rel=1e-9)
    # what other data of the same shape would have given, under the same k and weights
    assert fit.refit(blocks) == pytest.approx(wanted, rel=1e-9)


def test_bias_is_stated_and_the_interval_includes_it():
    ordinary = fitted(sigma=0.1)
    fit, kept, index = principal_components(ordinary, FREE)
    assert kept == 2  # of three: one dependency, condition index over 30
    assert np.sum(index > 30.0) == 1
    parameters, _ = assess("Cm", fit, np.zeros((4, 4)), {}, {})
    slope = parameters[1]
    expected = (bias_matrix(fit.solution, design()) @ ordinary.solution.value)[1]
    assert slope.bias == pytest.approx(expected, rel=1e-9)
    # the interval's half width is at least the bias, here many standard errors
    assert slope.ci95[1] - slope.value > abs(slope.bias) > 10.0 * slope.se
    assert closed_form("principal components")[0][0] == pytest.approx(slope.bias, rel=0.6)
    # ... 0.6: two standard errors of the ordinary estimate that stands in for the truth


def test_an_unbiased_fit_has_no_bias():
    assert fitted().bias is None
    assert assess("Cm", fitted(), np.zeros((4, 4)), {}, {})[0][1].bias is None


def test_what_the_data_do_not_determine_stays_not_identifiable():
    """Two equal columns: ridge has a value for each, the data have one for the sum."""
    x = design()
    x[:, 3] = 2.0 * x[:, 2]
    ordinary = regress(
        NAMES, [Block(x, x @ TRUTH + 0.1 * np.random.default_rng(1).normal(size=200))]
    )
    fit, _ = ridge(ordinary, FREE, K)
    verdicts = {p.name: p for p in assess("Cm", fit, np.zeros((4, 4)), {}, {})[0]}
    assert verdicts["a"].verdict == "ok"
    assert verdicts["b"].verdict == verdicts["c"].verdict == "not_identifiable"
    assert verdicts["b"].tied_to[0].name == "c"
    assert verdicts["b"].tied_to[0].weight == pytest.approx(2.0)


def test_choices_of_k():
    """Hoerl, Kennard and Baldwin's by its formula; cross-validation's beats its neighbours."""
    ordinary = fitted()
    x, z = design(), ordinary.blocks[0].measured
    centered = x[:, 1:] - x[:, 1:].mean(axis=0)
    scale = np.linalg.norm(centered, axis=0)
    scaled = ordinary.solution.value[1:] * scale
    assert ridge(ordinary, FREE, "hkb")[1] == pytest.approx(
        3.0 * ordinary.solution.variance / (scaled @ scaled), rel=1e-9
    )
    k = ridge(ordinary, FREE, "gcv")[1]

    def score(k):
        hat = centered @ np.linalg.solve(centered.T @ centered + k * np.diag(scale**2), centered.T)
        left = z - z.mean() - hat @ z
        return len(z) * (left @ left) / (len(z) - 1.0 - np.trace(hat)) ** 2

    assert k > 0.0
    assert score(k) < min(score(0.8 * k), score(1.25 * k))


@pytest.mark.parametrize("k", [-1.0, np.nan, "best"])
def test_bad_k_is_refused(k):
    with pytest.raises(BadInput, match="bad_option"):
        ridge(fitted(), FREE, k)


@pytest.mark.parametrize("count", [0, 4])
def test_bad_number_of_components_is_refused(count):
    with pytest.raises(BadInput, match="bad_option"):
        principal_components(fitted(), FREE, count)
