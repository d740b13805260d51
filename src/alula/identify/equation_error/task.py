"""One coefficient's formula on the maneuvers that serve it: what every regression starts from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn
from alula.identify.coefficients import CoefficientData
from alula.identify.regression.regress import Block
from alula.identify.typical import constant_name
from alula.model import LIFT, parse, regressors

LONGITUDINAL = frozenset({"CX", "CZ", "CD", "CL", "Cm"})
MOMENTS = frozenset({"Cl", "Cm", "Cn"})


def need_models(models: Mapping[str, str]) -> None:
    """Refuse an identification that is asked for nothing."""
    if not models:
        raise refuse(
            "no_model",
            where="models",
            expected="a formula for at least one coefficient",
            found="none",
            do='State one, e.g. Cm = "1 + alpha + qhat + de".',
        )


class CoefficientTask:
    """Parameter names and regressor blocks of one coefficient's formula.

    names: (k,) of the parameters, the maneuvers' own constants first where they have their own.
    free: those names that are constant terms. terms: the formula's own names. formula_terms: what
    they are made of.
    """

    def __init__(
        self,
        coefficient: str,
        formula: str,
        learn: tuple[CoefficientData, ...],
        common: bool,
    ) -> None:
        self.coefficient, self.formula, self.learn = coefficient, formula, learn
        self.formula_terms = parse(formula)
        terms, _ = regressors(coefficient, formula, variables_of(learn[0]))
        self.terms = tuple(terms)
        self.constant = constant_name(coefficient)
        self.split = self.constant in self.terms and len(learn) > 1 and not common
        self.shared = tuple(n for n in self.terms if n != self.constant or not self.split)
        own = tuple(f"{self.constant}[{d.maneuver.id}]" for d in learn) if self.split else ()
        self.names = (*own, *self.shared)
        self.free = own or tuple(n for n in self.terms if n == self.constant)

    def terms_of(self, item: CoefficientData, variables: Mapping[str, Array]) -> Array:
        """The formula's regressors (n, k) in the order of `terms`, smoothed as the measured side:
        beside a smoothed moment sharper regressors would draw every estimate toward zero.
        """
        names, matrix = regressors(self.coefficient, self.formula, variables)
        assert tuple(names) == self.terms  # a formula's terms do not depend on the data
        return self.smoothed(item, matrix)

    def smoothed(self, item: CoefficientData, matrix: Array) -> Array:
        """Regressors (n, k) through the filter that the measured coefficient has passed."""
        if item.cubic is None or self.coefficient not in MOMENTS:
            return matrix
        return item.cubic.matched(matrix)

    def blocks(self, source: str | None) -> list[Block]:
        """One block per maneuver, as it was or as `source` would have had it."""
        out = []
        for i, item in enumerate(self.learn):
            coefficients, variables = item.coefficients, item.variables
            for way in item.perturbed:
                if way.source == source:
                    coefficients, variables = way.coefficients, way.variables
            variables = _with_lift(variables, coefficients)
            measured = coefficients[self.coefficient]
            matrix = self._spread(i, self.terms_of(item, variables))
            sharp = None
            if item.cubic is not None and source is None:
                sharp = self._spread(i, self.terms_of(replace(item, cubic=None), variables))
            out.append(Block(matrix, measured, sharp))
        return out

    def _spread(self, i: int, matrix: Array) -> Array:
        """Regressors (n, k) in the order of `names`, for maneuver i."""
        if not self.split:
            return matrix
        own = np.zeros((len(matrix), len(self.learn)))
        own[:, i] = 1.0
        keep = [j for j, name in enumerate(self.terms) if name in self.shared]
        return np.hstack([own, matrix[:, keep]])


def variables_of(item: CoefficientData) -> Mapping[str, Array]:
    """The variables of a formula: also the measured lift, which the drag's may name."""
    return _with_lift(item.variables, item.coefficients)


def _with_lift(
    variables: Mapping[str, Array], coefficients: Mapping[str, Array]
) -> Mapping[str, Array]:
    return {**variables, LIFT: coefficients[LIFT]} if LIFT in coefficients else variables


def serving(data: Sequence[CoefficientData], coefficient: str) -> list[CoefficientData]:
    """The maneuvers of the coefficient's aspect; refuses where none is left to learn from."""
    aspect = "longitudinal" if coefficient in LONGITUDINAL else "lateral"
    serving = [item for item in data if item.maneuver.aspect in (aspect, "both")]
    if not any(not item.maneuver.held_out for item in serving):
        raise refuse(
            "no_maneuver",
            where=f"model of {coefficient}",
            expected=f"a {aspect} maneuver (or 'both') that is not held out",
            found=", ".join(f"{d.maneuver.id} ({d.maneuver.aspect})" for d in data) or "none",
            do="Set a maneuver's aspect or held_out, or take the model out.",
        )
    for item in serving:
        if coefficient not in item.coefficients:
            raise refuse(
                "missing_coefficient",
                where=f"maneuver {item.maneuver.id}",
                expected=f"coefficient '{coefficient}'",
                found=", ".join(item.coefficients),
                do="Map it in [channels], or model one of those found.",
            )
    return serving


def uneven(item: CoefficientData) -> list[Message]:
    """A warning where samples are not evenly spaced, as the autocorrelation takes them to be."""
    steps = np.diff(item.t)
    usual = float(np.median(steps)) if len(steps) else 0.0
    odd = int(np.sum(np.abs(steps - usual) > 0.5 * abs(usual)))
    if not odd:
        return []
    return [
        warn(
            "uneven_time",
            where=f"maneuver {item.maneuver.id}",
            expected=f"samples every {usual:.4g} s",
            found=f"{odd} of {len(steps)} steps off by more than half, the longest "
            f"{steps.max():.4g} s",
            do="Split the maneuver there; the coloured standard errors take samples as even.",
        )
    ]
