"""A DAVE-ML model as values: variables, functions, check cases; its evaluation.

AIAA S-119-2011 (DAVE-ML 2.0).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse
from alula.export.daveml_expression import Expression
from alula.export.daveml_table import GriddedFunction

# Internal values of a check case come without a tolerance; this much of the value (or of one)
# covers the digits they are printed with.
_INTERNAL_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Uncertainty:
    """How sure a value is: effect as the standard's word ('additive', 'percentage', ...).

    sigma: one standard deviation of a normal distribution, or None for a uniform one. bounds: as
    written. correlations: coefficient by the other's varID.
    """

    effect: str
    sigma: float | None
    bounds: tuple[float, ...]
    correlations: Mapping[str, float]


@dataclass(frozen=True)
class DaveVariable:
    """A signal of the model; its value is in `units` and positive as `sign` says."""

    id: str
    name: str
    units: str
    sign: str
    description: str
    initial: float | None
    low: float | None
    high: float | None
    calculation: Expression | None
    is_input: bool
    is_output: bool
    is_standard: bool
    uncertainty: Uncertainty | None


@dataclass(frozen=True)
class CheckSignal:
    """One signal of a check case, by varID; tolerance: None where none is stated."""

    id: str
    units: str | None
    value: float
    tolerance: float | None


@dataclass(frozen=True)
class CheckCase:
    """A static shot: inputs, and what must come out."""

    name: str
    inputs: tuple[CheckSignal, ...]
    internal: tuple[CheckSignal, ...]
    outputs: tuple[CheckSignal, ...]


@dataclass(frozen=True)
class Checked:
    """One signal of one check case: expected, found, tolerance, in the signal's units."""

    case: str
    id: str
    expected: float
    found: float
    tolerance: float

    @property
    def passed(self) -> bool:
        """Whether it is within the tolerance."""
        return abs(self.found - self.expected) <= self.tolerance


@dataclass(frozen=True)
class DaveModel:
    """A DAVE-ML model. header: name, author, date, version, description of the file.

    references, modifications: by their identifiers, in words. messages: what the reader noticed.
    """

    path: str
    sha256: str
    header: Mapping[str, str]
    references: Mapping[str, str]
    modifications: Mapping[str, str]
    variables: Mapping[str, DaveVariable]
    functions: tuple[GriddedFunction, ...]
    cases: tuple[CheckCase, ...]
    messages: tuple[Message, ...] = ()

    @property
    def inputs(self) -> tuple[DaveVariable, ...]:
        """The signals that must be given."""
        return tuple(v for v in self.variables.values() if v.is_input)

    @property
    def outputs(self) -> tuple[DaveVariable, ...]:
        """The signals that the model gives."""
        return tuple(v for v in self.variables.values() if v.is_output)

    def by_name(self, name: str) -> DaveVariable:
        """The variable of this varID or name; raises BadInput for an unknown one."""
        if name in self.variables:
            return self.variables[name]
        for v in self.variables.values():
            if v.name == name:
                return v
        raise refuse(
            "daveml_signal",
            where=self.path,
            expected=f"one of {', '.join(self.variables)}",
            found=f"'{name}'",
            do="Use a varID or name of the file.",
        )

    def order(self) -> tuple[str, ...]:
        """The varIDs so that each comes behind what it is made of; raises BadInput on a circle."""
        made = {f.output: f for f in self.functions}
        graph = {
            v.id: (
                {axis.id for axis in made[v.id].axes}
                if v.id in made
                else (v.calculation.names() if v.calculation else set())
            )
            for v in self.variables.values()
        }
        try:
            return tuple(TopologicalSorter(graph).static_order())
        except CycleError as error:
            raise refuse(
                "daveml_circle",
                where=self.path,
                expected="calculations that end in inputs and constants",
                found=" from ".join(error.args[1]),
                do="Break the circle.",
            ) from None

    def evaluate(self, inputs: Mapping[str, Array | float]) -> dict[str, Array]:
        """The outputs (n,) by varID for inputs (n,) by varID or name, in the file's units."""
        values = self.values(inputs)
        return {v.id: values[v.id] for v in self.outputs}

    def values(self, inputs: Mapping[str, Array | float]) -> dict[str, Array]:
        """Every signal (n,) by varID; see `evaluate`. An input without a value is refused."""
        given = {self.by_name(n).id: np.asarray(x, dtype=np.float64) for n, x in inputs.items()}
        made = {f.output: f for f in self.functions}
        values: dict[str, Array] = {}
        # Branches that are not taken may divide by zero.
        with np.errstate(all="ignore"):
            for name in self.order():
                v = self.variables[name]
                if name in given:
                    x = given[name]
                elif name in made:
                    f = made[name]
                    x = f.evaluate(*(values[axis.id] for axis in f.axes))
                elif v.calculation is not None:
                    x = v.calculation.evaluate(values)
                elif v.initial is not None:
                    x = np.asarray(v.initial)
                else:
                    raise refuse(
                        "daveml_signal",
                        where=self.path,
                        expected=f"a value of the input '{v.id}' ({v.name}, {v.units})",
                        found="none",
                        do="Give it.",
                    )
                if v.low is not None:
                    x = np.maximum(x, v.low)
                if v.high is not None:
                    x = np.minimum(x, v.high)
                values[name] = x
        return values

    def check(self) -> tuple[Checked, ...]:
        """Every signal of every check case that the file carries; none where it carries none.

        Internal values without a tolerance are held to 1e-6 of the value, or of one.
        """
        found = []
        for case in self.cases:
            values = self.values({s.id: s.value for s in case.inputs})
            for signal in (*case.internal, *case.outputs):
                tolerance = signal.tolerance
                if tolerance is None:
                    tolerance = _INTERNAL_TOLERANCE * max(1.0, abs(signal.value))
                x = float(values[signal.id])
                found.append(Checked(case.name, signal.id, signal.value, x, tolerance))
        return tuple(found)
