"""Equation error: regress each aerodynamic coefficient on motion and controls.

Dittrich 2016, Eq. (3.46) to (3.48); van den Hoek 2017, Eq. (28) to (31). Error bars: coloured
residuals (coloured.py), and for each source of uncertainty outside the regression (reconstruction,
thrust) the change of the estimate when that source is one standard deviation off, squared and
added.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse
from alula.identify.coefficients import CoefficientData
from alula.identify.diagnostics import diagnose
from alula.identify.quality import (
    joint_covariance,
    predictions,
    quality,
    r_squared,
    se_words,
    status,
)
from alula.identify.regression import Weighting, regress
from alula.identify.regression_choice import Kind, RegressionChoice
from alula.identify.result import Fit, Identification, Parameter, Series
from alula.identify.task import LONGITUDINAL, MOMENTS, CoefficientTask, serving, uneven
from alula.identify.verdict import assess
from alula.model import reference_scales

METHODS: Mapping[Kind, str] = {
    "ordinary": "equation error",
    "ridge": "equation error, ridge regression (biased)",
    "pcr": "equation error, principal-components regression (biased)",
    "stepwise": "equation error, stepwise regression",
    "orthogonal": "equation error, orthogonal functions",
}

__all__ = ["LONGITUDINAL", "MOMENTS", "identify_equation_error", "r_squared"]


def identify_equation_error(
    data: Sequence[CoefficientData],
    models: Mapping[str, str],
    *,
    weighting: Weighting = "residual",
    common_constant: bool = False,
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
    regression: RegressionChoice | Kind = "ordinary",
) -> Identification:
    """Derivatives of every coefficient in `models`, shared by all maneuvers that serve it.

    data: one entry per maneuver, held-out ones among them. models: formula by coefficient, e.g.
    {"Cm": "1 + alpha + qhat + de"}. weighting: of maneuvers, see regression.py. common_constant:
    one constant term for all maneuvers instead of one each. scales: standard errors that are good
    enough, by parameter name. truth: true values where they are known, carried along.
    regression: how each coefficient is regressed and, where the data choose, on which terms.

    Only maneuvers of the coefficient's aspect are used. A held-out maneuver is predicted with
    the derivatives of the others; its constant term, which belongs to its trim, is taken from
    itself. Raises BadInput for a coefficient that the data do not have, a formula that cannot be
    read, no maneuver to learn from, or no more samples than parameters.
    """
    if not models:
        raise refuse(
            "no_model",
            where="models",
            expected="a formula for at least one coefficient",
            found="none",
            do='State one, e.g. Cm = "1 + alpha + qhat + de".',
        )
    if weighting not in ("residual", "equal"):
        raise refuse(
            "unknown_option",
            where="weighting",
            expected="'residual' or 'equal'",
            found=repr(weighting),
            do="Weight maneuvers by their residual variance, or all the same.",
        )
    choice = RegressionChoice(regression) if isinstance(regression, str) else regression
    fits: dict[str, Fit] = {}
    parameters: list[Parameter] = []
    series: list[Series] = []
    messages: list[Message] = [m for item in data for m in (*item.messages, *uneven(item))]
    parts: list[Array] = []
    changes: list[dict[str, Array]] = []
    for coefficient, formula in models.items():
        maneuvers = serving(data, coefficient)
        learn = [item for item in maneuvers if not item.maneuver.held_out]
        formula, structure, said = choice.select(
            coefficient, formula, learn, common_constant, weighting
        )
        messages += said
        task = CoefficientTask(coefficient, formula, tuple(learn), common_constant)
        fit, said = choice.fit(
            coefficient, regress(task.names, task.blocks(None), weighting), task.free
        )
        change = {
            source: fit.refit(task.blocks(source)) - fit.solution.value
            for source in dict.fromkeys(p.source for item in learn for p in item.perturbed)
        }
        added = sum((np.outer(d, d) for d in change.values()), np.zeros((len(task.names),) * 2))
        enough = {**reference_scales(coefficient, formula), **(scales or {})}
        assessed, remarks = assess(coefficient, fit, added, enough, truth or {})
        parameters += assessed
        messages += remarks
        parts.append(fit.coloured.covariance)
        changes.append(change)
        shown = predictions(task, fit, maneuvers)
        series += shown
        tests, warned = diagnose(task, fit)
        messages += [*said, *warned]
        fits[coefficient] = replace(
            quality(task, fit, shown), diagnostics=tests, structure=structure
        )
    return Identification(
        method=METHODS[choice.regression],
        parameters=tuple(parameters),
        fits=fits,
        series=tuple(series),
        covariance=joint_covariance(parts, changes, parameters),
        status=status(parameters),
        messages=tuple(messages),
        labels={k: v for item in data for k, v in (item.labels or {}).items() if k in models},
        uncertainty=se_words("coloured residuals", data),
    )
