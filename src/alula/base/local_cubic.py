"""A cubic fitted to a short window around every sample: derivative, and the filter that goes
with it.

Klein and Morelli, Aircraft System Identification, AIAA 2006, Sec. 11.2 (local polynomial); the
stamps may be uneven. A derivative so smoothed lacks what is faster than the window. Where it is
set equal to other signals, these must pass the same filter, or every estimate comes out too small:
`matched` is that filter.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from alula.base.arrays import Array

DEGREE = 3
LEAST = 7  # samples: a cubic needs four, and noise needs some to average
EVEN = 1e-6  # of an interval: what stamps of a steady clock differ by in double precision
PIECE = 2**18  # weights at a time


class LocalCubic:
    """The weights of every sample's window, for stamps t (n,) s.

    window_s = 0 takes nine samples, but at least 0.12 s. At the ends the window is one-sided.
    Fewer than seven samples fall back on plain differences. Windows of even stamps share one row
    of weights, so that a long record costs no more than its length.
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
        self._dt, self._half = dt, half
        self._first = np.clip(np.arange(n) - half, 0, n - width)
        # Intervals of each window that are not the usual one, as a difference of running sums.
        odd = np.concatenate([[0], np.cumsum(np.abs(np.diff(t) - dt) > EVEN * dt)])
        middle = self._first == np.arange(n) - half
        even = middle & (odd[self._first + width - 1] == odd[self._first])
        self._own = np.flatnonzero(~even)  # samples with weights of their own
        steps = np.arange(-half, half + 1, dtype=np.float64)
        self._shared = _Weights(steps[None] * dt, half * dt)

    def derivative(self, x: Array) -> Array:
        """Smoothed derivative of x (n,)."""
        if self.plain:
            return np.gradient(x, self.t) if len(x) > 1 else np.zeros(len(x))
        known = x[np.isfinite(x)]  # digits of a large mean stay out of the sums
        return self._sums(x - (known.mean() if known.size else 0.0), "slope")

    def matched(self, x: Array) -> Array:
        """x (n,) or (n, k) as it stands beside a smoothed derivative: the same low-pass."""
        if self.plain:
            return x
        if x.ndim == 2:
            columns = [self.matched(np.ascontiguousarray(c)) for c in x.T]
            return np.column_stack(columns) if columns else x
        return self._sums(x, "matched")

    def derivative_se(self, x: Array) -> float:
        """Standard deviation of the derivative by the scatter of x (n,) about the local cubics."""
        if self.plain:
            return float("nan")
        shared = np.setdiff1d(np.arange(len(x)), self._own)
        variances = [
            weights.slope_variance(self._windows(x, some))
            for rows, alike in ((shared, True), (self._own, False))
            for weights, some in self._pieces(rows, alike)
        ]
        return float(np.sqrt(np.concatenate(variances).mean()))

    def _sums(self, x: Array, of: str) -> Array:
        """Every sample's window times its weights."""
        out = np.zeros(len(x))
        half = self._half
        out[half : len(x) - half] = np.correlate(x, getattr(self._shared, of)[0], "valid")
        for weights, rows in self._pieces(self._own, shared=False):
            out[rows] = np.einsum("nw,nw->n", getattr(weights, of), self._windows(x, rows))
        return out

    def _pieces(self, rows: Any, shared: bool) -> Iterator[tuple[_Weights, Any]]:
        """Samples so many at a time that their weights stay small, with these weights."""
        for some in np.array_split(rows, max(1, len(rows) * (2 * self._half + 1) // PIECE)):
            if len(some) == 0:
                continue
            if shared:
                yield self._shared, some
            else:
                stamps = self._windows(self.t, some) - self.t[some, None]
                yield _Weights(stamps, self._half * self._dt), some

    def _windows(self, x: Array, rows: Any) -> Array:
        out: Array = sliding_window_view(x, 2 * self._half + 1)[self._first[rows]]
        return out


class _Weights:
    """What the samples of a window count, from their stamps (k, width) about the sample, s."""

    def __init__(self, stamps: Array, unit: float) -> None:
        self._unit = unit
        self._vandermonde = (stamps / unit)[:, :, None] ** np.arange(DEGREE + 1)
        self._inverse = np.linalg.inv(
            np.einsum("nwi,nwj->nij", self._vandermonde, self._vandermonde)
        )
        self.slope = np.einsum("ni,nwi->nw", self._inverse[:, 1], self._vandermonde) / unit
        # sum d_j x_j = sum g_j (x_j+1 - x_j) with g the negative running sum, and each difference
        # is the mean of the true derivative at its ends times the interval.
        running = -np.cumsum(self.slope, axis=1)[:, :-1] * np.diff(stamps, axis=1)
        self.matched = np.zeros_like(self.slope)
        self.matched[:, :-1] += 0.5 * running
        self.matched[:, 1:] += 0.5 * running

    def slope_variance(self, windows: Array) -> Array:
        """Variance of the slope by the scatter of windows (n, width) about their cubics."""
        signal = windows - windows.mean(axis=1, keepdims=True)
        count = len(signal)
        vandermonde = np.broadcast_to(self._vandermonde, (count, *self._vandermonde.shape[1:]))
        inverse = np.broadcast_to(self._inverse, (count, *self._inverse.shape[1:]))
        right = np.einsum("nwi,nw->ni", vandermonde, signal)
        fitted = np.einsum("nwi,nij,nj->nw", vandermonde, inverse, right)
        scatter = np.sum((signal - fitted) ** 2, axis=1) / (signal.shape[1] - DEGREE - 1)
        return np.asarray(scatter * inverse[:, 1, 1] / self._unit**2)
