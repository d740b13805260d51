"""Equation error: regress each aerodynamic coefficient on motion and controls.

Dittrich 2016, Eq. (3.46) to (3.48); van den Hoek 2017, Eq. (28) to (31). Error bars: coloured
residuals (coloured.py), and what lies outside of the regression (by_coefficient.py).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from alula.base.messages import refuse
from alula.identify.coefficients import CoefficientData
from alula.identify.equation_error.by_coefficient import Estimate, identify_each
from alula.identify.equation_error.choice import Kind, RegressionChoice
from alula.identify.equation_error.quality import r_squared
from alula.identify.equation_error.task import LONGITUDINAL, MOMENTS, CoefficientTask
from alula.identify.regression.regress import Weighting, regress
from alula.identify.result import Identification

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
    if weighting not in ("residual", "equal"):
        raise refuse(
            "unknown_option",
            where="weighting",
            expected="'residual' or 'equal'",
            found=repr(weighting),
            do="Weight maneuvers by their residual variance, or all the same.",
        )
    choice = RegressionChoice(regression) if isinstance(regression, str) else regression

    def estimate(coefficient: str, formula: str, learn: list[CoefficientData]) -> Estimate:
        formula, structure, chosen = choice.select(
            coefficient, formula, learn, common_constant, weighting
        )
        task = CoefficientTask(coefficient, formula, tuple(learn), common_constant)
        fit, said = choice.fit(
            coefficient, regress(task.names, task.blocks(None), weighting), task.free
        )
        return Estimate(
            task=task,
            fit=fit,
            off=lambda source: fit.refit(task.blocks(source)),
            structure=structure,
            messages=(*chosen, *said),
        )

    method = METHODS[choice.regression]
    return identify_each(method, data, models, estimate, scales=scales, truth=truth)
