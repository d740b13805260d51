"""Sequential least squares in the frequency domain, for use while flying.

Morelli, Real-Time Parameter Estimation in the Frequency Domain, J. Guidance, Control, and Dynamics
23 (2000): Fourier transforms of measured and regressors grow with every sample; whenever an
estimate is wanted, the complex transforms are regressed on one another. Noise and drift outside the
band do not count, and nothing has to be smoothed or integrated. A column of ones among the
regressors takes the trim's leakage along exactly.

Each of the m frequencies gives two real equations, once they are independent: in the first seconds,
when lines lie closer than one over the time flown, only as many count as the band holds by then.
Standard errors are those of noise that is flat over the band.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core


@dataclass(frozen=True)
class FrequencyHistory:
    """Estimates over time: t (r,) s, value and se (r, k); NaN before they are determined."""

    t: Array
    value: Array
    se: Array


def recursive_frequency_regression(
    regressors: Array,
    measured: Array,
    dt: float,
    frequencies: Array,
    *,
    every: int = 1,
    forgetting: float = 1.0,
) -> FrequencyHistory:
    """Measured (n,) on regressors (n, k) at frequencies (m,), Hz, evenly spaced, after every
    `every`-th sample.

    dt: s between samples. forgetting: factor per sample on the transforms, over 0 up to 1. A sample
    with a NaN counts as missing. Raises BadInput where shapes or numbers are out of range, and for
    frequencies above half the sampling rate.
    """
    x = np.ascontiguousarray(np.column_stack([regressors, measured]), dtype=float)
    hertz = np.array(frequencies, dtype=float)
    n, k = x.shape[0], x.shape[1] - 1
    for what, good, wanted, found in (
        ("regressors", 1 <= k < core.MAX_FOURIER_CHANNELS,
         f"1 to {core.MAX_FOURIER_CHANNELS - 1} columns", str(k)),
        ("frequencies", hertz.ndim == 1 and 1 <= len(hertz) <= core.MAX_FREQUENCIES
         and bool((np.diff(hertz) > 0.0).all()) and hertz[0] >= 0.0,
         f"1 to {core.MAX_FREQUENCIES}, ascending, not negative", f"{hertz}"),
        ("frequencies", hertz.size > 0 and bool(hertz.max() * dt < 0.5),
         "below half the sampling rate", f"{hertz.max(initial=0.0):g} Hz"),
        ("every", every >= 1, "1 or more samples", str(every)),
        ("forgetting", 0.0 < forgetting <= 1.0, "over 0, at most 1", str(forgetting)),
        ("dt", dt > 0.0, "a positive time", str(dt)),
    ):  # fmt: skip
        if not good:
            raise refuse(
                "bad_option",
                where=f"recursive frequency regression, {what}",
                expected=wanted,
                found=found,
                do="Correct it.",
            )
    rows = n // every
    value, se = np.empty((rows, k)), np.empty((rows, k))
    core.recursive_fourier(x, 2.0 * np.pi * hertz, dt, forgetting, every, value, se)
    t = dt * (every * np.arange(1, rows + 1) - 1)
    return FrequencyHistory(frozen(t), frozen(value), frozen(se))
