"""Least squares of a calibration whose reference is a vector, or only a vector's length.

The calibrated vector is linear in the parameters, v_k = J_k p. Of its reference the length is known
well (gravity, the Earth's field, the angle of a turn) and the direction poorly (a position set by
hand) or not at all. So the residual is taken apart: along the vector, the length,

    r = (|v| - rho) / gain - bias,

and across it, two components of v on axes normal to the given direction. Each part has its own
variance, estimated along with the parameters (variance components; Foerstner 1979): a poor
direction then does not spoil the length, and no weight has to be guessed.

gain is |dv/da' v/|v|| over its mean: the residual is a distance in the sensor's own space, to first
order (Sampson 1982). Minimizing |v| - rho itself would shrink the matrix, since a shorter v has
shorter errors. bias is what noise of variance s2 in each axis adds to a length, s2 / rho.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from alula.base.arrays import Array
from alula.base.coloured import coloured_covariance

ROUNDS = 50  # of variance components
SETTLED = 1e-3  # relative change of a standard deviation, far below its own error
SINGULAR = 1e-8  # relative singular value of the Jacobian that is rounding, not information
INVOLVED = 0.1  # share of a parameter in a direction that the data do not determine
FLOOR = 1e-12  # of the reference length: standard deviation of noise-free data
LENGTHS = 12  # from which on the lengths' own variance can be told


@dataclass(frozen=True)
class VectorProblem:
    """jacobian: (n, 3, P), v = J p. length: (n,) of the reference; 0 where v is to vanish.

    direction: (n, 3) unit vectors, or None. to_raw: (3, 3, P), dv/da as a matrix linear in p.
    typical: (P,) a size of each parameter that matters. ordered: samples follow one another in
    time, so that their errors may be correlated.
    """

    jacobian: Array
    length: Array
    direction: Array | None
    to_raw: Array
    typical: Array
    ordered: bool = False


@dataclass(frozen=True)
class VectorFit:
    """values, covariance: (P,), (P, P); infinite variance where the data determine nothing.

    along, across: standard deviations of the two parts of the residual, across NaN without
    directions. residual: (n,) of the length. dof: of the residual. weakest: (P,) the combination of
    parameters (in typical sizes) that the data tell least. common: both parts share one variance.
    """

    values: Array
    covariance: Array
    along: float
    across: float
    residual: Array
    dof: float
    weakest: Array
    common: bool
    converged: bool


def fit_vectors(problem: VectorProblem, start: Array) -> VectorFit:
    """Maximum likelihood of the parameters and of the parts' standard deviations.

    start: (P,). Lengths alone need more samples than parameters; the caller checks.
    """
    parts = _Parts(problem, start)
    # Fewer lengths than that: their variance cannot be told from the directions'.
    few = problem.direction is not None and int(parts.turned.sum()) < LENGTHS
    sigma, x = np.ones(3), start / problem.typical
    for _ in range(ROUNDS):
        found = least_squares(
            parts.residual, x, args=(sigma,), x_scale=1.0, xtol=1e-14, ftol=1e-14, gtol=1e-14
        )
        x = np.asarray(found.x)
        jacobian = np.asarray(found.jac) * sigma[parts.group][:, None]  # no longer whitened
        leverage = _leverage(found.jac)
        before, sigma = sigma, parts.deviations(x, leverage, few)
        if np.all(np.abs(sigma - before) <= SETTLED * sigma):
            break
    whitened = jacobian / sigma[parts.group][:, None]
    scaled, weakest = _covariance(whitened)
    if problem.ordered and problem.direction is None and np.all(np.isfinite(scaled)):
        scaled = coloured_covariance([(whitened, parts.residual(x, sigma))], scaled).corrected
    return VectorFit(
        values=x * problem.typical,
        covariance=scaled * np.outer(problem.typical, problem.typical),
        along=float(sigma[0]),
        across=float(sigma[1]) if problem.direction is not None else float("nan"),
        residual=parts.residual(x, np.ones(3))[parts.group == 0],
        dof=max(_free(parts.group == 1 if few else parts.group >= 0, leverage), 0.0),
        weakest=weakest,
        common=few,
        converged=bool(found.success),
    )


class _Parts:
    """Residuals by group: 0 along, 1 across, 2 all three components where v is to vanish."""

    def __init__(self, problem: VectorProblem, start: Array) -> None:
        self.typical = problem.typical
        self.turned = problem.length > 0.0
        self.length = problem.length[self.turned]
        self.jacobian = problem.jacobian[self.turned]
        self.still = problem.jacobian[~self.turned]
        self.to_raw = problem.to_raw
        n = len(self.length)
        across = 0 if problem.direction is None else 2 * n
        self.group = np.repeat([0, 1, 2], [n, across, 3 * len(self.still)])
        self.sides = None if problem.direction is None else _sides(problem.direction[self.turned])
        self.scale = float(np.mean(self.length)) if n else 1.0
        v = self.jacobian @ start
        self.gain = float(np.mean(self._gains(start, v))) if n else 1.0
        self.bias = np.zeros(n)
        self.ordered = problem.ordered

    def _gains(self, p: Array, v: Array) -> Array:
        size = np.maximum(np.linalg.norm(v, axis=1), FLOOR * self.scale)
        out: Array = np.linalg.norm((v / size[:, None]) @ (self.to_raw @ p), axis=1)
        return np.maximum(out, 1e-300)

    def residual(self, x: Array, sigma: Array) -> Array:
        """All residuals over their group's standard deviation. x: in typical sizes."""
        p = x * self.typical
        v = self.jacobian @ p
        gain = self._gains(p, v) / self.gain
        out = [((np.linalg.norm(v, axis=1) - self.length) / gain - self.bias) / sigma[0]]
        if self.sides is not None:
            out.append(np.einsum("nij,nj->ni", self.sides, v).ravel() / sigma[1])
        out.append((self.still @ p).ravel() / sigma[2])
        return np.concatenate(out)

    def deviations(self, x: Array, leverage: Array, common: bool) -> Array:
        """Standard deviation of each group: squares over what the fit has left free of them."""
        squares = self.residual(x, np.ones(3)) ** 2
        least = (FLOOR * self.scale) ** 2
        variance = np.full(3, least)
        for k in range(3):
            mine = self.group == k
            free = _free(mine, leverage)
            if free > 1e-6:
                # A length errs less than a direction: of a common variance all squares are of it.
                of = squares if common else squares[mine]
                variance[k] = max(float(of.sum()) / free, least)
        if common:
            variance[:] = variance[1]
        if self.sides is None and len(self.length):
            noise = float(variance[0])
            if self.ordered:  # what stays from sample to sample is the place's, not the sensor's
                along = self.residual(x, np.ones(3))[self.group == 0]
                noise = min(noise, 0.5 * float(np.mean(np.diff(along) ** 2)))
            self.bias = noise / self.length
        out: Array = np.sqrt(variance)
        return out


