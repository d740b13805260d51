"""A DAVE-ML calculation as a sum of products of a model's factors."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from alula.base.messages import BadInput, refuse
from alula.export.daveml_expression import RELATIONS, Expression
from alula.export.daveml_polynomial import (
    Polynomial,
    add,
    as_constant,
    as_line,
    constant,
    multiply,
    scaled,
    single,
)
from alula.model import Factor


class Expander:
    """Expands expressions over `polynomials` by varID, which the caller fills in order.

    lengths: b for 'p' and 'r', c for 'q', in m. where: the variable's place, for messages.
    """

    def __init__(self, lengths: Mapping[str, float], file: str) -> None:
        self.lengths = lengths
        self.polynomials: dict[str, Polynomial] = {}
        self.file = file
        self.where = file

    def variable(self, name: str, expression: Expression) -> Polynomial:
        """The polynomial of a variable; raises BadInput by its name where there is none."""
        self.where = f"{self.file}, variableDef '{name}'"
        try:
            return self.expand(expression)
        except OverflowError:
            raise self.refused("more than 2000 products") from None

    def expand(self, e: Expression) -> Polynomial:
        """The polynomial of an expression."""
        if e.op == "cn":
            return constant(e.value)
        if e.op == "ci":
            return self.polynomials[e.name]
        if e.op == "piecewise":
            return self.piecewise(e)
        args = [self.expand(a) for a in e.args]
        values = [as_constant(a) for a in args]
        if e.op == "minus":
            return scaled(args[0], -1.0) if len(args) == 1 else add(args[0], scaled(args[1], -1.0))
        if e.op == "plus":
            out = args[0]
            for a in args[1:]:
                out = add(out, a)
            return out
        if e.op == "times":
            out = args[0]
            for a in args[1:]:
                out = multiply(out, a, self.lengths)
            return out
        if e.op == "divide":
            return multiply(args[0], self.inverse(args[1]), self.lengths)
        if e.op == "power" and values[1] is not None:
            return self.power(args[0], values[1].value)
        if all(v is not None for v in values):
            return self.number(e, [v.value for v in values if v is not None], args)
        if e.op in ("max", "min"):
            out = args[0]
            for a in args[1:]:
                out = self.larger(out, a) if e.op == "max" else self.smaller(out, a)
            return out
        if e.op == "abs":
            return self.absolute(args[0])
        raise self.refused(f"'{e.op}' of a variable")

    def number(self, e: Expression, values: list[float], args: list[Polynomial]) -> Polynomial:
        if any(v.slopes for a in args for v in a.values()):
            raise self.refused(f"'{e.op}' of an uncertain constant")
        names = {f"x{i}": np.asarray(v) for i, v in enumerate(values)}
        with np.errstate(all="ignore"):
            found = float(
                Expression(e.op, tuple(Expression("ci", name=n) for n in names)).evaluate(names)
            )
        if not np.isfinite(found):
            raise self.refused(f"'{e.op}' that has no finite value")
        return constant(found)

    def inverse(self, a: Polynomial) -> Polynomial:
        if len(a) != 1:
            raise self.refused("a division by a sum" if a else "a division by zero")
        ((monomial, value),) = a.items()
        if value.value == 0.0 or any(f.kind != "plain" for f, _ in monomial):
            raise self.refused("a division by a table, an absolute value or zero")
        return {tuple((f, -k) for f, k in monomial): value.inverse()}

    def power(self, a: Polynomial, exponent: float) -> Polynomial:
        if exponent != round(exponent) or abs(exponent) > 9:
            known = as_constant(a)
            if known is not None and not known.slopes and known.value > 0.0:
                return constant(known.value**exponent)
            raise self.refused(f"the power {exponent:g} of a variable")
        base = a if exponent >= 0 else self.inverse(a)
        out = constant(1.0)
        for _ in range(abs(round(exponent))):
            out = multiply(out, base, self.lengths)
        return out

    def absolute(self, a: Polynomial) -> Polynomial:
        line = as_line(a)
        if line is None or line[2] != 0.0 or line[0].kind not in ("plain", "abs"):
            raise self.refused("the absolute value of more than one variable")
        return single(Factor(line[0].variable, kind="abs"), abs(line[1]))

    def larger(self, a: Polynomial, b: Polynomial) -> Polynomial:
        """max(a, b) is b + max(a - b, 0)."""
        return add(b, self.positive(add(a, scaled(b, -1.0))))

    def smaller(self, a: Polynomial, b: Polynomial) -> Polynomial:
        """min(a, b) is a - max(a - b, 0)."""
        return add(a, scaled(self.positive(add(a, scaled(b, -1.0))), -1.0))

    def positive(self, a: Polynomial) -> Polynomial:
        """max(a, 0) of a line k (x - c): a spline; for k < 0, k (x - c) - k (x - c)+."""
        known = as_constant(a)
        if known is not None:
            return a if known.value > 0.0 else constant(0.0)
        line = as_line(a)
        if line is None or line[0].kind != "plain":
            raise self.refused("min or max of more than one variable")
        x, slope, knot = line
        ramp = single(Factor(x.variable, kind="ramp", knot=knot), abs(slope))
        return ramp if slope > 0.0 else add(a, ramp)

    def piecewise(self, e: Expression) -> Polynomial:
        """Branches by the sign of one variable: their mean and, signed, half their difference."""
        conditions = e.args[1:-1:2]
        if len(e.args) not in (3, 5) or any(c.op not in RELATIONS[:4] for c in conditions):
            raise self.refused("a piecewise with more branches or another condition")
        differences = []
        for c in conditions:
            left, right = (self.expand(a) for a in c.args)
            differences.append(add(left, scaled(right, -1.0)))
        condition, difference = conditions[0], differences[0]
        first, second = self.expand(e.args[0]), self.expand(e.args[2])
        known = as_constant(difference)
        if known is not None and len(conditions) == 1:
            return first if self.holds(condition.op, known.value) else second
        line = as_line(difference)
        if line is None or line[2] != 0.0 or line[0].kind != "plain":
            raise self.refused("a piecewise whose condition is not the sign of one variable")
        if len(conditions) == 2:  # below, above, and the mean of both at zero
            opposite = as_line(differences[1]) == line and {c.op for c in conditions} == {
                "lt",
                "gt",
            }
            middle = scaled(add(first, second), -0.5)
            if not opposite or add(self.expand(e.args[4]), middle):
                raise self.refused("a piecewise of three branches that is not a sign")
        above = (line[1] > 0.0) == (condition.op in ("gt", "geq"))  # the first branch holds there
        high, low = (first, second) if above else (second, first)
        mean = scaled(add(high, low), 0.5)
        half = scaled(add(high, scaled(low, -1.0)), 0.5)
        sign = single(Factor(line[0].variable, kind="sign"))
        return add(mean, multiply(half, sign, self.lengths))

    @staticmethod
    def holds(relation: str, difference: float) -> bool:
        zero = np.asarray(0.0)
        names = {"a": np.asarray(difference), "b": zero}
        args = (Expression("ci", name="a"), Expression("ci", name="b"))
        return bool(Expression(relation, args).evaluate(names))

    def refused(self, found: str) -> BadInput:
        return refuse(
            "daveml_not_a_model",
            where=self.where,
            expected="sums of products of constants, tables, powers, absolute values, signs and "
            "splines of the variables",
            found=found,
            do="This output cannot become terms of an aerodynamic model; leave it out with "
            "'outputs', or evaluate the file as it is.",
        )
