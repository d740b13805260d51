"""Covariance of a least-squares estimate whose residuals are coloured.

Klein and Morelli, Aircraft System Identification, AIAA 2006, ch. 5; Morelli and Klein, Journal of
Aircraft 34 (1997). With the residuals' autocorrelation R(k), the covariance is

    D [ sum_i sum_j x_i R(i - j) x_j' ] D,        D = (X' X)^-1,

R estimated from the residuals, biased, at all lags. In frequency the double sum is a single sum
over the residuals' periodogram, so the cost is that of a Fourier transform and the result is
positive semidefinite by construction. Maneuvers are blocks: no correlation between them. A block
may have several outputs whose residuals go together: R(k) is then a matrix, R(-k) = R(k)'.

Two things are added, both needed for an interval that holds as often as it says. The fit bends
toward the residuals, so that their periodogram lacks what the regressors can imitate: `corrected`
puts back the expected loss (a fixed point: the autocorrelation whose expected residual
autocorrelation is the one observed). And the estimate rests on few periods of the motion: `dof` is
Satterthwaite's number of degrees of freedom of each variance, to be used with Student's t.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from alula.base.arrays import Array

Spectrum = NDArray[Any]  # real of one output, complex of several

ITERATIONS = 12  # the constant term converges slowest, by about 0.4 a step
SETTLED = 5e-3  # relative change of a variance at which the fixed point is taken as reached


@dataclass(frozen=True)
class Coloured:
    """covariance: (k, k), Klein and Morelli's. corrected: (k, k), with the loss put back.

    dof: (k,) degrees of freedom of the corrected variances.
    """

    covariance: Array
    corrected: Array
    dof: Array


class _Transformed:
    """What both kinds of block share: the padded transform of regressors over time."""

    def __init__(self, regressors: Array) -> None:
        self.n = len(regressors)
        self.length = fft.next_fast_len(2 * self.n, real=True)  # no wrap-around
        self.x = regressors
        self.spectrum_x = fft.rfft(regressors, self.length, axis=0)
        self.bins = np.full(len(self.spectrum_x), 2.0)  # a bin stands for its mirror image too
        self.bins[0] = 1.0
        if self.length % 2 == 0:
            self.bins[-1] = 1.0

    def _in_time(self, spectrum: Spectrum) -> Array:
        out: Array = fft.irfft(spectrum / self.n, self.length, axis=0)[: self.n]
        return out


class _Block(_Transformed):
    """One maneuver in frequency: regressors (n, k) and residual (n,), both weighted."""

    def __init__(self, regressors: Array, residual: Array) -> None:
        super().__init__(regressors)
        self.periodogram: Array = np.abs(fft.rfft(residual, self.length)) ** 2

    def score(self, periodogram: Array) -> Array:
        """sum_ij x_i R(i - j) x_j', (k, k)."""
        weighted = (self.bins * periodogram)[:, None] * self.spectrum_x
        total: Array = (weighted.conj().T @ self.spectrum_x).real / (self.length * self.n)
        return total

    def filtered(self, periodogram: Array) -> Array:
        """T X, (n, k), with T the Toeplitz matrix of R."""
        return self._in_time(periodogram[:, None] * self.spectrum_x)

    def product(self, filtered: Array) -> Array:
        """X' T X, (k, k)."""
        out: Array = self.x.T @ filtered
        return out

    def loss(self, filtered: Array, dispersion: Array, score: Array) -> Array:
        """The expected periodogram that the fit has taken out of this block's residuals."""
        spectrum_t = fft.rfft(filtered, self.length, axis=0)
        inner = dispersion @ score @ dispersion
        cross = 2.0 * ((self.spectrum_x @ dispersion).conj() * spectrum_t).real
        again = (self.spectrum_x.conj() * (self.spectrum_x @ inner)).real
        out: Array = (cross - again).sum(axis=1)
        return out

    def possible(self, periodogram: Array) -> Array:
        """The nearest that is none below zero."""
        out: Array = np.maximum(periodogram, 0.0)
        return out

    def share(self, periodogram: Array, dispersion: Array) -> Array:
        """(f, k): what each frequency adds to each parameter's variance, but for a factor."""
        out: Array = np.abs(self.spectrum_x @ dispersion) ** 2 * periodogram[:, None]
        return out


