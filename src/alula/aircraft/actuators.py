"""The actuator between a command and a control's position."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Actuator:
    """A first-order lag with limits, in Alula's notation: rad, or 1 for the throttle.

    tau: s. rate_limit: per second, infinite where there is none. low, high: position limits,
    infinite where the file states none. dead_band: full width around the command in which the
    control stays where it is.
    """

    tau: float
    rate_limit: float
    low: float
    high: float
    dead_band: float
