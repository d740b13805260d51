"""Gaps in a recording: where the interval is over three times the median one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.flight.flight import Channel, Flight
from alula.flight.maneuver import Maneuver

# One or two lost samples of a regular recording are bridged by their neighbors; the hundredth is
# for the rounding of the stamps.
FACTOR = 3.0 * 1.01


@dataclass(frozen=True)
class Gap:
    """No sample between `start` and `end`, s; both are stamps of samples."""

    start: float
    end: float
    channels: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """Length, s."""
        return self.end - self.start


def gaps_of(t: Array) -> tuple[Gap, ...]:
    """The gaps of increasing time stamps t (n,) s: intervals over 3 times the median."""
    if len(t) < 3:
        return ()
    dt = np.diff(t)
    at = np.flatnonzero(dt > FACTOR * np.median(dt))
    return tuple(Gap(float(t[i]), float(t[i + 1])) for i in at)


def gaps(channel: Channel) -> tuple[Gap, ...]:
    """The gaps between the valid samples of a channel; samples that are NaN are not there.

    The median interval is that of the stamps, so a channel of a slower sensor that fills every
    fifth row should be read as its own time base (the reader does so).
    """
    valid = np.isfinite(channel.values)
    if valid.all():
        return gaps_of(channel.t)
    if len(channel.t) < 3 or valid.sum() < 2:
        return ()
    t = channel.t[valid]
    dt = np.diff(t)
    at = np.flatnonzero(dt > FACTOR * np.median(np.diff(channel.t)))
    return tuple(Gap(float(t[i]), float(t[i + 1]), (channel.name,)) for i in at)


def gaps_within(
    flight: Flight, start: float, end: float, channels: Iterable[str] | None = None
) -> tuple[Gap, ...]:
    """The gaps that touch a window, over all channels (or those named), joined where they overlap.

    A channel that begins late or ends early within the window has no gap there: whether it covers
    the window is another question.
    """
    found: list[Gap] = []
    seen: set[tuple[int, bytes]] = set()
    for name in channels if channels is not None else flight.channels:
        channel = flight[name]
        valid = np.isfinite(channel.values)
        base = (id(channel.t), b"" if valid.all() else valid.tobytes())
        for gap in gaps(channel) if base not in seen else ():
            if gap.start < end and gap.end > start:
                found.append(replace(gap, channels=(name,)))
        seen.add(base)
    joined: list[Gap] = []
    for gap in sorted(found, key=lambda g: (g.start, g.end)):
        if joined and gap.start < joined[-1].end:
            last = joined[-1]
            names = last.channels + tuple(n for n in gap.channels if n not in last.channels)
            joined[-1] = Gap(last.start, max(last.end, gap.end), names)
        else:
            joined.append(gap)
    return tuple(joined)


def split_at_gaps(
    flight: Flight, maneuver: Maneuver, channels: Iterable[str] | None = None
) -> tuple[Maneuver, ...]:
    """The maneuver's parts between gaps, named 'id.1', 'id.2', ...; itself where there is none."""
    found = gaps_within(flight, maneuver.start, maneuver.end, channels)
    if not found:
        return (maneuver,)
    edges = [maneuver.start, *(x for g in found for x in (g.start, g.end)), maneuver.end]
    parts = [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b > a]
    return tuple(
        replace(maneuver, id=f"{maneuver.id}.{k}", start=a, end=b)
        for k, (a, b) in enumerate(parts, 1)
    )


def describe(found: tuple[Gap, ...], most: int = 5) -> str:
    """'12.3 to 14.1 s, ...' for messages."""
    text = ", ".join(f"{g.start:.6g} to {g.end:.6g} s" for g in found[:most])
    return text + (f" and {len(found) - most} more" if len(found) > most else "")
