"""Heights in feet that are declared in meters, or the other way, by what else tells the height."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from alula.base.messages import Message
from alula.base.project import ChannelSpec, LogSpec
from alula.base.units import FT, to_si
from alula.flight import Channel
from alula.logs.changes import at, integral, together
from alula.logs.unit_message import other_unit_message

WINDOW = 2.0  # s over which climbs are compared
ALIKE = 0.9  # correlation of two accounts of the climb
NEAR = 0.3  # of the ratio's logarithm, from that of feet and meters, 1.19


def heights(
    log: LogSpec, specs: Mapping[str, ChannelSpec], channels: Mapping[str, Channel]
) -> list[Message]:
    """An error for each of h and h_gps whose unit looks like the other one; a warning where the
    project confirms it."""
    out = []
    for name in ("h", "h_gps"):
        if name not in channels or specs[name].constant is not None:
            continue
        other = other_unit(name, channels, specs[name].unit or "m")
        if other is None:
            continue
        unit, words, times = other
        out.append(
            other_unit_message(
                log, name, f"climbs as {words}", f"{times:.3g} times as much", unit,
                confirmed=specs[name].confirmed,
            )
        )  # fmt: skip
    return out


def other_unit(
    name: str, channels: Mapping[str, Channel], stated: str
) -> tuple[str, str, float] | None:
    """The unit that the height looks recorded in, by what, and how many times as much it climbs."""
    scale = to_si(stated).scale
    for words, ratio in _accounts(name, channels):
        for unit in ("m", "ft"):
            off = abs(math.log(to_si(unit).scale / scale / ratio))
            # the ratio of feet and meters, whatever unit is stated
            if off < NEAR and abs(abs(math.log(ratio)) + math.log(FT)) < NEAR:
                return unit, words, 1.0 / ratio
    return None


def _accounts(name: str, channels: Mapping[str, Channel]) -> Iterator[tuple[str, float]]:
    """What tells the climb, in words, and the true change over the recorded one by it."""
    h = channels[name]
    good = np.isfinite(h.values)
    if good.sum() < 20 or h.t[good][-1] - h.t[good][0] < 8.0 * WINDOW:
        return
    t = h.t[good]
    grid = np.arange(float(t[0]), float(t[-1]), WINDOW)
    climbed = np.diff(np.interp(grid, t, h.values[good]))
    rates = []
    for other, sign in (("v_down", -1.0), ("climb_rate", 1.0)):
        rate = at(channels, other, t)
        if rate is not None:
            rates.append((f"{other} integrated", sign * rate))
    V, theta, alpha = (at(channels, n, t) for n in ("V", "theta", "alpha"))
    phi = at(channels, "phi", t)
    if V is not None and theta is not None and alpha is not None:
        level = 1.0 if phi is None else np.cos(phi)
        rates.append(("V, theta and alpha say", V * np.sin(theta - level * alpha)))
    for words, rate in rates:
        alike, ratio = together(np.diff(np.interp(grid, t, integral(t, rate))), climbed)
        if alike > ALIKE:
            yield words, ratio
