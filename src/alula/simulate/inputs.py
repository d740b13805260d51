"""Control inputs for maneuvers: small immutable signals with a pure `value(t)`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from alula.base.arrays import Array


class Signal(Protocol):
    """Anything that has a value at a time."""

    def value(self, t: Array) -> Array:
        """Values (n,) at times t (n,), s."""
        ...


@dataclass(frozen=True)
class Pulse:
    """`amplitude` from `start` for `duration` s, zero elsewhere; ramp: as in `Steps`, s."""

    amplitude: float
    start: float
    duration: float
    ramp: float = 0.0

    @property
    def end(self) -> float:
        """Time at which the pulse ends, s."""
        return self.start + self.duration

    def value(self, t: Array) -> Array:
        """Values (n,) at times t (n,), s."""
        return Steps(self.amplitude, self.start, (self.duration,), (1.0,), self.ramp).value(t)


@dataclass(frozen=True)
class Steps:
    """A train of steps: sign or size `levels[i]` times `amplitude` for `widths[i]` s, from `start`.

    ramp: time of each change of level (s), begun at the step's edge, a half cosine as a hand or an
    actuator makes it; 0 for ideal edges.
    """

    amplitude: float
    start: float
    widths: tuple[float, ...]
    levels: tuple[float, ...]
    ramp: float = 0.0

    def __post_init__(self) -> None:
        if len(self.widths) != len(self.levels):
            raise ValueError(f"{len(self.widths)} widths but {len(self.levels)} levels")

    @property
    def end(self) -> float:
        """Time at which the last step ends, s."""
        return self.start + sum(self.widths)

    def value(self, t: Array) -> Array:
        """Values (n,) at times t (n,), s."""
        edges = self.start + np.concatenate([[0.0], np.cumsum(self.widths)])
        levels = np.concatenate([[0.0], self.levels, [0.0]])
        out = np.zeros(np.shape(t))
        for edge, change in zip(edges, np.diff(levels), strict=True):
            part = np.asarray(t >= edge, dtype=np.float64)
            if self.ramp > 0.0:
                part = 0.5 - 0.5 * np.cos(np.pi * np.clip((t - edge) / self.ramp, 0.0, 1.0))
            out = out + self.amplitude * change * part
        return out


@dataclass(frozen=True)
class Sweep:
    """A sine of rising (or falling) frequency, faded in and out.

    low, high: first and last frequency, Hz, over `duration` s from `start`. logarithmic: as many
    seconds for each octave (Tischler and Remple, Aircraft and Rotorcraft System Identification,
    2nd ed., Sec. 5.11, take such a law); else as many for each hertz. fade: time of the half
    cosine at either end, s. Begins and, with a fade, ends at zero.
    """

    amplitude: float
    start: float
    duration: float
    low: float
    high: float
    logarithmic: bool = False
    fade: float = 0.0

    def __post_init__(self) -> None:
        if not (self.duration > 0.0 and self.low > 0.0 and self.high > 0.0):
            raise ValueError("duration and both frequencies of a sweep are above zero")
        if not 0.0 <= 2.0 * self.fade <= self.duration:
            raise ValueError(f"two fades of {self.fade} s do not fit into {self.duration} s")

    @property
    def end(self) -> float:
        """Time at which the sweep ends, s."""
        return self.start + self.duration

    def cycles(self, t: Array) -> Array:
        """Cycles done (n,) at times t (n,), s; its derivative is the frequency, Hz."""
        part = np.clip((t - self.start) / self.duration, 0.0, 1.0)
        if self.logarithmic and self.high != self.low:
            ratio = np.log(self.high / self.low)
            return np.asarray(self.low * self.duration / ratio * np.expm1(ratio * part))
        return np.asarray(self.duration * part * (self.low + 0.5 * (self.high - self.low) * part))

    def value(self, t: Array) -> Array:
        """Values (n,) at times t (n,), s."""
        inside = (t >= self.start) & (t <= self.end)
        level = np.ones(np.shape(t))
        if self.fade > 0.0:
            edge = np.minimum(t - self.start, self.end - t) / self.fade
            level = 0.5 - 0.5 * np.cos(np.pi * np.clip(edge, 0.0, 1.0))
        wave = self.amplitude * level * np.sin(2.0 * np.pi * self.cycles(t))
        return np.where(inside, wave, 0.0)


@dataclass(frozen=True)
class Delay:
    """A signal that comes `delay` s later, as by a pilot's reaction or a computer."""

    signal: Signal
    delay: float

    def value(self, t: Array) -> Array:
        """Values (n,) at times t (n,), s."""
        return self.signal.value(t - self.delay)


@dataclass(frozen=True)
class Sum:
    """The sum of signals, such as a doublet on top of a trim deflection."""

    parts: tuple[Signal, ...]
    constant: float = 0.0

    def value(self, t: Array) -> Array:
        """Values (n,) at times t (n,), s."""
        return self.constant + sum((s.value(t) for s in self.parts), np.zeros(np.shape(t)))


def doublet(amplitude: float, start: float, width: float, ramp: float = 0.0) -> Steps:
    """Up for `width` s, down for `width` s."""
    return Steps(amplitude, start, (width, width), (1.0, -1.0), ramp)


def input_3211(amplitude: float, start: float, unit: float, ramp: float = 0.0) -> Steps:
    """The 3-2-1-1 input: alternating steps of 3, 2, 1 and 1 `unit` s.

    It excites a wider band than a doublet of the same length (Jategaonkar, Flight Vehicle System
    Identification, chapter 2).
    """
    return Steps(amplitude, start, (3 * unit, 2 * unit, unit, unit), (1.0, -1.0, 1.0, -1.0), ramp)


def bank_to_bank(
    amplitude: float,
    start: float,
    width: float,
    hold: float = 0.0,
    ramp: float = 0.0,
    levels: Sequence[float] = (1.0, -1.0, 1.0),
) -> Steps:
    """Ailerons for a bank to one side, through to the other, and back to level.

    width: time of the first and the last deflection, s; the one between lasts twice as long; hold:
    neutral time at each bank angle.
    """
    first, through, last = levels
    return Steps(
        amplitude,
        start,
        (width, hold, 2 * width, hold, width),
        (first, 0.0, through, 0.0, last),
        ramp,
    )
