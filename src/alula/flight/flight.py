"""A flight as it was recorded: channels at their native rates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse
from alula.base.units import known_channel


@dataclass(frozen=True)
class SourceFile:
    """One file that was read, with every byte accounted for: the three counts sum to `bytes`."""

    path: str
    sha256: str
    bytes: int
    decoded: int
    skipped: int
    unknown: int


@dataclass(frozen=True)
class Channel:
    """One recorded quantity in SI units, on its own time base.

    t: (n,) s, increasing. values: (n,) in `unit`; NaN where the log has no valid sample.
    source: where it came from and how it was converted, in words.
    """

    name: str
    t: Array
    values: Array
    unit: str
    source: str

    @property
    def rate(self) -> float:
        """Median sample rate, Hz."""
        return float(1.0 / np.median(np.diff(self.t)))


@dataclass(frozen=True)
class Flight:
    """The channels of one log by name, with the files and what was noticed while reading."""

    id: str
    channels: Mapping[str, Channel]
    files: tuple[SourceFile, ...] = ()
    messages: tuple[Message, ...] = ()

    def __getitem__(self, name: str) -> Channel:
        """The channel `name`; raises BadInput naming the channels there are."""
        try:
            return self.channels[name]
        except KeyError:
            own = [c for c in self.channels if known_channel(c) is None]
            near = get_close_matches(name, own, n=1, cutoff=0.66)
            raise refuse(
                "missing_channel",
                where=f"log {self.id}",
                expected=f"channel '{name}'",
                found=", ".join(sorted(self.channels)) or "no channels",
                do=f"Map '{name}' in [channels] of the project file."
                + (f" Is '{near[0]}' a slip of the pen?" if near else ""),
            ) from None

    def __contains__(self, name: str) -> bool:
        return name in self.channels

    @property
    def start(self) -> float:
        """Earliest time stamp of any channel that has more than one sample, s."""
        return min(float(c.t[0]) for c in self.channels.values() if len(c.t) > 1)

    @property
    def end(self) -> float:
        """Latest time stamp of any channel, s."""
        return max(float(c.t[-1]) for c in self.channels.values() if len(c.t) > 1)
