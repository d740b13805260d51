"""Synthetic angle of attack from the load factor and an identified lift model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.model import AeroModel

ITERATIONS = 12


def lift_angle(
    model: AeroModel,
    *,
    mass: float,
    f: Array,
    V: Array,
    rho: Array,
    variables: Mapping[str, Array],
    engine_force: Array | None = None,
) -> Array:
    """Angles of attack (n,), rad, at which the model's CL (or -CZ) is the measured one.

    f: (n, 3) specific force, m/s2; V: (n,) m/s; rho: (n,) kg/m3; variables: the model's other
    variables by name (n,), `qhat`, `de` and so on. engine_force: (n, 3) N, body axes, if known.
    NaN outside the range of alpha that the model is valid in, and where nothing solves it: an
    attached-flow model says nothing of a stall. Raises BadInput where the model has no lift.
    """
    coefficient = "CL" if model.axes == "stability" else "CZ"
    if coefficient not in model.coefficients:
        raise refuse(
            "no_lift",
            where=f"aerodynamic model '{model.name}'",
            expected=f"a formula of {coefficient}",
            found=", ".join(model.coefficients) or "none",
            do="Identify the lift too.",
        )
    lift = [i for i, (name, _) in enumerate(model.terms) if name == coefficient]
    only = replace(
        model,
        terms=tuple(model.terms[i] for i in lift),
        values=model.values[lift],
        covariance=None,
        stall=None,
    )
    V, rho = np.asarray(V, dtype=np.float64), np.asarray(rho, dtype=np.float64)
    pressure_area = 0.5 * rho * V**2 * model.reference.S
    engines = np.zeros_like(f) if engine_force is None else engine_force
    force = mass * np.asarray(f, dtype=np.float64) - engines  # of the air
    low, high = model.validity.get("alpha", (-0.3, 0.5))
    given = {name: np.asarray(x, dtype=np.float64) for name, x in variables.items()}

    def difference(alpha: Array) -> Array:
        found = only.evaluate({**given, "alpha": alpha, "V": V})[coefficient]
        if coefficient == "CZ":
            return np.asarray(found - force[:, 2] / pressure_area, dtype=np.float64)
        up = force[:, 0] * np.sin(alpha) - force[:, 2] * np.cos(alpha)
        return np.asarray(found - up / pressure_area, dtype=np.float64)

    alpha = np.full(len(V), 0.5 * (low + high))
    step = 1e-4
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(ITERATIONS):
            here = difference(alpha)
            slope = (difference(alpha + step) - here) / step
            alpha = np.clip(alpha - here / slope, low - 0.1, high + 0.1)
        solved = np.abs(difference(alpha)) < 1e-6
    inside = (alpha >= low) & (alpha <= high)
    return np.asarray(np.where(solved & inside, alpha, np.nan), dtype=np.float64)
