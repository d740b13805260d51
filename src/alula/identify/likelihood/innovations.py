"""The likelihood of a Kalman filter's innovations, and its derivatives.

With innovations v of covariance S, J = sum 1/2 (v' S^-1 v + ln det S) (Schweppe 1965; Maine and
Iliff 1981, natural formulation: process and measurement noise are parameters, so that S follows
from them and nothing has to be compensated when it changes). Information has the share of the
innovations and that of their covariance, dv' S^-1 dv + 1/2 tr(S^-1 dS S^-1 dS).

Derivatives by central differences: the filter runs once for the parameters and once for each of
them a thousandth of its standard error off to either side, all side by side.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.identify.likelihood.optimizer import Point
from alula.identify.likelihood.parameters import Whitened

Places = NDArray[np.intp]
STEP = 1e-3  # standard errors; the first time, when none are known, 1e-4 of the value
HUGE = 1e12


@dataclass(frozen=True)
class Innovations:
    """Of m parameter vectors: v (m, n, k), S (m, n or 1, k, k), predicted outputs y (m, n, k).

    Where nothing was measured, v is zero and S that of a measurement apart with variance 1.
    members: which of the vectors asked for these are, all by default; the others go as the first.
    """

    v: Array
    S: Array
    y: Array
    members: Places | None = None


# Parameters (m, free) -> innovations of every maneuver; None where the filter diverges.
Filter = Callable[[Array], Sequence[Innovations] | None]


class InnovationLikelihood:
    """The likelihood of a filter's innovations as a function of its parameters (free,)."""

    def __init__(self, run: Filter) -> None:
        self.run = run
        self.width: Array | None = None

    def __call__(self, p: Array, derivatives: bool) -> Point | None:
        """Cost, gradient and information at p."""
        if not derivatives:
            runs = self._run(p[None, :])
            return None if runs is None else Point(_cost(runs))
        h, runs = self._around(p)
        if runs is None:
            return None
        gradient, information = np.zeros(len(p)), np.zeros((len(p), len(p)))
        for r in runs:
            columns, blocks = _rows(r, h)
            for X, e in blocks:
                gradient[columns] -= X.T @ e
                information[np.ix_(columns, columns)] += X.T @ X
        diagonal = np.diag(information)
        known = np.where(diagonal > 0.0, diagonal, np.inf)
        self.width = np.where(diagonal > 0.0, 1.0 / np.sqrt(known), h / STEP)
        return Point(_cost(runs), gradient, information)

    def blocks(self, p: Array) -> list[Whitened]:
        """The likelihood at p as a regression, see `_rows`.

        Of each maneuver in turn, those of the whitened innovations (k outputs) first.
        """
        h, runs = self._around(p)
        out = []
        for r in runs or []:
            columns, blocks = _rows(r, h)
            for X, e in blocks:
                whole = np.zeros((len(e), len(p)))
                whole[:, columns] = X
                out.append(Whitened(whole, e))
        return out

    def _around(self, p: Array) -> tuple[Array, Sequence[Innovations] | None]:
        floor = 1e-9 * np.maximum(np.abs(p), 1e-3)
        h = 1e-4 * np.maximum(np.abs(p), 1e-2) if self.width is None else STEP * self.width
        h = np.clip(h, floor, 1e-2 * np.maximum(np.abs(p), 1.0))
        steps = np.diag(h)
        return h, self._run(np.vstack([p, p + steps, p - steps]))

    def _run(self, members: Array) -> Sequence[Innovations] | None:
        try:
            with np.errstate(all="ignore"):
                runs = self.run(members)
        except np.linalg.LinAlgError:  # a covariance has lost its rank: no filter here
            return None
        if runs is None:
            return None
        for r in runs:
            if not (np.isfinite(r.v).all() and np.isfinite(r.S).all() and np.abs(r.v).max() < HUGE):
                return None
        return runs


def whitened(v: Array, S: Array) -> Array:
    """L^-1 v (n, k) of innovations v (n, k) and their covariance S = L L' (n or 1, k, k)."""
    inverse = np.linalg.inv(np.linalg.cholesky(S))
    out: Array = np.einsum("nab,nb->na", np.broadcast_to(inverse, (*v.shape, v.shape[1])), v)
    return out


def _cost(runs: Sequence[Innovations]) -> float:
    total = 0.0
    for r in runs:
        sign, logarithm = np.linalg.slogdet(r.S[0])
        if (sign <= 0.0).any():
            return np.inf
        e = np.linalg.solve(r.S[0], r.v[0][:, :, None])[:, :, 0]
        total += 0.5 * float(np.sum(e * r.v[0]))
        total += 0.5 * float(np.sum(logarithm)) * len(r.v[0]) / len(logarithm)
    return total


def _rows(r: Innovations, h: Array) -> tuple[Places, list[tuple[Array, Array]]]:
    """The parameters that concern a maneuver, and blocks X (n, them), residual (n,) of it.

    The sum of X'X is the information and that of X'residual minus the gradient, exactly. With
    S = L L' and e = L^-1 v, the innovations give one block for each of e; their covariance gives
    one for each pair a <= b, e_a e_b minus its expectation over its standard deviation, with
    (L^-1 dS L^-T)_ab as regressor: mean 0, variance 1, white if the model is right.
    """
    n, k = r.v.shape[1:]
    place = np.zeros(2 * len(h) + 1, dtype=np.intp)
    place[... if r.members is None else r.members] = np.arange(len(r.v))
    up, down = place[1 : len(h) + 1], place[len(h) + 1 :]
    columns = np.flatnonzero((up > 0) | (down > 0))
    up, down, j, apart = up[columns], down[columns], len(columns), 2.0 * h[columns]
    inverse = np.linalg.inv(np.linalg.cholesky(r.S[0]))
    dv = (r.v[up] - r.v[down]) / apart[:, None, None]
    dS = (r.S[up] - r.S[down]) / apart[:, None, None, None]
    inverse_n = np.broadcast_to(inverse, (n, k, k))
    e = whitened(r.v[0], r.S[0])
    de = np.einsum("nab,jnb->naj", inverse_n, dv, optimize=True)
    turn = inverse @ dS @ np.swapaxes(inverse, -1, -2)  # (j, n or 1, k, k)
    out = [(-de[:, a], e[:, a]) for a in range(k)]
    for a in range(k):
        for b in range(a, k):
            column = np.broadcast_to(turn[:, :, a, b].T, (n, j))
            if a == b:
                out.append((column / 2**0.5, (e[:, a] ** 2 - 1.0) / 2**0.5))
            else:
                out.append((column, e[:, a] * e[:, b]))
    return columns, out
