"""The log card: what is in a log, channel by channel, and in its maneuvers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message
from alula.flight import Channel, Flight, Maneuver, SourceFile, gaps, gaps_within
from alula.logs.maneuvers import samples

ENTRY_S = 0.5  # s at the start of a maneuver whose median is its entry condition
ENTRY = ("V", "V_cas", "mach", "h", "alpha", "beta", "theta", "phi", "df", "thrust", "fuel_used")


@dataclass(frozen=True)
class ChannelCard:
    """One channel: SI values. step: its quantization, NaN where the values lie on no grid."""

    name: str
    unit: str
    source: str
    n: int
    missing: int  # samples that are NaN
    rate: float  # Hz, median
    start: float  # s
    end: float
    gaps: tuple[tuple[float, float], ...]
    minimum: float
    median: float
    maximum: float
    step: float


@dataclass(frozen=True)
class ManeuverCard:
    """One maneuver: samples of its fastest channel, gaps, and the medians at its entry, SI."""

    id: str
    log: str
    kind: str
    aspect: str
    held_out: bool
    configuration: Mapping[str, str]
    start: float
    end: float
    samples: int
    gaps: tuple[tuple[float, float], ...]
    entry: Mapping[str, float]


@dataclass(frozen=True)
class LogCard:
    """What `alula check` prints and the report begins with."""

    log: str
    files: tuple[SourceFile, ...]
    channels: tuple[ChannelCard, ...]
    maneuvers: tuple[ManeuverCard, ...]
    messages: tuple[Message, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain dicts and lists for JSON; numbers that are not finite are None."""
        plain: dict[str, Any] = _plain(asdict(self))
        return plain


def log_card(flight: Flight, maneuvers: Iterable[Maneuver] = ()) -> LogCard:
    """The card of one log and of those maneuvers that are its own."""
    own = [m for m in maneuvers if m.log == flight.id]
    return LogCard(
        flight.id,
        flight.files,
        tuple(_channel(c) for c in flight.channels.values()),
        tuple(_maneuver(flight, m) for m in own),
        flight.messages,
    )


def _channel(channel: Channel) -> ChannelCard:
    values = channel.values[np.isfinite(channel.values)]
    low, middle, high = (
        (float(values.min()), float(np.median(values)), float(values.max()))
        if len(values)
        else (math.nan,) * 3
    )
    return ChannelCard(
        channel.name,
        channel.unit,
        channel.source,
        len(channel.values),
        len(channel.values) - len(values),
        channel.rate if len(channel.t) > 2 else math.nan,
        float(channel.t[0]),
        float(channel.t[-1]),
        tuple((g.start, g.end) for g in gaps(channel)),
        low,
        middle,
        high,
        quantization(values),
    )


def quantization(values: Array) -> float:
    """The step of the grid that all values lie on; NaN if they lie on none.

    The smallest difference between values that occur counts as the step if every value is a whole
    number of such steps from the least one, to a twentieth of a step, and if steps are shared by
    several samples: n different values of n samples are no grid.
    """
    if len(values) < 10:
        return math.nan
    levels = np.unique(values)
    if len(levels) < 2 or len(levels) > 0.8 * len(values):
        return math.nan
    differences = np.diff(levels)
    real = differences[differences > 1e-9 * np.ptp(levels)]  # the rest is rounding
    step = float(real.min())
    count = (levels - levels[0]) / step
    if count[-1] > 1e7 or np.abs(count - np.round(count)).max() > 0.05:
        return math.nan
    return float(np.ptp(levels) / np.round(count[-1]))


def _maneuver(flight: Flight, maneuver: Maneuver) -> ManeuverCard:
    entry = {}
    for name in ENTRY:
        if name not in flight:
            continue
        channel = flight[name]
        inside = (channel.t >= maneuver.start) & (channel.t <= maneuver.start + ENTRY_S)
        values = channel.values[inside & np.isfinite(channel.values)]
        if len(values):
            entry[name] = float(np.median(values))
    return ManeuverCard(
        maneuver.id,
        maneuver.log,
        maneuver.kind,
        maneuver.aspect,
        maneuver.held_out,
        dict(maneuver.configuration),
        maneuver.start,
        maneuver.end,
        max((samples(flight, n, maneuver.start, maneuver.end) for n in flight.channels), default=0),
        tuple((g.start, g.end) for g in gaps_within(flight, maneuver.start, maneuver.end)),
        entry,
    )


def _plain(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return value
