"""Equation error: regress each aerodynamic coefficient on motion and controls.

Dittrich 2016, Eq. (3.46) to (3.48); van den Hoek 2017, Eq. (28) to (31). Error bars: coloured
residuals (coloured.py), and for each source of uncertainty outside the regression (reconstruction,
thrust) the change of the estimate when that source is one standard deviation off, squared and
added.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.identify.coefficients import CoefficientData
from alula.identify.regression import Block, Regression, Weighting, regress
from alula.identify.result import Fit, Identification, Parameter, Series
from alula.identify.typical import constant_name
from alula.identify.verdict import assess
from alula.model import LIFT, reference_scales, regressors

LONGITUDINAL = frozenset({"CX", "CZ", "CD", "CL", "Cm"})
MOMENTS = frozenset({"Cl", "Cm", "Cn"})


def identify_equation_error(
    data: Sequence[CoefficientData],
    models: Mapping[str, str],
    *,
    weighting: Weighting = "residual",
    common_constant: bool = False,
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Derivatives of every coefficient in `models`, shared by all maneuvers that serve it.

    data: one entry per maneuver, held-out ones among them. models: formula by coefficient, e.g.
    {"Cm": "1 + alpha + qhat + de"}. weighting: of maneuvers, see regression.py. common_constant:
    one constant term for all maneuvers instead of one each. scales: standard errors that are good
    enough, by parameter name. truth: true values where they are known, carried along.

    Only maneuvers of the coefficient's aspect are used. A held-out maneuver is predicted with
    the derivatives of the others; its constant term, which belongs to its trim, is taken from
    itself. Raises BadInput for a coefficient that the data do not have, a formula that cannot be
    read, no maneuver to learn from, or no more samples than parameters.
    """
    if not models:
        raise refuse(
            "no_model",
            where="models",
            expected="a formula for at least one coefficient",
            found="none",
            do='State one, e.g. Cm = "1 + alpha + qhat + de".',
        )
    if weighting not in ("residual", "equal"):
        raise refuse(
            "unknown_option",
            where="weighting",
            expected="'residual' or 'equal'",
            found=repr(weighting),
            do="Weight maneuvers by their residual variance, or all the same.",
        )
    fits: dict[str, Fit] = {}
    parameters: list[Parameter] = []
    series: list[Series] = []
    messages: list[Message] = [m for item in data for m in (*item.messages, *_uneven(item))]
    parts: list[Array] = []
    changes: list[dict[str, Array]] = []
    for coefficient, formula in models.items():
        serving = _serving(data, coefficient)
        learn = [item for item in serving if not item.maneuver.held_out]
        task = _Task(coefficient, formula, tuple(learn), common_constant)
        fit = regress(task.names, task.blocks(None), weighting)
        change = {
            source: fit.refit(task.blocks(source)) - fit.solution.value
            for source in dict.fromkeys(p.source for item in learn for p in item.perturbed)
        }
        added = sum((np.outer(d, d) for d in change.values()), np.zeros((len(task.names),) * 2))
        enough = {**reference_scales(coefficient, formula), **(scales or {})}
        assessed, remarks = assess(coefficient, fit, added, enough, truth or {})
        parameters += assessed
        messages += remarks
        parts.append(fit.coloured.covariance)
        changes.append(change)
        shown = _series(task, fit, serving)
        series += shown
        fits[coefficient] = _quality(task, fit, shown)
    return Identification(
        method="equation error",
        parameters=tuple(parameters),
        fits=fits,
        series=tuple(series),
        covariance=_joint(parts, changes, parameters),
        status=_status(parameters),
        messages=tuple(messages),
        labels={k: v for item in data for k, v in (item.labels or {}).items() if k in models},
    )


class _Task:
    """One coefficient's formula on its maneuvers: parameter names and regressor blocks."""

    def __init__(
        self,
        coefficient: str,
        formula: str,
        learn: tuple[CoefficientData, ...],
        common: bool,
    ) -> None:
        self.coefficient, self.formula, self.learn = coefficient, formula, learn
        terms, _ = regressors(coefficient, formula, _variables(learn[0]))
        self.terms = tuple(terms)
        self.constant = constant_name(coefficient)
        self.split = self.constant in self.terms and len(learn) > 1 and not common
        self.shared = tuple(n for n in self.terms if n != self.constant or not self.split)
        own = tuple(f"{self.constant}[{d.maneuver.id}]" for d in learn) if self.split else ()
        self.names = (*own, *self.shared)

    def terms_of(self, item: CoefficientData, variables: Mapping[str, Array]) -> Array:
        """The formula's regressors (n, k) in the order of `terms`, smoothed as the measured side:
        beside a smoothed moment sharper regressors would draw every estimate toward zero.
        """
        names, matrix = regressors(self.coefficient, self.formula, variables)
        assert tuple(names) == self.terms  # a formula's terms do not depend on the data
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


