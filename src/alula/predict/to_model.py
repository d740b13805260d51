"""A prediction as an aerodynamic model: what the simulator flies and estimation starts from."""

from __future__ import annotations

from math import radians

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.model import AeroModel, Reference, aero_model
from alula.predict.axes import COEFFICIENTS, turn
from alula.predict.combine import PAIRS
from alula.predict.derivatives import Derivatives

# Attached flow, where linear derivatives mean something; said in the model, not measured.
VALIDITY = {"alpha": (-0.10, 0.21), "beta": (-0.17, 0.17)}

_TERMS = {"0": "1", "alpha": "alpha", "alpha2": "alpha^2", "beta": "beta",
          "p": "phat", "q": "qhat", "r": "rhat",
          "de": "de", "da": "da", "dr": "dr", "df": "df"}  # fmt: skip


def to_model(
    prediction: Derivatives, reference: Reference, reference_point: Array, *, name: str
) -> AeroModel:
    """The model of a prediction, with the covariance of its values.

    Lift and drag stay those of stability axes; side force's and the moments' derivatives are turned
    from stability to body axes by the prediction's angle of attack (condition 'alpha_deg'), as the
    model's are. Derivatives to alphadot and betadot go into those to the rates, with which they act
    in the short period and the Dutch roll: Cm_q + Cm_alphadot, Cn_r - Cn_betadot. Errors count as
    independent before the turn. Raises BadInput where the prediction has neither lift nor moment.
    """
    values, variances = _lumped(prediction)
    if "CL_alpha" not in values:
        raise refuse(
            "incomplete_prediction",
            where=f"prediction by {prediction.method}",
            expected="CL_alpha at the least",
            found=", ".join(values) or "no derivative",
            do="Predict with a method that gives the whole aircraft's lift.",
        )
    alpha = radians(float(prediction.conditions.get("alpha_deg", "0")))
    given = list(values)
    names, matrix = turn(given, alpha if prediction.axes == "stability" else 0.0)
    order = sorted(range(len(names)), key=lambda i: _order(names[i]))
    names, matrix = [names[i] for i in order], matrix[order]
    vector = matrix @ np.array([values[n] for n in given])
    covariance = matrix @ np.diag([variances[n] for n in given]) @ matrix.T
    formulas = {
        c: " + ".join(text for label, text in _TERMS.items() if f"{c}_{label}" in names)
        for c in COEFFICIENTS
        if any(n.startswith(f"{c}_") for n in names)
    }
    return aero_model(
        name,
        formulas,
        dict(zip(names, vector.tolist(), strict=True)),
        reference,
        axes="stability",
        covariance=0.5 * (covariance + covariance.T),
        reference_point=reference_point,
        validity=VALIDITY,
        provenance={
            "method": prediction.method,
            "rates": "to qhat and rhat with those to alphadot and betadot added",
            **{f"condition: {k}": v for k, v in prediction.conditions.items()},
            **{f"source: {n}": e.source for n, e in prediction.values.items()},
            **{f"note {i}": note for i, note in enumerate(prediction.notes, 1)},
        },
    )


def priors(model: AeroModel) -> dict[str, tuple[float, float]]:
    """Mean and standard error of each parameter, for estimation with a Gaussian prior.

    `Prior(*pair)` of each (`alula.identify.likelihood.parameters`) is what the estimators take.
    Parameters without a standard error (None, or zero by symmetry) are left out: a prior needs a
    width.
    """
    if model.covariance is None:
        return {}
    se = np.sqrt(np.diagonal(model.covariance))
    return {
        n: (float(v), float(s))
        for n, v, s in zip(model.names, model.values, se, strict=True)
        if s > 0.0
    }


def _lumped(prediction: Derivatives) -> tuple[dict[str, float], dict[str, float]]:
    """Values and variances by name, the lags added to the rates; other names are left out."""
    lags = {partner: (name, sign) for name, (partner, sign) in PAIRS.items()}
    values: dict[str, float] = {}
    se: dict[str, float] = {}
    for name, e in prediction.values.items():
        target, sign = lags.get(name, (name, 1.0))
        coefficient, _, label = target.partition("_")
        if coefficient not in COEFFICIENTS or label not in _TERMS:
            continue
        values[target] = values.get(target, 0.0) + sign * e.value
        se[target] = se.get(target, 0.0) + e.se  # of one tail: they go together
    return values, {n: s**2 for n, s in se.items()}


def _order(name: str) -> tuple[int, int]:
    coefficient, _, label = name.partition("_")
    return COEFFICIENTS.index(coefficient), list(_TERMS).index(label)
