"""Plain regression on SIDPAC's problem with known answer, and on what linear algebra dictates."""

import numpy as np
import pytest
from scipy.io import loadmat

from alula.base.messages import BadInput
from alula.identify.regression.least_squares import least_squares
from alula.identify.regression.regress import Block, regress
from data import data


def test_known_answer():
    """SIDPAC's example: its own estimate, its standard errors, and the truth behind the noise."""
    m = loadmat(data("regression", "swr_example.mat"), squeeze_me=True)
    used = m["x"][:, [0, 1, 3]]  # the third has no effect: p[2] is zero
    got = least_squares(np.column_stack([used, np.ones(len(used))]), m["z"])
    theirs = m["p"][[0, 1, 3, 4]]
    assert got.value == pytest.approx(theirs, rel=1e-9)  # the same problem, double precision
    assert np.sqrt(np.diag(got.covariance)) == pytest.approx(m["serr"], rel=1e-6)
    truth = m["p_true"][[0, 1, 3, 4]]
    assert np.all(np.abs(got.value - truth) < 3.5 * np.sqrt(np.diag(got.covariance)))


def test_badly_scaled_columns_do_not_matter():
    """Columns of size 1e-9 and 1e9: the normal equations would have a condition of 1e36."""
    rng = np.random.default_rng(3)
    x = rng.standard_normal((200, 2)) * [1e-9, 1e9]
    got = least_squares(x, x @ [2e9, -3e-9])
    assert got.value == pytest.approx([2e9, -3e-9], rel=1e-12)
    assert got.null.shape == (2, 0)


def test_weights_are_repeated_rows():
    """A row with weight 3 is the row three times."""
    rng = np.random.default_rng(4)
    x, z = rng.standard_normal((20, 2)), rng.standard_normal(20)
    weight = np.where(np.arange(20) < 5, 3.0, 1.0)
    repeated = np.repeat(np.arange(20), weight.astype(int))
    assert least_squares(x, z, weight).value == pytest.approx(
        least_squares(x[repeated], z[repeated]).value, rel=1e-12
    )


def test_noisy_maneuver_weighs_less():
    """Of two maneuvers that disagree, the estimate lies nearer the quiet one."""
    rng = np.random.default_rng(5)
    x = rng.standard_normal((300, 1))
    quiet = Block(x, 1.0 * x[:, 0] + 0.1 * rng.standard_normal(300))
    noisy = Block(x, 2.0 * x[:, 0] + 3.0 * rng.standard_normal(300))
    assert regress(["a"], [quiet, noisy], "equal").solution.value[0] > 1.3
    assert regress(["a"], [quiet, noisy]).solution.value[0] < 1.2


def test_too_few_samples_are_refused():
    with pytest.raises(BadInput, match="too_few_samples"):
        least_squares(np.eye(3), np.ones(3))


def test_not_finite_is_refused():
    x = np.ones((5, 1))
    with pytest.raises(BadInput, match="not_finite"):
        least_squares(x, np.array([1.0, 2.0, np.nan, 3.0, 4.0]))
