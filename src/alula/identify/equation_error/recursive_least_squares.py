"""Recursive least squares with forgetting, over recorded arrays (Dittrich 2016, section 3.3.3).

    K = P x/(a + x'P x),   value += K (z - x'value),   P <- (P - K x'P)/a       Eq. (3.66) to (3.68)

with the forgetting factor where it belongs (see the deviations). By default forgetting takes old
information only out of the direction in which the sample brings new (Cao and Schwartz, Automatica
36, 2000): quiet flight then leaves the derivatives as they were, where plain forgetting lets them
drift off on noise. No variance is forgotten beyond what it was at the start in either case.

Adaptive: the mean square of the last residuals (Eq. (3.69)) over their usual variance lowers the
factor when the aircraft changes. The loop is the core's: nothing is allocated, and one call serves
a whole recording.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.core import core

DIFFUSE = 1e8  # samples of information that the start is short of one


@dataclass(frozen=True)
class Forgetting:
    """How the past fades.

    factor: a, over 0 up to 1 (no forgetting); the memory is about 1/(1 - a) samples. directional:
    along the regressor only, otherwise in all directions. window: samples of the adaptive variant's
    variance, 0 for a fixed factor; least: its lowest factor. variance: the residuals' usual one,
    0 where it is learned. reset_ratio: of recent to usual variance, at which the variances start
    anew; 0 for never. Raises BadInput for what is out of range.
    """

    factor: float = 1.0
    directional: bool = True
    window: int = 0
    least: float = 0.9
    variance: float = 0.0
    reset_ratio: float = 0.0

    def __post_init__(self) -> None:
        """Check the ranges."""
        most = core.MAX_RESIDUAL_WINDOW
        for name, good, wanted in (
            ("factor", 0.0 < self.factor <= 1.0, "over 0, at most 1"),
            ("least", 0.0 < self.least <= 1.0, "over 0, at most 1"),
            ("window", 0 <= self.window <= most, f"0 to {most} samples"),
            ("variance", 0.0 <= self.variance < np.inf, "0 or more"),
            ("reset_ratio", self.reset_ratio == 0.0 or self.reset_ratio > 1.0, "0, or over 1"),
        ):
            if not good:
                raise refuse(
                    "bad_option",
                    where=f"recursive least squares, {name}",
                    expected=wanted,
                    found=repr(getattr(self, name)),
                    do="Correct it.",
                )


NOTHING_FORGOTTEN = Forgetting()
# By which names a project's options give the fields of `Forgetting`.
OPTIONS: Mapping[str, str] = {
    "forgetting": "factor",
    "forgetting_directional": "directional",
    "adaptive_window": "window",
    "least_forgetting": "least",
    "residual_variance": "variance",
    "reset_ratio": "reset_ratio",
}


def forgetting_of(options: Mapping[str, Any]) -> Forgetting:
    """The forgetting of a project's [identify.options], of which it takes `OPTIONS`.

    Raises BadInput for a window that is not a whole number and for what is out of range.
    """
    given = {OPTIONS[name]: value for name, value in options.items() if name in OPTIONS}
    if "window" in given:
        if given["window"] != int(given["window"]):
            raise refuse(
                "bad_option",
                where="identify.options.adaptive_window",
                expected="a whole number of samples",
                found=repr(given["window"]),
                do="Correct it.",
            )
        given["window"] = int(given["window"])
    return Forgetting(**given)


@dataclass(frozen=True)
class RecursiveFit:
    """Histories of a recursive fit, n samples and k parameters.

    value: (n, k) after each sample. se: (n, k), sqrt(s^2 P), as it is known in flight: of white
    residuals, NaN before there are enough. innovation: (n,) measured minus predicted. spread: (n,)
    its variance over the noise's. factor: (n,) forgetting used. reset: (n,) whether the variances
    started anew. noise: (n,) variance s^2. gain: (n, k), or
    (0, k) where it was not asked for.
    """

    value: Array
    se: Array
    innovation: Array
    spread: Array
    factor: Array
    reset: Array
    noise: Array
    gain: Array

    @property
    def residual(self) -> Array:
        """(n,) innovations over the square root of their spread: white with the noise's variance
        where the noise is white (Brown, Durbin and Evans, J. R. Stat. Soc. B 37, 1975)."""
        out: Array = self.innovation / np.sqrt(self.spread)
        return out


def recursive_least_squares(
    regressors: Array,
    measured: Array,
    forgetting: Forgetting = NOTHING_FORGOTTEN,
    *,
    initial: Array | None = None,
    variance: Array | None = None,
    bound: Array | None = None,
    reset: Array | None = None,
    gains: bool = False,
) -> RecursiveFit:
    """Measured (n,) on regressors (n, k), sample by sample.

    initial: (k,) values at the start, zero by default. variance: (k,) of them, in units of the
    noise's variance; by default so large that they count as a 1e-8th of a typical sample. bound:
    (k,) variances that forgetting does not exceed, by default those of the start. reset: (n,) flags
    where the variances start anew. gains: whether to keep them, for `sample_weights`. A sample with
    a NaN is passed over. Raises BadInput where shapes
    do not fit or a variance is not positive.
    """
    x = np.ascontiguousarray(regressors, dtype=float)
    z = np.ascontiguousarray(measured, dtype=float)
    if x.ndim != 2 or z.shape != x.shape[:1] or not 1 <= x.shape[1] <= core.MAX_RECURSIVE:
        raise refuse(
            "wrong_length",
            where="recursive least squares",
            expected=f"regressors (n, k) with k up to {core.MAX_RECURSIVE}, measured (n,)",
            found=f"{x.shape} and {z.shape}",
            do="Give one measured value per row of regressors.",
        )
    n, k = x.shape
    start = diffuse(x) if variance is None else np.array(variance, dtype=float)
    first = np.zeros(k) if initial is None else np.array(initial, dtype=float)
    most = start if bound is None else np.array(bound, dtype=float)
    flags = np.zeros(0) if reset is None else np.array(reset, dtype=float)
    if (
        start.shape != (k,)
        or first.shape != (k,)
        or most.shape != (k,)
        or flags.shape not in ((0,), (n,))
        or not (np.isfinite(start).all() and (start > 0.0).all() and np.isfinite(first).all())
    ):
        raise refuse(
            "wrong_length",
            where="recursive least squares",
            expected=f"finite initial values and positive variances ({k},), reset ({n},)",
            found=f"{first.shape}, {start.shape}, {most.shape}, {flags.shape}",
            do="Give one of each per parameter.",
        )
    value, se, steps = (np.empty((n, m)) for m in (k, k, 5))
    gain = np.empty((n if gains else 0, k))
    f = forgetting
    core.recursive_least_squares(
        x, z, first, start, most, flags, f.factor, f.directional, f.window, f.least, f.variance,
        f.reset_ratio, value, se, gain, steps,
    )  # fmt: skip
    for filled in (value, se, gain, steps):
        filled.setflags(write=False)  # in place: a copy takes as long as the fit
    innovation, spread, factor, was_reset, noise = steps.T
    return RecursiveFit(value, se, innovation, spread, factor, was_reset, noise, gain)


def diffuse(regressors: Array) -> Array:
    """(k,) variances of a start that counts as a 1e-8th of a typical sample of each regressor."""
    used = regressors
    size = np.einsum("nk,nk->k", used, used)
    if not np.isfinite(size).all():
        used = regressors[np.isfinite(regressors).all(axis=1)]
        size = np.einsum("nk,nk->k", used, used)
    size = size / max(len(used), 1)
    out: Array = DIFFUSE / np.where(size > 0.0, size, 1.0)
    return out


def sample_weights(regressors: Array, gain: Array) -> tuple[Array, Array]:
    """How the last value depends on every sample: last = G z + T initial.

    regressors, gain: (n, k). Returns G (k, n) and T (k, k). Whatever was forgotten and how is in
    the gains, so that the covariance of the last value is G cov(noise) G'.
    """
    n, k = regressors.shape
    rest = np.eye(k)
    weights = np.empty((k, n))
    for i in range(n - 1, -1, -1):
        column = rest @ gain[i]
        weights[:, i] = column
        rest -= np.outer(column, regressors[i])
    return weights, rest
