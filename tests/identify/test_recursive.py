"""Recursive least squares: against batch solutions, and what forgetting does to an estimate."""

import numpy as np
import pytest
from identify_flights import maneuver, twin_otter
from scipy import signal

from alula.base.messages import BadInput
from alula.identify import identify_equation_error
from alula.identify.equation_error.recursive import identify_recursive
from alula.identify.equation_error.recursive_least_squares import (
    Forgetting,
    recursive_least_squares,
    sample_weights,
)
from alula.identify.frequency.recursive_fourier import recursive_frequency_regression

MODELS = {"CZ": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de"}


def problem(n=400, k=3, seed=0):
    rng = np.random.default_rng(seed)
    x = rng.standard_normal((n, k))
    return x, x @ np.arange(1.0, k + 1.0) + 0.1 * rng.standard_normal(n)


def test_without_forgetting_every_step_is_the_batch_solution_so_far():
    x, z = problem()
    got = recursive_least_squares(x, z)
    for n in (10, 50, 400):
        batch, squares = np.linalg.lstsq(x[:n], z[:n], rcond=None)[:2]
        # 1e-7: the start counts as a 1e-8th of a sample
        assert got.value[n - 1] == pytest.approx(batch, rel=1e-7)
        noise = squares[0] / (n - 3)
        # 1e-5: the start at zero is off by the values, which are 10 to 30 times the noise
        assert got.noise[n - 1] == pytest.approx(noise, rel=1e-5)
        se = np.sqrt(noise * np.diag(np.linalg.inv(x[:n].T @ x[:n])))
        assert got.se[n - 1] == pytest.approx(se, rel=1e-5)


def test_plain_forgetting_is_exponentially_weighted_least_squares():
    x, z = problem()
    got = recursive_least_squares(x, z, Forgetting(0.97, directional=False), gains=True)
    w = 0.97 ** np.arange(len(z) - 1.0, -1.0, -1.0)
    batch = np.linalg.solve((x * w[:, None]).T @ x, (x * w[:, None]).T @ z)
    assert got.value[-1] == pytest.approx(batch, rel=1e-6)
    weights, rest = sample_weights(x, got.gain)
    assert weights @ z == pytest.approx(got.value[-1], rel=1e-9)  # the start was zero
    assert np.abs(rest).max() < 1e-6  # and is forgotten


@pytest.mark.parametrize("forgetting", [Forgetting(0.98), Forgetting(0.99, window=30)])
def test_the_last_value_is_the_weighted_samples(forgetting):
    x, z = problem(seed=3)
    first = np.array([5.0, -3.0, 2.0])
    got = recursive_least_squares(x, z, forgetting, initial=first, variance=[1.0] * 3, gains=True)
    weights, rest = sample_weights(x, got.gain)
    assert weights @ z + rest @ first == pytest.approx(got.value[-1], rel=1e-9)


def test_quiet_flight_leaves_the_derivatives():
    """An hour of trim at 10 Hz after a maneuver: the constant is tracked, the rest is kept."""
    rng = np.random.default_rng(2)
    moving = np.concatenate([np.sin(0.2 * np.arange(300)), np.zeros(36000)])
    x = np.column_stack([np.ones(len(moving)), moving])
    drift = np.where(np.arange(len(moving)) > 2000, 0.5, 0.3)
    z = drift - 1.5 * moving + 0.02 * rng.standard_normal(len(moving))
    kept = recursive_least_squares(x, z, Forgetting(0.99))
    assert kept.value[-1] == pytest.approx([0.5, -1.5], abs=0.02)
    assert kept.se[-1, 1] < 2.0 * kept.se[300, 1]
    lost = recursive_least_squares(x, z, Forgetting(0.99, directional=False))
    assert lost.se[-1, 1] > 100.0 * kept.se[-1, 1]  # what directional forgetting is for


def test_a_reset_starts_the_variances_anew():
    x, z = problem()
    flags = np.arange(len(z)) == 200
    got = recursive_least_squares(x, z, reset=flags)
    batch = np.linalg.lstsq(x[200:], z[200:], rcond=None)[0]
    assert got.value[-1] == pytest.approx(batch, rel=1e-6)


def test_a_change_of_the_aircraft_is_followed_by_adaptive_forgetting_only():
    x, z = problem(n=2000, seed=4)
    z[1000:] -= 1.5 * x[1000:, 0]
    fixed = recursive_least_squares(x, z, Forgetting(0.999))
    adaptive = recursive_least_squares(x, z, Forgetting(0.999, window=40, least=0.9))
    late = slice(1250, 1350)
    assert np.abs(adaptive.value[late, 0] + 0.5).max() < 0.1
    assert np.abs(fixed.value[late, 0] + 0.5).min() > 0.5
    assert adaptive.factor[900:1000].min() > 0.998  # nothing forgotten faster before
    assert adaptive.factor[1000:1100].min() < 0.95


def test_gaps_are_passed_over():
    x, z = problem()
    z[100:120] = np.nan
    x[150, 1] = np.inf
    got = recursive_least_squares(x, z)
    good = np.isfinite(z) & np.isfinite(x).all(axis=1)
    assert got.value[-1] == pytest.approx(
        np.linalg.lstsq(x[good], z[good], rcond=None)[0], rel=1e-7
    )
    assert np.isnan(got.innovation[[100, 150]]).all()


@pytest.mark.parametrize(
    "options",
    [{"factor": 0.0}, {"factor": 1.1}, {"window": -1}, {"least": 0.0}, {"reset_ratio": 0.5}],
)
def test_options_out_of_range_are_refused(options):
    with pytest.raises(BadInput, match="bad_option"):
        Forgetting(**options)


def test_shapes_that_do_not_fit_are_refused():
    x, z = problem()
    for bad in (lambda: recursive_least_squares(x, z[:-1]),
                lambda: recursive_least_squares(x, z, variance=[1.0, -1.0, 1.0]),
                lambda: recursive_least_squares(np.ones((50, 40)), np.ones(50))):  # fmt: skip
        with pytest.raises(BadInput, match="wrong_length"):
            bad()


def test_last_values_of_the_twin_otter_are_those_of_equation_error():
    """Published problem: the same values and coloured standard errors as by the batch method."""
    batch = identify_equation_error([twin_otter()], MODELS)
    got = identify_recursive([twin_otter()], MODELS)
    for a, b in zip(got.parameters, batch.parameters, strict=True):
        assert a.value == pytest.approx(b.value, rel=1e-6)
        assert a.se == pytest.approx(b.se, rel=1e-4)
        assert a.verdict == b.verdict
    (cz, cm) = got.histories
    assert cz.names == ("CZ_0", "CZ_alpha", "CZ_q", "CZ_de")
    assert cm.value.shape == cm.se.shape == (401, 4)
    assert np.isnan(cm.se[3]).all()  # four samples, four parameters
    assert cm.value[-1, 2] == got["Cm_q"].value


def test_intervals_with_forgetting_hold_in_coloured_noise():
    """150 draws of noise of 0.2 s: last values under forgetting cover the truth as they say."""
    inside = []
    for seed in range(150):
        item = maneuver(seed=seed)
        noise = signal.lfilter([0.43], [1.0, -0.905], np.random.default_rng(seed).normal(size=900))
        item.coefficients["Cm"] = item.coefficients["Cm"] + 2e-3 * noise[300:]
        got = identify_recursive(
            [item], {"Cm": "1 + alpha + qhat + de"}, forgetting=Forgetting(0.998)
        )
        truth = {"Cm_alpha": -1.2, "Cm_q": -20.0, "Cm_de": -1.5}
        inside += [got[n].ci95[0] <= v <= got[n].ci95[1] for n, v in truth.items()]
    assert (
        0.88 <= np.mean(inside) <= 0.995
    )  # 450 intervals, three of a kind dependent: 2 % by chance


def test_a_control_that_stands_still_is_not_identifiable():
    got = identify_recursive([maneuver()], {"Cm": "1 + alpha + qhat + de + df"})
    assert got["Cm_df"].verdict == "not_identifiable"
    assert got["Cm_alpha"].verdict == "ok"


def frequency_problem(seed, drift=0.0):
    rng = np.random.default_rng(seed)
    t = np.arange(2000) * 0.02
    a = sum(np.sin(2 * np.pi * f * t + f) for f in (0.3, 0.7, 1.3))
    b = sum(np.sin(2 * np.pi * f * t + 2 * f) for f in (0.5, 0.9, 1.7))
    x = np.column_stack([np.ones(len(t)), 0.05 * a, 0.05 * b])
    noise = 0.02 * rng.standard_normal(len(t)) + drift * np.sin(2 * np.pi * 8.0 * t)
    return x, x @ [0.4, -1.2, 0.7] + noise


BAND = np.arange(0.1, 2.01, 0.05)


def test_frequency_domain_values_and_standard_errors():
    """100 draws: unbiased, and the scatter is as large as the standard errors say."""
    runs = [recursive_frequency_regression(*frequency_problem(s), 0.02, BAND, every=500)
            for s in range(100)]  # fmt: skip
    last = np.array([r.value[-1] for r in runs])
    scatter, said = last.std(axis=0, ddof=1), np.mean([r.se[-1] for r in runs], axis=0)
    assert np.abs(last.mean(axis=0) - [0.4, -1.2, 0.7])[1:].max() < 4.0 * scatter[1:].max() / 10.0
    assert scatter[1:] == pytest.approx(said[1:], rel=0.25)  # 7 % by chance of 100 draws, twice 1.7
    assert runs[0].t == pytest.approx([9.98, 19.98, 29.98, 39.98])


def test_noise_outside_the_band_does_not_count():
    """A vibration forty times the noise at 8 Hz: out of a band up to 2 Hz."""
    quiet = recursive_frequency_regression(*frequency_problem(1), 0.02, BAND, every=2000)
    shaken = recursive_frequency_regression(
        *frequency_problem(1, drift=0.8), 0.02, BAND, every=2000
    )
    assert shaken.value[-1, 1:] == pytest.approx(quiet.value[-1, 1:], abs=0.02)


def test_frequencies_beyond_half_the_sampling_rate_are_refused():
    x, z = frequency_problem(0)
    with pytest.raises(BadInput, match="bad_option"):
        recursive_frequency_regression(x, z, 0.02, np.array([1.0, 30.0]))
    with pytest.raises(BadInput, match="bad_option"):
        recursive_frequency_regression(x, z, 0.02, np.array([]))
