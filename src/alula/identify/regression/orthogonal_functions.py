"""Multivariate orthogonal functions (van den Hoek 2017, Eq. (32) to (36); Morelli, 1995).

Candidates are made orthogonal to the core and to one another, so that what each explains does not
depend on the others (Eq. (32) to (34)). At each stage the candidate that explains most comes next:
orthogonalized in a fixed order, a term's worth would depend on its place in the list. As many are
kept as make the predicted squared error least (Eq. (35)), the mean square of the fit plus
sigma_max^2/N a term, with sigma_max^2 the variance of the measured (Eq. (36)): an upper bound, so a
term has to explain at least an N-th of the whole variation. That is a rule for the size of an
effect, not for its significance. A term that later ones have made superfluous, so that the error is
less without it, goes out again. The functions are triangular in the physical terms, so the values
are carried back exactly.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.identify.regression.structure import (
    SAME,
    Pool,
    Step,
    Structure,
    about_constants,
    orthonormal,
    step_at,
    without,
)

MOST = 60  # orthogonal functions


def orthogonal_functions(pool: Pool, *, least_share: float = 0.0) -> Structure:
    """The candidates whose orthogonal functions give the least predicted squared error.

    least_share: of the variation about the constant terms that a term must explain to be kept.
    """
    about = about_constants(pool)
    total, _ = about
    core = orthonormal(pool.core)
    basis = core
    left = without(core, pool.measured)
    rest = without(core, pool.candidates)
    whole = np.sum(pool.candidates**2, axis=0)
    order: list[int] = []
    steps: list[Step] = [step_at(pool, basis, about, "core", "", np.nan)]
    shares: list[float] = []
    most = min(MOST, len(pool.measured) - core.shape[1] - 1)
    while len(order) < min(most, len(pool.names)):
        size = np.sum(rest**2, axis=0)
        fresh = size > SAME * np.where(whole > 0.0, whole, 1.0)
        fresh[order] = False
        if not fresh.any():
            break
        gain = np.where(fresh, (rest.T @ left) ** 2 / np.where(fresh, size, 1.0), -1.0)
        j = int(np.argmax(gain))
        p = rest[:, j] / np.sqrt(size[j])
        before = left
        left = left - p * float(p @ left)
        freedom = len(left) - basis.shape[1] - 1
        f = (float(before @ before) / max(float(left @ left), 1e-300) - 1.0) * freedom
        basis = np.column_stack([basis, p])
        rest = without(p[:, None], rest)
        order.append(j)
        shares.append(float(gain[j]) / total if total > 0.0 else 0.0)
        steps.append(step_at(pool, basis, about, "in", pool.names[j], f))
    errors = [s.pse for s in steps]
    best = int(np.argmin(errors))
    kept = [j for j, share in zip(order[:best], shares, strict=False) if share >= least_share]
    why = f"the predicted squared error is least with {best} of {len(order)} functions"
    if len(kept) < best:
        why += f", of which {best - len(kept)} explain less than {least_share:.2g}"
    steps = steps[: best + 1]
    while kept:
        fewer = [[i for i in kept if i != j] for j in kept]
        tried = [
            step_at(pool, orthonormal(pool.columns(f)), about, "out", pool.names[j], np.nan)
            for f, j in zip(fewer, kept, strict=True)
        ]
        i = int(np.argmin([s.pse for s in tried]))
        if tried[i].pse >= steps[-1].pse:
            break
        steps.append(tried[i])
        why += f"; {pool.names[kept[i]]} became superfluous"
        kept = fewer[i]
    return Structure("orthogonal functions", tuple(sorted(kept)), tuple(steps), why)


def gram_schmidt(columns: Array) -> tuple[Array, Array]:
    """Orthogonal functions P (n, k) of columns X (n, k), and G (k, k) with X = P G.

    van den Hoek 2017, Eq. (32), (33): G is upper triangular with a diagonal of 1. Each column is
    made orthogonal twice, which leaves rounding only.
    """
    p = np.array(columns, dtype=float)
    g = np.eye(p.shape[1])
    for j in range(p.shape[1]):
        for _ in range(2):
            for k in range(j):
                share = float(p[:, k] @ p[:, j]) / float(p[:, k] @ p[:, k])
                p[:, j] -= share * p[:, k]
                g[k, j] += share
    return p, g


def physical_values(columns: Array, measured: Array) -> Array:
    """(k,) values of the physical terms, carried back from those of their orthogonal functions."""
    p, g = gram_schmidt(columns)
    along = (p.T @ measured) / np.sum(p**2, axis=0)
    out: Array = np.linalg.solve(g, along)
    return out
