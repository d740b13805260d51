"""Equation error in the frequency domain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from identify_flights import DT, N, maneuver, short_period, twin_otter
from scipy.signal import lfilter

from alula.base.messages import BadInput
from alula.identify import identify_equation_error
from alula.identify.frequency.regression import identify_frequency_regression
from alula.identify.regression.sandwich import sandwich

MODEL = {"Cm": "1 + alpha + qhat + de"}
TRUE = {"Cm_alpha": -1.2, "Cm_q": -20.0, "Cm_de": -1.5}


def with_noise(item, noise):
    return replace(item, coefficients={"Cm": item.coefficients["Cm"] + noise})


def test_exact_without_noise_offset_and_drift_included():
    """What holds in time holds in frequency; a constant and a drift of the moment do not matter."""
    item = maneuver()
    v = item.variables
    clean = -1.2 * v["alpha"] - 20.0 * v["qhat"] - 1.5 * v["de"]
    drift = 0.3 + 0.1 * np.linspace(0.0, 1.0, N)
    found = identify_frequency_regression(
        [replace(item, coefficients={"Cm": clean + drift})], MODEL
    )
    for name, value in TRUE.items():
        assert found[name].value == pytest.approx(value, rel=1e-9)
    assert found["Cm_0"].value == pytest.approx(0.35, rel=1e-9)  # of the means


@pytest.mark.parametrize("tau", [0.0, 0.2])
def test_intervals_hold(tau):
    """80 draws, white and coloured (0.2 s): 240 intervals of the derivatives, within 3 binomial
    deviations and the draws' own correlation 89 to 99 %; 80 of the constants, 87 % or more.
    """
    inside, constants = [], []
    for seed in range(80):
        rng = np.random.default_rng(seed)
        noise = 2e-3 * rng.standard_normal(N + 200)
        if tau:
            pole = np.exp(-DT / tau)
            noise = lfilter([(1.0 - pole**2) ** 0.5], [1.0, -pole], noise)
        found = identify_frequency_regression([with_noise(maneuver(seed=seed), noise[200:])], MODEL)
        inside += [found[n].ci95[0] < v < found[n].ci95[1] for n, v in TRUE.items()]
        constants.append(found["Cm_0"].ci95[0] < 0.0 < found["Cm_0"].ci95[1])
    assert 0.89 <= np.mean(inside) <= 0.99
    assert np.mean(constants) >= 0.87


def test_vibration_outside_the_band_does_not_matter():
    """An engine at 15 Hz, as large as the moment itself, moves the estimate by leakage only."""
    item = maneuver()
    shake = 0.05 * np.sin(2.0 * np.pi * 15.0 * item.t + 0.3)
    quiet = identify_frequency_regression([item], MODEL, band_hz=(0.0, 2.0))
    shaken = identify_frequency_regression([with_noise(item, shake)], MODEL, band_hz=(0.0, 2.0))
    in_time = identify_equation_error([with_noise(item, shake)], MODEL)
    for name in TRUE:
        moved = abs(shaken[name].value - quiet[name].value)
        assert moved < 0.03 * abs(TRUE[name])
        assert shaken[name].se < 0.2 * in_time[name].se_white


def test_noisy_regressors_bias_less_than_in_time():
    """White noise in the pitch rate: only the band's share of it counts (mean of 20 draws)."""
    shifts = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        q = 0.02 * 0.05 * short_period(N, DT)[:, 2]
        item = maneuver(seed=seed, qhat=q)
        noisy = replace(
            item, variables=item.variables | {"qhat": q + 3e-4 * rng.standard_normal(N)}
        )
        pair = (
            identify_frequency_regression([noisy], MODEL),
            identify_equation_error([noisy], MODEL),
        )
        shifts.append([r["Cm_q"].value + 20.0 for r in pair])
    band, time = np.mean(shifts, axis=0)
    assert time > 2.0  # over 10 % toward zero
    assert abs(band) < 0.3 * time


def test_several_maneuvers_have_their_own_constants():
    a, b = maneuver("a", 1), with_noise(maneuver("b", 2), 0.02)
    found = identify_frequency_regression([a, b], MODEL)
    assert found["Cm_0[a]"].value == pytest.approx(0.0, abs=4.0 * found["Cm_0[a]"].se)
    assert found["Cm_0[b]"].value == pytest.approx(0.02, abs=4.0 * found["Cm_0[b]"].se)
    assert found["Cm_alpha"].se < identify_frequency_regression([a], MODEL)["Cm_alpha"].se


def test_control_that_stands_still_is_named():
    found = identify_frequency_regression([maneuver(de=np.full(N, 0.01))], MODEL)
    assert found["Cm_de"].verdict == "not_identifiable"
    assert not found.identifiable


def test_twin_otter_within_two_published_standard_errors():
    """Klein and Morelli's equation error of run 018 (time domain), CZ and Cm."""
    found = identify_frequency_regression(
        [twin_otter()], {"CZ": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de"}
    )
    published = {
        "CZ_alpha": (-6.3489, 0.0200), "CZ_q": (-18.4061, 0.5524), "CZ_de": (-0.6261, 0.0153),
        "Cm_alpha": (-1.4762, 0.0224), "Cm_q": (-36.3533, 0.689), "Cm_de": (-1.8688, 0.0204),
    }  # fmt: skip
    for name, (value, se) in published.items():
        assert abs(found[name].value - value) < 2.0 * se, name
        assert 1.0 / 1.5 < found[name].se / se < 1.5, name


def test_refusals():
    with pytest.raises(BadInput, match="band_hz"):
        identify_frequency_regression([maneuver()], MODEL, band_hz=(2.0, 1.0))
    with pytest.raises(BadInput, match="too_few_samples"):
        identify_frequency_regression([maneuver()], MODEL, band_hz=(0.0, 0.09))
    with pytest.raises(BadInput, match="no_model"):
        identify_frequency_regression([maneuver()], {})


def test_sandwich_is_the_plain_covariance_for_even_residuals():
    """Orthonormal rows and residuals of one size: D s^2 (closed form)."""
    rows = np.kron(np.eye(2), np.ones((50, 1))) / 50**0.5
    found = sandwich([(rows, np.full(100, 0.3))], np.eye(2))
    np.testing.assert_allclose(found.covariance, 0.09 * np.eye(2), atol=1e-15)
    np.testing.assert_allclose(found.corrected, 0.09 / 0.98 * np.eye(2), rtol=1e-12)
    np.testing.assert_allclose(
        found.dof, 100.0
    )  # 25 pairs each, of which none is larger: twice two
