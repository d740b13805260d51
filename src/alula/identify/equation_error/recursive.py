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

from alula.base.arrays import frozen
from alula.base.coloured import Coloured, coloured_covariance
from alula.base.messages import refuse
from alula.core import core
from alula.identify.coefficients import CoefficientData
from alula.identify.equation_error.by_coefficient import Estimate, identify_each
from alula.identify.equation_error.recursive_least_squares import (
    NOTHING_FORGOTTEN,
    Forgetting,
    RecursiveFit,
    diffuse,
    recursive_least_squares,
    sample_weights,
)
from alula.identify.equation_error.task import CoefficientTask
from alula.identify.regression.regress import Block, Regression, regress
from alula.identify.result import History, Identification


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

    def estimate(coefficient: str, formula: str, learn: list[CoefficientData]) -> Estimate:
        task = CoefficientTask(coefficient, formula, tuple(learn), common_constant)
        _check_size(coefficient, task.names)
        blocks = task.blocks(None)
        run = _run(blocks, forgetting)
        return Estimate(
            task=task,
            fit=_last(task.names, blocks, run),
            off=lambda source: _run(task.blocks(source), forgetting).value[-1],
            histories=tuple(_histories(task, run)),
        )

    return identify_each(
        "recursive least squares", data, models, estimate, scales=scales, truth=truth
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
