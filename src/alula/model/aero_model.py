"""The aerodynamic model of an aircraft: the one currency between stages.

Prediction and identification make it; simulation, export and firmware take it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.model.grammar import check_lift, parse
from alula.model.lookup import LookupTable, check_table_name
from alula.model.stall import STALL_KEYS, Stall, check_stall
from alula.model.terms import LIFT, Term

Axes = Literal["body", "stability"]

# The coefficients of each set of axes, in the order of the core's six places.
AXES: dict[Axes, tuple[str, ...]] = {
    "body": ("CX", "CY", "CZ", "Cl", "Cm", "Cn"),
    "stability": ("CD", "CY", "CL", "Cl", "Cm", "Cn"),
}


@dataclass(frozen=True)
class Reference:
    """Reference area S (m2), full span b (m) and chord c (m) of the coefficients."""

    S: float
    b: float
    c: float


@dataclass(frozen=True)
class AeroModel:
    """Coefficients as sums of values times terms.

    terms: (coefficient, term) pairs; values: (k,), one per term; covariance: (k, k) of the values,
    None where it is not known. axes: 'body' for CX CZ, 'stability' for CD CL; CY and the moments
    are about body axes in both. reference_point: (3,) m, where the moments act, in the aircraft
    file's datum frame (body axes). validity: range of each variable the values were found in (SI,
    rad). assumed: names of parameters whose value is assumed, of the stall's as 'stall.a1'.
    provenance: where the values come from, in words and hashes. tables: what the terms look up, by
    name. stall: what separated flow takes from the terms, which are then the attached flow's.
    """

    name: str
    axes: Axes
    terms: tuple[tuple[str, Term], ...]
    values: Array
    reference: Reference
    covariance: Array | None = None
    reference_point: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    validity: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    assumed: tuple[str, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)
    tables: Mapping[str, LookupTable] = field(default_factory=dict)
    stall: Stall | None = None

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of `values`."""
        return tuple(term.name(coefficient) for coefficient, term in self.terms)

    @property
    def coefficients(self) -> tuple[str, ...]:
        """The coefficients that have terms, in the order of the axes."""
        present = {coefficient for coefficient, _ in self.terms}
        return tuple(c for c in AXES[self.axes] if c in present)

    @property
    def formulas(self) -> dict[str, str]:
        """One formula per coefficient, as a person writes it."""
        return {
            c: " + ".join(term.formula for name, term in self.terms if name == c)
            for c in self.coefficients
        }

    @property
    def params(self) -> dict[str, float]:
        """The values by parameter name."""
        return dict(zip(self.names, self.values.tolist(), strict=True))

    def evaluate(self, variables: Mapping[str, Array]) -> dict[str, Array]:
        """The coefficients (n,) for variables (n,) by name; a missing variable is refused.

        With a stall they are the attached flow's.
        """
        n = np.broadcast_shapes(*(np.shape(v) for v in variables.values()))
        out = {c: np.zeros(n) for c in AXES[self.axes]}
        known = {**variables, LIFT: out[LIFT]} if self.axes == "stability" else variables
        valued = list(zip(self.terms, self.values, strict=True))
        for (coefficient, term), value in sorted(valued, key=lambda item: item[0][0] != LIFT):
            out[coefficient] += value * term.values(known)  # lift first: the drag may need it
        return out

    def check_without_lift(self, consumer: str) -> None:
        """Raise BadInput where the drag uses the lift coefficient: `consumer` cannot."""
        if self.needs_lift:
            raise refuse(
                "lift_in_drag",
                where=f"aerodynamic model '{self.name}', CD",
                expected=f"a drag of alpha and the controls for {consumer}",
                found=self.formulas["CD"],
                do="Identify the drag as '1 + alpha + alpha^2' for this export.",
            )

    def check_without_wash(self, consumer: str) -> None:
        """Raise BadInput where a term uses the slipstream's wash: `consumer` cannot know it."""
        if any("wash" in f.variables for _, term in self.terms for f in term.factors):
            raise refuse(
                "wash_in_model",
                where=f"aerodynamic model '{self.name}'",
                expected=f"terms without the propeller's slipstream for {consumer}",
                found="the variable 'wash'",
                do="Export the tables for the flight computer, or a model without propwash.",
            )

    @property
    def needs_lift(self) -> bool:
        """Whether the drag's terms use the lift coefficient."""
        return any(term.needs_lift for _, term in self.terms)


