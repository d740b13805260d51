"""A DAVE-ML function as a lookup table of a model: SI, radians, Alula's signs."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.export.daveml_polynomial import Monomial, Polynomial, as_line
from alula.export.daveml_table import Axis, GriddedFunction
from alula.model import VARIABLES, Factor, LookupTable, lookup_table


@dataclass(frozen=True)
class Mirrored:
    """A table over |x|, spread over x: even as it is; odd where it is multiplied by sign(x)."""

    variable: str
    even: LookupTable
    odd: LookupTable | None  # None where it is not zero at x = 0: then the sign jumps


class Tables:
    """Makes the tables and keeps them by name."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.tables: dict[str, LookupTable] = {}
        self.mirrored: dict[str, Mirrored] = {}

    def factor(self, function: GriddedFunction, arguments: list[Polynomial]) -> Factor:
        """The factor of a function of these arguments; raises BadInput by the function's name."""
        where = f"{self.file}, function '{function.name}'"
        names, points, values = [], [], function.values
        mirror = None
        outside = {_outside(axis, where) for axis in function.axes}
        for i, (axis, argument) in enumerate(zip(function.axes, arguments, strict=True)):
            line = as_line(argument)
            if line is None or line[0].kind not in ("plain", "abs"):
                raise _refused(where, f"an argument '{axis.id}' that is not one variable")
            x, slope, at_zero = line
            b = axis.breakpoints / slope + at_zero
            if slope < 0.0:
                b, values = b[::-1], np.flip(values, i)
            if x.kind == "abs":
                if mirror is not None or b[0] != 0.0:
                    raise _refused(where, f"breakpoints over |{x.variable}| that begin at {b[0]:g}")
                mirror = (i, x.variable)
            names.append(x.variable)
            points.append(b)
        if len(outside) > 1:
            raise _refused(where, "axes that go on differently outside")
        if len(set(names)) < len(names):
            raise _refused(where, "two axes over one variable")
        name = self._name(function.output)
        how = outside.pop()

        def table(values: Array) -> LookupTable:
            axes = dict(zip(names, points, strict=True))
            return lookup_table(axes, values, outside=how, where=where)  # type: ignore[arg-type]

        if mirror is None:
            made = table(values)
        else:
            i, variable = mirror
            if how == "line":
                raise _refused(where, "a table over an absolute value that goes on outside")
            b = points[i]
            points[i] = np.concatenate([-b[:0:-1], b])
            inner = np.flip(np.delete(values, 0, axis=i), i)
            made = table(np.concatenate([inner, values], axis=i))
            odd = None
            if not np.take(values, 0, axis=i).any():
                odd = table(np.concatenate([-inner, values], axis=i))
            self.mirrored[name] = Mirrored(variable, made, odd)
        self.tables[name] = made
        return Factor(made.variables[0], kind="table", table=name, lookup=made)

    def without_signs(self, monomial: Monomial) -> Monomial:
        """sign(x) times a table over |x| as the odd table: it has the right slope at x = 0."""
        powers = dict(monomial)
        for f in list(powers):
            spread = self.mirrored.get(f.table)
            if spread is None or spread.odd is None or powers[f] != 1:
                continue
            sign = Factor(spread.variable, kind="sign")
            if powers.get(sign) != 1:
                continue
            del powers[sign], powers[f]
            name = re.sub(r"^abs_?(?=\w)", "", f.table)
            if name == f.table or (name in self.tables and self.tables[name] != spread.odd):
                name = f"{f.table}_odd"
            self.tables[name] = spread.odd
            powers[replace(f, table=name, lookup=spread.odd)] = 1
        return tuple(powers.items())

    def _name(self, text: str) -> str:
        name = re.sub(r"\W", "_", text, flags=re.ASCII)[:34]
        taken = {"abs", "sign", "p", "q", "r", *VARIABLES, *self.tables}
        name = name if re.match(r"[A-Za-z]", name) else f"t_{name}"
        while name in taken:
            name += "_t"
        return name


def _outside(axis: Axis, where: str) -> str:
    b = axis.breakpoints
    if axis.interpolate != "linear":
        raise _refused(where, f"interpolation '{axis.interpolate}'")
    held = (axis.low is None or axis.low <= b[0]) and (axis.high is None or axis.high >= b[-1])
    if axis.extrapolate == "neither" and held:
        return "hold"
    if axis.extrapolate == "both" and axis.low is None and axis.high is None:
        return "line"
    raise _refused(where, f"'{axis.id}' extrapolated to '{axis.extrapolate}' with its limits")


def _refused(where: str, found: str) -> BadInput:
    return refuse(
        "daveml_not_a_model",
        where=where,
        expected="tables over variables, linear, held or continued on all sides",
        found=found,
        do="This output cannot become terms of an aerodynamic model; leave it out with "
        "'outputs', or evaluate the file as it is.",
    )
