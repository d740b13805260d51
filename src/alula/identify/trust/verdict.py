"""Interval and verdict of each parameter.

'ok': |value| > 2 se and the interval does not include zero, or se below the scale that the user
calls negligible. 'weak': resolved but neither of these. 'not_identifiable': see
identifiability.py; such a parameter has no value, because any value would fit.

The 95 % interval takes Student's t with Satterthwaite's degrees of freedom and the variance with
the loss put back (coloured.py); `se` is the variance as Klein and Morelli define it. So the
interval is wider than 2 se on short maneuvers, and is the one that covers.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from scipy import special

from alula.base.arrays import Array
from alula.base.messages import Message, warn
from alula.identify.regression.regress import Regression
from alula.identify.regression.regressor_noise import warn_of_bias
from alula.identify.result import Parameter, Verdict
from alula.identify.trust.identifiability import Unresolved, unresolved, variance_inflation
from alula.identify.typical import typical_magnitude, unit

_WHY = {
    "collinear": "does not vary independently of the other regressors",
    "noise": "varies by sensor noise only, and the coefficient does not respond to it",
    "uncertain": "varies so little that the standard error is over ten typical magnitudes",
}


def verdict(value: float, se: float, ci95: tuple[float, float], scale: float | None) -> Verdict:
    """The verdict on a resolved parameter. scale: a standard error that is good enough."""
    if scale is not None and se < scale:
        return "ok"
    outside = ci95[0] > 0.0 or ci95[1] < 0.0
    return "ok" if abs(value) > 2.0 * se and outside else "weak"


def assess(
    coefficient: str,
    fit: Regression,
    added: Array,
    scales: Mapping[str, float],
    truth: Mapping[str, float],
    units: Mapping[str, str] | None = None,
) -> tuple[tuple[Parameter, ...], tuple[Message, ...]]:
    """All parameters of one regression with error bars and verdicts.

    added: (k, k) covariance from what is uncertain outside the regression. scales: standard errors
    that are good enough, by name. units: by name, where the names do not tell them.
    """
    covariance = fit.coloured.covariance + added
    typical = [typical_magnitude(n.split("_")[0], n.split("[")[0]) for n in fit.names]
    # What the data determine does not depend on the method: a biased one would hide it.
    judge = fit if fit.ordinary is None else fit.ordinary
    lost = unresolved(judge, judge.coloured.covariance + added, typical)
    inflation = variance_inflation(judge)
    white = np.sqrt(np.diag(fit.solution.covariance))
    se = np.sqrt(np.diag(covariance))
    bias = fit.bias
    half = _half_width(fit, added, np.zeros(len(se)) if bias is None else bias)
    total = se if bias is None else np.hypot(se, bias)
    parameters = []
    for i, name in enumerate(fit.names):
        value, gone = float(fit.solution.value[i]), lost.get(name)
        ci95 = (value - float(half[i]), value + float(half[i]))
        parameters.append(
            Parameter(
                name=name,
                coefficient=coefficient,
                value=np.nan if gone else value,
                se_white=np.nan if gone else float(white[i]),
                se=np.nan if gone else float(se[i]),
                ci95=(np.nan, np.nan) if gone else ci95,
                verdict="not_identifiable"
                if gone
                else verdict(value, float(total[i]), ci95, scales.get(name)),
                tied_to=gone.tied_to if gone else (),
                unit=unit(coefficient, name) if units is None else units[name],
                vif=np.inf if gone and gone.reason == "collinear" else float(inflation[i]),
                truth=truth.get(name),
                bias=None if bias is None else np.nan if gone else float(bias[i]),
            )
        )
    messages = [_explain(coefficient, name, why, fit) for name, why in lost.items()]
    if not lost:  # of parameters that are not told, neither is the bias
        messages += warn_of_bias(coefficient, fit, se)
    return tuple(parameters), tuple(messages)


def weak_words(parameters: Iterable[Parameter]) -> str:
    """Which parameters are weak, '' where none: 'weak: CY_p; zero within their error: CY_0'."""
    weak = [p for p in parameters if p.verdict == "weak"]
    zero = ", ".join(p.name for p in weak if p.zero_constant)
    rest = ", ".join(p.name for p in weak if not p.zero_constant)
    said = (f"weak: {rest}" if rest else "", f"zero within their error: {zero}" if zero else "")
    return "; ".join(words for words in said if words)


def combination(name: str, why: Unresolved) -> str:
    """What the data do determine, in words: 'Cm_q + 2.1 Cm_alphadot'; '' where nothing."""
    if not why.tied_to:
        return ""
    return name + "".join(
        f" {'+' if tie.weight >= 0 else '-'} {abs(tie.weight):.3g} {tie.name}"
        for tie in why.tied_to
    )


def _half_width(fit: Regression, added: Array, bias: Array) -> Array:
    """Half of the 95 % interval. The added variance counts as known (Welch-Satterthwaite), and so
    does the square of a bias (k,).
    """
    own = np.diag(fit.coloured.corrected)
    total = own + np.diag(added) + bias**2
    share = np.where(own > 0.0, own / np.where(total > 0.0, total, 1.0), 1.0)
    dof = fit.coloured.dof / share**2
    out: Array = special.stdtrit(dof, 0.975) * np.sqrt(total)
    return out


def _explain(coefficient: str, name: str, why: Unresolved, fit: Regression) -> Message:
    known = combination(name, why)
    found = f"the regressor of {name} {_WHY[why.reason]}"
    if known:
        values = dict(zip(fit.names, fit.solution.value, strict=True))
        total = values[name] + sum(tie.weight * values[tie.name] for tie in why.tied_to)
        found += f"; the data determine only {known} = {total:.4g}"
    return warn(
        "not_identifiable",
        where=f"{coefficient}, {name}",
        expected="a regressor that the maneuvers excite on its own",
        found=found,
        do="Add a maneuver that excites it, or take the term out of the formula"
        + (" (or one of those it is tied to)." if known else "."),
    )
