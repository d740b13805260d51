"""A channel whose stamps are late is found out, with an error bar that holds."""

import made
import numpy as np
import pytest

from alula.flight import Maneuver
from alula.reconstruct.kalman import solve_filter
from alula.reconstruct.problem import make_problem
from alula.reconstruct.skew import time_skews


def skews(recipe, seed):
    flight, _ = made.record(recipe, seed)
    maneuver = Maneuver("m", "made", "", 0.0, recipe.duration)
    problem = make_problem(
        {"made": flight}, [maneuver], made.aircraft(recipe), made.spec(recipe.sensors)
    )
    return {s.channel: s for s in time_skews(problem, solve_filter(problem, "ekf"))}


@pytest.mark.parametrize(("channel", "delay"), [("alpha", 0.08), ("phi", 0.04), ("alpha", -0.08)])
def test_delay_of_one_channel_is_recovered(channel, delay):
    found = skews(made.Recipe(delay={channel: delay}), 1)[channel]
    # Beside noise: the reconstruction has followed the late channel a little.
    assert found.delay_s == pytest.approx(delay, abs=4.0 * found.se + 0.1 * abs(delay))
    assert found.significant


def test_without_a_delay_none_is_found():
    z = []
    for seed in range(6):
        z += [s.delay_s / s.se for s in skews(made.Recipe(duration=20.0), seed).values()]
    # Some fifty: rms 1 if the error bars are right, to 10 % if all were independent.
    assert np.sqrt(np.mean(np.square(z))) < 1.6
    assert np.mean(np.abs(z) > 3.0) < 0.06


def test_the_reconstruction_says_so():
    result, _ = made.solve(made.Recipe(delay={"alpha": 0.08}))
    said = [m for m in result.messages if m.code == "time_skew" and m.level == "warning"]
    assert "channel alpha" in [m.where for m in said]
    assert "delay_s" in said[0].do
