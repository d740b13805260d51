"""What is left in the residuals: whiteness, and correlation with the inputs.

Whiteness: Ljung and Box, Biometrika 65 (1978), Q = n (n + 2) sum r_k^2/(n - k) over h lags, which
is chi-squared with h degrees of freedom where residuals are white; maneuvers add up. It tells which
standard error to believe: flight-test residuals are hardly ever white.

Correlation with an input at a lag tells that the coefficient answers to what that input did earlier
in a way that the model lacks: a delay, unsteady flow, a wrong lag of a sensor. Its variance for
unrelated series is sum_k R_v(k) R_u(k)/n whatever their colours (Ljung, System Identification,
1999, section 16.6), here from their periodograms.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft, special

from alula.base.arrays import Array

LAGS = 25
LEVEL = 0.01  # of all lags of all inputs together


@dataclass(frozen=True)
class Whiteness:
    """Ljung-Box test. p: probability of a larger statistic in white residuals.

    lag_one: autocorrelation from one sample to the next.
    """

    statistic: float
    dof: int
    p: float
    lag_one: float

    @property
    def white(self) -> bool:
        """Whether residuals may be taken as white, at 5 %."""
        return bool(self.p > 0.05)


@dataclass(frozen=True)
class InputCorrelation:
    """The largest correlation of residuals with an input's past. p: for all lags and inputs."""

    input: str
    lag: int  # samples by which the input leads
    correlation: float
    p: float

    @property
    def significant(self) -> bool:
        """Whether it is more than chance."""
        return bool(self.p < LEVEL)


def ljung_box(residuals: Sequence[Array], lags: int = LAGS) -> Whiteness:
    """The test over all maneuvers: residuals (n,) each, in time order."""
    statistic, dof, first, total = 0.0, 0, 0.0, 0.0
    for v in residuals:
        n = len(v)
        h = min(lags, n // 5)
        v = v - v.mean() if n else v
        power = float(v @ v)
        if h < 1 or not power > 0.0:
            continue
        r = np.array([v[k:] @ v[:-k] for k in range(1, h + 1)]) / power
        statistic += n * (n + 2.0) * float(np.sum(r**2 / (n - np.arange(1, h + 1))))
        dof += h
        first += float(r[0]) * power
        total += power
    if dof == 0:
        return Whiteness(np.nan, 0, np.nan, np.nan)
    return Whiteness(statistic, dof, float(special.chdtrc(dof, statistic)), first / total)


def input_correlations(
    residuals: Sequence[Array], inputs: Mapping[str, Sequence[Array]], lags: int = LAGS
) -> tuple[InputCorrelation, ...]:
    """For each input that moves, the lag at which residuals follow it most.

    residuals: (n,) per maneuver. inputs: by name, (n,) per maneuver.
    """
    found = []
    for name, series in inputs.items():
        cross, variance, size = np.zeros(lags + 1), 0.0, 0.0
        for v, u in zip(residuals, series, strict=True):
            n = len(v)
            if n <= 5 * lags:
                continue
            v, u = v - v.mean(), u - u.mean()
            length = fft.next_fast_len(2 * n, real=True)
            sv, su = fft.rfft(v, length), fft.rfft(u, length)
            cross += fft.irfft(sv * su.conj(), length)[: lags + 1]
            pv = fft.irfft(np.abs(sv) ** 2, length)
            pu = fft.irfft(np.abs(su) ** 2, length)
            variance += max(float(pv @ pu) / n, 0.0)
            size += float(np.sqrt((v @ v) * (u @ u)))
        if not variance > 0.0:
            continue
        lag = int(np.argmax(np.abs(cross)))
        tests = (lags + 1) * len(inputs)
        p = 2.0 * float(special.ndtr(-abs(cross[lag]) / np.sqrt(variance)))
        found.append(InputCorrelation(name, lag, float(cross[lag]) / size, min(1.0, tests * p)))
    return tuple(found)
