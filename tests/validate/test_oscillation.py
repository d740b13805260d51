"""Period and damping from responses whose period and damping are known."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.arrays import Array
from alula.validate import fit_oscillation

T = np.arange(0.0, 20.0, 0.02)


def wave(period: float, damping: float, phase: float = 0.0) -> Array:
    w = 2.0 * np.pi / period
    s = w * damping / np.sqrt(1.0 - damping**2)
    return np.asarray(np.exp(-s * T) * np.cos(w * T - phase))


@pytest.mark.parametrize("period", [1.2, 3.7, 11.0])
@pytest.mark.parametrize("damping", [-0.03, 0.0, 0.08, 0.25])
def test_exact_response_gives_exact_numbers(period: float, damping: float) -> None:
    found = fit_oscillation(T, {"beta": 0.1 + 0.02 * T + wave(period, damping, 0.4)})
    assert found is not None
    assert found.period == pytest.approx(period, rel=1e-5)  # the search's own tolerance
    assert found.damping == pytest.approx(damping, abs=1e-5)
    assert found.explained["beta"] == pytest.approx(1.0, abs=1e-8)


def test_time_to_half_is_the_time_to_half() -> None:
    found = fit_oscillation(T, {"r": wave(3.0, 0.1)})
    assert found is not None
    w = 2.0 * np.pi / 3.0
    rate = w * 0.1 / np.sqrt(1.0 - 0.01)
    assert np.exp(-rate * found.time_to_half) == pytest.approx(0.5, rel=1e-4)
    growing = fit_oscillation(T, {"r": wave(3.0, -0.05)})
    assert growing is not None
    assert growing.time_to_half < 0.0


def test_cycles_end_where_the_oscillation_has_died_out() -> None:
    """A ratio of 0.25 leaves a twentieth after ln 20 / (2 pi 0.258) = 1.85 periods."""
    found = fit_oscillation(T, {"r": wave(2.0, 0.25)})
    assert found is not None
    assert found.cycles == pytest.approx(1.847, abs=0.01)
    endless = fit_oscillation(T, {"r": wave(2.0, 0.0)})
    assert endless is not None
    assert endless.cycles == pytest.approx(T[-1] / 2.0, rel=1e-3)


def test_peaks_of_one_trace_behind_another() -> None:
    late = {"phi": wave(4.0, 0.1, 0.0), "beta": 0.3 * wave(4.0, 0.1, np.pi / 2.0)}
    found = fit_oscillation(T, late)
    assert found is not None
    # a quarter of a period later: cos(wt - pi/2) peaks 1 s after cos(wt)
    assert found.lag("phi", "beta") == pytest.approx(1.0, abs=1e-4)
    assert found.lag("beta", "phi") == pytest.approx(-1.0, abs=1e-4)


def test_a_slow_mode_left_over_does_not_bend_the_fast_one() -> None:
    """A spiral of 8 s beside a Dutch roll of ratio 0.2 that has died out after 8 s."""
    spiral = 0.5 * np.exp(-T / 8.0)
    found = fit_oscillation(T, {"beta": wave(3.5, 0.2), "p": wave(3.5, 0.2, 1.0) + spiral})
    assert found is not None
    assert found.period == pytest.approx(3.5, rel=0.02)  # a fifth of the regulation's tolerance
    assert found.damping == pytest.approx(0.2, abs=0.01)  # half of it


def test_errors_are_as_large_as_they_say() -> None:
    """Colored noise (0.1 s), 80 draws: the scatter is what is stated."""
    random = np.random.default_rng(5)
    keep = np.exp(-0.02 / 0.1)
    off, said = [], []
    for _ in range(80):
        white = random.standard_normal(len(T))
        noise = np.zeros(len(T))
        for i in range(1, len(T)):
            noise[i] = keep * noise[i - 1] + np.sqrt(1.0 - keep**2) * white[i]
        found = fit_oscillation(T, {"r": wave(3.0, 0.06) + 0.08 * noise})
        assert found is not None
        off.append([found.period - 3.0, found.damping - 0.06])
        said.append([found.period_se, found.damping_se])
    ratio = np.sqrt(np.mean(np.square(off), axis=0) / np.mean(np.square(said), axis=0))
    # 80 draws know a standard deviation to 8 %, and the stated ones scatter: three of these
    np.testing.assert_allclose(ratio, 1.0, atol=0.25)


@pytest.mark.parametrize("seed", range(5))
def test_noise_alone_explains_nothing(seed: int) -> None:
    found = fit_oscillation(T, {"r": np.random.default_rng(seed).standard_normal(len(T))})
    assert found is None or found.explained["r"] < 0.2


def test_what_cannot_oscillate_is_none() -> None:
    assert fit_oscillation(T, {"r": np.ones(len(T))}) is None
    assert fit_oscillation(T[:5], {"r": np.sin(T[:5])}) is None
    # less than a period in the stretch
    short = slice(0, 60)
    found = fit_oscillation(T[short], {"r": wave(8.0, 0.0)[short]})
    assert found is None or found.cycles < 1.0
