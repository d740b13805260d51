"""Smoothed local differentiation: a cubic fitted to a short window around every sample.

Klein and Morelli, Aircraft System Identification, AIAA 2006, Sec. 11.2 (local polynomial); the
stamps may be uneven. The window sets the bandwidth: a cubic over w seconds follows motion up to
about 1/w Hz and averages noise above.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from alula.base.arrays import Array

DEGREE = 3
LEAST = 7  # samples: a cubic needs four, and noise needs some to average


@dataclass(frozen=True)
class Derivative:
    """values, rates (n,): the smoothed signal and its derivative. se: standard deviation of the
    rates by the scatter about the local cubics. window_s: length of the window.
    """

    values: Array
    rates: Array
    se: float
    window_s: float


def differentiate(t: Array, x: Array, window_s: float = 0.0) -> Derivative:
    """Derivative of x (n,) at the stamps t (n,) s.

    window_s = 0 takes nine samples, but at least 0.12 s. At the ends the window is one-sided. NaN
    is not allowed; fewer than seven samples fall back on plain differences.
    """
    n = len(t)
    if n < LEAST:
        rates = np.gradient(x, t) if n > 1 else np.zeros(n)
        return Derivative(x, rates, float("nan"), 0.0)
    dt = float(np.median(np.diff(t)))
    wanted = window_s if window_s > 0.0 else max(8.0 * dt, 0.12)
    width = min(max(2 * round(wanted / dt / 2.0) + 1, LEAST), n if n % 2 else n - 1)
    half = width // 2
    start = np.clip(np.arange(n) - half, 0, n - width)
    tau = (sliding_window_view(t, width)[start] - t[:, None]) / (half * dt)
    signal = sliding_window_view(x, width)[start]
    middle = signal.mean(axis=1, keepdims=True)  # digits of a large mean are kept out of the fit
    vandermonde = tau[:, :, None] ** np.arange(DEGREE + 1)
    normal = np.einsum("nwi,nwj->nij", vandermonde, vandermonde)
    right = np.einsum("nwi,nw->ni", vandermonde, signal - middle)
    inverse = np.linalg.inv(normal)
    coefficients = np.einsum("nij,nj->ni", inverse, right)
    fitted = np.einsum("nwi,ni->nw", vandermonde, coefficients)
    scatter = np.sum((signal - middle - fitted) ** 2, axis=1) / (width - DEGREE - 1)
    se = np.sqrt(np.mean(scatter * inverse[:, 1, 1])) / (half * dt)
    return Derivative(
        coefficients[:, 0] + middle[:, 0], coefficients[:, 1] / (half * dt), float(se), width * dt
    )
