"""Stepwise regression with a forced core (Klein, Batterson and Murphy, NASA TP-1916, 1981).

One candidate after another is taken in, the one with the largest partial correlation first; after
each, those that have become superfluous go out again, but never one of the core. A candidate comes
in where its partial F is significant and PRESS falls, and goes out where its F no longer is.

Significance is at 5 % for the whole pool: each of m candidates is tested at 5 %/m (Bonferroni),
leaving at twice that. F is the square of the coefficient over its standard error, as if residuals
were white. In flight data they are not, and slow terms come in by that measure: so a last pass
(`colour`) takes out those that are not significant by the standard error of coloured residuals. It
comes last, because before that the residual is coloured by the very terms that are still missing.
"""

from __future__ import annotations

import numpy as np
from scipy.special import fdtrc

from alula.base.arrays import Array
from alula.base.coloured import coloured_covariance
from alula.identify.regression.structure import (
    SAME,
    Action,
    Pool,
    Step,
    Structure,
    about_constants,
    orthonormal,
    step_at,
    without,
)

LEVEL = 0.05
LEAVE = 2.0  # times the level of coming in, so that a term does not come and go


def stepwise(pool: Pool, *, level: float = LEVEL, colour: bool = True) -> Structure:
    """The candidates that stepwise regression chooses.

    level: of false terms over the whole pool. colour: the last pass by coloured standard errors.
    """
    tested = level / max(len(pool.names), 1)
    chosen: list[int] = []
    barred: set[int] = set()  # went out: do not come in again, so that the search ends
    about = about_constants(pool)

    def step(members: list[int], action: Action, term: str, f: float) -> Step:
        return step_at(pool, orthonormal(pool.columns(members)), about, action, term, f)

    steps = [step(chosen, "core", "", np.nan)]

    def take_out(threshold: float, coloured: bool) -> None:
        while (leaving := _worst(pool, chosen, threshold, coloured)) is not None:
            i, f = leaving
            chosen.remove(i)
            barred.add(i)
            steps.append(step(chosen, "out", pool.names[i], f))

    while True:
        entering = _best(pool, chosen, barred, tested)
        if entering is None:
            why = f"no other candidate has a significant partial F (level {level:g} for all)"
            break
        j, f = entering
        next_step = step([*chosen, j], "in", pool.names[j], f)
        if next_step.press >= steps[-1].press:
            why = f"PRESS no longer falls with the best candidate, {pool.names[j]}"
            break
        chosen.append(j)
        steps.append(next_step)
        take_out(LEAVE * tested, False)
    if colour:
        before = len(chosen)
        take_out(tested, True)
        if len(chosen) < before:
            why += f"; {before - len(chosen)} went out again by coloured standard errors"
    return Structure("stepwise", tuple(sorted(chosen)), tuple(steps), why)


def partial_f(pool: Pool, basis: Array, column: Array, colour: bool) -> tuple[float, float]:
    """Partial F of a column (n,) beside a model (orthonormal basis (n, r)), and its p-value.

    (0, 1) where the model contains the column already.
    """
    new = without(basis, column)
    size = float(new @ new)
    if size <= SAME * float(column @ column):
        return 0.0, 1.0
    value = float(new @ pool.measured) / size
    left = without(basis, pool.measured) - value * new
    freedom = len(left) - basis.shape[1] - 1
    if freedom < 1:
        return 0.0, 1.0
    variance = float(left @ left) / freedom / size
    if colour:
        blocks = [(x[:, None], v) for x, v in zip(pool.split(new), pool.split(left), strict=True)]
        found = coloured_covariance(blocks, np.array([[1.0 / size]]))
        variance, freedom = float(found.corrected[0, 0]), float(found.dof[0])
    if variance <= 0.0:
        return np.inf, 0.0
    f = value**2 / variance
    return f, float(fdtrc(1, freedom, f))


def _best(
    pool: Pool, chosen: list[int], barred: set[int], level: float
) -> tuple[int, float] | None:
    """The candidate of the largest partial correlation, where it is significant, and its F."""
    basis = orthonormal(pool.columns(chosen))
    new = without(basis, pool.candidates)
    size = np.sum(new**2, axis=0)
    fresh = size > SAME * np.sum(pool.candidates**2, axis=0)
    fresh[[*chosen, *barred]] = False
    if not fresh.any():
        return None
    gain = np.where(fresh, (new.T @ pool.measured) ** 2 / np.where(fresh, size, 1.0), -1.0)
    j = int(np.argmax(gain))
    f, p = partial_f(pool, basis, pool.candidates[:, j], False)
    return (j, f) if p < level else None


def _worst(pool: Pool, chosen: list[int], level: float, colour: bool) -> tuple[int, float] | None:
    """The least significant of the chosen, where it is not significant, and its F."""
    tests = []
    for i in chosen:
        rest = orthonormal(pool.columns([j for j in chosen if j != i]))
        f, p = partial_f(pool, rest, pool.candidates[:, i], colour)
        tests.append((p, -f, i))
    if not tests:
        return None
    p, f, i = max(tests)
    return (i, -f) if p > level else None
