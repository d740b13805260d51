"""Orthogonal multisines with phases optimized for a low peak factor.

Morelli, "Multiple input design for real-time parameter estimation in the frequency domain", 13th
IFAC Symposium on System Identification, 2003; Morelli and Klein, Aircraft System Identification,
2nd ed., 2016, Sec. 9.3: every control has harmonics of its own of one period, so that the inputs
are orthogonal over it, in time and in frequency, and can be flown at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize

from alula.base.arrays import Array
from alula.base.messages import refuse

_POINTS = 16  # per period of the fastest harmonic, on which a peak is looked for
_POWERS = (4, 8, 16, 32, 64)  # of the norms that lead from the rms to the peak


@dataclass(frozen=True)
class Multisine:
    """A sum of sines at multiples of 1/period from `start`, for `cycles` periods; zero elsewhere.

    harmonics: the multiples. amplitudes: one for each, in the unit of the control. phases: rad.
    """

    start: float
    period: float
    harmonics: tuple[int, ...]
    amplitudes: tuple[float, ...]
    phases: tuple[float, ...]
    cycles: int = 1

    @property
    def end(self) -> float:
        """Time at which the last period ends, s."""
        return self.start + self.cycles * self.period

    @property
    def frequencies(self) -> Array:
        """The frequencies, (m,) Hz."""
        return np.asarray(self.harmonics, dtype=np.float64) / self.period

    def value(self, t: Array) -> Array:
        """Values (n,) at times t (n,), s."""
        t = np.asarray(t, dtype=np.float64)
        out = np.zeros(t.shape)
        turn = 2.0 * np.pi * (t - self.start) / self.period
        for k, amplitude, phase in zip(self.harmonics, self.amplitudes, self.phases, strict=True):
            out += amplitude * np.sin(k * turn + phase)
        return np.where((t >= self.start) & (t <= self.end), out, 0.0)


def multisines(
    amplitudes: Sequence[float],
    period: float,
    band: tuple[float, float],
    *,
    start: float = 0.0,
    cycles: int = 1,
) -> tuple[Multisine, ...]:
    """One multisine per control, orthogonal to the others over each period.

    amplitudes: the peak of each, in the unit of its control. period: s; the slowest resolved motion
    should fit into it. band: lowest and highest frequency, Hz. The multiples of 1/period in the
    band go to the controls in turn, each with the same power; phases begin as Schroeder's (IEEE
    Trans. Information Theory 16, 1970, Eq. 11) and are then optimized for the peak factor. Each
    signal begins and ends at zero. Raises BadInput where a control would get no harmonic.
    """
    first = max(1, int(np.ceil(band[0] * period * (1.0 - 1e-9))))
    last = int(np.floor(band[1] * period * (1.0 + 1e-9)))
    every = range(first, last + 1)
    n = len(amplitudes)
    if n == 0 or len(every) < n:
        raise refuse(
            "multisine_band",
            where="multisine",
            expected=f"at least one multiple of {1.0 / period:g} Hz for each of {n} controls",
            found=f"{len(every)} from {band[0]:g} to {band[1]:g} Hz",
            do="Widen the band or lengthen the period.",
        )
    return tuple(
        _one(float(amplitude), start, period, tuple(every[i::n]), cycles)
        for i, amplitude in enumerate(amplitudes)
    )


def relative_peak_factor(values: Array) -> float:
    """(max - min) / (2 sqrt(2) rms) of a signal (n,); 1 for a single sine (Morelli 2003, Eq. 8)."""
    return float(np.ptp(values) / (2.0 * np.sqrt(2.0) * np.sqrt(np.mean(values**2))))


def schroeder(m: int) -> Array:
    """Schroeder's phases (m,) rad of m harmonics of equal power."""
    k = np.arange(1, m + 1)
    return np.asarray(-np.pi * k * (k - 1) / m)


def _one(
    amplitude: float, start: float, period: float, harmonics: tuple[int, ...], cycles: int
) -> Multisine:
    k = np.array(harmonics, dtype=np.float64)
    phases = _optimized(k, schroeder(len(k)))
    phases = phases + k * _zero(k, phases)  # a shift in time: the same wave from a zero on
    turn = _grid(k)
    peak = np.max(np.abs(np.sin(np.outer(turn, k) + phases).sum(axis=1)))
    return Multisine(
        start=start,
        period=period,
        harmonics=harmonics,
        amplitudes=(amplitude / float(peak),) * len(harmonics),
        phases=tuple(float(p) for p in np.mod(phases, 2.0 * np.pi)),
        cycles=cycles,
    )


def _grid(k: Array) -> Array:
    return np.linspace(0.0, 2.0 * np.pi, _POINTS * int(k.max()), endpoint=False)


def _optimized(k: Array, phases: Array) -> Array:
    """Phases of a lower peak, by minimizing norms of rising power (Guillaume et al. 1991).

    IEEE Trans. Instrumentation and Measurement 40, 982. The best of the steps is kept, so that the
    result is never worse than the start.
    """
    turn = np.outer(_grid(k), k)
    sine, cosine = np.sin(turn), np.cos(turn)
    rms = np.sqrt(0.5 * len(k))

    def wave(phi: Array) -> Array:
        return np.asarray((sine @ np.cos(phi) + cosine @ np.sin(phi)) / rms)

    def cost(phi: Array, power: int) -> tuple[float, Array]:
        values = wave(phi)
        top = np.max(np.abs(values))
        weights = (values / top) ** (power - 1)
        mean = float(np.mean(weights * values / top))
        slope = (weights @ cosine) * np.cos(phi) - (weights @ sine) * np.sin(phi)
        slope *= mean ** (1.0 / power - 1.0) / (rms * len(values))
        return float(top * mean ** (1.0 / power)), slope

    def peak(phi: Array) -> float:
        return relative_peak_factor(wave(phi))

    best, value = phases, peak(phases)
    for power in _POWERS:
        phases = minimize(
            cost, phases, args=(power,), jac=True, method="L-BFGS-B", options={"maxiter": 100}
        ).x
        if peak(phases) < value:
            best, value = phases, peak(phases)
    return np.asarray(best)


def _zero(k: Array, phases: Array) -> float:
    """An angle of the period at which the wave passes through zero, rad."""

    def wave(turn: float) -> float:
        return float(np.sin(k * turn + phases).sum())

    grid = _grid(k)
    values = np.sin(np.outer(grid, k) + phases).sum(axis=1)
    i = int(np.flatnonzero(np.diff(np.sign(values)) != 0)[0])  # no constant part: there is one
    return float(brentq(wave, grid[i], grid[i + 1], xtol=1e-15, rtol=1e-15))
