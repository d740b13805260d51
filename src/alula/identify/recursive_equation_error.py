"""Equation error by recursive least squares: estimates over time, and their last values.

The coefficients and formulas are those of equation error (equation_error.py); the maneuvers come
one after another, as they were flown. Standard errors in the histories are those that are known in
flight (white residuals). For the last values every sample's weight on them is worked out, whatever
was forgotten, and with it the covariance for coloured residuals, so that they compare with those of
the other methods. Without forgetting the last values are those of ordinary least squares.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.coloured import Coloured, coloured_covariance
from alula.base.messages import Message, refuse
from alula.core import core
from alula.identify.coefficients import CoefficientData
from alula.identify.diagnostics import diagnose
from alula.identify.quality import joint_covariance, predictions, quality, status
from alula.identify.recursive import (
    NOTHING_FORGOTTEN,
    Forgetting,
    RecursiveFit,
    diffuse,
    recursive_least_squares,
    sample_weights,
)
from alula.identify.regression import Block, Regression, regress
from alula.identify.result import Fit, History, Identification, Parameter, Series
from alula.identify.task import CoefficientTask, serving, uneven
from alula.identify.verdict import assess
from alula.model import reference_scales


def identify_recursive(
    data: Sequence[CoefficientData],
    models: Mapping[str, str],
    *,
    forgetting: Forgetting = NOTHING_FORGOTTEN,
    common_constant: bool = False,
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Derivatives of every coefficient in `models` by recursive least squares.

    Arguments, sharing of parameters, held-out maneuvers and refusals are those of
    `identify_equation_error`; maneuvers count alike. `histories` of the result holds the estimates
    over time, `parameters` the last ones.
    """
    if not models:
        raise refuse(
            "no_model",
            where="models",
            expected="a formula for at least one coefficient",
            found="none",
            do='State one, e.g. Cm = "1 + alpha + qhat + de".',
        )
    fits: dict[str, Fit] = {}
    parameters: list[Parameter] = []
    series: list[Series] = []
    histories: list[History] = []
    messages: list[Message] = [m for item in data for m in (*item.messages, *uneven(item))]
    parts: list[Array] = []
    changes: list[dict[str, Array]] = []
    for coefficient, formula in models.items():
        maneuvers = serving(data, coefficient)
        learn = [item for item in maneuvers if not item.maneuver.held_out]
        task = CoefficientTask(coefficient, formula, tuple(learn), common_constant)
        _check_size(coefficient, task.names)
        blocks = task.blocks(None)
        run = _run(blocks, forgetting)
        fit = _last(task.names, blocks, run)
        change = {
            source: _run(task.blocks(source), forgetting).value[-1] - run.value[-1]
            for source in dict.fromkeys(p.source for item in learn for p in item.perturbed)
        }
        added = sum((np.outer(d, d) for d in change.values()), np.zeros((len(task.names),) * 2))
        enough = {**reference_scales(coefficient, formula), **(scales or {})}
        assessed, remarks = assess(coefficient, fit, added, enough, truth or {})
        tests, warned = diagnose(task, fit)
        parameters += assessed
        messages += [*remarks, *warned]
        parts.append(fit.coloured.covariance)
        changes.append(change)
        shown = predictions(task, fit, maneuvers)
        series += shown
        fits[coefficient] = replace(quality(task, fit, shown), diagnostics=tests)
        histories += _histories(task, run)
    return Identification(
        method="recursive least squares",
        parameters=tuple(parameters),
        fits=fits,
        series=tuple(series),
        covariance=joint_covariance(parts, changes, parameters),
        status=status(parameters),
        messages=tuple(messages),
        labels={k: v for item in data for k, v in (item.labels or {}).items() if k in models},
        histories=tuple(histories),
    )


def _run(blocks: Sequence[Block], forgetting: Forgetting) -> RecursiveFit:
    x = np.vstack([b.regressors for b in blocks])
    measured = np.concatenate([b.measured for b in blocks])
    return recursive_least_squares(x, measured, forgetting, gains=True)


def _last(names: Sequence[str], blocks: Sequence[Block], run: RecursiveFit) -> Regression:
    """The last values as a regression; without forgetting the ordinary one's error bars."""
    ordinary = regress(names, blocks, "equal")
    x = np.vstack([b.regressors for b in blocks])
    value = run.value[-1]
    left = np.concatenate([b.measured for b in blocks]) - x @ value
    ends = np.cumsum([len(b.measured) for b in blocks])[:-1]
    solution = replace(ordinary.solution, value=value, residual=left)
    fit = replace(ordinary, solution=solution, residuals=tuple(np.split(left, ends)))
    if np.all(run.factor == 1.0) and not run.reset.any():
        return fit
    weights, rest = sample_weights(x, run.gain)
    dispersion = weights @ weights.T + (rest * diffuse(x)) @ rest.T
    shares = np.linalg.pinv(dispersion, hermitian=True) @ weights
    settled = np.arange(len(left)) >= 2 * len(names)  # before that they follow the start
    pairs = [
        (s.T, v)
        for s, v in zip(
            np.split(shares, ends, axis=1),
            np.split(np.where(settled, run.residual, 0.0), ends),
            strict=True,
        )
    ]
    found = coloured_covariance(pairs, dispersion)
    # Innovations lack nothing that the fit has bent to: there is no loss to put back.
    coloured = Coloured(found.covariance, found.covariance, found.dof)
    noise = float(run.noise[-1])
    return replace(
        fit,
        solution=replace(solution, dispersion=dispersion, variance=noise),
        coloured=coloured,
    )


def _histories(task: CoefficientTask, run: RecursiveFit) -> list[History]:
    ends = np.cumsum([len(item.t) for item in task.learn])
    return [
        History(
            coefficient=task.coefficient,
            maneuver=item.maneuver.id,
            names=task.names,
            t=frozen(item.t),
            value=frozen(run.value[end - len(item.t) : end]),
            se=frozen(run.se[end - len(item.t) : end]),
            factor=frozen(run.factor[end - len(item.t) : end]),
        )
        for item, end in zip(task.learn, ends.tolist(), strict=True)
    ]


def _check_size(coefficient: str, names: Sequence[str]) -> None:
    if len(names) > core.MAX_RECURSIVE:
        raise refuse(
            "too_many_parameters",
            where=f"model of {coefficient}",
            expected=f"at most {core.MAX_RECURSIVE} parameters, the maneuvers' constants included",
            found=str(len(names)),
            do="Ask for a common constant, or take fewer maneuvers or terms.",
        )
