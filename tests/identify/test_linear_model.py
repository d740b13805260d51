"""Linear models from text, and their exact sampling."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_lyapunov

from alula.base.messages import BadInput
from alula.identify.linear.model import (
    linear_model,
    process_covariance,
    sample,
    sample_derivatives,
)

LATERAL = {
    "p": "Lp*p + Lr*r + Lda*da - 0.5*Ldr*dr + L0",
    "r": "Np*p + Nr*r + Ldr*dr/4 - 2*dr + 0.25",
}


def model():
    return linear_model(LATERAL, ["p", "rdot"], ["da", "dr"])


def test_rows_become_matrices():
    found = model()
    assert found.parameters == ("Lp", "Lr", "Lda", "Ldr", "L0", "Np", "Nr")
    value = np.array([-5.0, 1.5, -16.0, 0.4, 0.1, -0.6, -0.7])
    m = found.at(value)
    np.testing.assert_allclose(m.A, [[-5.0, 1.5], [-0.6, -0.7]])
    # a parameter shared by two rows, with its factor in each; numbers; constants in the last column
    np.testing.assert_allclose(m.B, [[-16.0, -0.2, 0.1], [0.0, 0.1 - 2.0, 0.25]])
    np.testing.assert_allclose(m.C, [[1.0, 0.0], [-0.6, -0.7]])
    np.testing.assert_allclose(m.D, [[0.0, 0.0, 0.0], [0.0, 0.1 - 2.0, 0.25]])
    assert found.belongs["Ldr"] == "pdot"


@pytest.mark.parametrize(
    ("row", "what"),
    [
        ("Lp*p*r", "one state"),
        ("Lp*Lr*p", "one parameter"),
        ("Lp*p +", "a number"),
        ("Lp p", "'+'"),
        ("p/Lp", "number behind"),
        ("p/0", "zero"),
        ("", "characters"),
        ("__import__('os')", "'+'"),
    ],
)
def test_what_is_not_linear_is_refused(row, what):
    with pytest.raises(BadInput, match=re.escape(what)):
        linear_model({"p": row, "r": "Nr*r"}, ["p"], ["da"])


def test_names_must_be_distinct_and_outputs_known():
    with pytest.raises(BadInput, match="no states"):
        linear_model({"p": "Lp*p"}, ["p"], ["p"])
    with pytest.raises(BadInput, match="a formula"):
        linear_model({"p": "Lp*p"}, ["ay"], ["da"])


def test_sampling_agrees_with_an_integrator():
    """Against SciPy's integrator at 1e-11, for inputs that run straight over the step."""
    m = model().at(np.array([-5.0, 1.5, -16.0, 0.4, 0.1, -0.6, -0.7]))
    dt, x0 = 0.05, np.array([0.1, -0.2])
    w0, w1 = np.array([0.02, -0.1, 1.0]), np.array([0.05, 0.03, 1.0])
    right = solve_ivp(
        lambda t, x: m.A @ x + m.B @ (w0 + (w1 - w0) * t / dt), (0, dt), x0, rtol=1e-11, atol=1e-13
    ).y[:, -1]
    s = sample(m, dt)
    np.testing.assert_allclose(s.phi @ x0 + s.now @ w0 + s.next @ w1, right, atol=1e-11)
    held = solve_ivp(lambda t, x: m.A @ x + m.B @ w0, (0, dt), x0, rtol=1e-11, atol=1e-13).y[:, -1]
    z = sample(m, dt, "zero")
    np.testing.assert_allclose(z.phi @ x0 + z.now @ w0 + z.next @ w1, held, atol=1e-11)


@pytest.mark.parametrize("hold", ["linear", "zero"])
def test_derivatives_agree_with_central_differences(hold):
    found, value, h = model(), np.array([-5.0, 1.5, -16.0, 0.4, 0.1, -0.6, -0.7]), 1e-5
    exact = sample_derivatives(found.at(value), found.slopes, 0.05, hold)
    for j in range(len(value)):
        step = np.eye(len(value))[j] * h
        up, down = (sample(found.at(value + s * step), 0.05, hold) for s in (1, -1))
        for name in ("phi", "now", "next"):
            rough = (getattr(up, name) - getattr(down, name)) / (2.0 * h)
            # rounding of a difference of numbers near 1 over 2e-5
            np.testing.assert_allclose(getattr(exact, name)[j], rough, atol=1e-10)


def test_process_noise_settles_at_the_lyapunov_solution():
    """Step by step the covariance tends to that of the continuous equation A P + P A' + Q = 0."""
    A, Q = np.array([[-5.8, 1.8], [-0.7, -0.7]]), np.diag([0.05, 0.02])
    phi = sample(linear_model({"a": "0*a", "b": "0*b"}, ["a"], []).at(np.zeros(0)), 1.0).phi
    np.testing.assert_allclose(phi, np.eye(2))
    from scipy.linalg import expm

    step, P = process_covariance(A, Q, 0.05), np.zeros((2, 2))
    e = expm(A * 0.05)
    for _ in range(2000):
        P = e @ P @ e.T + step
    np.testing.assert_allclose(P, solve_continuous_lyapunov(A, -Q), rtol=1e-10)
