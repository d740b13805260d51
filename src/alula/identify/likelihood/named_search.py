"""A search whose first values, bounds and priors are given by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from alula.base.arrays import Array
from alula.identify.likelihood.optimizer import Algorithm, Likelihood, Minimum, minimize, with_prior
from alula.identify.likelihood.parameters import Prior, Whitened

# (values by name, what the others are (k,)) -> (k,)
Vector = Callable[[Mapping[str, float], Array], Array]


def search_named(
    likelihood: Likelihood,
    first: Array,
    vector: Vector,
    bounds: Mapping[str, tuple[float, float]] | None,
    priors: Mapping[str, Prior] | None,
    algorithm: Algorithm,
) -> Minimum:
    """The minimum from the first values (k,), within the bounds and with the priors."""
    infinite = np.full(len(first), np.inf)
    low = vector({n: b[0] for n, b in (bounds or {}).items()}, -infinite)
    high = vector({n: b[1] for n, b in (bounds or {}).items()}, infinite)
    joint = with_priors(likelihood, vector, priors, len(first))
    return minimize(joint, first, algorithm=algorithm, lower=low, upper=high)


def with_priors(
    likelihood: Likelihood, vector: Vector, priors: Mapping[str, Prior] | None, k: int
) -> Likelihood:
    """The likelihood of k parameters together with the priors (Dittrich 2016, Eq. (3.11))."""
    if not priors:
        return likelihood
    mean = vector({n: p.mean for n, p in priors.items()}, np.zeros(k))
    weight = vector({n: 1.0 / p.se**2 for n, p in priors.items()}, np.zeros(k))
    return with_prior(likelihood, mean, np.diag(weight))


def prior_blocks(names: Sequence[str], value: Array, priors: Mapping[str, Prior]) -> list[Whitened]:
    """A prior is one more observation of the parameter, in units of its standard error."""
    out = []
    for i, name in enumerate(names):
        prior = priors.get(name, priors.get(name.split("[")[0]))
        if prior is not None:
            row = np.zeros((1, len(names)))
            row[0, i] = 1.0 / prior.se
            out.append(Whitened(row, np.array([(prior.mean - value[i]) / prior.se]), prior=True))
    return out
