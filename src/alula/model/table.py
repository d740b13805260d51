"""An AeroModel as the table that the core evaluates, and its variables as the core's columns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.core import core
from alula.model.aero_model import AXES, AeroModel
from alula.model.lookup import LookupTable
from alula.model.terms import LIFT, VARIABLES, Factor

MAX_STEPS = 64  # core/include/alula/aero/term_table.hpp
MAX_TERMS = 64  # core/include/alula/math/capacity.hpp
_MULTIPLY, _ABSOLUTE, _RAMP, _SIGN, _LOOKUP, _LIFT = 0, 1, 2, 3, 4, 5
_Step = tuple[float, float, float, float, float, float]  # operation, a, b, knot, c, table


class _Slots:
    """Hands out slots, one for each distinct product, so that nothing is computed twice."""

    def __init__(self) -> None:
        self.steps: list[_Step] = []
        self.slot_of: dict[_Step, int] = {}
        self.tables: dict[str, LookupTable] = {}  # those that are looked up, in the core's order

    def step(
        self, operation: int, a: int, b: int = 0, knot: float = 0.0, c: int = 0, table: int = 0
    ) -> int:
        key = (float(operation), float(a), float(b), knot, float(c), float(table))
        if key not in self.slot_of:
            self.slot_of[key] = 1 + len(VARIABLES) + len(self.steps)
            self.steps.append(key)
        return self.slot_of[key]

    def factor(self, factor: Factor) -> int:
        slots = [
            self.step(_LIFT, 0) if name == LIFT else 1 + VARIABLES.index(name)
            for name in factor.variables
        ]
        slot = slots[0]
        if factor.lookup is not None:
            self.tables.setdefault(factor.table, factor.lookup)
            a, b, c = (*slots, 0, 0)[:3]
            slot = self.step(_LOOKUP, a, b, c=c, table=list(self.tables).index(factor.table))
        elif factor.kind == "abs":
            slot = self.step(_ABSOLUTE, slot)
        elif factor.kind == "sign":
            slot = self.step(_SIGN, slot)
        elif factor.kind == "ramp":
            slot = self.step(_RAMP, slot, knot=factor.knot)
        base = slot
        for _ in range(factor.power - 1):
            slot = self.step(_MULTIPLY, slot, base)
        return slot

    def product(self, factors: tuple[Factor, ...]) -> int:
        slot = 0  # the constant 1
        for i, factor in enumerate(factors):
            other = self.factor(factor)
            slot = other if i == 0 else self.step(_MULTIPLY, slot, other)
        return slot


@dataclass(frozen=True)
class TableParts:
    """An AeroModel as the core's table: steps (m, 6) of operation, a, b, knot, c, table; terms
    (k, 2) of coefficient and slot; the tables in the order in which steps number them.
    """

    steps: Array
    terms: Array
    tables: Mapping[str, LookupTable]


def table_parts(model: AeroModel) -> TableParts:
    """What the core's TermTable is made of.

    Raises BadInput where the model has more terms or products than the table holds.
    """
    slots = _Slots()
    places = AXES[model.axes]
    for c, term in model.terms:
        if c == LIFT:  # its products go before the step that takes it up
            slots.product(term.factors)
    terms = [(places.index(c), slots.product(term.factors)) for c, term in model.terms]
    if len(terms) > MAX_TERMS or len(slots.steps) > MAX_STEPS:
        raise refuse(
            "model_too_large",
            where=f"aerodynamic model '{model.name}'",
            expected=f"at most {MAX_TERMS} terms and {MAX_STEPS} distinct products",
            found=f"{len(terms)} terms and {len(slots.steps)} products",
            do="Remove terms that do not matter.",
        )
    return TableParts(
        np.array(slots.steps, dtype=np.float64).reshape(-1, 6),
        np.array(terms, dtype=np.float64).reshape(-1, 2),
        slots.tables,
    )


def to_table(model: AeroModel) -> Any:
    """The core's TermTable of a model; its values are `model.values`.

    Raises BadInput where the model has more terms or products than the table holds.
    """
    parts = table_parts(model)
    tables = [
        (
            list(t.breakpoints),
            np.ascontiguousarray(t.values).ravel(),
            t.interpolation == "cubic",
            t.outside == "line",
        )
        for t in parts.tables.values()
    ]
    if not tables:  # the last two columns are the lookups'
        return core.TermTable(np.ascontiguousarray(parts.steps[:, :4]), parts.terms)
    return core.TermTable(parts.steps, parts.terms, tables)


def evaluate_in_core(model: AeroModel, variables: Mapping[str, Array]) -> dict[str, Array]:
    """The coefficients (n,) as the core computes them, by name; see `AeroModel.evaluate`.

    A variable of the model that is missing is refused.
    """
    for _, term in model.terms:
        for factor in term.factors:
            if factor.variable != LIFT:
                factor.values(variables)  # refuses what is missing
    rows = np.zeros((len(next(iter(variables.values()))), 1 + len(VARIABLES)))
    rows[:, 0] = 1.0
    for j, name in enumerate(VARIABLES, start=1):
        if name in variables:
            rows[:, j] = variables[name]
    out = np.empty((len(rows), 6))
    to_table(model).evaluate(model.values, rows, out)
    return dict(zip(AXES[model.axes], out.T, strict=True))
