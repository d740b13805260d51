"""Minimize a negative log-likelihood by modified Newton-Raphson or Levenberg-Marquardt.

The step is p <- p + M^-1 g with the Fisher information M in place of the second derivatives and
g = -dJ/dp (Dittrich 2016, Eq. (3.60), (3.61) with errata, (3.64)); Levenberg-Marquardt adds a
multiple of M's own diagonal (Eq. (3.65), scaled so that units do not matter: Marquardt 1963).
Steps are halved until the cost falls; where a bound or a longest step cuts a parameter short, the
others take the values best given that. Combinations without information are not moved. The
iteration ends by the Newton decrement: the predicted step in units of the estimate's standard
errors, which knows no units either.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array

Flags = NDArray[np.bool_]
Algorithm = Literal["gauss_newton", "levenberg_marquardt"]

CLOSE = 1e-4  # standard errors: predicted step at which the minimum is reached
HALVINGS = 12
DAMPING = 1e-3  # first of Levenberg-Marquardt (Dittrich 2016, after Eq. (3.65))
SMALLEST_DAMPING = 1e-12
ROUNDING = 1e-13  # of the scaled information's largest eigenvalue: below it there is none
FLAT = 1e-12  # relative change of the cost that rounding alone can make


@dataclass(frozen=True)
class Point:
    """Negative log-likelihood at one parameter vector.

    gradient: (k,) dJ/dp. information: (k, k) Fisher information. Both are empty where only the cost
    was asked for.
    """

    cost: float
    gradient: Array = field(default_factory=lambda: np.zeros(0))
    information: Array = field(default_factory=lambda: np.zeros((0, 0)))


# (parameters (k,), with derivatives) -> Point; None where the model diverges there.
Likelihood = Callable[[Array, bool], Point | None]


@dataclass(frozen=True)
class Minimum:
    """Where the search ended. why: in words. at_bound: (k,) parameters that a bound holds.

    information includes that of priors; history: cost after each iteration.
    """

    value: Array
    cost: float
    gradient: Array
    information: Array
    converged: bool
    why: str
    iterations: int
    at_bound: tuple[bool, ...]
    history: tuple[float, ...]


def with_prior(likelihood: Likelihood, mean: Array, information: Array) -> Likelihood:
    """The likelihood times a Gaussian prior (Dittrich 2016, Eq. (3.11)).

    mean: (k,). information: (k, k), inverse covariance; zero rows where nothing is known.
    """

    def joint(p: Array, derivatives: bool) -> Point | None:
        point = likelihood(p, derivatives)
        if point is None:
            return None
        pull = information @ (p - mean)
        cost = point.cost + 0.5 * float((p - mean) @ pull)
        if not derivatives:
            return Point(cost)
        return Point(cost, point.gradient + pull, point.information + information)

    return joint


def minimize(
    likelihood: Likelihood,
    start: Array,
    *,
    algorithm: Algorithm = "gauss_newton",
    lower: Array | None = None,
    upper: Array | None = None,
    largest: Array | None = None,
    iterations: int = 200,
    close: float = CLOSE,
) -> Minimum:
    """The parameters (k,) of least cost, from `start`, within `lower` and `upper` (k,).

    largest: (k,) longest step of each parameter in one iteration; infinite by default. close:
    predicted step, in standard errors, that counts as converged. Never raises for a search
    that fails: `converged` is False then and `why` says what happened.
    """
    low = np.full(len(start), -np.inf) if lower is None else lower
    high = np.full(len(start), np.inf) if upper is None else upper
    far = np.full(len(start), np.inf) if largest is None else largest
    p = np.clip(np.asarray(start, dtype=float), low, high)
    point = likelihood(p, True)
    if point is None or not _finite(point):
        k = len(p)
        none = Point(np.inf, np.zeros(k), np.zeros((k, k)))
        return _end(p, none, False, "the model diverges at its first values", 0, p < low, [])
    history = [point.cost]
    damping = DAMPING if algorithm == "levenberg_marquardt" else 0.0
    for i in range(iterations):
        held = ((p <= low) & (point.gradient > 0.0)) | ((p >= high) & (point.gradient < 0.0))
        plain = _step(point, held, 0.0)
        decrement = float(max(0.0, float(-point.gradient @ plain)) ** 0.5)
        if decrement < close:
            why = f"converged: the next step is {decrement:.1g} standard errors"
            return _end(p, point, True, why, i, held, history)
        found = None
        least, most = np.maximum(-far, low - p), np.minimum(far, high - p)
        step = _within(point, held, least, most, damping)
        for _ in range(HALVINGS):
            trial = np.clip(p + step, low, high)
            there = likelihood(trial, False)
            if there is not None and np.isfinite(there.cost) and there.cost < point.cost:
                found = trial
                damping = max(damping / 10.0, SMALLEST_DAMPING) if damping else 0.0
                break
            if damping:
                damping = max(10.0 * damping, DAMPING)
                step = _within(point, held, least, most, damping)
            else:
                step = 0.5 * step
        if found is None:
            flat = 0.5 * decrement**2 < FLAT * max(1.0, abs(point.cost)) or decrement < 0.01
            why = (
                f"converged: no step lowers the cost, the next one is {decrement:.1g} standard "
                "errors"
                if flat
                else f"stopped: no step along the search direction lowers the cost, though the "
                f"predicted one is {decrement:.2g} standard errors. Try other first values or the "
                "other algorithm"
            )
            return _end(p, point, flat, why, i, held, history)
        point = likelihood(found, True)
        p = found
        if point is None or not _finite(point):  # the cost was finite there, its derivatives not
            k = len(p)
            none = Point(history[-1], np.zeros(k), np.zeros((k, k)))
            return _end(p, none, False, "the sensitivities diverge", i + 1, p < low, history)
        history.append(point.cost)
    why = f"stopped after {iterations} iterations, still {decrement:.2g} standard errors a step"
    return _end(p, point, False, why, iterations, held, history)


def _within(point: Point, held: Flags, least: Array, most: Array, damping: float) -> Array:
    """The step (k,) as far as it may go: least <= step <= most (k,), with zero between them.

    A component that meets its limit stays there and the others go on to their minimum given that:
    the predicted cost falls all the way. If it were merely cut off, the others would make up for a
    movement that does not take place, and the cost may rise however short the step.
    """
    step = np.zeros(len(held))
    stays = held
    left = point.gradient
    while not stays.all():
        rest = _step(replace(point, gradient=left), stays, damping)
        limit = np.where(rest > 0.0, most, least)
        room = np.divide(limit - step, rest, out=np.full(len(rest), np.inf), where=rest != 0.0)
        share = float(room.min())
        if share >= 1.0:
            return step + rest
        step = np.where(room <= share, limit, step + share * rest)
        stays = stays | (room <= share)
        left = point.gradient + point.information @ step
        left += damping * point.information.diagonal() * step
    return step


def _step(point: Point, held: Flags, damping: float) -> Array:
    """Minus M^-1 times gradient, (k,), in the combinations that carry information."""
    if held.any():
        step = np.zeros(len(held))
        free = ~held
        if free.any():
            within = Point(0.0, point.gradient[free], point.information[np.ix_(free, free)])
            step[free] = _step(within, np.zeros(int(free.sum()), dtype=bool), damping)
        return step
    size = np.sqrt(point.information.diagonal())
    size[size == 0.0] = 1.0
    values, axes = np.linalg.eigh(point.information / (size[:, None] * size))
    along = (point.gradient / size) @ axes
    kept = values > ROUNDING * max(float(values[-1]), 0.0)
    along = np.divide(along, values + damping, out=np.zeros(len(along)), where=kept)
    out: Array = -(axes @ along) / size
    return out


def _finite(point: Point) -> bool:
    return bool(
        np.isfinite(point.cost)
        and np.isfinite(point.gradient).all()
        and np.isfinite(point.information).all()
    )


def _end(
    p: Array,
    point: Point,
    converged: bool,
    why: str,
    iterations: int,
    held: Flags,
    history: list[float],
) -> Minimum:
    return Minimum(
        value=p,
        cost=point.cost,
        gradient=point.gradient,
        information=point.information,
        converged=converged,
        why=why,
        iterations=iterations,
        at_bound=tuple(bool(h) for h in held),
        history=tuple(history),
    )
