"""The search for the maximum of a likelihood, on functions whose minimum is known."""

from __future__ import annotations

import numpy as np
import pytest

from alula.identify.likelihood.optimizer import Point, _within, minimize, with_prior


def rosenbrock(p, derivatives):
    """Least squares with a bent valley: residuals 10 (y - x^2) and 1 - x, minimum at (1, 1)."""
    v = np.array([10.0 * (p[1] - p[0] ** 2), 1.0 - p[0]])
    J = np.array([[-20.0 * p[0], 10.0], [-1.0, 0.0]])
    return Point(0.5 * v @ v, J.T @ v, J.T @ J) if derivatives else Point(0.5 * v @ v)


@pytest.mark.parametrize("algorithm", ["gauss_newton", "levenberg_marquardt"])
def test_bent_valley(algorithm):
    found = minimize(rosenbrock, np.array([-1.2, 1.0]), algorithm=algorithm, close=1e-8)
    assert found.converged, found.why
    np.testing.assert_allclose(found.value, 1.0, atol=1e-7)  # the stated step of 1e-8 errors
    assert all(b < a for a, b in zip(found.history, found.history[1:], strict=False))


def test_bound_holds_and_is_named():
    found = minimize(rosenbrock, np.array([0.0, 0.0]), upper=np.array([0.5, 5.0]), close=1e-8)
    assert found.converged
    assert found.at_bound == (True, False)
    # given x, the valley's floor is y = x^2
    np.testing.assert_allclose(found.value, [0.5, 0.25], atol=1e-7)


@pytest.mark.parametrize("algorithm", ["gauss_newton", "levenberg_marquardt"])
def test_longest_step_leaves_a_direction_that_lowers_the_cost(algorithm):
    """Two parameters that make up for each other, minimum at (100, -98), first moved 10 at most.

    Newton's step cut to (10, -98) goes uphill at any length: its slope is -29.8 + 98.
    """
    M, at = np.array([[1.0, 0.99], [0.99, 1.0]]), np.array([100.0, -98.0])

    def valley(p, derivatives):
        return Point(0.5 * (p - at) @ M @ (p - at), M @ (p - at), M)

    largest = np.array([10.0, np.inf])
    found = minimize(valley, np.zeros(2), algorithm=algorithm, largest=largest)
    assert found.converged, found.why
    assert found.iterations >= 10  # 100 in steps of 10
    np.testing.assert_allclose(found.value, at, atol=1e-3)  # 1e-4 of the error, 7


@pytest.mark.parametrize("damping", [0.0, 1e-3, 1.0])
def test_step_within_limits_lowers_the_predicted_cost(damping):
    """Random information and limits, some of them zero: never beyond a limit, never uphill."""
    rng = np.random.default_rng(1)
    none = np.zeros(6, dtype=bool)
    for _ in range(300):
        J = rng.standard_normal((8, 6)) @ np.diag(10.0 ** rng.uniform(-3, 3, 6))
        point = Point(0.0, J.T @ rng.standard_normal(8), J.T @ J)
        least, most = -(10.0 ** rng.uniform(-3, 1, 6)), 10.0 ** rng.uniform(-3, 1, 6)
        i = int(rng.integers(6))  # at a bound, the gradient pointing away from it
        least[i], most[i] = (least[i], 0.0) if point.gradient[i] > 0.0 else (0.0, most[i])
        step = _within(point, none, least, most, damping)
        assert (step >= least).all()
        assert (step <= most).all()
        assert point.gradient @ step + 0.5 * step @ point.information @ step < 0.0


def test_prior_is_the_weighted_mean():
    """Data say 3 with variance 1, the prior 0 with variance 4: together 2.4 (closed form)."""

    def data(p, derivatives):
        return Point(0.5 * (p[0] - 3.0) ** 2, p - 3.0, np.eye(1))

    found = minimize(with_prior(data, np.zeros(1), np.array([[0.25]])), np.zeros(1))
    assert found.value[0] == pytest.approx(2.4, rel=1e-12)
    assert found.information[0, 0] == pytest.approx(1.25)


def test_combination_without_information_is_not_moved():
    def sum_only(p, derivatives):
        v = p[0] + p[1] - 2.0
        return Point(0.5 * v * v, np.full(2, v), np.ones((2, 2)))

    found = minimize(sum_only, np.array([0.5, 0.0]))
    assert found.converged
    np.testing.assert_allclose(found.value, [1.25, 0.75], atol=1e-12)


def test_divergence_is_survived_by_halving_and_said_where_it_is_not():
    def edge(p, derivatives):
        """Minimum at 1, no model beyond 1.5, and a step that is too long by a factor of 4."""
        if p[0] > 1.5:
            return None
        return Point(0.5 * (p[0] - 1.0) ** 2, p - 1.0, np.full((1, 1), 0.25))

    found = minimize(edge, np.array([0.0]))
    assert found.converged
    assert found.value[0] == pytest.approx(1.0, abs=1e-3)
    lost = minimize(edge, np.array([2.0]))
    assert not lost.converged
    assert "diverges" in lost.why


def test_wrong_gradient_is_no_success():
    """A gradient of the wrong sign leads nowhere, and the result says so."""

    def liar(p, derivatives):
        return Point(0.5 * float(p @ p), -p, np.eye(1))

    found = minimize(liar, np.array([3.0]))
    assert not found.converged
    assert "no step" in found.why


def test_too_few_iterations_are_no_success():
    found = minimize(rosenbrock, np.array([-1.2, 1.0]), iterations=1)
    assert not found.converged
    assert "1 iterations" in found.why
