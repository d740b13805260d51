"""Lateral derivatives turned by the angle of attack between stability axes and a model's axes.

A model keeps drag and lift along stability axes, rates and moments along body axes (docs/notation);
handbook formulas are in stability axes throughout. x_s = x cos + z sin, z_s = z cos - x sin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, radians, sin

import numpy as np

from alula.base.arrays import Array
from alula.predict.derivatives import Derivatives, Estimate, PredictionAxes

COEFFICIENTS = ("CD", "CY", "CL", "Cl", "Cm", "Cn")


def turn(given: Sequence[str], alpha: float) -> tuple[list[str], Array]:
    """Names in body axes and the matrix (k, m) that makes them of m derivatives in stability axes.

    p_s = p cos + r sin, r_s = r cos - p sin; l = l_s cos - n_s sin, n = l_s sin + n_s cos. With
    -alpha it goes the other way. Only CY, Cl, Cn and their rates turn.
    """
    c, s = cos(alpha), sin(alpha)
    moment = {"Cl": {"Cl": c, "Cn": s}, "Cn": {"Cl": -s, "Cn": c}}
    rate = {"p": {"p": c, "r": s}, "r": {"p": -s, "r": c}}
    rows: dict[str, dict[str, float]] = {}
    for name in given:
        coefficient, _, label = name.partition("_")
        for to, factor in moment.get(coefficient, {coefficient: 1.0}).items():
            for onto, share in rate.get(label, {label: 1.0}).items():
                if factor * share != 0.0:
                    rows.setdefault(f"{to}_{onto}", {})[name] = factor * share
    matrix = np.zeros((len(rows), len(given)))
    places = {name: i for i, name in enumerate(given)}
    for i, row in enumerate(rows.values()):
        for source, weight in row.items():
            matrix[i, places[source]] = weight
    return list(rows), matrix


def along(prediction: Derivatives, axes: PredictionAxes) -> Derivatives:
    """The prediction in these axes, by its own angle of attack (condition 'alpha_deg').

    Errors count as independent before the turn.
    """
    if prediction.axes == axes:
        return prediction
    alpha = radians(float(prediction.conditions.get("alpha_deg", "0")))
    given = list(prediction.values)
    names, matrix = turn(given, alpha if axes == "model" else -alpha)
    estimates = list(prediction.values.values())
    value = matrix @ np.array([e.value for e in estimates])
    se = np.sqrt(matrix**2 @ np.array([e.se**2 for e in estimates]))
    values = {}
    for i, name in enumerate(names):
        own = prediction.values.get(name)
        main = own or estimates[int(np.argmax(np.abs(matrix[i])))]
        values[name] = Estimate(float(value[i]), float(se[i]), main.source)
    return replace(prediction, values=values, axes=axes)
