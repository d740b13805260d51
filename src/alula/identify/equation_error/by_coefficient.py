"""Identification coefficient by coefficient: what the methods have in common that regress each on
its own, from the formulas to the result.

Standard errors: of the residuals as the method has them, and for each source of uncertainty outside
the regression (reconstruction, thrust) the change of the estimate when that source is one standard
deviation off, squared and added.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message
from alula.identify.coefficients import CoefficientData
from alula.identify.equation_error.diagnostics import diagnose
from alula.identify.equation_error.quality import (
    joint_covariance,
    predictions,
    quality,
    se_words,
    status,
)
from alula.identify.equation_error.task import CoefficientTask, need_models, serving, uneven
from alula.identify.regression.regress import Regression
from alula.identify.regression.regressor_noise import warn_of_bias
from alula.identify.regression.structure import Structure
from alula.identify.result import Fit, History, Identification, Parameter, Series
from alula.identify.trust.control_sign import contradicted, signs_checked
from alula.identify.trust.verdict import assess
from alula.model import reference_scales


@dataclass(frozen=True)
class InTime:
    """A fit whose rows are not samples, beside samples. fit: residuals over time. noisy: regressors
    with as much noise as the method lets in.
    """

    fit: Regression
    noisy: Regression


@dataclass(frozen=True)
class Estimate:
    """One coefficient's fit.

    fit: whose error bars and verdicts count. off: the values (k,) as they were with a source of
    outside uncertainty one standard deviation off. in_time: where the rows of `fit` are not
    samples. structure: how the terms were chosen. messages: what the method has to say.
    """

    task: CoefficientTask
    fit: Regression
    off: Callable[[str], Array]
    in_time: InTime | None = None
    structure: Structure | None = None
    histories: tuple[History, ...] = ()
    messages: tuple[Message, ...] = ()


# Of a coefficient, its formula and the maneuvers to learn from.
Estimator = Callable[[str, str, list[CoefficientData]], Estimate]


def identify_each(
    method: str,
    data: Sequence[CoefficientData],
    models: Mapping[str, str],
    estimate: Estimator,
    *,
    residuals: str = "coloured residuals",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Derivatives of every coefficient in `models`, shared by all maneuvers that serve it.

    data: one entry per maneuver, held-out ones among them, which are predicted with the derivatives
    of the others. residuals: what the standard errors take them to be, in words. scales: standard
    errors that are good enough, by parameter name. truth: carried along.

    Raises BadInput where no model is asked for, and for a coefficient that the data do not have or
    that no maneuver serves.
    """
    need_models(models)
    fits: dict[str, Fit] = {}
    found: list[Parameter] = []
    series: list[Series] = []
    histories: list[History] = []
    messages: list[Message] = [m for item in data for m in (*item.messages, *uneven(item))]
    parts: list[Array] = []
    changes: list[dict[str, Array]] = []
    for coefficient, formula in models.items():
        maneuvers = serving(data, coefficient)
        learn = [item for item in maneuvers if not item.maneuver.held_out]
        e = estimate(coefficient, formula, learn)
        change = {
            source: e.off(source) - e.fit.solution.value
            for source in dict.fromkeys(p.source for item in learn for p in item.perturbed)
        }
        added = sum((np.outer(d, d) for d in change.values()), np.zeros((len(e.task.names),) * 2))
        enough = {**reference_scales(coefficient, e.task.formula), **(scales or {})}
        assessed, remarks = assess(coefficient, e.fit, added, enough, truth or {})
        found += assessed
        messages += _of_noise(coefficient, e, assessed, remarks)
        parts.append(e.fit.coloured.covariance)
        changes.append(change)
        beside = e.fit if e.in_time is None else e.in_time.fit
        shown = predictions(e.task, beside, maneuvers)
        series += shown
        fits[coefficient] = replace(quality(e.task, beside, shown), structure=e.structure)
        messages += e.messages
        if e.in_time is None:
            tests, warned = diagnose(e.task, e.fit)
            messages += warned
            fits[coefficient] = replace(fits[coefficient], diagnostics=tests)
        histories += e.histories
    parameters, turned = signs_checked(found)
    return Identification(
        method=method,
        parameters=parameters,
        fits=fits,
        series=tuple(series),
        covariance=joint_covariance(parts, changes, parameters),
        status=status(parameters) + contradicted(turned),
        messages=(*messages, *turned),
        histories=tuple(histories),
        labels={k: v for item in data for k, v in (item.labels or {}).items() if k in models},
        uncertainty=se_words(residuals, data),
    )


def _of_noise(
    coefficient: str,
    e: Estimate,
    assessed: Sequence[Parameter],
    remarks: Sequence[Message],
) -> list[Message]:
    """The remarks; those on noise in regressors told by samples, where rows are not."""
    if e.in_time is None:
        return list(remarks)
    out = [m for m in remarks if m.code != "noisy_regressor"]
    if all(p.verdict != "not_identifiable" for p in assessed):
        out += warn_of_bias(coefficient, e.in_time.noisy, np.array([p.se for p in assessed]))
    return out
