"""One term of an aerodynamic model: a product of powers, its name, its values.

Names: the coefficient, an underscore, and the factors in the order of `VARIABLES`. The constant is
'0'; `phat qhat rhat` read `p q r`, as the field writes them; powers follow their factor; |beta|
reads 'absbeta'; a spline keeps its formula. Products are joined by underscores: `Cm_0`, `Cm_q`,
`CX_alpha2`, `CY_beta_dr`, `CY_absbeta`, `CX_(alpha-0.2)+2`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse

# The base variables in the order of the core's slots 1 to 12; slot 0 is the constant 1.
# V in m/s, angles in rad, rates as pb/2V, qc/2V, rb/2V, dt 0 to 1.
VARIABLES = (
    "V", "alpha", "beta", "phat", "qhat", "rhat", "de", "da", "dr", "df", "dt", "mach",
)  # fmt: skip
COEFFICIENTS = ("CX", "CY", "CZ", "Cl", "Cm", "Cn", "CD", "CL")
_SHORT = {"phat": "p", "qhat": "q", "rhat": "r"}

Kind = Literal["plain", "abs", "ramp"]
_KIND_ORDER: dict[Kind, int] = {"plain": 0, "abs": 1, "ramp": 2}


@dataclass(frozen=True)
class Factor:
    """A power of a variable, of its absolute value, or of its ramp max(variable - knot, 0)."""

    variable: str
    power: int = 1
    kind: Kind = "plain"
    knot: float = 0.0

    @property
    def base(self) -> Factor:
        """The same factor to the first power."""
        return Factor(self.variable, 1, self.kind, self.knot)

    @property
    def label(self) -> str:
        """The factor as it stands in a parameter's name."""
        power = str(self.power) if self.power > 1 else ""
        short = _SHORT.get(self.variable, self.variable)
        if self.kind == "abs":
            return f"abs{short}{power}"
        if self.kind == "ramp":
            return f"({short}{_knot(self.knot, '')})+{power}"
        return short + power

    @property
    def formula(self) -> str:
        """The factor as a person writes it in a formula."""
        power = f"^{self.power}" if self.power > 1 else ""
        if self.kind == "abs":
            return f"abs({self.variable}){power}"
        if self.kind == "ramp":
            return f"({self.variable}{_knot(self.knot, ' ')})+{power}"
        return self.variable + power

    def values(self, variables: Mapping[str, Array]) -> Array:
        """The factor's values; raises BadInput where its variable is missing."""
        try:
            x = variables[self.variable]
        except KeyError:
            raise refuse(
                "missing_variable",
                where=f"model term '{self.formula}'",
                expected=f"values of '{self.variable}'",
                found=", ".join(sorted(variables)) or "no variables",
                do=f"Map the channel that gives '{self.variable}', or drop the term.",
            ) from None
        if self.kind == "abs":
            x = np.abs(x)
        elif self.kind == "ramp":
            x = np.maximum(x - self.knot, 0.0)
        out = x
        for _ in range(self.power - 1):  # products, as the core does it: the same rounding
            out = out * x
        return out


@dataclass(frozen=True)
class Term:
    """A product of factors, in canonical order; no factors: the constant 1.

    reference_scale: the size below which the parameter's value does not matter, as the formula
    states it (`beta~0.01`), or None.
    """

    factors: tuple[Factor, ...] = ()
    reference_scale: float | None = None

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
    order = sorted(powers, key=lambda f: (VARIABLES.index(f.variable), _KIND_ORDER[f.kind], f.knot))
    joined = tuple(Factor(f.variable, powers[f], f.kind, f.knot) for f in order)
    return Term(joined, reference_scale)


def _knot(knot: float, space: str) -> str:
    sign = "-" if knot >= 0.0 else "+"
    return f"{space}{sign}{space}{abs(knot)!r}"
