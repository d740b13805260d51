"""First values of output error: equation error on what was measured, smooth or not.

Biased by the noise of its regressors, but in the valley (Dittrich 2016, Eq. (3.46) to (3.48)).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic
from alula.base.messages import refuse
from alula.identify.flown.core_maneuver import filled, force_coefficients
from alula.identify.flown.measured_maneuver import STATES, MeasuredManeuver
from alula.identify.regression.least_squares import least_squares
from alula.model import LIFT, parse

_COLUMN = {"CX": 0, "CY": 1, "CZ": 2, "Cl": 0, "Cm": 1, "Cn": 2}


def start_values(
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    given: Mapping[str, float],
) -> dict[str, float]:
    """A value for every term by name; `given` ones as they are.

    Coefficients are taken as measured, or from the outputs ax ay az and pdot qdot rdot (or the
    derivatives of p q r). Raises BadInput where none of these is there and no value is given.
    """
    values = dict(given)
    variables = [regressor_variables(m) for m in maneuvers]
    measured = [measured_coefficients(m) for m in maneuvers]
    for coefficient, formula in models.items():
        terms = parse(formula)
        names = [t.name(coefficient) for t in terms]
        if all(n in given for n in names):
            continue
        if any(coefficient not in c for c in measured):
            raise refuse(
                "no_start",
                where=f"output error, {coefficient}",
                expected="start values, or measurements that give the coefficient",
                found=f"neither for {', '.join(n for n in names if n not in given)}",
                do="Give start values, or the accelerations (rates for a moment).",
            )
        rows = []
        for m, known, own in zip(maneuvers, variables, measured, strict=True):
            with_lift = {**known, LIFT: own[LIFT]} if LIFT in own else known
            rows.append(
                np.column_stack([np.broadcast_to(t.values(with_lift), m.t.shape) for t in terms])
            )
        matrix = np.vstack(rows)
        y = np.concatenate([c[coefficient] for c in measured])
        free = [i for i, n in enumerate(names) if n not in given]
        for i, name in enumerate(names):
            if name in given:
                y = y - matrix[:, i] * given[name]
        good = np.isfinite(y) & np.isfinite(matrix).all(axis=1)
        if int(good.sum()) <= len(free):
            found = np.zeros(len(free))
        else:
            found = least_squares(matrix[np.ix_(good, free)], y[good]).value
        values.update({names[i]: float(v) for i, v in zip(free, found, strict=True)})
    return values


def regressor_variables(m: MeasuredManeuver) -> dict[str, Array]:
    """The formulas' variables (n,), from outputs where they were measured, else from the motion."""
    x = {name: filled(m, name) for name in STATES}
    half = 0.5 / x["V"]
    return {
        "V": x["V"],
        "alpha": x["alpha"],
        "beta": x["beta"],
        "phat": x["p"] * m.reference.b * half,
        "qhat": x["q"] * m.reference.c * half,
        "rhat": x["r"] * m.reference.b * half,
        "mach": x["V"] / m.speed_of_sound,
        **m.controls,
    }


def measured_coefficients(m: MeasuredManeuver) -> dict[str, Array]:
    """The coefficients (n,) that the maneuver tells: as it has them, else from its outputs."""
    out = {**force_coefficients(m), **m.coefficients}
    x = {name: filled(m, name) for name in STATES}
    pressure_area = 0.5 * m.rho * x["V"] ** 2 * m.reference.S
    if not {"Cl", "Cm", "Cn"} <= out.keys():
        rates = np.column_stack([x["p"], x["q"], x["r"]])
        cubic = LocalCubic(m.t)
        accelerations = np.column_stack(
            [
                m.outputs[dot] if dot in m.outputs else cubic.derivative(rates[:, i])
                for i, dot in enumerate(("pdot", "qdot", "rdot"))
            ]
        )
        moment = accelerations @ m.inertia.T + np.cross(rates, rates @ m.inertia.T) - m.moment
        if {"CX", "CY", "CZ"} <= out.keys() or not np.any(m.arm):
            aero = np.column_stack([out.get(c, 0.0 * m.t) for c in ("CX", "CY", "CZ")])
            moment -= np.cross(m.arm, aero * pressure_area[:, None])
        for name, length in (("Cl", m.reference.b), ("Cm", m.reference.c), ("Cn", m.reference.b)):
            if name not in out:
                out[name] = moment[:, _COLUMN[name]] / (pressure_area * length)
    return out
