"""Structure selection on SIDPAC's example: the true terms and only those, with their values.

The truth is -x1 + 2 x2 + 3 x4 - 0.5; x3 has no effect. Beside the four columns themselves the
selection has to hold in pools of all their products up to second and third order, which nobody put
there and which are collinear with the true terms. Standard errors are those of coloured residuals.
"""

from __future__ import annotations

from itertools import combinations_with_replacement
from pathlib import Path

import numpy as np
from scipy.io import loadmat

from alula.base.arrays import Array
from alula.identify.regression.orthogonal_functions import orthogonal_functions, physical_values
from alula.identify.regression.regress import Block, regress
from alula.identify.regression.stepwise import stepwise
from alula.identify.regression.structure import Pool, Structure
from verification.places import DATA

TRUE = {"x1": -1.0, "x2": 2.0, "x4": 3.0}
CONSTANT = -0.5
METHODS = {"stepwise": stepwise, "orthogonal functions": orthogonal_functions}


def load(path: Path | None = None) -> tuple[Array, Array]:
    """The example's columns (500, 4) and measured (500,)."""
    m = loadmat(path or DATA / "regression" / "swr_example.mat", squeeze_me=True)
    return m["x"], m["z"]


def pool(x: Array, z: Array, order: int) -> Pool:
    """All products of the columns up to that order, beside a constant."""
    names, columns = [], []
    for k in range(1, order + 1):
        for chosen in combinations_with_replacement(range(x.shape[1]), k):
            names.append("*".join(f"x{i + 1}" for i in chosen))
            columns.append(np.prod(x[:, chosen], axis=1))
    return Pool(tuple(names), np.ones((len(z), 1)), np.column_stack(columns), z, (), 1)


def select(method: str, work: Pool) -> tuple[Structure, dict[str, tuple[float, float]]]:
    """The structure, and value and coloured standard error by term; the constant is '1'."""
    found = METHODS[method](work)
    names = ["1", *(work.names[j] for j in found.chosen)]
    fit = regress(names, [Block(work.columns(found.chosen), work.measured)])
    se = np.sqrt(np.diag(fit.coloured.covariance))
    value = fit.solution.value
    if method == "orthogonal functions":  # the values come back from the functions themselves
        value = physical_values(work.columns(found.chosen), work.measured)
    return found, dict(zip(names, zip(value.tolist(), se.tolist(), strict=True), strict=True))


def check(quick: bool = False) -> tuple[str, bool]:
    """What was chosen and the largest error in standard errors, by method and pool."""
    if not (DATA / "regression" / "swr_example.mat").exists():
        return "regression/swr_example.mat is not there (set ALULA_DATA)", False
    x, z = load()
    words, good = [], True
    for method in METHODS:
        for order in (1, 2, 3):
            work = pool(x, z, order)
            _, values = select(method, work)
            right = set(values) == {"1", *TRUE}
            worst = max(
                abs(value - {"1": CONSTANT, **TRUE}.get(name, 0.0)) / se
                for name, (value, se) in values.items()
            )
            good &= right and worst < 2.0
            words.append(
                f"{method} of {len(work.names)}: {', '.join(n for n in values if n != '1')}, "
                f"at most {worst:.2f} standard errors off"
            )
    return "; ".join(words), bool(good)
