"""Is the linear model enough? (the second question of Dittrich 2016.)

Every square and product of the variables that enter the model linearly is tried beside it, each
alone, by its partial F with coloured standard errors; p-values by Holm's method (Scand. J. Stat. 6,
1979), so that the chance of any false alarm is the level. Significance is one thing, size another:
`gain` is what all of them together would add to R2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from alula.identify.regression.stepwise import partial_f
from alula.identify.regression.structure import Pool, about_constants, orthonormal, r2_of, without
from alula.model.terms import Factor, Term, product

LEVEL = 0.05
SMALL = 0.01  # of R2: what second-order terms add together, below which linear is enough in size


@dataclass(frozen=True)
class Curvature:
    """One term of second order beside the linear model. p: Holm's, for all that were tried."""

    term: str
    partial_f: float
    p: float


@dataclass(frozen=True)
class Linearity:
    """tried: by p, smallest first. gain: of R2 by all of them."""

    tried: tuple[Curvature, ...]
    gain: float

    @property
    def linear(self) -> bool:
        """Whether no term of second order is significant, at 5 % for all."""
        return all(c.p > LEVEL for c in self.tried)

    @property
    def enough(self) -> bool:
        """Whether the linear model will do: nothing significant, or nothing of size."""
        return self.linear or self.gain < SMALL

    @property
    def words(self) -> str:
        """The answer in words."""
        if not self.tried:
            return "linearity not tested: no variable enters linearly"
        if self.linear:
            return f"linear is enough: of {len(self.tried)} second-order terms none is significant"
        names = ", ".join(c.term for c in self.tried if c.p <= LEVEL)
        if self.enough:
            return f"linear is enough in size (R2 +{self.gain:.1g}), though significant: {names}"
        return (
            f"linear is not enough: significant {names}; all second-order terms R2 +{self.gain:.2g}"
        )


def second_order(terms: Sequence[Term]) -> tuple[Term, ...]:
    """Squares and products of the variables that have a linear term, less those there already."""
    linear = [
        t.factors[0].variable
        for t in terms
        if len(t.factors) == 1 and t.factors[0] == Factor(t.factors[0].variable)
    ]
    there = {t.factors for t in terms}
    every = [product([Factor(a), Factor(b)]) for a, b in combinations_with_replacement(linear, 2)]
    return tuple(t for t in every if t.factors not in there)


def linearity(pool: Pool) -> Linearity:
    """The answer for a model (the pool's core) and terms of second order (its candidates)."""
    if not pool.names:
        return Linearity((), 0.0)
    basis = orthonormal(pool.core)
    found = [partial_f(pool, basis, x, True) for x in pool.candidates.T]
    order = np.argsort([p for _, p in found]).tolist()
    tried, least = [], 0.0
    for rank, j in enumerate(order):
        least = max(least, min(1.0, (len(found) - rank) * found[j][1]))
        tried.append(Curvature(pool.names[j], found[j][0], least))
    total, _ = about_constants(pool)
    whole = orthonormal(np.hstack([pool.core, pool.candidates]))
    before = r2_of(without(basis, pool.measured), total)
    return Linearity(tuple(tried), r2_of(without(whole, pool.measured), total) - before)
