"""Standard errors by moving blocks of residuals: no formula for their colour, only their pieces.

Kuensch, Annals of Statistics 17 (1989). Residuals of each maneuver are cut into overlapping blocks;
blocks drawn at random and joined make new residuals of the same colour, and the fit is repeated
with each set. Regressors stay as they are, so that one repetition is one matrix product. The length
of a block follows from the residuals' autocorrelation (Politis and White, Econometric Reviews 23,
2004, with the correction of Patton, Politis and White, 2009): where they are near white it is
short, where they are coloured long. Residuals are enlarged by sqrt(n/(n - k)) for what the fit has
taken out of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import special

from alula.base.arrays import Array, frozen
from alula.base.messages import note, refuse
from alula.identify.coefficients import CoefficientData
from alula.identify.equation_error.quality import joint_covariance, se_words, status
from alula.identify.equation_error.task import CoefficientTask, serving
from alula.identify.regression.regress import Regression, Weighting, regress
from alula.identify.result import Identification, Parameter
from alula.identify.trust.control_sign import contradicted, signs_checked
from alula.identify.trust.verdict import verdict
from alula.model import reference_scales

REPLICATES = 1000
FEWEST = 100
LONGEST = 1.0 / 3.0  # of a maneuver: fewer than three blocks are no sample
QUIET = 5  # lags in a row without correlation, after which there is none
BLOCK_OPTIONS = ("replicates", "block_s")
_SMALL = 2.0  # standard deviations of an autocorrelation, sqrt(log10(n)/n)


@dataclass(frozen=True)
class Draws:
    """value: (replicates, k) estimates less the fit's. lengths: samples of a block by maneuver."""

    value: Array
    lengths: tuple[int, ...]

    @property
    def covariance(self) -> Array:
        """(k, k), about the draws' own mean."""
        centered = self.value - self.value.mean(axis=0)
        out: Array = centered.T @ centered / (len(centered) - 1)
        return out


