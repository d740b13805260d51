"""A cubic fitted to a short window around every sample: derivative, and the filter that goes
with it.

Klein and Morelli, Aircraft System Identification, AIAA 2006, Sec. 11.2 (local polynomial); the
stamps may be uneven. A derivative so smoothed lacks what is faster than the window. Where it is
set equal to other signals, these must pass the same filter, or every estimate comes out too small:
`matched` is that filter.
"""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from alula.base.arrays import Array

DEGREE = 3
LEAST = 7  # samples: a cubic needs four, and noise needs some to average


class LocalCubic:
    """The weights of every sample's window, for stamps t (n,) s.

    window_s = 0 takes nine samples, but at least 0.12 s. At the ends the window is one-sided.
    Fewer than seven samples fall back on plain differences.
    """

    def __init__(self, t: Array, window_s: float = 0.0) -> None:
        self.t, n = t, len(t)
        self.plain = n < LEAST
        self.window_s = 0.0
        if self.plain:
            return
        dt = float(np.median(np.diff(t)))
        wanted = window_s if window_s > 0.0 else max(8.0 * dt, 0.12)
        width = min(max(2 * round(wanted / dt / 2.0) + 1, LEAST), n if n % 2 else n - 1)
        half = width // 2
        self.window_s = (width - 1) * dt
        self._first = np.clip(np.arange(n) - half, 0, n - width)
        stamps = sliding_window_view(t, width)[self._first]
        tau = (stamps - t[:, None]) / (half * dt)
        vandermonde = tau[:, :, None] ** np.arange(DEGREE + 1)
        self._inverse = np.linalg.inv(np.einsum("nwi,nwj->nij", vandermonde, vandermonde))
        weights = np.einsum("nij,nwj->niw", self._inverse, vandermonde)
        self._vandermonde, self._unit = vandermonde, half * dt
        self._value, self._slope = weights[:, 0, :], weights[:, 1, :] / (half * dt)
        # sum d_j x_j = sum g_j (x_j+1 - x_j) with g the negative running sum, and each difference
        # is the mean of the true derivative at its ends times the interval.
        running = -np.cumsum(self._slope, axis=1)[:, :-1] * np.diff(stamps, axis=1)
        self._matched = np.zeros_like(self._slope)
        self._matched[:, :-1] += 0.5 * running
        self._matched[:, 1:] += 0.5 * running

    def derivative(self, x: Array) -> Array:
        """Smoothed derivative of x (n,)."""
        if self.plain:
            return np.gradient(x, self.t) if len(x) > 1 else np.zeros(len(x))
        signal = self._windows(x)
        middle = signal.mean(axis=1, keepdims=True)  # digits of a large mean stay out of the sum
        out: Array = np.einsum("nw,nw->n", self._slope, signal - middle)
        return out

    def matched(self, x: Array) -> Array:
        """x (n,) or (n, k) as it stands beside a smoothed derivative: the same low-pass."""
        if self.plain:
            return x
        if x.ndim == 2:
            columns = [self.matched(np.ascontiguousarray(c)) for c in x.T]
            return np.column_stack(columns) if columns else x
        out: Array = np.einsum("nw,nw->n", self._matched, self._windows(x))
        return out

    def derivative_se(self, x: Array) -> float:
        """Standard deviation of the derivative by the scatter of x (n,) about the local cubics."""
        if self.plain:
            return float("nan")
        signal = self._windows(x)
        signal = signal - signal.mean(axis=1, keepdims=True)
        right = np.einsum("nwi,nw->ni", self._vandermonde, signal)
        fitted = np.einsum("nwi,nij,nj->nw", self._vandermonde, self._inverse, right)
        scatter = np.sum((signal - fitted) ** 2, axis=1) / (signal.shape[1] - DEGREE - 1)
        return float(np.sqrt(np.mean(scatter * self._inverse[:, 1, 1])) / self._unit)

    def _windows(self, x: Array) -> Array:
        return sliding_window_view(x, self._slope.shape[1])[self._first]
