"""Principal-components regression (van den Hoek 2017, section 4; Massy, 1965).

The regressors, constant terms taken out and scaled to unit length, are turned to their principal
axes, and those along which they hardly vary are left out. What such a component would have added to
the collinear parameters is the bias; what its noise would have added is saved.

Left out are components whose condition index s_max/s is over 30 (Belsley, Kuh and Welsch,
Regression Diagnostics, 1980, section 3.2: 30 to 100 tells of moderate to strong dependencies), or
all beyond a given number.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.regression.regress import Regression, solve_again
from alula.identify.regression.shrinkage import Flags, Shrunk, components

CONDITION = 30.0


@dataclass(frozen=True)
class FirstComponents:
    """1 for the first `count` components, 0 for the others."""

    count: int

    def __call__(self, singular: Array) -> Array:
        """Factors (m,) of singular values (m,), which come largest first."""
        out: Array = (np.arange(len(singular)) < self.count).astype(float)
        return out


def principal_components(
    ordinary: Regression, free: Flags, count: int | None = None, condition: float = CONDITION
) -> tuple[Regression, int, Array]:
    """The principal-components estimate, how many components it keeps, and their condition indices.

    ordinary: the unbiased fit of the same model. free: (p,) flags of the columns that stay as they
    are. count: of components to keep; None keeps those with a condition index up to `condition`.
    Raises BadInput where count is not from 1 to the number of components.
    """
    root = np.repeat(np.sqrt(ordinary.weights), [len(b.measured) for b in ordinary.blocks])
    rows = np.vstack([b.regressors for b in ordinary.blocks]) * root[:, None]
    singular = components(rows, free).singular
    index = singular.max(initial=1.0) / singular
    kept = int(np.sum(index <= condition)) if count is None else count
    if len(index) and not 1 <= kept <= int(np.sum(~free)):
        raise refuse(
            "bad_option",
            where="components",
            expected=f"a whole number from 1 to {int(np.sum(~free))}",
            found=str(kept),
            do="State how many principal components to keep, or leave it out.",
        )
    return solve_again(ordinary, Shrunk(free, FirstComponents(kept))), kept, index