def block_length(residual: Array) -> int:
    """Samples in a block of this residual (n,), between 1 and a third of it.

    The rule that is best for the variance of a mean: (2 g^2 / d)^(1/3) n^(1/3), with flat-top
    estimates of g = sum |k| R(k) and d = 4/3 (sum R(k))^2.
    """
    v = residual - residual.mean()
    n = len(v)
    power = float(v @ v)
    most = max(1, int(LONGEST * n))
    if n < 10 or power == 0.0:
        return 1
    lags = min(n - 1, int(np.ceil(np.sqrt(n))) + max(QUIET, int(np.log10(n))) + n // 4)
    R = np.array([float(v[k:] @ v[: n - k]) for k in range(lags + 1)]) / n
    small = np.abs(R / R[0]) < _SMALL * np.sqrt(np.log10(n) / n)
    last = lags
    for k in range(1, lags - QUIET + 2):
        if small[k : k + QUIET].all():
            last = k - 1
            break
    wide = min(2 * max(last, 1), lags)
    x = np.arange(1, wide + 1) / wide
    window = np.where(x <= 0.5, 1.0, 2.0 * (1.0 - x))
    g = 2.0 * float(np.sum(window * np.arange(1, wide + 1) * R[1 : wide + 1]))
    total = R[0] + 2.0 * float(np.sum(window * R[1 : wide + 1]))
    if total <= 0.0:
        return most
    d = 4.0 / 3.0 * total**2
    return int(np.clip(np.ceil((2.0 * g**2 / d) ** (1.0 / 3.0) * n ** (1.0 / 3.0)), 1, most))


def block_bootstrap(
    fit: Regression,
    *,
    replicates: int = REPLICATES,
    lengths: Sequence[int] | None = None,
    seed: int = 0,
) -> Draws:
    """Estimates of residuals put together anew. lengths: of blocks, one per maneuver.

    The fit must be one of least squares (ordinary or weighted).
    """
    rng = np.random.default_rng(seed)
    k = len(fit.names)
    samples = sum(len(v) for v in fit.residuals)
    enlarge = np.sqrt(samples / max(samples - k, 1))
    value = np.zeros((replicates, k))
    used = []
    for i, (block, v, weight) in enumerate(
        zip(fit.blocks, fit.residuals, fit.weights, strict=True)
    ):
        n = len(v)
        length = block_length(v) if lengths is None else min(max(lengths[i], 1), n)
        used.append(length)
        row = weight * block.regressors @ fit.solution.dispersion  # (n, k): what a sample adds
        count = -(-n // length)
        inside = np.arange(length)
        for start in range(0, replicates, 100):  # bounded memory
            many = min(100, replicates - start)
            first = rng.integers(0, n - length + 1, size=(many, count))
            index = (first[:, :, None] + inside).reshape(many, -1)[:, :n]
            value[start : start + many] += enlarge * v[index] @ row
    return Draws(value, tuple(used))


def bootstrapped(
    result: Identification,
    data: Sequence[CoefficientData],
    *,
    weighting: Weighting = "residual",
    common_constant: bool = False,
    scales: Mapping[str, float] | None = None,
    replicates: float = REPLICATES,
    block_s: float | None = None,
    seed: int = 0,
) -> Identification:
    """An equation-error result with standard errors by block bootstrap instead of by formula.

    `se` is the scatter of the replicates, and what lies outside of the regression added as before;
    the interval keeps the formula's degrees of freedom. Values do not change. data, weighting,
    common_constant, scales: as the result was made. block_s: length of a block, s, for all; None
    takes it from the residuals. Raises BadInput for a biased method, whose replicates scatter
    about the wrong value, and for numbers out of range.
    """
    if any(p.bias is not None for p in result.parameters):
        raise _refused(
            "uncertainty", "an unbiased regression for the bootstrap", result.method,
            'Take uncertainty = "coloured", or an ordinary regression.',
        )  # fmt: skip
    if replicates != int(replicates) or not FEWEST <= replicates <= 100_000:
        raise _refused(
            "replicates", f"a whole number from {FEWEST} to 100000", repr(replicates), "Correct it."
        )
    if block_s is not None and not 0.0 < block_s < np.inf:
        raise _refused("block_s", "seconds above zero", repr(block_s), "Correct it.")
    parameters: list[Parameter] = []
    parts: list[Array] = []
    changes: list[dict[str, Array]] = []
    said = []
    for order, (coefficient, shown) in enumerate(result.fits.items()):
        learn = [d for d in serving(data, coefficient) if not d.maneuver.held_out]
        task = CoefficientTask(coefficient, shown.formula, tuple(learn), common_constant)
        fit = regress(task.names, task.blocks(None), weighting)
        steps = [float(np.median(np.diff(d.t))) for d in learn]
        lengths = None
        if block_s is not None:
            lengths = [max(1, round(block_s / dt)) for dt in steps]
        draws = block_bootstrap(
            fit, replicates=int(replicates), lengths=lengths, seed=seed + 7919 * order
        )
        sources = dict.fromkeys(p.source for d in learn for p in d.perturbed)
        change = {s: fit.refit(task.blocks(s)) - fit.solution.value for s in sources}
        outside = np.array([sum(d[i] ** 2 for d in change.values()) for i in range(len(fit.names))])
        enough = {**reference_scales(coefficient, shown.formula), **(scales or {})}
        own = {p.name: p for p in result.parameters if p.coefficient == coefficient}
        variance = np.diag(draws.covariance)
        for i, name in enumerate(fit.names):
            dof = float(fit.coloured.dof[i])
            parameters.append(
                _with(own[name], float(variance[i]), float(outside[i]), dof, enough.get(name))
            )
        parts.append(draws.covariance)
        changes.append(change)
        blocks = ", ".join(
            f"{n * dt:.3g} s ({d.maneuver.id})"
            for n, dt, d in zip(draws.lengths, steps, learn, strict=True)
        )
        said.append(
            note(
                "block_bootstrap",
                where=f"model of {coefficient}",
                expected="standard errors by bootstrap",
                found=f"{int(replicates)} replicates, seed {seed}, moving blocks of {blocks}",
                do="Nothing; set block_s in [identify.options] to choose another length.",
            )
        )
    judged, turned = signs_checked(parameters)
    return replace(
        result,
        method=f"{result.method}, block bootstrap",
        parameters=judged,
        covariance=frozen(joint_covariance(parts, changes, judged)),
        status=status(judged) + contradicted(turned),
        messages=tuple(dict.fromkeys((*result.messages, *said, *turned))),
        uncertainty=se_words("block bootstrap of the residuals", data),
    )


def _with(
    p: Parameter, variance: float, outside: float, dof: float, scale: float | None
) -> Parameter:
    if p.verdict == "not_identifiable":
        return p
    total = variance + outside
    share = variance / total if total > 0.0 else 1.0
    se = float(np.sqrt(total))
    half = float(special.stdtrit(dof / max(share, 1e-6) ** 2, 0.975)) * se
    ci95 = (p.value - half, p.value + half)
    return replace(p, se=se, ci95=ci95, verdict=verdict(p.value, se, ci95, scale))


def _refused(name: str, expected: str, found: str, do: str) -> Exception:
    return refuse(
        "bad_option", where=f"identify.options.{name}", expected=expected, found=found, do=do
    )
