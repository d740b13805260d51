"""What a maneuver will tell output error of each parameter: Cramer-Rao bounds before the flight.

D = sum of S' R^-1 S over samples, with the outputs' sensitivities S to derivatives and initial
states along the a-priori motion; standard errors are the roots of the diagonal of D^-1 (Dittrich
2016, Eq. (3.64); Klein and Morelli, Aircraft System Identification, 2nd ed., 2016, Sec. 9.2).
Initial states of every maneuver are estimated along and cost information, as they will in flight.

Assumed: the model is right, the air is still, the sensors' noise is white and of the size stated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from alula.base.messages import refuse
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.problem import FlightProblem, Setting
from alula.model import AeroModel, Reference, aero_model, parse
from alula.plan.information import Prediction, verdict_of

NO_INFORMATION = 1e-12  # of the scaled information's largest eigenvalue: rounding
_MEMBER = 1e-6  # share of a direction without information above which a parameter belongs to it


def predict_output_error(
    flights: Sequence[MeasuredManeuver],
    model: AeroModel,
    formulas: Mapping[str, str],
    sigma: Mapping[str, float],
    *,
    states: Sequence[str],
    outputs: Sequence[str],
) -> tuple[Prediction, ...]:
    """Standard errors of all parameters of `formulas` by all flights together.

    flights: as flown by the a-priori model, without noise. sigma: standard deviation per sample of
    every output (m/s, rad, rad/s, m/s2, rad/s2). states, outputs: as in `identify_output_error`.
    Constants that the model does not have are estimated along and not reported. Raises BadInput
    where a sigma is missing or a flight cannot be repeated.
    """
    missing = [name for name in outputs if not sigma.get(name, 0.0) > 0.0]
    if missing:
        raise refuse(
            "missing_sigma",
            where="plan, output error",
            expected="a standard deviation above zero for every output",
            found=f"none of {', '.join(missing)}",
            do="State the sensors' noise.",
        )
    names = {t.name(c): c for c, formula in formulas.items() for t in parse(formula)}
    r = model.reference
    axes_name: Literal["body", "stability"] = (
        "stability" if {"CD", "CL"} & set(formulas) else "body"
    )
    known = {n: model.params.get(n, 0.0) for n in names}
    chosen = aero_model("plan", dict(formulas), known, Reference(r.S, r.b, r.c), axes=axes_name)
    problem = FlightProblem(flights, chosen, Setting(tuple(states), tuple(outputs)))
    sums = problem.evaluate(problem.start)
    if not sums.finite:
        raise refuse(
            "diverged",
            where="plan, output error",
            expected="flights that the a-priori model can repeat",
            found="a motion that grew without bound",
            do="Fly shorter maneuvers, or plan by equation error.",
        )
    weight = np.array([sigma[name] ** -2 for name in outputs])
    information = np.tensordot(weight, sums.information, 1)
    size = np.sqrt(np.diag(information))
    size[size == 0.0] = 1.0
    values, axes = np.linalg.eigh(information / np.outer(size, size))
    kept = values > NO_INFORMATION * values[-1]
    se = np.sqrt(np.sum((axes[:, kept] ** 2) / values[kept], axis=1)) / size
    null = np.abs(axes[:, ~kept]) > _MEMBER
    out = []
    for i, name in enumerate(problem.names):
        if name not in model.params:
            continue
        lost = null[i]
        tied = tuple(
            other
            for j, other in enumerate(problem.names)
            if j != i and lost.any() and null[j][lost].any()
        )
        error = float("inf") if lost.any() else float(se[i])
        value, coefficient = model.params[name], problem.belongs[i]
        verdict = verdict_of(coefficient, name, value, error)
        out.append(Prediction(name, coefficient, value, error, verdict, tied))
    return tuple(out)
