"""Output error with a model in Python: the same answer as linear output error's closed case."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.identify.flown.python_model import FunctionManeuver, identify_output_error_function

TRUTH = {"a": -1.5, "b": 4.0}


def f(t, x, u, p):
    return [x[1], p["a"] * x[1] - 9.0 * np.sin(x[0]) + p["b"] * u[0]]


def one_at_a_time(t, x, u, p):
    """The same, but of numbers only."""
    if float(x[0]) > 100.0:
        return [0.0, 0.0]
    return f(t, x, u, p)


def g(t, x, u, p):
    return [x[0], x[1]]


@cache
def swing() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, torque and motion of a driven pendulum, in steps of a tenth of the record's."""
    t = np.arange(0.0, 8.0, 0.02)
    u = np.sin(2.0 * t)[:, None]
    x, out = np.array([0.3, 0.0]), []
    for k in range(len(t)):
        out.append(x.copy())
        for part in range(10):
            h = 0.002
            at = [u[k] + (u[min(k + 1, len(t) - 1)] - u[k]) * (part + s) / 10 for s in (0, 0.5, 1)]
            k1 = np.array(f(0, x, at[0], TRUTH))
            k2 = np.array(f(0, x + 0.5 * h * k1, at[1], TRUTH))
            k3 = np.array(f(0, x + 0.5 * h * k2, at[1], TRUTH))
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + np.array(f(0, x + h * k3, at[2], TRUTH)))
    return t, u, np.array(out)


def pendulum(seed: int | None, samples: int = 400) -> FunctionManeuver:
    """Its record, noisy where a seed is given."""
    t, u, z = (column[:samples] for column in swing())
    if seed is not None:
        z = z + np.random.default_rng(seed).normal(0.0, 0.01, z.shape)
    return FunctionManeuver("one", t, u, z, np.array([0.3, 0.0]))


@pytest.mark.parametrize("call", [f, one_at_a_time])
def test_truth_comes_back(call) -> None:
    samples = 150 if call is one_at_a_time else 400  # each of them costs some hundred calls
    result = identify_output_error_function(
        call,
        g,
        [pendulum(None, samples)],
        {"a": -1.0, "b": 3.0},
        states=("x", "v"),
        outputs=("x", "v"),
    )
    for name, value in TRUTH.items():
        # RK4 at 0.02 s against a tenth of it: 1e-8 of the motion
        assert result[name].value == pytest.approx(value, rel=1e-5)
    said = [m for m in result.messages if m.code == "finite_differences"]
    assert len(said) == 1
    assert ("one point at a time" in said[0].found) == (call is one_at_a_time)


def test_noise_gives_errors_that_hold() -> None:
    result = identify_output_error_function(
        f, g, [pendulum(3)], {"a": -1.0, "b": 3.0}, states=("x", "v"), outputs=("x", "v")
    )
    for name, value in TRUTH.items():
        assert abs(result[name].value - value) < 4.0 * result[name].se


def test_wrong_sizes_are_refused() -> None:
    with pytest.raises(BadInput, match="returns a rate for each state"):
        identify_output_error_function(
            g, lambda t, x, u, p: [x[0]], [pendulum(None)], {"a": 1.0},
            states=("x", "v"), outputs=("x", "v"),
        )  # fmt: skip
