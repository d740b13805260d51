"""The reconstruction's uncertainty carried into an estimate from readings.

A bias that reconstruction found one standard deviation off moves every reading of its sensor, and
the estimate by one Gauss-Newton step: for output error `(sum J' R^-1 J)^-1 sum J' R^-1 dz`. The
squares of these steps, over all independent directions of the reconstruction's uncertainty, are
added to the variances.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.identify.flown.core_maneuver import formula_model
from alula.identify.flown.fit import Covariance
from alula.identify.flown.good_enough import good_enough
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.output_likelihood import likelihood_of
from alula.identify.flown.problem import FlightProblem, Setting
from alula.identify.flown.saturation import without_saturated
from alula.identify.likelihood.parameters import Prior
from alula.identify.linear.noise_search import noise_verdict
from alula.identify.result import Identification, Parameter
from alula.identify.trust.verdict import verdict, weak_words
from alula.model import parse

Shifts = Mapping[str, Mapping[str, Array]]  # by maneuver and output: (n,)
_NORMAL = 1.96  # what is added counts as known
# How the parts of a status begin that tell how well parameters are known.
_RESOLVED = ("weak: ", "zero within their error: ", "every parameter is resolved")


def carried(
    result: Identification,
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    shifts: Sequence[Shifts],
    setting: Setting,
    *,
    noise: Mapping[str, float] | None = None,
    priors: Mapping[str, Prior] | None = None,
    scales: Mapping[str, float] | None = None,
    covariance: Covariance = "diagonal",
) -> Identification:
    """Output error's result with the shifts of the readings, one for each direction, in its error
    bars.

    A result in which some parameter has no value is returned as it is.
    """
    learn = [without_saturated(m)[0] for m in maneuvers if not m.maneuver.held_out]
    if not shifts or not has_values(result):
        return result
    theta = np.array([p.value for p in result.parameters])
    values = {t.name(c): 0.0 for c, formula in models.items() for t in parse(formula)}
    model = formula_model(models, {**values, **setting.fixed}, learn[0].reference)
    problem = FlightProblem(learn, model, setting)
    known = None if noise is None else np.array([noise[n] for n in setting.outputs]) ** 2
    likelihood = likelihood_of(problem, known, covariance == "full")
    at = likelihood(theta, True)
    if at is None:
        return result
    weights = likelihood.weights(theta)
    information = at.information + np.diag(
        [1.0 / priors[n].se ** 2 if priors and n in priors else 0.0 for n in problem.names]
    )
    score = np.zeros((len(theta), len(shifts)))
    for i, m in enumerate(learn):
        weighted = np.einsum("noi,op->npi", problem.flight(theta, i)[1], weights)
        counted = likelihood.counted(i)
        for o, name in enumerate(setting.outputs):
            heard = counted[:, o]
            for s, shift in enumerate(shifts):
                moved = shift.get(m.maneuver.id, {}).get(name)
                if moved is not None:
                    score[:, s] += weighted[heard, o].T @ moved[heard]
    step = np.linalg.pinv(information, hermitian=True) @ score
    return with_steps(result, step, {**good_enough(models, problem.names), **(scales or {})})


def has_values(result: Identification) -> bool:
    """Whether there are parameters and every one has a value."""
    values = [p.value for p in result.parameters]
    return bool(values) and bool(np.isfinite(values).all())


def with_steps(
    result: Identification,
    step: Array,
    enough: Mapping[str, float],
    logarithmic: Collection[str] = (),
) -> Identification:
    """The result with independent steps of its estimate (k, directions) in its error bars.

    enough: standard errors that are good enough, by name. logarithmic: noises, whose steps and
    intervals are those of their logarithms. A verdict can only get worse by it.
    """
    gain = [p.value if p.name in logarithmic else 1.0 for p in result.parameters]
    step = step * np.array(gain)[:, None]
    added = step @ step.T
    parameters = []
    for p, extra in zip(result.parameters, np.sqrt(np.diag(added)).tolist(), strict=True):
        wider = _noise(p, extra) if p.name in logarithmic else _plain(p, extra, enough.get(p.name))
        parameters.append(wider if p.verdict == "ok" else replace(wider, verdict=p.verdict))
    said = result.status.split("; ")
    kept = [s for s in said if not s.startswith(_RESOLVED)]
    at = next((i for i, s in enumerate(said) if s.startswith(_RESOLVED)), len(said))
    kept.insert(at, weak_words(parameters) or _RESOLVED[-1])
    return replace(
        result,
        parameters=tuple(parameters),
        covariance=frozen(result.covariance + added),
        status="; ".join(kept),
        uncertainty=f"{result.uncertainty} + reconstruction",
    )


def _plain(p: Parameter, extra: float, enough: float | None) -> Parameter:
    se = float(np.hypot(p.se, extra))
    half = float(np.hypot(0.5 * (p.ci95[1] - p.ci95[0]), _NORMAL * extra))
    middle = 0.5 * (p.ci95[0] + p.ci95[1])
    ci95 = (middle - half, middle + half)
    return replace(p, se=se, ci95=ci95, verdict=verdict(p.value, se, ci95, enough))


def _noise(p: Parameter, extra: float) -> Parameter:
    """As `natural_scale` has it: the interval that of the logarithm, 'ok' if known to a factor."""
    se = float(np.hypot(p.se, extra))
    judged = noise_verdict(se / p.value)
    low, high = p.ci95
    if not low > 0.0:  # a logarithm so wide that it has left the numbers
        return replace(p, se=se, verdict=judged)
    half = float(np.hypot(0.5 * np.log(high / low), _NORMAL * extra / p.value))
    middle = 0.5 * np.log(high * low)
    low, high = float(np.exp(middle - half)), float(np.exp(min(middle + half, 700.0)))
    return replace(p, se=se, ci95=(low, high), verdict=judged)
