"""What structure selection works on and what it gives, whichever method selects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from alula.base.arrays import Array

Action = Literal["in", "out", "core"]
SAME = 1e-8  # squared length of what is left of a column, over its own: below it is not new


@dataclass(frozen=True)
class Pool:
    """Candidates beside a forced core, over several maneuvers, weighted.

    names: (m,) of the candidates. core: (n, c). candidates: (n, m). measured: (n,). All rows are
    multiplied by the square roots of the maneuvers' weights. ends: (maneuvers - 1,) where each but
    the last ends. free: number of the core's first columns that are constant terms.
    """

    names: tuple[str, ...]
    core: Array
    candidates: Array
    measured: Array
    ends: tuple[int, ...] = ()
    free: int = 0

    def split(self, rows: Array) -> list[Array]:
        """Rows (n, ...) by maneuver."""
        return np.split(rows, list(self.ends))

    def columns(self, chosen: Sequence[int]) -> Array:
        """(n, c + chosen) the core and the chosen candidates."""
        return np.hstack([self.core, self.candidates[:, list(chosen)]])


@dataclass(frozen=True)
class Step:
    """One term taken in or out. partial_f: its own, by the standard error that the method uses.

    press: prediction error sum of squares with leave-one-out. pse: predicted squared error. r2: of
    the model after the step, about what the constant terms explain.
    """

    action: Action
    term: str
    partial_f: float
    press: float
    pse: float
    r2: float


@dataclass(frozen=True)
class Structure:
    """Which candidates were chosen, in the order of the pool; how, and why it stopped."""

    method: str
    chosen: tuple[int, ...]
    steps: tuple[Step, ...]
    why: str


def orthonormal(columns: Array) -> Array:
    """(n, r) an orthonormal basis of the columns (n, k), whatever their sizes."""
    if columns.shape[1] == 0:
        return np.zeros((len(columns), 0))
    size = np.linalg.norm(columns, axis=0)
    left, singular, _ = np.linalg.svd(columns / np.where(size > 0.0, size, 1.0), False)
    out: Array = left[:, singular > SAME * max(singular[0], 1e-300)]
    return out


def without(basis: Array, columns: Array) -> Array:
    """What an orthonormal basis (n, r) leaves of columns (n, k); taken out twice, for rounding."""
    rest = columns - basis @ (basis.T @ columns)
    out: Array = rest - basis @ (basis.T @ rest)
    return out


def press(basis: Array, measured: Array) -> float:
    """Prediction error sum of squares: each sample predicted without itself (Allen, 1974).

    basis: (n, r) orthonormal columns of the model. The leave-one-out residual is v/(1 - h), h the
    diagonal of the projector. Infinite where a sample determines a parameter alone.
    """
    left = 1.0 - np.sum(basis**2, axis=1)
    if np.any(left < 1e-12):
        return np.inf
    return float(np.sum((without(basis, measured) / left) ** 2))


def about_constants(pool: Pool) -> tuple[float, int]:
    """Sum of squares (of measured) that constant terms leave, and how many of them there are.

    Without a constant term in the core about the mean.
    """
    fixed = pool.core[:, : pool.free]
    if pool.free == 0:
        fixed = np.ones((len(pool.measured), 1))
    basis = orthonormal(fixed)
    left = without(basis, pool.measured)
    return float(left @ left), basis.shape[1]


def r2_of(left: Array, total: float) -> float:
    """1 - residual over total sum of squares; NaN without variation."""
    return 1.0 - float(left @ left) / total if total > 0.0 else np.nan


def predicted_squared_error(left: Array, total: float, fixed: int, terms: int) -> float:
    """van den Hoek 2017, Eq. (35) and (36): mean square plus a penalty on every term.

    left: (n,) residual. total: sum of squares about `fixed` constant terms.
    """
    n = len(left)
    largest = total / (n - fixed)  # sigma_max squared, Eq. (36)
    return float(left @ left) / n + largest * terms / n


def step_at(
    pool: Pool, basis: Array, about: tuple[float, int], action: Action, term: str, f: float
) -> Step:
    """The step that led to the model of an orthonormal basis (n, r). about: `about_constants`."""
    total, fixed = about
    left = without(basis, pool.measured)
    error = predicted_squared_error(left, total, fixed, basis.shape[1])
    return Step(action, term, f, press(basis, pool.measured), error, r2_of(left, total))