def _with_lift(
    variables: Mapping[str, Array], coefficients: Mapping[str, Array]
) -> Mapping[str, Array]:
    """The variables and the measured lift coefficient, which the drag's formula may name."""
    return {**variables, LIFT: coefficients[LIFT]} if LIFT in coefficients else variables


def _variables(item: CoefficientData) -> Mapping[str, Array]:
    return _with_lift(item.variables, item.coefficients)


def _serving(data: Sequence[CoefficientData], coefficient: str) -> list[CoefficientData]:
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


def _uneven(item: CoefficientData) -> list[Message]:
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


def _series(task: _Task, fit: Regression, serving: Sequence[CoefficientData]) -> list[Series]:
    value = dict(zip(fit.names, fit.solution.value, strict=True))
    out = []
    for item in serving:
        measured = item.coefficients[task.coefficient]
        own = f"{task.constant}[{item.maneuver.id}]"
        used = [value.get(own, 0.0) if n not in value else value[n] for n in task.terms]
        model = task.terms_of(item, _variables(item)) @ np.array(used)
        if item.maneuver.held_out and task.constant in task.terms:
            model = model + np.mean(measured - model)
        out.append(
            Series(
                coefficient=task.coefficient,
                maneuver=item.maneuver.id,
                t=frozen(item.t),
                measured=frozen(measured),
                model=frozen(model),
                held_out=item.maneuver.held_out,
            )
        )
    return out


def _quality(task: _Task, fit: Regression, shown: Sequence[Series]) -> Fit:
    """R2 and relative rms; RRMSE is rms over the range of the measured (van den Hoek, Table 8)."""
    learned = [s for s in shown if not s.held_out]
    held = [s for s in shown if s.held_out]
    residuals = fit.residuals
    squares = sum(float(v @ v) for v in residuals)
    steps = sum(float(np.sum(np.diff(v) ** 2)) for v in residuals)
    measured = np.concatenate([s.measured for s in learned])
    spread = float(np.ptp(measured))
    return Fit(
        coefficient=task.coefficient,
        formula=task.formula,
        r2=r_squared(learned),
        rrmse=float(np.sqrt(squares / len(measured))) / spread if spread > 0.0 else np.nan,
        n=len(measured),
        n_held_out=sum(len(s.measured) for s in held),
        r2_held_out=r_squared(held),
        durbin_watson=steps / squares if squares > 0.0 else np.nan,
    )


def r_squared(shown: Sequence[Series]) -> float:
    """1 - residual over total sum of squares, each maneuver about its own mean.

    About one common mean a difference of trim would count as explained. NaN without variation.
    """
    total = sum(float(np.sum((s.measured - s.measured.mean()) ** 2)) for s in shown)
    left = sum(float(np.sum((s.measured - s.model) ** 2)) for s in shown)
    return 1.0 - left / total if total > 0.0 else np.nan


def _joint(
    parts: Sequence[Array], changes: Sequence[Mapping[str, Array]], parameters: Sequence[Parameter]
) -> Array:
    """Covariance of all parameters; NaN for those that are not identifiable.

    Coefficients share what was added from outside (one bias changes them all); the residuals of
    different coefficients are taken as independent.
    """
    sizes = [len(p) for p in parts]
    ends = np.cumsum(sizes)
    out = np.zeros((ends[-1], ends[-1]))
    for part, end in zip(parts, ends, strict=True):
        out[end - len(part) : end, end - len(part) : end] = part
    for source in dict.fromkeys(s for change in changes for s in change):
        whole = np.concatenate(
            [c.get(source, np.zeros(n)) for c, n in zip(changes, sizes, strict=True)]
        )
        out += np.outer(whole, whole)
    lost = [i for i, p in enumerate(parameters) if p.verdict == "not_identifiable"]
    out[lost, :] = np.nan
    out[:, lost] = np.nan
    return frozen(out)


def _status(parameters: Sequence[Parameter]) -> str:
    lost = [p.name for p in parameters if p.verdict == "not_identifiable"]
    weak = [p.name for p in parameters if p.verdict == "weak"]
    if lost:
        return (
            f"not identifiable: {', '.join(lost)}. Fly a maneuver that excites them on their own, "
            "or take a term out of the formula."
        )
    if weak:
        return (
            f"identified; weak: {', '.join(weak)}. Their error bars are over half the value: "
            "more or longer maneuvers would narrow them."
        )
    return "identified: every parameter is resolved"
