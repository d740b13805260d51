"""The reconstruction's uncertainty carried into an estimate by output error.

A bias that reconstruction found one standard deviation off moves every reading of its sensor, and
the estimate by one Gauss-Newton step, `(sum J' R^-1 J)^-1 sum J' R^-1 dz`. The squares of these
steps, over all independent directions of the reconstruction's uncertainty, are added to the
variances.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.identify.flown.core_maneuver import formula_model
from alula.identify.flown.fit import Covariance
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.output_likelihood import likelihood_of
from alula.identify.flown.problem import FlightProblem, Setting
from alula.identify.likelihood.parameters import Prior
from alula.identify.result import Identification
from alula.identify.trust.verdict import verdict
from alula.model import parse, reference_scales

Shifts = Mapping[str, Mapping[str, Array]]  # by maneuver and output: (n,)
_NORMAL = 1.96  # what is added counts as known


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
    """The result with the shifts of the readings, one for each direction, in its error bars.

    A result in which some parameter has no value is returned as it is.
    """
    theta = np.array([p.value for p in result.parameters])
    learn = [m for m in maneuvers if not m.maneuver.held_out]
    if not shifts or not len(theta) or not np.isfinite(theta).all():
        return result
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
    added = step @ step.T
    enough = {
        n: v for c, formula in models.items() for n, v in reference_scales(c, formula).items()
    }
    enough.update(scales or {})
    parameters = []
    for p, extra in zip(result.parameters, np.diag(added).tolist(), strict=True):
        se = float(np.hypot(p.se, np.sqrt(extra)))
        half = float(np.hypot(0.5 * (p.ci95[1] - p.ci95[0]), _NORMAL * np.sqrt(extra)))
        middle = 0.5 * (p.ci95[0] + p.ci95[1])
        ci95 = (middle - half, middle + half)
        judged = verdict(p.value, se, ci95, enough.get(p.name))
        parameters.append(replace(p, se=se, ci95=ci95, verdict=judged))
    weak = ", ".join(p.name for p in parameters if p.verdict == "weak")
    why = result.status.split("; ")[0]
    return replace(
        result,
        parameters=tuple(parameters),
        covariance=frozen(result.covariance + added),
        status=f"{why}; " + (f"weak: {weak}" if weak else "every parameter is resolved"),
        uncertainty=f"{result.uncertainty} + reconstruction",
    )
