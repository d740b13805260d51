"""Covariance with coloured residuals: against its definition, and by how often intervals cover."""

import numpy as np
import pytest
from identify_flights import short_period
from scipy import signal

from alula.base.coloured import coloured_covariance
from alula.identify.regression.least_squares import least_squares
from alula.identify.regression.regress import Block, regress
from alula.identify.trust.verdict import assess


def autoregressive(rng: np.random.Generator, n: int, dt: float, tau: float) -> np.ndarray:
    """Noise of unit variance whose correlation falls off in `tau` seconds."""
    rho = np.exp(-dt / tau)
    return signal.lfilter([np.sqrt(1 - rho**2)], [1, -rho], rng.standard_normal(n + 2000))[2000:]


def test_it_is_the_double_sum_of_its_definition():
    """Klein and Morelli's sum over i and j with an n by n matrix, two maneuvers."""
    rng = np.random.default_rng(1)
    blocks = [(rng.standard_normal((n, 2)), autoregressive(rng, n, 0.02, 0.1)) for n in (60, 101)]
    x = np.vstack([b[0] for b in blocks])
    dispersion = np.linalg.inv(x.T @ x)
    inner = np.zeros((2, 2))
    for regressors, v in blocks:
        n = len(v)
        lags = np.correlate(v, v, "full")[n - 1 :] / n
        index = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
        inner += regressors.T @ lags[index] @ regressors
    got = coloured_covariance(blocks, dispersion).covariance
    assert got == pytest.approx(dispersion @ inner @ dispersion, rel=1e-9)  # rounding of the FFT


def test_outputs_that_go_together_are_the_double_sum_with_a_matrix():
    """sum_ij X_i' R(i - j) X_j with R(k) = mean of v(n + k) v(n)': not symmetric, R(-k) = R(k)'."""
    rng = np.random.default_rng(4)
    n, m, k = 40, 2, 3
    x = rng.standard_normal((n, m, k))
    v = np.column_stack([autoregressive(rng, n, 0.02, 0.1) for _ in range(m)])
    v[1:, 1] += v[:-1, 0]  # the second output follows the first
    dispersion = np.linalg.inv(np.einsum("noi,noj->ij", x, x))
    inner = np.zeros((k, k))
    for i in range(n):
        for j in range(n):
            lag = i - j
            pairs = range(max(0, -lag), min(n, n - lag))
            R = sum(np.outer(v[t + lag], v[t]) for t in pairs) / n
            inner += x[i].T @ R @ x[j]
    got = coloured_covariance([(x, v)], dispersion).covariance
    assert got == pytest.approx(dispersion @ inner @ dispersion, rel=1e-9)  # rounding of the FFT


def test_one_output_is_the_same_either_way():
    rng = np.random.default_rng(6)
    x, v = short_period(200, 0.02), autoregressive(rng, 200, 0.02, 0.1)
    dispersion = np.linalg.inv(x.T @ x)
    one = coloured_covariance([(x, v)], dispersion)
    same = coloured_covariance([(x[:, None, :], v[:, None])], dispersion)
    # rounding, which the fixed point does not enlarge
    assert same.corrected == pytest.approx(one.corrected, rel=1e-9)
    assert same.dof == pytest.approx(one.dof, rel=1e-9)


@pytest.mark.parametrize("together", [0.0, 0.7, -0.7])
def test_variances_of_outputs_that_go_together(together):
    """Two coloured outputs of one set of parameters, 150 draws: the variance is the scatter.

    Taken as independent, outputs that go together would be off by the square root of 1 + together.
    """
    rng = np.random.default_rng(9)
    one = short_period(400, 0.02)
    x = np.stack([one, one], axis=1)  # the same sensitivities: where correlation matters most
    dispersion = np.linalg.inv(np.einsum("noi,noj->ij", x, x))
    mix = np.linalg.cholesky(np.array([[1.0, together], [together, 1.0]]))
    found, variance = [], []
    for _ in range(150):
        noise = np.column_stack([autoregressive(rng, 400, 0.02, 0.1) for _ in range(2)]) @ mix.T
        error = dispersion @ np.einsum("noi,no->i", x, noise)
        both = coloured_covariance([(x, noise - x @ error)], dispersion)
        found.append(error)
        variance.append(np.diag(both.corrected))
    ratio = np.sqrt(np.mean(variance, axis=0)) / np.std(found, axis=0)
    # 150 draws tell a standard deviation to 6 %; the rest is what a maneuver of 8 s cannot tell
    assert ratio[1:] == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize("tau", [0.05, 0.2, 1.0])
def test_intervals_cover_as_often_as_they_say(tau):
    """600 fits of 8 s at 50 Hz: the standard error of a coverage of 95 % is 0.9 %.

    The constant term may cover more: residuals slower than the maneuver cannot be told from it, so
    its interval is wide.
    """
    rng = np.random.default_rng(11)
    x = short_period(400, 0.02)
    names = ["Cm_0", "Cm_alpha", "Cm_q", "Cm_de"]
    inside, white = np.zeros(4), np.zeros(4)
    repeats = 600
    for _ in range(repeats):
        noise = autoregressive(rng, 400, 0.02, tau) + 0.3 * rng.standard_normal(400)
        found, _ = assess("Cm", regress(names, [Block(x, noise)]), np.zeros((4, 4)), {}, {})
        for i, p in enumerate(found):
            inside[i] += p.ci95[0] < 0.0 < p.ci95[1]
            white[i] += abs(p.value) < 1.96 * p.se_white
    assert np.all(inside / repeats > 0.92)
    assert np.all(inside[1:] / repeats < 0.98)
    if tau == 1.0:
        assert np.all(white[1:] / repeats < 0.8)  # and plain intervals do not


def test_white_residuals_give_the_plain_error():
    """On long white data both standard errors estimate the same thing."""
    rng = np.random.default_rng(2)
    x = short_period(8000, 0.02)
    ratios = []
    for _ in range(20):
        fit = least_squares(x, rng.standard_normal(8000))
        both = coloured_covariance([(x, fit.residual)], fit.dispersion)
        ratios.append(np.sqrt(np.diag(both.corrected) / np.diag(fit.covariance))[2:])
    # 3.5 s of excitation leave about 40 degrees of freedom: 11 % scatter, 2.5 % in the mean of 20
    assert np.mean(ratios, axis=0) == pytest.approx(1.0, abs=0.1)


def test_standard_errors_shrink_with_repeated_maneuvers():
    """Four maneuvers of the same kind: half the standard error, whatever the colour."""
    rng = np.random.default_rng(8)
    x = short_period(400, 0.02)
    one, four = [], []
    for _ in range(30):
        blocks = [Block(x, autoregressive(rng, 400, 0.02, 0.3)) for _ in range(4)]
        one.append(np.diag(regress("abcd", blocks[:1]).coloured.corrected))
        four.append(np.diag(regress("abcd", blocks, "equal").coloured.corrected))
    ratio = np.sqrt(np.mean(four, axis=0) / np.mean(one, axis=0))
    assert ratio[1:] == pytest.approx(0.5, abs=0.06)  # 30 repeats scatter by about 5 %
