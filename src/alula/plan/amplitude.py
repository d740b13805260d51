"""The largest amplitude that keeps the aircraft inside its limits, found by flying it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from alula.aircraft import Aircraft
from alula.base.messages import BadInput, Message, note
from alula.model import AeroModel
from alula.simulate.fly import SimulatedFlight

G = 9.80665  # m/s2
BANK = (
    np.pi / 3.0
)  # rad; beyond it begin acrobatics (14 CFR 91.303 and CS-23.3 draw the line there)
SHARE = 0.9  # of the way to a limit that is used: the a-priori model is not the aircraft


@dataclass(frozen=True)
class Limits:
    """(lowest, highest) of what a maneuver may reach: SI, rad; n is the load factor."""

    ranges: Mapping[str, tuple[float, float]]
    messages: tuple[Message, ...] = field(default=())


def limits_of(aircraft: Aircraft, model: AeroModel) -> Limits:
    """The limits that the aircraft file and the model's validity state, and 60 deg of bank.

    A message names what neither states.
    """
    e = aircraft.envelope
    ranges = {"phi": (-BANK, BANK)}
    for name, pair in (("V", e.V), ("alpha", e.alpha), ("n", e.n), ("h", e.h)):
        if pair is not None:
            ranges[name] = pair
    for name in ("alpha", "beta"):
        if name in model.validity:
            low, high = model.validity[name]
            before = ranges.get(name, (-np.inf, np.inf))
            ranges[name] = (max(low, before[0]), min(high, before[1]))
    messages = tuple(
        note(
            "no_limit",
            where=aircraft.path,
            expected=f"a limit of {name} in [envelope]",
            found="none",
            do="Amplitudes are limited by what is stated; add it to have it kept.",
        )
        for name in ("V", "alpha", "n")
        if name not in ranges
    )
    return Limits(ranges, messages)


def outside(flight: SimulatedFlight, limits: Limits) -> dict[str, tuple[float, float]]:
    """What leaves its limits, with the (lowest, highest) value reached, SI, rad."""
    m = flight.motion
    reached = {"n": -m.az / G} | {k: getattr(m, k) for k in ("V", "alpha", "beta", "phi", "h")}
    out = {}
    for name, (low, high) in limits.ranges.items():
        least, most = float(np.min(reached[name])), float(np.max(reached[name]))
        if least < low or most > high:
            out[name] = (least, most)
    return out


def largest_amplitude(
    flown: Callable[[float], SimulatedFlight], most: float, limits: Limits, *, steps: int = 8
) -> tuple[float, str]:
    """The largest amplitude, rad, up to `most`, whose flight stays inside the limits, and what
    bounds it; nine tenths of it are kept.

    flown: the flight with an amplitude. Found by halving, so to `most` / 2^steps. 0 where even the
    trim is outside.
    """

    def left(amplitude: float) -> str:
        try:
            return ", ".join(outside(flown(amplitude), limits))
        except BadInput:  # it diverged
            return "stability"

    bound = left(0.0)
    if bound:
        return 0.0, bound
    bound = left(most)
    if not bound:
        return most, "control"
    low, high = 0.0, most
    for _ in range(steps):
        middle = 0.5 * (low + high)
        now = left(middle)
        low, high, bound = (low, middle, now) if now else (middle, high, bound)
    return SHARE * low, bound
