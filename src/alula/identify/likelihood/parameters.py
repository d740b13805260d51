"""From a converged likelihood search to parameters with error bars and verdicts.

At its maximum a Gaussian likelihood is a linear regression of residuals on sensitivities, both in
units of their standard deviations: the information matrix is X'X and the Cramer-Rao bounds are
(X'X)^-1 (Dittrich 2016, Eq. (3.64)). So the regression's error bars for coloured residuals (Klein
and Morelli 2006, Eq. (6.29) ff.), its ties and its verdicts serve here as they are. Each output of
each maneuver is one block with its own autocorrelation; different outputs count as independent,
except where the search took their errors as going together. No error bar is smaller than its
Cramer-Rao bound: the coloured formula alone is, by up to a factor of three for constants, because
residuals lack just what constants can imitate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.coloured import coloured_covariance
from alula.base.messages import Message, note, warn
from alula.identify.likelihood.optimizer import Minimum
from alula.identify.likelihood.stillness import distrusted_if_still
from alula.identify.parameter_unit import with_units
from alula.identify.regression.least_squares import least_squares
from alula.identify.regression.regress import Block, Regression
from alula.identify.regression.sandwich import sandwich
from alula.identify.result import Fit, Identification, Parameter, Series
from alula.identify.trust.verdict import assess, weak_words


@dataclass(frozen=True)
class Whitened:
    """One block at the maximum: sensitivities (n, k) and residual (n,), over their deviation.

    prior: a prior's row, whose variance is known to be 1 and not to be told from its residual.
    together: the same number for outputs of the same samples whose errors go together.
    """

    sensitivity: Array
    residual: Array
    prior: bool = False
    together: int | None = None


@dataclass(frozen=True)
class Fitted:
    """Measured (NaN where missing) and modeled output over one maneuver; (n,) each."""

    output: str
    maneuver: str
    t: Array
    measured: Array
    model: Array
    held_out: bool


@dataclass(frozen=True)
class Prior:
    """A Gaussian prior: mean and standard error of one parameter (Dittrich 2016, Eq. (3.11))."""

    mean: float
    se: float


def regression_at(
    names: Sequence[str], value: Array, blocks: Sequence[Whitened], ordinates: bool = False
) -> Regression:
    """The likelihood at `value` (k,) as a linear regression.

    ordinates: rows are real and imaginary parts of a transform's ordinates in turn, not samples.
    """
    parts = [Block(b.sensitivity, b.residual + b.sensitivity @ value, _silent(b)) for b in blocks]
    solution = least_squares(
        np.vstack([b.regressors for b in parts]), np.concatenate([b.measured for b in parts])
    )
    # the search's value, not one linear step further: they differ by less than its tolerance
    null = solution.null @ (solution.null.T @ (value * solution.scale))
    solution = replace(solution, value=value - null / solution.scale)
    residuals = tuple(b.residual for b in blocks)
    rows = _rows(blocks)
    if ordinates:
        rows = [(x, v) if len(v) > 1 else (np.vstack([x, 0.0 * x]), np.ones(2)) for x, v in rows]
        coloured = sandwich(rows, solution.dispersion)
    else:
        coloured = coloured_covariance(rows, solution.dispersion)
    coloured = replace(
        coloured,
        covariance=_at_least(coloured.covariance, solution.dispersion),
        corrected=_at_least(coloured.corrected, solution.dispersion),
    )
    return Regression(
        names=tuple(names),
        blocks=tuple(parts),
        weights=(1.0,) * len(parts),
        solution=solution,
        residuals=residuals,
        coloured=coloured,
    )


def _rows(blocks: Sequence[Whitened]) -> list[tuple[Array, Array]]:
    """Sensitivities and residuals for the coloured covariance, joint ones side by side."""
    single = [b for b in blocks if b.together is None]
    rows = [(b.sensitivity, np.ones(1) if b.prior else b.residual) for b in single]
    for number in sorted({b.together for b in blocks if b.together is not None}):
        joint = [b for b in blocks if b.together == number]
        S = np.stack([b.sensitivity for b in joint], axis=1)
        rows.append((S, np.stack([b.residual for b in joint], axis=1)))
    return rows


def assembled(
    method: str,
    names: Sequence[str],
    belongs: Mapping[str, str],
    blocks: Sequence[Whitened],
    found: Minimum,
    fitted: Sequence[Fitted],
    rows: Mapping[str, str],
    *,
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
    messages: Sequence[Message] = (),
    ordinates: bool = False,
) -> Identification:
    """The result of a search. belongs: by bare parameter name, the row it stands in. ordinates:
    rows are a transform's, as in `regression_at`, and what is fitted is over frequency, Hz.

    Where the search failed no parameter has a value: a point that is no maximum has no error bars.
    Units as far as names and rows tell them (`parameter_unit`).
    """
    if not blocks or not np.isfinite(found.information).all() or not found.information.any():
        return _failed(method, names, belongs, found, messages)
    fit = regression_at(names, found.value, blocks, ordinates)
    none = np.zeros((len(names), len(names)))
    parameters, remarks = assess(
        method, fit, none, scales or {}, truth or {}, units=dict.fromkeys(names, "")
    )
    said = [
        replace(m, where=m.where.removeprefix(f"{method}, "))
        for m in remarks
        if m.code != "noisy_regressor"  # sensitivities are the model's, no noisy regressors
    ]
    at_bound = [n for n, held in zip(names, found.at_bound, strict=True) if held]
    if at_bound:
        said.append(
            note(
                "at_bound",
                where=", ".join(at_bound),
                expected="a maximum inside the bounds",
                found="a bound holds the estimate",
                do="Its error bar says nothing there; widen the bound, or fix the parameter.",
            )
        )
    if not found.converged:
        return _failed(method, names, belongs, found, (*messages, *said))
    parameters = tuple(
        # a bound's value is not the data's
        replace(p, verdict="weak") if p.name in at_bound and p.verdict == "ok" else p
        for p in parameters
    )
    parameters = tuple(
        replace(p, coefficient=belongs.get(p.name.split("[")[0], p.name.split("(")[0]))
        for p in parameters
    )
    if not ordinates:  # amplitudes over frequency are not about a mean
        parameters, unmoved = distrusted_if_still(parameters, fitted)
        said += unmoved
    covariance = fit.coloured.covariance.copy()
    lost = [i for i, p in enumerate(parameters) if p.verdict == "not_identifiable"]
    covariance[lost, :] = np.nan
    covariance[:, lost] = np.nan
    series = tuple(
        Series(
            f.output,
            f.maneuver,
            frozen(f.t),
            frozen(f.measured),
            frozen(f.model),
            f.held_out,
            "Hz" if ordinates else "s",
        )
        for f in fitted
    )
    result = Identification(
        method=method,
        parameters=parameters,
        fits={
            name: _quality(name, rows, series) for name in dict.fromkeys(f.output for f in fitted)
        },
        series=series,
        covariance=frozen(covariance),
        status=_status(parameters, found),
        messages=(*messages, *said),
    )
    return with_units(result)


def _at_least(covariance: Array, bound: Array) -> Array:
    """The covariance (k, k), its variances raised to those of `bound`, correlations kept."""
    own, least = np.diag(covariance), np.diag(bound)
    small = (own > 0.0) & (own < least)
    factor = np.where(small, np.sqrt(least / np.where(small, own, 1.0)), 1.0)
    out: Array = covariance * np.outer(factor, factor)
    return out


def _silent(block: Whitened) -> Array:
    """Sensitivities come from a model and carry no sensor noise to be judged: zero, constant."""
    return np.zeros_like(block.sensitivity)


def _failed(
    method: str,
    names: Sequence[str],
    belongs: Mapping[str, str],
    found: Minimum,
    messages: Sequence[Message],
) -> Identification:
    said = warn(
        "no_convergence",
        where=method,
        expected="a maximum of the likelihood",
        found=found.why,
        do="Give better first values (equation error's, say), fix what the maneuver does not "
        "excite, or choose another algorithm.",
    )
    nan = float("nan")
    parameters = tuple(
        Parameter(
            name=n,
            coefficient=belongs.get(n.split("[")[0], n.split("(")[0]),
            value=nan,
            se_white=nan,
            se=nan,
            ci95=(nan, nan),
            verdict="not_identifiable",
            tied_to=(),
            unit="",
            vif=nan,
        )
        for n in names
    )
    result = Identification(
        method=method,
        parameters=parameters,
        fits={},
        series=(),
        covariance=frozen(np.full((len(names), len(names)), nan)),
        status=f"failed: {found.why}",
        messages=(*messages, said),
    )
    return with_units(result)


def _quality(name: str, rows: Mapping[str, str], series: Sequence[Series]) -> Fit:
    learned = [s for s in series if s.coefficient == name and not s.held_out]
    held = [s for s in series if s.coefficient == name and s.held_out]
    residuals = [(s.measured - s.model)[np.isfinite(s.measured)] for s in learned]
    squares = sum(float(v @ v) for v in residuals)
    steps = sum(float(np.sum(np.diff(v) ** 2)) for v in residuals)
    count = sum(len(v) for v in residuals)
    measured = np.concatenate([s.measured[np.isfinite(s.measured)] for s in learned])
    spread = float(np.ptp(measured)) if len(measured) else 0.0
    return Fit(
        coefficient=name,
        formula=rows.get(name, ""),
        r2=_r_squared(learned),
        rrmse=float(np.sqrt(squares / count)) / spread if spread > 0.0 else np.nan,
        n=count,
        n_held_out=sum(int(np.isfinite(s.measured).sum()) for s in held),
        r2_held_out=_r_squared(held),
        durbin_watson=steps / squares if squares > 0.0 else np.nan,
    )


def _r_squared(shown: Sequence[Series]) -> float:
    good = [np.isfinite(s.measured) for s in shown]
    total = sum(
        float(np.sum((s.measured[g] - s.measured[g].mean()) ** 2))
        for s, g in zip(shown, good, strict=True)
        if g.any()
    )
    left = sum(
        float(np.sum((s.measured - s.model)[g] ** 2)) for s, g in zip(shown, good, strict=True)
    )
    return 1.0 - left / total if total > 0.0 else np.nan


def _status(parameters: Sequence[Parameter], found: Minimum) -> str:
    lost = [p.name for p in parameters if p.verdict == "not_identifiable"]
    if lost:
        return f"{found.why}; not identifiable: {', '.join(lost)}"
    return f"{found.why}; {weak_words(parameters) or 'every parameter is resolved'}"
