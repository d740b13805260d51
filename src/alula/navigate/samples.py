"""What the filters take: inertial samples, and readings of other sensors as they arrived."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.core import core

KINDS: tuple[str, ...] = tuple(core.NAVIGATE_KINDS.split())
TAKEN: tuple[str, ...] = tuple(core.NAVIGATE_TAKEN.split())
VECTORS = ("position", "velocity", "field")
MICRO = 1e6  # the core's numbers stay near one in microtesla


@dataclass(frozen=True)
class Inertial:
    """t (n,) s; rate (n, 3) rad/s, force (n, 3) m/s2 (level: az = -9.81), body axes."""

    t: Array
    rate: Array
    force: Array

    def __post_init__(self) -> None:
        n = len(self.t)
        if n < 2 or self.rate.shape != (n, 3) or self.force.shape != (n, 3):
            raise refuse(
                "inertial_shape",
                where="navigation, inertial samples",
                expected="two or more samples: t (n,), rate (n, 3), force (n, 3)",
                found=f"{self.t.shape}, {self.rate.shape}, {self.force.shape}",
                do="Give one row per time.",
            )


@dataclass(frozen=True)
class Readings:
    """One sensor: kind of KINDS, t (m,) s when it was true, values (m,) or (m, 3).

    position, velocity: NED, m, m/s; field: body axes, T; height m; V m/s; alpha, beta rad. sigma:
    standard deviation, one or one per axis. arrived (m,): when the filter got it; None: at once.
    A NaN is handed on: the filter counts it and stays as it was.
    """

    kind: str
    t: Array
    values: Array
    sigma: float | Sequence[float]
    arrived: Array | None = field(default=None)

    def events(self) -> Array:
        """Rows (m, 9) as the core takes them."""
        m = len(self.t)
        width = 3 if self.kind in VECTORS else 1
        values = np.asarray(self.values, dtype=np.float64).reshape(len(self.values), -1)
        sigma = np.broadcast_to(np.asarray(self.sigma, dtype=np.float64), (width,))
        arrived = self.t if self.arrived is None else self.arrived
        if (
            self.kind not in KINDS
            or values.shape != (m, width)
            or len(arrived) != m
            or not (np.isfinite(sigma).all() and (sigma > 0.0).all())
        ):
            raise refuse(
                "readings",
                where=f"navigation, readings of '{self.kind}'",
                expected=f"one of {', '.join(KINDS)}; one value a time ({width} wide), sigma > 0",
                found=f"values {values.shape} for {m} times, sigma {self.sigma}",
                do="Correct the readings.",
            )
        rows = np.zeros((m, 9))
        rows[:, 0] = KINDS.index(self.kind)
        rows[:, 1], rows[:, 2] = arrived, self.t
        scale = MICRO if self.kind == "field" else 1.0
        rows[:, 3 : 3 + width] = scale * values
        rows[:, 6:9] = scale * (sigma if width == 3 else sigma[0])
        return rows


def merged(readings: Sequence[Readings]) -> tuple[Array, NDArray[np.intp]]:
    """Rows (m, 9) of all readings in the order of arrival, and whose each is (m,) of indices."""
    parts = [r.events() for r in readings]
    rows = np.concatenate([*parts, np.zeros((0, 9))])
    whose = np.repeat(np.arange(len(parts)), [len(p) for p in parts])
    # a stamp that is no number cannot be put in order: it comes last and is refused there
    order = np.argsort(np.where(np.isfinite(rows[:, 1]), rows[:, 1], np.inf), kind="stable")
    return np.ascontiguousarray(rows[order]), whose[order]


def assumed_sideslip(inertial: Inertial, sigma: float = 0.12, rate: float = 1.0) -> Readings:
    """Sideslip near zero, as readings of what is not measured: an airplane flies straight ahead.

    Without it an airspeed alone leaves the wind across unknown until the flight has turned. sigma:
    rad, of the true sideslip about zero; wide, because what a turn adds
    lasts; rate: Hz.
    """
    t = inertial.t[np.isfinite(inertial.t)]
    stamps = np.arange(float(t[0]), float(t[-1]), 1.0 / rate)
    return Readings("beta", stamps, np.zeros(len(stamps)), sigma)


def row(values: Array) -> Array:
    """The values as the core takes them: contiguous, double."""
    return np.ascontiguousarray(values, dtype=np.float64)


def just_before(t: float, inertial: Inertial) -> float:
    """A start `t`, s, at the first sample lies just before it, so that this is the first step."""
    if t < float(inertial.t[0]):
        return t
    usual = _usual_step(inertial)
    return t - (1e-3 if usual is None else usual)


def longest_step(inertial: Inertial) -> float:
    """Time between samples, s, beyond which there is a hole: 0.1; 0.15 for samples at 10 Hz."""
    usual = _usual_step(inertial)
    return 0.1 if usual is None else min(max(0.1, 1.5 * usual), 0.2)


def _usual_step(inertial: Inertial) -> float | None:
    """Median time between samples, s; None where none goes on."""
    steps = np.diff(inertial.t[np.isfinite(inertial.t)])
    steps = steps[steps > 0.0]
    return float(np.median(steps)) if len(steps) else None
