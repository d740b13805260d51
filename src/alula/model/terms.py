"""One term of an aerodynamic model: a product of powers, its name, its values.

Names: the coefficient, an underscore, and the factors in the order of `VARIABLES`. The constant is
'0'; `phat qhat rhat` read `p q r`, as the field writes them; powers follow their factor; |beta|
reads 'absbeta', the sign of beta 'signbeta'; a spline keeps its formula; a table goes last, by its
name. Products are joined by underscores: `Cm_0`, `Cm_q`, `CX_alpha2`, `CY_beta_dr`, `CY_absbeta`,
`CX_(alpha-0.2)+2`, `CX_cxt`, `Cm_q_cmq`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.model.lookup import LookupTable
from alula.model.variables import COEFFICIENTS, LIFT, SHORT, VARIABLES

__all__ = ["COEFFICIENTS", "LIFT", "VARIABLES", "Factor", "Kind", "Term", "product"]

Kind = Literal["plain", "abs", "sign", "ramp", "table"]
_ORDER = (*VARIABLES, LIFT)
_KIND_ORDER: dict[Kind, int] = {"plain": 0, "abs": 1, "ramp": 2, "sign": 3, "table": 4}


@dataclass(frozen=True)
class Factor:
    """A power of a variable, of its absolute value, its sign (0 at 0), its ramp
    max(variable - knot, 0), or of a table.

    variable: a table's first. table: its name; lookup: the table itself, which belongs to the
    model, so that factors of one name are equal.
    """

    variable: str
    power: int = 1
    kind: Kind = "plain"
    knot: float = 0.0
    table: str = ""
    lookup: LookupTable | None = field(default=None, compare=False, repr=False)

    @property
    def base(self) -> Factor:
        """The same factor to the first power."""
        return replace(self, power=1)

    @property
    def variables(self) -> tuple[str, ...]:
        """The variables it needs: one, or a table's, in the order of its axes."""
        return (self.variable,) if self.lookup is None else self.lookup.variables

    @property
    def label(self) -> str:
        """The factor as it stands in a parameter's name."""
        power = str(self.power) if self.power > 1 else ""
        short = SHORT.get(self.variable, self.variable)
        if self.kind == "table":
            return self.table + power
        if self.kind in ("abs", "sign"):
            return f"{self.kind}{short}{power}"
        if self.kind == "ramp":
            return f"({short}{_knot(self.knot, '')})+{power}"
        return short + power

    @property
    def formula(self) -> str:
        """The factor as a person writes it in a formula."""
        power = f"^{self.power}" if self.power > 1 else ""
        if self.kind == "table":
            return f"{self.table}({', '.join(self.variables)}){power}"
        if self.kind in ("abs", "sign"):
            return f"{self.kind}({self.variable}){power}"
        if self.kind == "ramp":
            return f"({self.variable}{_knot(self.knot, ' ')})+{power}"
        return self.variable + power

    def values(self, variables: Mapping[str, Array]) -> Array:
        """The factor's values; raises BadInput where its variable is missing."""
        given = [self._of(name, variables) for name in self.variables]
        x = given[0]
        if self.lookup is not None:
            x = self.lookup.evaluate(*given)
        elif self.kind == "abs":
            x = np.abs(x)
        elif self.kind == "sign":
            x = np.sign(x)
        elif self.kind == "ramp":
            x = np.maximum(x - self.knot, 0.0)
        out = x
        for _ in range(self.power - 1):  # products, as the core does it: the same rounding
            out = out * x
        return out

    def _of(self, name: str, variables: Mapping[str, Array]) -> Array:
        try:
            return variables[name]
        except KeyError:
            raise refuse(
                "missing_variable",
                where=f"model term '{self.formula}'",
                expected=f"values of '{name}'",
                found=", ".join(sorted(variables)) or "no variables",
                do=f"Map the channel that gives '{name}', or drop the term.",
            ) from None


@dataclass(frozen=True)
class Term:
    """A product of factors, in canonical order; no factors: the constant 1.

    reference_scale: the size below which the parameter's value does not matter, as the formula
    states it (`beta~0.01`), or None.
    """

    factors: tuple[Factor, ...] = ()
    reference_scale: float | None = None

    @property
    def needs_lift(self) -> bool:
        """Whether the lift coefficient is one of its factors."""
        return any(f.variable == LIFT for f in self.factors)

    @property
    def label(self) -> str:
        """The term as it stands behind the coefficient in a parameter's name."""
        return "_".join(f.label for f in self.factors) or "0"

    @property
    def formula(self) -> str:
        """The term as a person writes it."""
        text = "*".join(f.formula for f in self.factors) or "1"
        return text if self.reference_scale is None else f"{text}~{self.reference_scale!r}"

    def name(self, coefficient: str) -> str:
        """The parameter's name, such as 'Cm_alpha'."""
        return f"{coefficient}_{self.label}"

    def values(self, variables: Mapping[str, Array]) -> Array:
        """The term's values; a scalar-shaped 1.0 for the constant."""
        out: Array = np.asarray(1.0)
        for i, factor in enumerate(self.factors):
            x = factor.values(variables)
            out = x if i == 0 else out * x
        return out


def product(factors: list[Factor], reference_scale: float | None = None) -> Term:
    """The term of these factors: equal bases joined, in canonical order."""
    powers: dict[Factor, int] = {}
    for factor in factors:
        powers[factor.base] = powers.get(factor.base, 0) + factor.power

    def place(f: Factor) -> tuple[bool, int, int, float, str]:
        kind = _KIND_ORDER[f.kind]
        return (f.kind == "table", _ORDER.index(f.variable), kind, f.knot, f.table)

    joined = tuple(replace(f, power=powers[f]) for f in sorted(powers, key=place))
    return Term(joined, reference_scale)


def _knot(knot: float, space: str) -> str:
    sign = "-" if knot >= 0.0 else "+"
    return f"{space}{sign}{space}{abs(knot)!r}"
