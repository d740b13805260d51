"""The linear Kalman filter and its smoother against closed forms and dense least squares."""

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.reconstruct import LinearSystem, linear_filter

DT = 0.1


def constant_velocity(q=2.0, r=0.3):
    return LinearSystem(
        transition=np.array([[1.0, DT], [0.0, 1.0]]),
        gain=np.array([[0.5 * DT**2], [DT]]),
        process=np.array([[q]]),
        output=np.array([[1.0, 0.0]]),
        noise=np.array([[r]]),
    )


def test_constant_velocity_reaches_its_steady_gain():
    """Kalata 1984: alpha and beta by the tracking index."""
    q, r = 2.0, 0.3
    found = linear_filter(constant_velocity(q, r), np.zeros(2000), [0, 0], 10 * np.eye(2))
    index = DT**2 * np.sqrt(q / r)
    alpha = 1.0 - ((4.0 + index - np.sqrt(8.0 * index + index**2)) / 4.0) ** 2
    beta = 2.0 * (2.0 - alpha) - 4.0 * np.sqrt(1.0 - alpha)
    last = linear_filter(
        constant_velocity(q, r), np.zeros(2000), [0, 0], 10 * np.eye(2), smooth=False
    ).covariance[-1]
    # K = P C' R^-1; 2000 steps leave rounding only.
    assert last[:, 0] / r == pytest.approx([alpha, beta / DT], rel=1e-10)
    np.testing.assert_allclose(found.covariance[-1], last)


def test_random_walk_filtered_and_smoothed_variance():
    """The filter's by the scalar Riccati equation, the smoother's by Wiener's integral."""
    q, r = 0.04, 1.0
    system = LinearSystem(np.eye(1), np.eye(1), [[q]], [[r]])
    z = np.zeros(1001)
    filtered = linear_filter(system, z, [0.0], [[5.0]], smooth=False).covariance[-1, 0, 0]
    smoothed = linear_filter(system, z, [0.0], [[5.0]]).covariance[500, 0, 0]
    assert filtered == pytest.approx(0.5 * (-q + np.sqrt(q**2 + 4.0 * q * r)), rel=1e-10)
    assert smoothed == pytest.approx(r * np.sqrt(q / (q + 4.0 * r)), rel=1e-10)


def test_smoother_is_least_squares_over_the_whole_record():
    """Inputs, correlated noise, holes in the readings, three states: one dense problem."""
    rng = np.random.default_rng(4)
    n, m, steps = 3, 2, 12
    transition = np.array([[1.0, 0.2, 0.0], [-0.1, 0.9, 0.3], [0.0, 0.0, 0.8]])
    gamma = rng.standard_normal((n, 1))
    output = rng.standard_normal((m, n))
    half = rng.standard_normal((m, m))
    noise, process = half @ half.T + np.eye(m), np.diag([0.1, 0.3, 0.2])
    x0, P0 = np.array([1.0, -2.0, 0.5]), np.diag([2.0, 1.0, 4.0])
    z, u = rng.standard_normal((steps, m)), rng.standard_normal((steps, 1))
    z[3, 0] = z[7, 1] = np.nan
    z[5] = np.nan
    system = LinearSystem(transition, output, process, noise, input=gamma)
    found = linear_filter(system, z, x0, P0, u)

    information, right = np.zeros((n * steps, n * steps)), np.zeros(n * steps)

    def add(H, value, covariance):
        nonlocal information, right
        weight = H.T @ np.linalg.inv(covariance)
        information = information + weight @ H
        right = right + weight @ value

    def at(k, block):
        H = np.zeros((len(block), n * steps))
        H[:, n * k : n * k + n] = block
        return H

    add(at(0, np.eye(n)), x0, P0)
    for k in range(steps):
        there = np.isfinite(z[k])
        if there.any():
            add(at(k, output[there]), z[k, there], noise[np.ix_(there, there)])
        if k + 1 < steps:
            add(at(k + 1, np.eye(n)) - at(k, transition), gamma @ u[k], process)
    covariance = np.linalg.inv(information)
    np.testing.assert_allclose(found.x.ravel(), covariance @ right, rtol=0, atol=1e-10)
    for k in range(steps):
        block = covariance[n * k : n * k + n, n * k : n * k + n]
        np.testing.assert_allclose(found.covariance[k], block, rtol=0, atol=1e-10)
        np.testing.assert_allclose(found.se[k], np.sqrt(np.diagonal(block)), rtol=1e-9)
    assert found.nis[5] == 0.0
    assert np.isnan(found.innovation[5]).all()


def test_innovations_of_a_simulated_system_are_as_stated():
    rng = np.random.default_rng(9)
    system, steps = constant_velocity(), 4000
    x, z, truth = np.zeros(2), np.zeros(steps), np.zeros((steps, 2))
    for k in range(steps):
        truth[k] = x
        z[k] = x[0] + np.sqrt(0.3) * rng.standard_normal()
        x = system.transition @ x + system.gain[:, 0] * np.sqrt(2.0) * rng.standard_normal()
    found = linear_filter(system, z, [0.0, 0.0], np.eye(2))
    # The mean of 4000 squared normal numbers has a deviation of 0.022; four of them.
    assert np.mean(found.nis) == pytest.approx(1.0, abs=0.09)
    normalized = np.mean(((found.x - truth) / found.se) ** 2, axis=0)
    # Smoothing errors are correlated over a second or so: some 300 independent ones.
    np.testing.assert_allclose(normalized, 1.0, atol=0.3)


def test_what_is_known_exactly_stays_so():
    system = LinearSystem(np.eye(2), np.ones((1, 2)), np.zeros((2, 2)), [[1.0]])
    found = linear_filter(system, np.full(50, 3.0), [1.0, 0.0], np.diag([0.0, 1.0]))
    np.testing.assert_array_equal(found.x[:, 0], 1.0)
    # Mean of 50 readings of unit variance with a prior of the same.
    np.testing.assert_allclose(found.covariance[:, 1, 1], 1.0 / 51.0, rtol=1e-9)
    np.testing.assert_allclose(found.x[:, 1], 2.0 * 50.0 / 51.0, rtol=1e-9)


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"noise": [[0.0]]}, "noise"),
        ({"noise": [[1.0, 0.0]]}, "noise"),
        ({"process": [[-1.0]]}, "process"),
        ({"output": [[1.0, 0.0, 0.0]]}, "output"),
        ({"transition": [[1.0, np.nan], [0.0, 1.0]]}, "transition"),
        ({"gain": np.ones((2, 3))}, "process"),
    ],
)
def test_a_wrong_matrix_is_named(change, named):
    good = constant_velocity()
    parts = {n: getattr(good, n) for n in ("transition", "output", "process", "noise", "gain")}
    with pytest.raises(BadInput, match=named):
        LinearSystem(**{**parts, **change})


def test_wrong_records_are_refused():
    system = constant_velocity()
    for readings, x0, P0, u in (
        (np.zeros((5, 2)), [0, 0], np.eye(2), None),
        (np.zeros(0), [0, 0], np.eye(2), None),
        (np.full(5, np.inf), [0, 0], np.eye(2), None),
        (np.zeros(5), [0], np.eye(2), None),
        (np.zeros(5), [0, np.nan], np.eye(2), None),
        (np.zeros(5), [0, 0], -np.eye(2), None),
        (np.zeros(5), [0, 0], np.eye(2), np.zeros((5, 1))),
    ):
        with pytest.raises(BadInput, match="linear filter"):
            linear_filter(system, readings, x0, P0, u)
