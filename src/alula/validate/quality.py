"""How well one channel of the model's flight matches the measured one.

Theil's inequality coefficient and its parts: H. Theil, Economic Forecasts and Policy, 2nd ed.,
North-Holland 1961, ch. 2; for flight vehicles R. V. Jategaonkar, Flight Vehicle System
Identification, AIAA, 2nd ed. 2015, ch. 11.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array


@dataclass(frozen=True)
class Quality:
    """Measures of match; NaN where they have no meaning (no variation, no error to divide).

    rms: of model minus measured, in the channel's unit. r2: 1 - SSE/SST about the measured mean.
    rrmse: rms over the range of the measured. theil: 0 perfect, 1 no better than nothing. bias,
    variance, covariance: shares of the mean squared error; they sum to one.
    """

    rms: float
    r2: float
    rrmse: float
    theil: float
    bias: float
    variance: float
    covariance: float


def quality(measured: Array, model: Array) -> Quality:
    """The measures for one channel, measured and model (n,), finite.

    With e = model - measured, means m, standard deviations s (over n) and correlation r of both:

        U   = rms(e) / (rms(z) + rms(y)),  z and y: measured and model less the measured mean,
        U_M = (m_y - m_z)^2 / mean(e^2),   the share of a bias,
        U_S = (s_y - s_z)^2 / mean(e^2),   the share of a wrong amplitude,
        U_C = 2 (1 - r) s_y s_z / mean(e^2), the share of what does not move together.

    The mean is taken off before U is formed: with it the airspeed's U would be near zero for any
    model, since its trim value stands in the denominator.
    """
    error = model - measured
    square = float(np.mean(error**2))
    rms = float(np.sqrt(square))
    z, y = measured - measured.mean(), model - measured.mean()
    spread = float(np.ptp(measured))
    total = float(np.mean(z**2))
    size = float(np.sqrt(total) + np.sqrt(np.mean(y**2)))
    s_z, s_y = float(np.std(measured)), float(np.std(model))
    shared = float(np.mean(z * (model - model.mean())))  # r s_y s_z
    return Quality(
        rms=rms,
        r2=1.0 - square / total if total > 0.0 else np.nan,
        rrmse=rms / spread if spread > 0.0 else np.nan,
        theil=rms / size if size > 0.0 else np.nan,
        bias=float(error.mean()) ** 2 / square if square > 0.0 else np.nan,
        variance=(s_y - s_z) ** 2 / square if square > 0.0 else np.nan,
        covariance=2.0 * (s_y * s_z - shared) / square if square > 0.0 else np.nan,
    )
