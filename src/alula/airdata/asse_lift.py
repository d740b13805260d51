"""Synthetic angle of attack from the load factor and an identified lift model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.model import AeroModel

ITERATIONS, STEP = 12, 1e-4
LOAD, PRESSURE = 0.02, 0.01  # m/s2, of itself: errors of load factor and dynamic pressure


def lift_coefficient(model: AeroModel) -> str:
    """'CL' or 'CZ', whichever the model has; raises BadInput where it has no lift."""
    coefficient = "CL" if model.axes == "stability" else "CZ"
    if coefficient not in model.coefficients:
        raise refuse(
            "no_lift",
            where=f"aerodynamic model '{model.name}'",
            expected=f"a formula of {coefficient}",
            found=", ".join(model.coefficients) or "none",
            do="Identify the lift too.",
        )
    return coefficient


def lift_angle(
    model: AeroModel,
    *,
    mass: float | Array,
    f: Array,
    V: Array,
    rho: Array,
    variables: Mapping[str, Array],
    engine_force: Array | None = None,
) -> Array:
    """Angles of attack (n,), rad, at which the model's CL (or -CZ) is the measured one.

    mass: kg, or (n,); f: (n, 3) specific force at the center of gravity, m/s2; V: (n,) m/s; rho:
    (n,) kg/m3; variables: the model's other variables by name (n,), `qhat`, `de` and so on.
    engine_force: (n, 3) N, body axes, if known.
    NaN outside the range of alpha that the model is valid in, and where nothing solves it: an
    attached-flow model says nothing of a stall. Raises BadInput where the model has no lift.
    """
    difference = _difference(model, mass, f, V, rho, variables, engine_force)
    low, high = model.validity.get("alpha", (-0.3, 0.5))
    alpha = np.full(len(V), 0.5 * (low + high))
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(ITERATIONS):
            here = difference(alpha)
            slope = (difference(alpha + STEP) - here) / STEP
            alpha = np.clip(alpha - here / slope, low - 0.1, high + 0.1)
        solved = np.abs(difference(alpha)) < 1e-6
    inside = (alpha >= low) & (alpha <= high)
    return np.asarray(np.where(solved & inside, alpha, np.nan), dtype=np.float64)


def lift_angle_sigma(
    model: AeroModel,
    alpha: Array,
    *,
    mass: float | Array,
    f: Array,
    V: Array,
    rho: Array,
    variables: Mapping[str, Array],
    engine_force: Array | None = None,
    load: float = LOAD,
    pressure: float = PRESSURE,
) -> Array:
    """Standard deviation (n,), rad, of what `lift_angle` gave, to first order.

    load: standard deviation of the specific force, m/s2; pressure: of dynamic pressure, relative;
    and the covariance of the lift's parameters where the model has one. What the formula leaves
    out is not in it.
    """
    coefficient = lift_coefficient(model)
    difference = _difference(model, mass, f, V, rho, variables, engine_force)
    lift = [i for i, (name, _) in enumerate(model.terms) if name == coefficient]
    known = {**variables, "alpha": alpha, "V": np.asarray(V, dtype=np.float64)}
    columns = [
        np.broadcast_to(np.asarray(model.terms[i][1].values(known), dtype=np.float64), alpha.shape)
        for i in lift
    ]
    X = np.column_stack(columns)
    C = X @ model.values[lift]
    variance = (load * mass / (0.5 * rho * V**2 * model.reference.S)) ** 2 + (pressure * C) ** 2
    if model.covariance is not None:
        part = model.covariance[np.ix_(lift, lift)]
        variance = variance + np.einsum("ni,ij,nj->n", X, np.where(np.isfinite(part), part, 0.0), X)
    slope = (difference(alpha + STEP) - difference(alpha)) / STEP
    return np.asarray(np.sqrt(variance) / np.abs(slope), dtype=np.float64)


def _difference(
    model: AeroModel,
    mass: float | Array,
    f: Array,
    V: Array,
    rho: Array,
    variables: Mapping[str, Array],
    engine_force: Array | None,
) -> Callable[[Array], Array]:
    """Model's coefficient less the measured one, (n,), for angles (n,)."""
    coefficient = lift_coefficient(model)
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
    weight = np.broadcast_to(np.asarray(mass, dtype=np.float64), V.shape)[:, None]
    force = weight * np.asarray(f, dtype=np.float64) - engines  # of the air
    given = {name: np.asarray(x, dtype=np.float64) for name, x in variables.items()}

    def difference(alpha: Array) -> Array:
        found = only.evaluate({**given, "alpha": alpha, "V": V})[coefficient]
        if coefficient == "CZ":
            return np.asarray(found - force[:, 2] / pressure_area, dtype=np.float64)
        up = force[:, 0] * np.sin(alpha) - force[:, 2] * np.cos(alpha)
        return np.asarray(found - up / pressure_area, dtype=np.float64)

    return difference
