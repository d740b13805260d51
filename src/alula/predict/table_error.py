"""How far lookup tables lie from what they were made of, at random points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.model import AeroModel, evaluate_in_core
from alula.predict.strip_model import COEFFICIENTS, StripModel
from alula.predict.strip_tables import INCREMENTS, Grid

# Where an aircraft flies: what 'in flight' means, in rad, hats, wash.
FLIGHT: Mapping[str, tuple[float, float]] = {
    "alpha": (-0.14, 0.30),
    "beta": (-0.20, 0.20),
    "wash": (-0.1, 1.0),
    "de": (-0.20, 0.20),
    "da": (-0.20, 0.20),
    "dr": (-0.25, 0.25),
    "df": (0.0, 0.52),
    "phat": (-0.08, 0.08),
    "qhat": (-0.010, 0.010),
    "rhat": (-0.05, 0.05),
}


@dataclass(frozen=True)
class TableError:
    """Of each coefficient, over random points: root mean square and largest difference between
    tables and direct evaluation, and the coefficient's own root mean square there.
    """

    what: str
    points: int
    rms: Mapping[str, float]
    largest: Mapping[str, float]
    size: Mapping[str, float]

    @property
    def text(self) -> str:
        """One line: rms (largest) by coefficient."""
        parts = [f"{c} {self.rms[c]:.2g} ({self.largest[c]:.2g})" for c in COEFFICIENTS]
        return f"{self.what}, {self.points} points, rms (largest): " + ", ".join(parts)


def table_errors(
    strips: StripModel, tables: AeroModel, grid: Grid, *, points: int = 4000, seed: int = 1
) -> tuple[TableError, ...]:
    """Errors of the base table over its whole range, of the increments on their own axes, and of
    the whole sum with everything at random: where an aircraft flies (`FLIGHT`), and over all of
    the grid. The first two are interpolation; the last two are that and what the sum leaves out.
    """
    rng = np.random.default_rng(seed)
    full = {a: (float(grid[a][0]), float(grid[a][-1])) for a in grid.axes}
    out = [_error("base", strips, tables, _draw(rng, full, ("alpha", "beta", "wash"), points))]
    apart = []
    for variable, (angle, _) in INCREMENTS.items():
        apart.append(_draw(rng, full, (angle, variable, "wash"), points // len(INCREMENTS)))
    joined = {a: np.concatenate([_column(d, a) for d in apart]) for a in grid.axes}
    out.append(_error("one control or rate", strips, tables, joined))
    names = tuple(grid.axes)
    out.append(_error("all, in flight", strips, tables, _draw(rng, FLIGHT, names, points)))
    out.append(_error("all, whole range", strips, tables, _draw(rng, full, names, points)))
    return tuple(out)


def _draw(
    rng: np.random.Generator,
    ranges: Mapping[str, tuple[float, float]],
    names: tuple[str, ...],
    n: int,
) -> dict[str, Array]:
    return {name: rng.uniform(*ranges[name], n) for name in names}


def _column(drawn: Mapping[str, Array], name: str) -> Array:
    n = len(next(iter(drawn.values())))
    return drawn.get(name, np.zeros(n))


def _error(what: str, strips: StripModel, tables: AeroModel, at: Mapping[str, Array]) -> TableError:
    n = len(next(iter(at.values())))
    variables = {v: np.zeros(n) for v in FLIGHT} | dict(at)
    true = strips.evaluate(variables)
    made = evaluate_in_core(tables, variables)
    gap = {c: made[c] - true[c] for c in COEFFICIENTS}
    return TableError(
        what,
        n,
        {c: float(np.sqrt(np.mean(gap[c] ** 2))) for c in COEFFICIENTS},
        {c: float(np.max(np.abs(gap[c]))) for c in COEFFICIENTS},
        {c: float(np.sqrt(np.mean(true[c] ** 2))) for c in COEFFICIENTS},
    )
