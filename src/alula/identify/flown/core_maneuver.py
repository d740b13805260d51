"""One maneuver as the core flies and filters it: its inputs in rows, and where parameters go."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.core import core
from alula.identify.coefficients import Reference
from alula.identify.flown.measured_maneuver import CONTROLS, OUTPUTS, STATES, MeasuredManeuver
from alula.model import AXES, AeroModel, aero_model, parse, to_table
from alula.model import Reference as Lengths

Columns = NDArray[np.int64]
# The outputs that tell a coefficient of force.
TOLD_BY = {"CX": {"ax"}, "CY": {"ay"}, "CZ": {"az"}, "CD": {"ax", "az"}, "CL": {"ax", "az"}}


class Spread:
    """Values of which some are parameters: `at(theta)` puts them in."""

    def __init__(self, fixed: Array, column: Columns, weight: Array | None = None) -> None:
        self.fixed = np.array(fixed, dtype=np.float64)
        self.places = np.flatnonzero(column >= 0)
        self.columns = column[self.places]
        self.weight = np.ones(len(self.places)) if weight is None else weight[self.places]

    def at(self, theta: Array) -> Array:
        """The values with parameters (k,) put in."""
        out = self.fixed.copy()
        out[self.places] = self.weight * theta[self.columns]
        return out


@dataclass(frozen=True)
class ManeuverInCore:
    """One maneuver in the core. used: which parameters act on it."""

    core: Any
    used: Columns
    values: Spread
    initial: Spread
    bias: Spread
    samples: int

    def arguments(self, theta: Array) -> tuple[Array, Array, Array]:
        """Values of the terms, initial state (8,), biases."""
        return self.values.at(theta), self.initial.at(theta), self.bias.at(theta)


def formula_model(
    models: Mapping[str, str], values: Mapping[str, float], reference: Reference
) -> AeroModel:
    """The model of these formulas by coefficient; its axes are theirs. values: by term at least."""
    axes: Literal["body", "stability"] = "stability" if {"CD", "CL"} & models.keys() else "body"
    names = {t.name(c) for c, formula in models.items() for t in parse(formula)}
    chosen = {n: v for n, v in values.items() if n in names}
    lengths = Lengths(reference.S, reference.b, reference.c)
    return aero_model("of the maneuvers", models, chosen, lengths, axes=axes)


def in_core(
    m: MeasuredManeuver,
    model: AeroModel,
    states: Sequence[str],
    outputs: Sequence[str],
    pull: Mapping[str, float] | None = None,
    substeps: int = 1,
) -> Any:
    """The core's `ManeuverFit`; no parameters named yet. Others as `Setting` has them."""
    r = m.reference
    return core.ManeuverFit(
        to_table(model),
        model.axes == "stability",
        np.array([r.S, r.b, r.c]),
        np.array([m.mass, m.gravity]),
        np.ascontiguousarray(m.inertia),
        np.ascontiguousarray(m.arm),
        [STATES.index(name) for name in states],
        np.array([float((pull or {}).get(name, 0.0)) for name in STATES]),
        [OUTPUTS.index(name) for name in outputs],
        np.ascontiguousarray(m.t),
        input_rows(m, model),
        np.column_stack([m.outputs[name] for name in outputs]),
        substeps,
    )


def input_rows(m: MeasuredManeuver, model: AeroModel) -> Array:
    """The core's rows of inputs (n, 28) for one maneuver.

    Coefficients without a formula come as measured: as the maneuver has them, else those of forces
    from its specific forces.
    """
    wanted = [c for c in AXES[model.axes] if c not in model.coefficients]
    known = dict(m.coefficients)
    if any(c in TOLD_BY and c not in known and TOLD_BY[c] <= m.outputs.keys() for c in wanted):
        known = {**force_coefficients(m), **known}
    rows = np.zeros((len(m.t), 28))
    for j, name in enumerate(STATES):
        rows[:, j] = m.motion[name]
    for j, name in enumerate(CONTROLS, start=8):
        rows[:, j] = m.controls.get(name, 0.0)
    rows[:, 13] = m.rho
    rows[:, 14] = 1.0 / m.speed_of_sound
    rows[:, 15:18] = m.force
    rows[:, 18:21] = m.moment
    for j, name in enumerate(AXES[model.axes], start=21):
        if name in wanted and name in known:
            rows[:, j] = np.where(np.isfinite(known[name]), known[name], 0.0)
    return rows


def force_coefficients(m: MeasuredManeuver) -> dict[str, Array]:
    """CX CY CZ CD CL (n,) by the outputs ax ay az, so far as these were measured."""
    V, alpha = filled(m, "V"), filled(m, "alpha")
    pressure_area = 0.5 * m.rho * V**2 * m.reference.S
    out = {}
    for i, (name, output) in enumerate((("CX", "ax"), ("CY", "ay"), ("CZ", "az"))):
        if output in m.outputs:
            out[name] = (m.mass * m.outputs[output] - m.force[:, i]) / pressure_area
    if "CX" in out and "CZ" in out:
        sin, cos = np.sin(alpha), np.cos(alpha)
        out["CD"] = -out["CX"] * cos - out["CZ"] * sin
        out["CL"] = out["CX"] * sin - out["CZ"] * cos
    return out


def filled(m: MeasuredManeuver, name: str) -> Array:
    """A variable (n,) as measured, the motion's where there is no reading."""
    reading = m.outputs.get(name, m.motion[name])
    out: Array = np.where(np.isfinite(reading), reading, m.motion[name])
    return out
