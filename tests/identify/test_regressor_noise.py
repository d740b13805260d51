"""The bias that noise in the regressors causes is foreseen and said."""

import numpy as np
import pytest
from identify_flights import short_period, twin_otter

from alula.identify import identify_equation_error
from alula.identify.regression.regress import Block, regress
from alula.identify.regression.regressor_noise import noise_bias


def noisy(seed: int, sigma: float) -> Block:
    """Cm without noise of its own, on an angle of attack with noise `sigma`, rad."""
    x = short_period(600, 0.02) * 0.05
    x[:, 0] = 1.0
    z = x @ [0.0, -1.2, -0.4, -1.5]
    x[:, 1] += sigma * np.random.default_rng(seed).standard_normal(600)
    return Block(x, z)


def test_foreseen_bias_is_the_one_that_happens():
    """Mean over 40 seeds of what the noise did, against the mean of what was foreseen."""
    fits = [regress("abcd", [noisy(seed, 0.002)]) for seed in range(40)]
    happened = np.mean([f.solution.value - [0.0, -1.2, -0.4, -1.5] for f in fits], axis=0)
    foreseen = np.mean([noise_bias(f) for f in fits], axis=0)
    assert abs(happened[1]) > 0.02  # there is something to foresee: 2 % of the value
    # first order: a shift of a few percent is foreseen to a few percent, and 40 seeds scatter
    assert foreseen[1] == pytest.approx(happened[1], rel=0.15)
    assert foreseen[2] == pytest.approx(happened[2], rel=0.15)


def test_exact_regressors_have_no_bias():
    fit = regress("abcd", [noisy(0, 0.0)])
    assert noise_bias(fit)[1:] == pytest.approx(0.0, abs=2e-3)  # below 0.2 % of the values


def test_real_flight_data_are_quiet_enough():
    """Twin Otter: no warning, as the published fit of the same columns stands."""
    result = identify_equation_error([twin_otter()], {"Cm": "1 + alpha + qhat + de"})
    assert not [m for m in result.messages if m.code == "noisy_regressor"]