def _free(rows: NDArray[np.bool_], leverage: Array) -> float:
    """Degrees of freedom that the fit leaves these residuals."""
    return float(rows.sum() - leverage[rows].sum())


def _sides(direction: Array) -> Array:
    """(n, 2, 3) two unit vectors normal to each direction and to one another."""
    least = np.argmin(np.abs(direction), axis=1)
    first = np.cross(direction, np.eye(3)[least])
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([first, np.cross(direction, first)], axis=1)


def _leverage(jacobian: Any) -> Array:
    """(M,) how much of each residual the fit takes away: the hat matrix's diagonal."""
    u, s, _ = np.linalg.svd(np.asarray(jacobian), full_matrices=False)
    out: Array = np.sum(u[:, s > SINGULAR * s[0]] ** 2, axis=1)
    return out


def _covariance(whitened: Array) -> tuple[Array, Array]:
    """(P, P) covariance in typical sizes, infinite where nothing is told; the weakest direction."""
    _, s, vt = np.linalg.svd(whitened, full_matrices=False)
    told = s > SINGULAR * s[0]
    covariance: Array = (vt[told].T / s[told] ** 2) @ vt[told]
    lost = np.any(np.abs(vt[~told]) > INVOLVED, axis=0)
    covariance[lost, :] = covariance[:, lost] = np.nan
    covariance[lost, lost] = np.inf
    return covariance, vt[-1]
