"""Equation error in the frequency domain: complex least squares over a band.

Morelli, Journal of Aircraft 34 (1997); Klein and Morelli 2006, ch. 7. Measured coefficients and
regressors, less their trend, are transformed at the multiples of one over
the maneuver's length within a band. Noise outside of it, vibration and drift do not count, and
white noise in the regressors biases less, by the band's share. Constants have no frequency: each
maneuver's own comes from its means.

The transform is a plain sum: what holds from sample to sample between coefficient and regressors
holds between their sums exactly, whatever the sums' error as integrals.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.messages import Message, note, refuse
from alula.identify.coefficients import CoefficientData
from alula.identify.equation_error.by_coefficient import Estimate, InTime, identify_each
from alula.identify.equation_error.task import CoefficientTask
from alula.identify.frequency.fourier import Detrend, detrended, harmonics
from alula.identify.regression.regress import Block, Regression, Weighting, regress
from alula.identify.regression.sandwich import sandwich
from alula.identify.result import Identification

ENERGY = 0.99  # share of the regressors' energy that the band holds where none is given
SLOWEST = 3  # ordinates whose mean power a constant's error bar takes


def identify_frequency_regression(
    data: Sequence[CoefficientData],
    models: Mapping[str, str],
    *,
    band_hz: tuple[float, float] | None = None,
    detrend: Detrend = "line",
    weighting: Weighting = "residual",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Derivatives of every coefficient in `models`, as `identify_equation_error`, over a band.

    band_hz: lowest and highest frequency, Hz; None takes, per maneuver and coefficient, from the
    lowest on what holds 99 % of the regressors' energy, and says so. Raises BadInput as equation
    error does, and where the band holds too few frequencies.
    """
    if band_hz is not None and not 0.0 <= band_hz[0] < band_hz[1] < np.inf:
        raise refuse(
            "bad_option",
            where="band_hz",
            expected="lowest and highest frequency in Hz",
            found=repr(band_hz),
            do='Write band_hz = [0.1, 2.0], or leave it out.',
        )  # fmt: skip

    def estimate(coefficient: str, formula: str, learn: list[CoefficientData]) -> Estimate:
        task = CoefficientTask(coefficient, formula, tuple(learn), common=False)
        times = task.blocks(None)
        bands = [band_hz or _band(item, b, detrend) for item, b in zip(learn, times, strict=True)]
        constant = [n in task.free for n in task.names]

        def transformed(blocks: Sequence[Block]) -> list[Block]:
            return [
                _transform(item, block, band, detrend, constant)
                for item, block, band in zip(learn, blocks, bands, strict=True)
            ]

        fit = _with_spectrum(regress(task.names, transformed(times), weighting))
        in_time = _in_time(fit, times)
        return Estimate(
            task=task,
            fit=fit,
            off=lambda source: fit.refit(transformed(task.blocks(source))),
            in_time=InTime(in_time, _band_share(in_time)),
            messages=tuple(
                _said(coefficient, item, band, len(block.measured))
                for item, band, block in zip(learn, bands, fit.blocks, strict=True)
            ),
        )

    return identify_each(
        "frequency-domain regression", data, models, estimate,
        residuals="ordinates of unequal variance", scales=scales, truth=truth,
    )  # fmt: skip


def _transform(
    item: CoefficientData,
    block: Block,
    band: tuple[float, float],
    detrend: Detrend,
    constant: Sequence[bool],
) -> Block:
    """Means in the first pair of rows, then real and imaginary part of every ordinate.

    Sized so that white noise in time has the same variance in every row.
    """
    n = len(block.measured)
    duration = n * float(item.t[-1] - item.t[0]) / (n - 1)
    f = harmonics(duration, *band)
    f = f[f < 0.5 * (n - 1) / duration]
    both = np.column_stack([block.regressors, block.measured])
    turn = np.exp(-2j * np.pi * np.outer(f, np.arange(n)) * duration / n)
    ordinates = turn @ detrended(both, detrend) * (2.0 / n) ** 0.5
    ordinates[:, :-1][:, np.array(constant)] = 0.0
    rows = np.empty((2 * len(f) + 2, both.shape[1]))
    rows[0] = both.mean(axis=0) * n**0.5
    rows[1] = 0.0
    rows[2::2], rows[3::2] = ordinates.real, ordinates.imag
    return Block(rows[:, :-1], rows[:, -1], block.unsmoothed)


def _band(item: CoefficientData, block: Block, detrend: Detrend) -> tuple[float, float]:
    """Up to the frequency below which the regressors, each sized alike, have most energy.

    What lies past the point where the spectrum has sunk to twice its own floor is noise.
    """
    x = detrended(block.regressors, detrend)
    power = np.abs(np.fft.rfft(x, axis=0)) ** 2
    power[0] = 0.0
    total = power.sum(axis=0)
    n = len(x)
    f = np.fft.rfftfreq(n, float(item.t[-1] - item.t[0]) / (n - 1))
    moving = total > 1e-20 * np.sum(block.regressors**2, axis=0)
    if not moving.any():
        return 0.0, float(f[-1])
    share = power[:, moving] / total[moving]
    floor = np.mean(share[len(share) // 2 :], axis=0)
    end = int(np.argmax(np.cumsum((share - 2.0 * floor).sum(axis=1))))
    energy = np.cumsum(share.sum(axis=1)[: end + 1])
    last = int(np.searchsorted(energy, ENERGY * energy[-1]))
    return 0.0, float(f[min(max(last, 2 * x.shape[1]), len(f) - 1)])


def _with_spectrum(fit: Regression) -> Regression:
    """The fit with error bars by the residuals' ordinates."""
    pairs = []
    for weight, block, residual in zip(fit.weights, fit.blocks, fit.residuals, strict=True):
        own = residual.copy()
        slow = own[2 : 2 + 2 * SLOWEST]
        # the means are met exactly by the constant, so their own residual is none
        own[0:2] = float(np.sqrt(np.mean(slow**2))) if len(slow) else 0.0
        pairs.append((np.sqrt(weight) * block.regressors, np.sqrt(weight) * own))
    found = sandwich(pairs, fit.solution.dispersion, as_is=2)
    return replace(fit, coloured=found)


def _in_time(fit: Regression, times: Sequence[Block]) -> Regression:
    """The fit beside samples instead of ordinates: residuals and regressors over time."""
    residuals = tuple(b.measured - b.regressors @ fit.solution.value for b in times)
    return replace(fit, blocks=tuple(times), residuals=residuals)


def _band_share(fit: Regression) -> Regression:
    """Blocks whose white noise is as much as falls into the band: rows used over samples."""
    rows = fit.solution.residual
    share = len(rows) / max(sum(len(b.measured) for b in fit.blocks), 1)
    blocks = tuple(replace(b, regressors=b.regressors * min(share, 1.0) ** 0.5) for b in fit.blocks)
    return replace(fit, blocks=blocks)


def _said(coefficient: str, item: CoefficientData, band: tuple[float, float], rows: int) -> Message:
    return note(
        "frequency_band",
        where=f"{coefficient}, maneuver {item.maneuver.id}",
        expected="a band that holds the motion",
        found=f"{rows // 2 - 1} frequencies from {band[0]:.3g} to {band[1]:.3g} Hz",
        do="Nothing; set band_hz in [identify.options] to choose it.",
    )