class _Together(_Transformed):
    """The same with m outputs: regressors (n, m, k), residuals (n, m); periodograms (f, m, m)."""

    def __init__(self, regressors: Array, residual: Array) -> None:
        super().__init__(regressors)
        v = fft.rfft(residual, self.length, axis=0)
        self.periodogram: Spectrum = v[:, :, None] * v[:, None, :].conj()

    def score(self, periodogram: Spectrum) -> Array:
        """sum_ij x_i' R(i - j) x_j, (k, k)."""
        weighted = self.bins[:, None, None] * (periodogram @ self.spectrum_x)
        total: Array = np.tensordot(self.spectrum_x.conj(), weighted, axes=([0, 1], [0, 1])).real
        return total / (self.length * self.n)

    def filtered(self, periodogram: Spectrum) -> Array:
        """T X, (n, m, k), with T the block Toeplitz matrix of R."""
        return self._in_time(periodogram @ self.spectrum_x)

    def product(self, filtered: Array) -> Array:
        """X' T X, (k, k)."""
        out: Array = np.tensordot(self.x, filtered, axes=([0, 1], [0, 1]))
        return out

    def loss(self, filtered: Array, dispersion: Array, score: Array) -> Spectrum:
        """The expected periodogram that the fit has taken out of this block's residuals."""
        spectrum_t = fft.rfft(filtered, self.length, axis=0)
        inner = dispersion @ score @ dispersion
        cross = (self.spectrum_x @ dispersion) @ _adjoint(spectrum_t)
        again = (self.spectrum_x @ inner) @ _adjoint(self.spectrum_x)
        out: Spectrum = cross + _adjoint(cross) - again
        return out

    def possible(self, periodogram: Spectrum) -> Spectrum:
        """The nearest that is none below zero."""
        size, direction = np.linalg.eigh(periodogram)
        out: Spectrum = (direction * np.maximum(size, 0.0)[:, None, :]) @ _adjoint(direction)
        return out

    def share(self, periodogram: Spectrum, dispersion: Array) -> Array:
        """(f, k): what each frequency adds to each parameter's variance, but for a factor."""
        gain = self.spectrum_x @ dispersion
        out: Array = np.sum(gain.conj() * (periodogram @ gain), axis=1).real
        return out


def _adjoint(matrices: Spectrum) -> Spectrum:
    out: Spectrum = matrices.conj().transpose(0, 2, 1)
    return out


def coloured_covariance(blocks: Sequence[tuple[Array, Array]], dispersion: Array) -> Coloured:
    """Covariance of the estimate from coloured residuals.

    blocks: one pair (regressors (n, k), residual (n,)) per maneuver, both multiplied by the square
    root of the weights where the fit was weighted; (n, m, k) and (n, m) where the residuals of m
    outputs go together. dispersion: (k, k), the fit's (X' W X)^-1.
    """
    parts = [_Block(x, v) if v.ndim == 1 else _Together(x, v) for x, v in blocks]
    plain = sum((b.score(b.periodogram) for b in parts), np.zeros_like(dispersion))
    covariance = dispersion @ plain @ dispersion
    spectra = _restored(parts, dispersion)
    corrected = sum(
        (b.score(s) for b, s in zip(parts, spectra, strict=True)), np.zeros_like(dispersion)
    )
    whole = dispersion @ corrected @ dispersion
    return Coloured(
        covariance=covariance,
        corrected=whole,
        dof=np.maximum(
            1.0,
            _degrees_of_freedom(parts, spectra, dispersion)
            * np.sqrt(_share_observed(covariance, whole)),
        ),
    )


def _share_observed(covariance: Array, whole: Array) -> Array:
    """(k,) part of each variance that was seen in the residuals and not put back, in (0, 1].

    What is put back is no observation of its own: were it known exactly, all degrees of freedom
    would count, were it not known at all, this share of them. The geometric mean, its square root,
    makes intervals of constant terms cover 93 to 98 % (86 to 94 % without), of derivatives 93 to
    96 %, in Monte Carlo with correlation times of 0.05 to 1 s on maneuvers of 8 and 30 s.
    """
    seen, total = np.diag(covariance), np.diag(whole)
    known = (seen > 0.0) & (total > seen)
    out: Array = np.where(known, seen / np.where(known, total, 1.0), 1.0)
    return out


def _restored(parts: Sequence[_Block | _Together], dispersion: Array) -> list[Spectrum]:
    """Periodograms of the errors themselves, as their expected residuals tell."""
    spectra = [b.periodogram for b in parts]
    before = np.zeros(len(dispersion))
    for _ in range(ITERATIONS):
        filtered = [b.filtered(s) for b, s in zip(parts, spectra, strict=True)]
        score = sum(
            (b.product(f) for b, f in zip(parts, filtered, strict=True)), np.zeros_like(dispersion)
        )
        spectra = [
            b.periodogram + b.loss(f, dispersion, score)
            for b, f in zip(parts, filtered, strict=True)
        ]
        now = np.diag(dispersion @ score @ dispersion)
        if np.all(np.abs(now - before) <= SETTLED * np.abs(now)):
            break
        before = now
    return [b.possible(s) for b, s in zip(parts, spectra, strict=True)]


def _degrees_of_freedom(
    parts: Sequence[_Block | _Together], spectra: list[Spectrum], dispersion: Array
) -> Array:
    """Satterthwaite: 2 mean^2 / variance of each parameter's variance.

    A periodogram ordinate has a standard deviation as large as its mean, and of the padded
    transform's `length` ordinates n are independent.
    """
    mean = np.zeros(len(dispersion))
    variance = np.zeros(len(dispersion))
    for block, spectrum in zip(parts, spectra, strict=True):
        share = block.share(spectrum, dispersion)
        mean += (block.bins @ share) / (block.length * block.n)
        variance += (block.bins @ share**2) / (block.length * block.n**3)
    samples = sum(b.x[..., 0].size for b in parts)
    safe = np.where(variance > 0.0, variance, 1.0)
    dof = np.where(variance > 0.0, 2.0 * mean**2 / safe, samples)
    return np.minimum(dof, samples - len(dispersion))
