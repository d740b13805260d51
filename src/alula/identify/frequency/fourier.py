"""Fourier transforms of maneuvers: finite, at chosen frequencies, exact for what runs smoothly.

The Fourier integral of sampled data is taken over the cubic through every four neighboring samples
(Morelli, Journal of Aircraft 34 (1997), p. 544: high-accuracy Fourier transform; its sums by the
chirp z-transform, Rabiner, Schafer, Rader 1969). A plain sum errs by (w dt)^2/12; at the ends it
also takes half a sample too much. The cubics' weights are integrated by Gauss's rule, so that there
is no small frequency at which their formulas cancel.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse

Detrend = Literal["ends", "mean", "line", "none"]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_SHORTEST = 8  # samples


def detrended(x: Array, how: Detrend) -> Array:
    """x (n,) or (n, k) less its mean, its line by least squares, or the line through its ends.

    All are linear: what holds between signals holds between the detrended ones. Without a line
    through its ends a drift leaks into every frequency as 1/f.
    """
    n = len(x)
    ramp = np.arange(n) / max(n - 1, 1)
    shape = (n,) + (1,) * (x.ndim - 1)
    if how == "ends":
        out: Array = x - (x[0] + ramp.reshape(shape) * (x[-1] - x[0]))
        return out
    level: Array = x - x.mean(axis=0)
    if how == "mean":
        return level
    if how == "line":
        centered = ramp - ramp.mean()
        slope = np.tensordot(centered, x, axes=(0, 0)) / max(float(centered @ centered), 1e-300)
        line: Array = level - centered.reshape(shape) * slope
        return line
    return x


def fourier_integral(x: Array, dt: float, frequencies: Array) -> np.ndarray:
    """Integral of x(t) exp(-j w t) over the record, t from 0; (m, ...) for x (n, ...).

    dt: sample interval, s. frequencies: (m,) Hz, up to half the sample rate. Raises BadInput where
    the record is too short or a frequency too high.
    """
    n = len(x)
    theta = 2.0 * np.pi * np.asarray(frequencies, dtype=float) * dt
    if n < _SHORTEST or not np.isfinite(x).all() or (np.abs(theta) > np.pi * (1 + 1e-9)).any():
        raise refuse(
            "bad_transform",
            where="Fourier transform",
            expected=f"{_SHORTEST} finite samples or more, frequencies to half the sample rate",
            found=f"{n} samples every {dt:.4g} s, to {np.abs(frequencies).max(initial=0.0):.4g} Hz",
            do="Take a longer window without gaps, or lower frequencies.",
        )
    flat = x.reshape(n, -1)
    inner = _cardinal(theta, np.array([-1.0, 0.0, 1.0, 2.0]))  # interval 0 to 1, four points around
    phase = np.exp(-1j * np.outer(theta, np.arange(4)))
    whole = np.zeros((len(theta), flat.shape[1]), dtype=complex)
    # inner intervals 1 .. n-3: each point m gets exp(-j theta m) sum_j c_j exp(j theta j), less
    # what intervals beyond the inner ones would have given
    sums = _sums(flat, theta)
    for k, j in enumerate((-1, 0, 1, 2)):
        shift = np.exp(1j * theta * j)
        first, last = 1 + j, n - 3 + j  # points this weight reaches
        missing = np.zeros_like(whole)
        for m in (*range(0, first), *range(last + 1, n)):
            missing += np.exp(-1j * theta * m)[:, None] * flat[m]
        whole += (inner[:, k] * shift)[:, None] * (sums - missing)
    left = _cardinal(theta, np.array([0.0, 1.0, 2.0, 3.0]))
    right = _cardinal(theta, np.array([-2.0, -1.0, 0.0, 1.0]))
    whole += left @ flat[:4] * phase[:, :1]
    whole += (right @ flat[n - 4 :]) * np.exp(-1j * theta * (n - 2))[:, None]
    return (dt * whole).reshape(len(theta), *x.shape[1:])


def harmonics(duration: float, low: float, high: float) -> Array:
    """The multiples of 1/duration from `low` to `high` Hz: independent, and blind to constants."""
    first = max(1, int(np.ceil(low * duration - 1e-9)))
    last = int(np.floor(high * duration + 1e-9))
    return np.arange(first, last + 1) / duration


def _sums(x: Array, theta: Array) -> np.ndarray:
    """sum_m x_m exp(-j theta m), (m, k): by chirp z where frequencies are evenly spaced."""
    steps = np.diff(theta)
    if len(theta) > 8 and np.allclose(steps, steps[0], rtol=1e-9, atol=1e-15):
        from scipy.signal import czt  # slow to import, for this branch only

        out: np.ndarray = czt(
            x, len(theta), w=np.exp(-1j * steps[0]), a=np.exp(1j * theta[0]), axis=0
        )
        return out
    return np.array([np.exp(-1j * a * np.arange(len(x))) @ x for a in theta])


def _cardinal(theta: Array, points: Array) -> np.ndarray:
    """Integrals over s from 0 to 1 of each cubic cardinal polynomial times exp(-j theta s)."""
    s = 0.5 * (_NODES + 1.0)
    basis = np.array(
        [np.prod([(s - q) / (p - q) for q in points if q != p], axis=0) for p in points]
    )
    turn = np.exp(-1j * np.outer(theta, s)) * (0.5 * _WEIGHTS)
    out: np.ndarray = turn @ basis.T
    return out