def aero_model(
    name: str,
    formulas: Mapping[str, str],
    values: Mapping[str, float],
    reference: Reference,
    *,
    axes: Axes = "body",
    covariance: Array | None = None,
    reference_point: Array | None = None,
    validity: Mapping[str, tuple[float, float]] | None = None,
    assumed: tuple[str, ...] = (),
    provenance: Mapping[str, str] | None = None,
    tables: Mapping[str, LookupTable] | None = None,
    stall: Stall | None = None,
) -> AeroModel:
    """An AeroModel from formulas by coefficient and values by parameter name.

    covariance: (k, k) in the order of `values`. Raises BadInput where a formula cannot be read, a
    coefficient does not belong to the axes, a parameter has no finite value, a value has no
    parameter, two terms share a name, or the stall's values are impossible.
    """
    where = f"aerodynamic model '{name}'"
    tables = dict(tables or {})
    for table in tables:
        check_table_name(table, where)
    if stall is not None:
        check_stall(stall, where)
    for coefficient in formulas:
        if coefficient not in AXES[axes]:
            raise refuse(
                "unknown_coefficient",
                where=where,
                expected=f"{', '.join(AXES[axes])} in {axes} axes",
                found=f"'{coefficient}'",
                do="Use the coefficients of one set of axes, or state axes = 'stability'.",
            )
    terms = tuple(
        (c, term) for c in AXES[axes] if c in formulas for term in parse(formulas[c], tables)
    )
    for c, term in terms:
        check_lift(c, [term], f"{where}, {c}")
    names = [term.name(c) for c, term in terms]
    _check_once(names, where)
    given = list(values)
    without = [n for n in names if n not in values or not np.isfinite(values[n])]
    if without or len(given) != len(names):
        extra = [n for n in given if n not in names]
        raise refuse(
            "model_values",
            where=where,
            expected=f"one finite value for each of {', '.join(names)}",
            found=f"none for {', '.join(without) or 'no term'}; "
            f"without a term: {', '.join(extra) or 'none'}",
            do="Give each term of the formulas its value, and each value its term.",
        )
    known = names if stall is None else [*names, *(f"stall.{key}" for key in STALL_KEYS)]
    for label in assumed:
        if label not in known:
            raise refuse(
                "unknown_parameter",
                where=f"{where}, assumed",
                expected=f"one of {', '.join(known)}",
                found=f"'{label}'",
                do="Correct the name or remove it.",
            )
    if not all(np.isfinite(x) and x > 0.0 for x in (reference.S, reference.b, reference.c)):
        raise refuse(
            "reference_geometry",
            where=where,
            expected="positive S (m2), b (m) and c (m)",
            found=f"S = {reference.S}, b = {reference.b}, c = {reference.c}",
            do="Give the reference area, the full span and the chord of the coefficients.",
        )
    for variable, (low, high) in (validity or {}).items():
        if not low <= high:
            raise refuse(
                "bad_validity",
                where=f"{where}, validity of {variable}",
                expected="the lowest and the highest value, in that order",
                found=f"[{low:g}, {high:g}]",
                do="Give the range in which the values were found, in SI and rad.",
            )
    return AeroModel(
        name=name,
        axes=axes,
        terms=terms,
        values=frozen([values[n] for n in names]),
        reference=reference,
        covariance=_reordered(covariance, given, names, where),
        reference_point=frozen(np.zeros(3) if reference_point is None else reference_point),
        validity=dict(validity or {}),
        assumed=assumed,
        provenance=dict(provenance or {}),
        tables=tables,
        stall=stall,
    )


def _check_once(names: list[str], where: str) -> None:
    twice = next((n for i, n in enumerate(names) if n in names[:i]), None)
    if twice is not None:  # a table called 'alpha_de' beside a product alpha*de
        raise refuse(
            "model_values",
            where=where,
            expected="one name for each term",
            found=f"two terms named '{twice}'",
            do="Rename the table whose name reads like a product.",
        )


def _reordered(
    covariance: Array | None, given: list[str], names: list[str], where: str
) -> Array | None:
    """The covariance in the order of the terms; refused where it is not one."""
    if covariance is None:
        return None
    k = len(names)
    matrix = np.asarray(covariance, dtype=np.float64)
    good = (
        matrix.shape == (k, k)
        and bool(np.isfinite(matrix).all())
        and np.allclose(matrix, matrix.T, rtol=1e-9, atol=0.0)  # written with all digits
        and bool((np.diagonal(matrix) >= 0.0).all())
    )
    if not good:
        raise refuse(
            "model_covariance",
            where=where,
            expected=f"a finite symmetric {k} x {k} matrix with no negative variance",
            found=f"an array of shape {matrix.shape} that is not one",
            do="Give rows and columns in the order of the values, or leave the covariance out.",
        )
    order = [given.index(n) for n in names]
    return frozen(matrix[np.ix_(order, order)])
