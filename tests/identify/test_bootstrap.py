"""Block bootstrap against what autoregressive residuals do, known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from identify_flights import maneuver
from scipy import signal
from scipy.linalg import toeplitz

from alula.base.messages import BadInput
from alula.identify import identify_equation_error
from alula.identify.equation_error.bootstrap import block_bootstrap, block_length, bootstrapped
from alula.identify.regression.regress import Block, regress

N, DT = 1000, 0.02


def coloured(rng: np.random.Generator, tau: float) -> np.ndarray:
    """Unit variance, correlation exp(-t/tau)."""
    rho = np.exp(-DT / tau)
    return signal.lfilter([np.sqrt(1 - rho**2)], [1, -rho], rng.standard_normal(N + 2000))[2000:]


@pytest.mark.parametrize("tau", [0.02, 0.1])
def test_standard_errors_of_autoregressive_residuals(tau: float) -> None:
    """Root mean square over 40 records against D X' T X D with the true T, and the formula."""
    rng = np.random.default_rng(4)
    x = np.column_stack([coloured(rng, 0.5) for _ in range(3)])
    dispersion = np.linalg.inv(x.T @ x)
    inner = x.T @ toeplitz(np.exp(-np.arange(N) * DT / tau)) @ x
    exact = np.sqrt(np.diag(dispersion @ inner @ dispersion))
    drawn, formula, white = [], [], []
    for i in range(40):
        fit = regress(("a", "b", "c"), [Block(x, coloured(rng, tau))])
        drawn.append(np.diag(block_bootstrap(fit, replicates=300, seed=i).covariance))
        formula.append(np.diag(fit.coloured.covariance))
        white.append(np.diag(fit.solution.covariance))
    se = np.sqrt(np.mean(drawn, axis=0))
    # One record's variance scatters by about a third, 40 by 5 %; blocks lose some correlation
    # where they join, up to 10 % at this length.
    assert se == pytest.approx(exact, rel=0.15)
    assert se == pytest.approx(np.sqrt(np.mean(formula, axis=0)), rel=0.1)
    assert (np.sqrt(np.mean(white, axis=0)) < 0.75 * exact).all()  # the test can tell


def test_white_residuals_give_the_plain_standard_error() -> None:
    rng = np.random.default_rng(5)
    x = rng.standard_normal((N, 2))
    fit = regress(("a", "b"), [Block(x, rng.standard_normal(N))])
    draws = block_bootstrap(fit, replicates=4000, seed=1)
    plain = np.sqrt(np.diag(fit.solution.covariance))
    # 4000 draws: 1.1 % of a standard deviation; the residuals' chance correlation, some more
    assert np.sqrt(np.diag(draws.covariance)) == pytest.approx(plain, rel=0.08)


def test_blocks_are_as_long_as_the_colour() -> None:
    rng = np.random.default_rng(6)
    white = [block_length(rng.standard_normal(N)) for _ in range(20)]
    short = [block_length(coloured(rng, 0.1)) for _ in range(20)]
    long = [block_length(coloured(rng, 0.5)) for _ in range(20)]
    assert np.median(white) <= 2
    # Politis and White's rule in closed form: (rho/(1 - rho^2))^(2/3) (6 n)^(1/3) for AR(1)
    rho = np.exp(-DT / 0.1)
    assert np.median(short) == pytest.approx(
        (rho / (1 - rho**2)) ** (2 / 3) * (6 * N) ** (1 / 3), rel=0.3
    )
    assert np.median(long) > 1.5 * np.median(short)
    assert block_length(np.zeros(50)) == 1
    assert max(long) <= N // 3


def test_maneuvers_do_not_lend_each_other_residuals() -> None:
    """A quiet maneuver's own constant has its own small error."""
    rng = np.random.default_rng(7)
    n = 300
    own = np.eye(2)[[0] * n + [1] * n]
    blocks = [
        Block(own[:n], 1e-3 * rng.standard_normal(n)),
        Block(own[n:], rng.standard_normal(n)),
    ]
    fit = regress(("quiet", "loud"), blocks, "equal")
    se = np.sqrt(np.diag(block_bootstrap(fit, replicates=500, seed=0).covariance))
    assert se[0] < 0.01 * se[1]


@pytest.fixture
def flown():
    data = maneuver("m1", 1)
    return [data], identify_equation_error([data], {"Cm": "1 + alpha + qhat + de"})


def test_result_says_so_and_keeps_its_values(flown) -> None:
    data, result = flown
    again = bootstrapped(result, data, seed=3)
    assert "bootstrap" in again.method
    assert again.uncertainty.startswith("block bootstrap")
    (said,) = [m for m in again.messages if m.code == "block_bootstrap"]
    assert "seed 3" in said.found
    for before, after in zip(result.parameters, again.parameters, strict=True):
        assert after.value == before.value
        assert after.se != before.se
        assert after.ci95[0] < after.value < after.ci95[1]
    same = bootstrapped(result, data, seed=3)
    assert [p.se for p in same.parameters] == [p.se for p in again.parameters]
    assert np.sqrt(np.diag(again.covariance)) == pytest.approx([p.se for p in again.parameters])


@pytest.mark.parametrize("wrong", [{"replicates": 5}, {"replicates": 200.5}, {"block_s": 0.0}])
def test_numbers_out_of_range_are_refused(flown, wrong) -> None:
    data, result = flown
    with pytest.raises(BadInput, match="bad_option"):
        bootstrapped(result, data, **wrong)


def test_biased_methods_are_refused(flown) -> None:
    data, _ = flown
    ridge = identify_equation_error(data, {"Cm": "1 + alpha + qhat + de"}, regression="ridge")
    with pytest.raises(BadInput, match="unbiased"):
        bootstrapped(ridge, data)
