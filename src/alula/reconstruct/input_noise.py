"""What the noise of the inertial sensors does to estimates by open loop.

Output error takes the inertial readings as exact. Their noise adds up to a random walk of the
motion, which is no residual's own noise and hardly visible beside it, but moves the estimates. To
first order an estimate errs by sum_i w_i e_i, with e_i the error of the integrated readings; noise
n_k at sample k contributes sum_(i>k) w_i H_i Phi(i, k) G_k n_k dt, and the samples are independent.
With M_k = dx_k/dx_0 of the same integration, H_i Phi(i, k) = (dy_i/dx_0) M_k^-1.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array


def input_gain(motion: Array) -> Array:
    """(n, states, 6): rates of the motion (n, states) by specific force and rates.

    van den Hoek 2017, Eq. (2), (3).
    """
    n, states = motion.shape
    u, v, w, phi, theta = (motion[:, i] for i in range(1, 6))
    G = np.zeros((n, states, 6))
    G[:, 1, 0] = G[:, 2, 1] = G[:, 3, 2] = G[:, 4, 3] = 1.0
    G[:, 1, 4], G[:, 1, 5] = -w, v
    G[:, 2, 3], G[:, 2, 5] = w, -u
    G[:, 3, 3], G[:, 3, 4] = -v, u
    sp, cp, ct = np.sin(phi), np.cos(phi), np.cos(theta)
    G[:, 4, 4], G[:, 4, 5] = sp * np.tan(theta), cp * np.tan(theta)
    G[:, 5, 4], G[:, 5, 5] = cp, -sp
    G[:, 6, 4], G[:, 6, 5] = sp / ct, cp / ct
    return G


def scatter_by_inputs(
    t: Array, motion: Array, by_start: Array, weighted: Array, sigma: Array
) -> Array:
    """(p, p) covariance of sum_i w_i e_i that noise of standard deviation sigma (6,) causes.

    t (n,) s; motion (n, m); by_start (n, m, m): dx_i/dx_0; weighted (n, p, m): w_i dy_i/dx_0,
    summed over the sensors. Zero where states were held at readings (by_start is singular there).
    """
    p = weighted.shape[1]
    after = np.cumsum(weighted[::-1], axis=0)[::-1] - weighted
    try:
        adjoint = np.linalg.solve(by_start.swapaxes(1, 2), after.swapaxes(1, 2)).swapaxes(1, 2)
    except np.linalg.LinAlgError:
        return np.zeros((p, p))
    dt = np.gradient(t)
    each = adjoint @ input_gain(motion) * (dt[:, None] * sigma)[:, None, :]
    total: Array = np.einsum("npi,nqi->pq", each, each)
    return total
