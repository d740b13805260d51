"""Overlapping Allan variance of a sensor at rest, and the covariance of its estimate.

IEEE Std 952-1997, annex C; Riley, NIST SP 1065. With y-bar_k the mean of m samples,

    sigma^2(tau) = 1/2 <(y-bar_{k+m} - y-bar_k)^2>,        tau = m dt.

The estimate is a mean of squares of a filtered series z_m, so for Gaussian noise of known spectrum
its covariance between two averaging times follows from the cross spectrum S_mm' of z_m and z_m':

    cov = 1/(2 N dt) int |S_mm'(f)|^2 df.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array

PER_OCTAVE = 1  # averaging times; closer ones repeat one another
LONGEST = 8  # windows of the longest averaging time that the record must hold
POINTS = 16000  # frequencies of the integrals: 1 % of the covariance, which suffices


def averaging_lengths(n: int) -> Array:
    """(k,) samples averaged: 1, 2, 4 .. as long as the record of n holds LONGEST of them."""
    last = int(np.floor(np.log2(max(n // LONGEST, 1))))
    return np.asarray(2.0 ** np.arange(last + 1))


def allan_variance(y: Array, lengths: Array) -> Array:
    """(k,) overlapping Allan variance of y (n,) at those averaging lengths, unit of y squared."""
    total = np.concatenate([[0.0], np.cumsum(y - y.mean())])
    out = []
    for m in lengths.astype(int):
        change = total[2 * m :] - 2.0 * total[m:-m] + total[: -2 * m]
        out.append(0.5 * float(np.mean((change / m) ** 2)))
    return np.array(out)


def frequencies(n: int) -> Array:
    """(POINTS,) cycles per sample, evenly in the logarithm, from 0.001/n to one half."""
    return np.geomspace(1e-3 / n, 0.5, POINTS)


def transfer(lengths: Array, f: Array) -> Array:
    """(k, len(f)) real gain of z_m but for a phase: 2 sin^2(pi f m) / (m sin(pi f))."""
    m = lengths[:, None]
    out: Array = 2.0 * np.sin(np.pi * f * m) ** 2 / (m * np.sin(np.pi * f))
    return out


def expected(gain: Array, spectrum: Array, f: Array) -> Array:
    """(k,) Allan variance of noise with that two-sided spectrum per cycle and sample."""
    return np.asarray(np.trapezoid(gain**2 * spectrum * f, np.log(f), axis=1))


def covariance(gain: Array, spectrum: Array, f: Array, n: int, lengths: Array) -> Array:
    """(k, k) covariance of the estimates from a record of n samples.

    z_m and z_m' are centered differently in time; the phase drops out of |S_mm'|. The number of
    z_m is n - 2 m + 1; of two averaging times the geometric mean, which keeps the matrix positive.
    """
    weight = spectrum**2 * np.gradient(f)
    cross = (gain**2 * weight) @ (gain**2).T
    count = n - 2.0 * lengths + 1.0
    # 1/(2 N) int over -1/2 .. 1/2, of which f covers half.
    return np.asarray(cross / np.sqrt(np.outer(count, count)))
