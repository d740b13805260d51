"""How well a fitted coefficient's model fits, and what all coefficients give together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from alula.base.arrays import Array, frozen
from alula.identify.coefficients import CoefficientData
from alula.identify.equation_error.task import CoefficientTask, variables_of
from alula.identify.regression.regress import Regression
from alula.identify.result import Fit, Parameter, Series
from alula.identify.trust.verdict import weak_words


def predictions(
    task: CoefficientTask, fit: Regression, serving: Sequence[CoefficientData]
) -> list[Series]:
    """Measured and model of every serving maneuver, held-out ones with a constant of their own."""
    value = dict(zip(fit.names, fit.solution.value, strict=True))
    out = []
    for item in serving:
        measured = item.coefficients[task.coefficient]
        own = f"{task.constant}[{item.maneuver.id}]"
        used = [value.get(own, 0.0) if n not in value else value[n] for n in task.terms]
        model = task.terms_of(item, variables_of(item)) @ np.array(used)
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


def quality(task: CoefficientTask, fit: Regression, shown: Sequence[Series]) -> Fit:
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


def joint_covariance(
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


def status(parameters: Sequence[Parameter]) -> str:
    """The result in words, and what to try next."""
    lost = [p.name for p in parameters if p.verdict == "not_identifiable"]
    if lost:
        return (
            f"not identifiable: {', '.join(lost)}. Fly a maneuver that excites them on their own, "
            "or take a term out of the formula"
        )
    if any(p.verdict == "weak" and not p.zero_constant for p in parameters):
        return (
            f"identified; {weak_words(parameters)}. Error bars over half the value: more or longer "
            "maneuvers would narrow them"
        )
    words = ("identified: every parameter is resolved", weak_words(parameters))
    return "; ".join(w for w in words if w)


def se_words(residuals: str, data: Sequence[CoefficientData]) -> str:
    """What a standard error is made of. residuals: how it takes these."""
    sources = dict.fromkeys(way.source.split()[0] for item in data for way in item.perturbed)
    return " + ".join([residuals, *sources])
