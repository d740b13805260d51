"""The algebra of error bars: narrow starts taken out, coloured innovations, inertial noise."""

import made
import numpy as np
import pytest

from alula.reconstruct.filter_colour import lift, white
from alula.reconstruct.input_noise import input_gain, scatter_by_inputs
from alula.reconstruct.tempering import Start, nearer, restored


def test_a_narrow_start_is_taken_out_exactly():
    """A linear estimate under two priors: the correction of one gives the other."""
    rng = np.random.default_rng(1)
    H, z = rng.standard_normal((12, 5)), rng.standard_normal(12)
    stated = Start(np.array([0.3, -1.0, 2.0]), np.array([2.0, 0.5, 9.0]))
    used = Start(np.array([0.5, -0.7, 1.0]), np.array([0.1, 0.5, 0.02]))

    def estimate(start):
        information = np.diag(np.concatenate([[1.0, 1.0], start.deviation**-2.0]))
        vector = np.concatenate([[0.0, 0.0], start.mean * start.deviation**-2.0]) + H.T @ z
        P = np.linalg.inv(H.T @ H + information)
        return P @ vector, P

    x, P = estimate(used)
    found, covariance = restored(x[None], P[None], 2, used, stated)
    right, expected = estimate(stated)
    np.testing.assert_allclose(found[0], right, rtol=1e-8)
    np.testing.assert_allclose(covariance[0], expected, rtol=1e-8)


def test_a_start_is_never_wider_than_stated():
    stated = Start(np.zeros(3), np.ones(3))
    near = nearer(stated, np.ones(3), np.array([1e-3, 50.0, 1e-3]), np.array([True, True, False]))
    assert near.deviation.tolist() == [pytest.approx(1e-4), 1.0, 1.0]
    assert near.mean.tolist() == [1.0, 1.0, 0.0]


@pytest.mark.parametrize(("correlation", "factor"), [(0.0, 1.0), (0.9, 19.0**0.5)])
def test_lift_of_a_mean_in_coloured_noise(correlation, factor):
    """A mean in noise of lag-one correlation rho: its variance is (1 + rho)/(1 - rho) times."""
    found = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        e, n = np.zeros(800), 800
        for k in range(n):
            shock = rng.standard_normal() * np.sqrt(1.0 - correlation**2)
            e[k] = correlation * e[k - 1] + shock if k else rng.standard_normal()
        assert white([e[:, None]]) == (correlation == 0.0)
        mean, se = e.mean(), n**-0.5

        def innovations(start, e=e):
            return [(e - start.mean[0])[:, None]]

        found.append(lift(innovations, np.array([mean]), np.array([se]), np.array([1e3]), [0])[0])
    # One periodogram near zero frequency: each scatters by a third; forty of them. Never below 1,
    # hence on white noise a little above.
    assert np.mean(found) == pytest.approx(factor, rel=0.25)
    assert min(found) >= 1.0


def test_input_gain_is_the_derivative_of_the_kinematics():
    truth = made.Motion(made.Recipe())
    t = np.array([1.0, 7.0])
    motion = np.column_stack([np.zeros(2), truth.velocity(t), truth.attitude(t)])
    G = input_gain(motion)

    def rates(k, m):
        _, u, v, w, phi, theta, _ = motion[k]
        ax, ay, az, p, q, r = m
        turn = (q * np.sin(phi) + r * np.cos(phi)) / np.cos(theta)
        return np.array(
            [0.0, ax + r * v - q * w, ay + p * w - r * u, az + q * u - p * v,
             p + turn * np.sin(theta), q * np.cos(phi) - r * np.sin(phi), turn]
        )  # fmt: skip

    for k in range(2):
        # Linear in the inputs, so the columns are the rates under unit inputs.
        np.testing.assert_allclose(G[k], np.array([rates(k, m) for m in np.eye(6)]).T, atol=1e-12)


def test_scatter_of_a_random_walk_is_that_of_theory():
    """A mean of N readings of an angle that sums up rate noise: variance dt^2 s^2 N/3."""
    n, dt, s = 2000, 0.02, 0.01
    t = np.arange(n) * dt
    motion = np.zeros((n, 7))
    by_start = np.broadcast_to(np.eye(7), (n, 7, 7))
    weighted = np.zeros((n, 1, 7))
    weighted[:, 0, 5] = 1.0 / n  # the pitch angle
    sigma = np.array([0.0, 0.0, 0.0, 0.0, s, 0.0])
    found = scatter_by_inputs(t, motion, by_start, weighted, sigma)[0, 0]
    assert found == pytest.approx(dt**2 * s**2 * n / 3.0, rel=1e-3)  # sum of squares: 1 + 1.5/n


def test_output_error_covers_the_inertial_noise():
    """Rate noise of 5e-4 rad/s adds up to a walk that residuals hardly show."""
    true = dict(zip([f"b_{n}" for n in made.IMU], made.BIAS.tolist(), strict=True))
    z = []
    for seed in range(8):
        result, _ = made.solve(made.Recipe(duration=20.0), seed=seed, filter="ml")
        z += [(v - true[n]) / se for n, (v, se) in made.constants(result).items() if n in true]
    # 48 values: rms 1 within 0.1 if independent; without the inertial noise it is 3.
    assert 0.6 < np.sqrt(np.mean(np.square(z))) < 1.5
