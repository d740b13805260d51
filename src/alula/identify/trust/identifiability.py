"""Which combinations of parameters the data cannot resolve, and what they are tied to.

Three ways of being unresolved, tried in this order:

'collinear'  The regressors are dependent within rounding (a singular value of the column-scaled
             regressors under n*eps): a channel that stands still, two that are multiples.
'noise'      The regressors' only variation along a direction is noise of the sensors: more than
             half of its variance looks white from one sample to the next, and the coefficient
             does not respond to it. Its estimate would be attenuated below half in any case.
'uncertain'  The standard error along a direction is over ten times the typical magnitude of its
             derivatives, and the value along it is not significant.

Everything is in units that make parameters comparable: a parameter times its regressor's norm, or
over its typical magnitude.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.identify.regression.regress import Regression
from alula.identify.regression.regressor_noise import rough_part
from alula.identify.result import Tie

Reason = Literal["collinear", "noise", "uncertain"]

MEMBER_EXACT = 1e-6  # share of a null direction above which a parameter belongs to it
MEMBER_NOISE = 0.3  # the same where the direction itself is only estimated
MEMBER_UNCERTAIN = 0.1  # times ten typical magnitudes: the parameter is uncertain by its own size
WHITE_SHARE = 0.5
UNCERTAIN = 10.0
SIGNIFICANT = 3.0  # standard errors along a direction beyond which the data did respond
SMALLEST_TIE = 0.01


@dataclass(frozen=True)
class Unresolved:
    """Why a parameter is not identifiable; `name + sum of weight * tied` is what data determine."""

    reason: Reason
    tied_to: tuple[Tie, ...]


def unresolved(
    fit: Regression, covariance: Array, typical: Sequence[float | None]
) -> dict[str, Unresolved]:
    """The parameters that cannot be told, by name.

    covariance: (k, k) of the estimate, all sources. typical: (k,) order of magnitude or None.
    """
    found: dict[str, Unresolved] = {}
    solution = fit.solution
    _mark(found, "collinear", fit.names, solution.null, solution.scale, MEMBER_EXACT)
    free = [i for i, name in enumerate(fit.names) if name not in found]
    names = [fit.names[i] for i in free]
    if free:
        null, scale = _noise_directions(fit, covariance, free)
        _mark(found, "noise", names, null, scale, MEMBER_NOISE)
    known: dict[int, float] = {
        i: size
        for i, (name, size) in enumerate(zip(fit.names, typical, strict=True))
        if size is not None and name not in found
    }
    if known:
        null, scale = _uncertain_directions(solution.value, covariance, known)
        _mark(found, "uncertain", [fit.names[i] for i in known], null, scale, MEMBER_UNCERTAIN)
    return found


def variance_inflation(fit: Regression) -> Array:
    """(k,) variance of each parameter over what it were if its regressor stood alone: 1 or more.

    Alone but for the constants: what a regressor has in common with those that do not move within
    a maneuver (the intercept, shared or each maneuver's own) does not count. These stand alone.
    """
    moving = np.zeros(len(fit.names))  # sum of squares about each maneuver's mean
    full = np.zeros(len(fit.names))
    means, samples = [], []
    for weight, block in zip(fit.weights, fit.blocks, strict=True):
        mean = block.regressors.mean(axis=0)
        moving += weight * np.sum((block.regressors - mean) ** 2, axis=0)
        full += weight * np.sum(block.regressors**2, axis=0)
        means.append(mean)
        samples.append(weight * len(block.regressors))
    constant = moving <= 1e-20 * full
    level = np.sqrt(samples)[:, None] * np.array(means)
    common = level[:, constant]
    apart = level - common @ np.linalg.lstsq(common, level, rcond=None)[0]
    alone = np.where(constant, full, moving + np.sum(apart**2, axis=0))
    out: Array = np.diag(fit.solution.dispersion) * alone
    return out


def _noise_directions(fit: Regression, covariance: Array, free: list[int]) -> tuple[Array, Array]:
    """Directions of scaled parameters along which the regressors are white; their scale.

    Solves the symmetric eigenproblem noise * w = share * total * w with total whitened first. Small
    members of a direction are chance, and would bring a large parameter's significance with them.
    """
    centered, rough = [], []
    for weight, block in zip(fit.weights, fit.blocks, strict=True):
        x = np.sqrt(weight) * block.unsmoothed[:, free]
        centered.append(x - x.mean(axis=0))
        rough.append(rough_part(x))
    moving = np.vstack(centered)
    scale = np.linalg.norm(moving, axis=0)
    constant = scale <= 1e-10 * fit.solution.scale[free]
    scale[constant] = 1.0
    empty = np.zeros((len(free), 0)), scale
    if constant.all():
        return empty
    singular, right = np.linalg.svd((moving / scale)[:, ~constant], full_matrices=False)[1:]
    kept = singular > 1e-12 * singular[0]
    whitened = right[kept].T / singular[kept]
    noise = (np.vstack(rough) / scale)[:, ~constant] @ whitened
    _, share, axes = np.linalg.svd(noise, full_matrices=False)
    directions = []
    for w in (whitened @ axes[share**2 > WHITE_SHARE].T).T:
        step = np.zeros(len(free))
        step[~constant] = np.where(np.abs(w) < MEMBER_NOISE * np.max(np.abs(w)), 0.0, w)
        if not _significant(step, fit.solution.value[free], covariance, free, scale):
            directions.append(step)
    return _orthonormal(directions, len(free)), scale


def _significant(
    step: Array, value: Array, covariance: Array, free: list[int], scale: Array
) -> bool:
    """Whether the estimate along a direction (scaled) is well away from zero."""
    along = step / np.linalg.norm(step)
    part = covariance[np.ix_(free, free)] * np.outer(scale, scale)
    return bool(abs(along @ (value * scale)) > SIGNIFICANT * np.sqrt(along @ part @ along))


def _uncertain_directions(
    value: Array, covariance: Array, known: Mapping[int, float]
) -> tuple[Array, Array]:
    index = list(known)
    scale = 1.0 / np.array([known[i] for i in index])
    relative = covariance[np.ix_(index, index)] * np.outer(scale, scale)
    variances, axes = np.linalg.eigh(relative)
    directions = [
        axis
        for variance, axis in zip(variances, axes.T, strict=True)
        if variance > UNCERTAIN**2
        and abs(axis @ (value[index] * scale)) <= SIGNIFICANT * np.sqrt(variance)
    ]
    return _orthonormal(directions, len(index)), scale


def _orthonormal(directions: Sequence[Array], size: int) -> Array:
    if not directions:
        return np.zeros((size, 0))
    return np.linalg.qr(np.column_stack(directions))[0]


def _mark(
    found: dict[str, Unresolved],
    reason: Reason,
    names: Sequence[str],
    null: Array,
    scale: Array,
    least: float,
) -> None:
    """Add the members of the null space with the combination each is tied to.

    The part of a scaled parameter that is determined is its projection on the rest space; divided
    by its own share it reads `name + sum of weight * other`.
    """
    if null.shape[1] == 0:
        return
    share = np.linalg.norm(null, axis=1)
    for i in np.flatnonzero(share > least).tolist():
        determined = -null @ null[i]
        determined[i] += 1.0
        ties = []
        if determined[i] > max(MEMBER_EXACT, SMALLEST_TIE):
            relative = determined / determined[i]
            ties = [
                Tie(names[j], float(relative[j] * scale[j] / scale[i]))
                for j in np.argsort(-np.abs(relative)).tolist()
                if j != i and share[j] > least and abs(relative[j]) > SMALLEST_TIE
            ]
        found[names[i]] = Unresolved(reason, tuple(ties))
