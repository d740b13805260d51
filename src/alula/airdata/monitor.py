"""Voting among sources of one flow angle: vanes, probe, ASSE, navigation, lift model.

Front of core/include/alula/airdata/monitor.hpp.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.core import core

HEALTH = ("healthy", "dead", "stuck", "biased", "noisy")
MOST = 8


@dataclass(frozen=True)
class Source:
    """white: rad, noise of one reading; slow: rad, standard deviation of errors that last.

    stuck_after: equal readings in a row that a live source does not give; 0: not watched.
    """

    white: float
    slow: float
    stuck_after: int = 25


@dataclass(frozen=True)
class MonitorSettings:
    """mean_time: s. bias_limit, gate: standard deviations. noise_limit: times expected power.

    dead_after: s without a reading. readmit: s of good behavior after which a source is back, 0:
    never. longest_step: s, a longer gap starts anew.
    """

    mean_time: float = 0.4
    bias_limit: float = 5.0
    noise_limit: float = 4.0
    dead_after: float = 0.5
    readmit: float = 0.0
    gate: float = 4.0
    longest_step: float = 1.0


@dataclass(frozen=True)
class Named:
    """A source that was taken out: when (s), and why."""

    source: str
    t: float
    reason: str


@dataclass(frozen=True)
class Voted:
    """angle, sigma: (n,) rad, of the healthy sources; NaN without any. used: (n,) how many.

    split: (n,) bool, two that disagree. health: (n, m) index into HEALTH, by `names`.
    """

    t: Array
    angle: Array
    sigma: Array
    used: Any
    split: Any
    names: tuple[str, ...]
    health: Any
    named: tuple[Named, ...]
    messages: tuple[Message, ...] = ()


def monitor(
    t: Array,
    readings: Mapping[str, Array],
    sources: Mapping[str, Source],
    settings: MonitorSettings | None = None,
) -> Voted:
    """Vote over readings (n,) rad by source at times t (n,) s; NaN where a source has none.

    Raises BadInput for a source without readings, no noise, or more than eight.
    """
    settings = settings or MonitorSettings()
    missing = [n for n in sources if n not in readings or len(readings[n]) != len(t)]
    flat = [n for n, s in sources.items() if not s.white**2 + s.slow**2 > 0.0]
    if missing or flat or not 1 <= len(sources) <= MOST:
        raise refuse(
            "monitor_sources",
            where="air-data monitor",
            expected=f"1 to {MOST} sources with noise, each with {len(t)} readings",
            found=f"{len(sources)}; without readings: {', '.join(missing) or 'none'}; without "
            f"noise: {', '.join(flat) or 'none'}",
            do="State the noise of every source, and give all on one grid, NaN where none is.",
        )
    names = tuple(sources)
    n, m = len(t), len(names)
    rows = np.ascontiguousarray(np.column_stack([readings[k] for k in names]), dtype=np.float64)
    out, health = np.empty((n, 4)), np.empty((n, m), dtype=np.int32)
    taken = np.empty(n, dtype=np.int32)
    refused = core.monitor(
        np.array([astuple(sources[k]) for k in names], dtype=np.float64),
        np.array(astuple(settings), dtype=np.float64),
        np.ascontiguousarray(t, dtype=np.float64), rows, out, health, taken,
    )  # fmt: skip
    named = tuple(
        Named(names[taken[k]], float(t[k]), HEALTH[health[k, taken[k]]])
        for k in np.flatnonzero(taken >= 0)
    )
    messages = [
        warn(
            f"source_{one.reason}",
            where=f"air-data monitor, {one.source}",
            expected="a source that agrees with the others",
            found=f"{one.reason} at {one.t:.6g} s",
            do="It has no vote from then on.",
        )
        for one in named
    ]
    if refused:
        messages.append(
            warn(
                "backward_time",
                where="air-data monitor",
                expected="time that goes on",
                found=f"{refused} steps of {n} where it does not",
                do="They are passed over.",
            )
        )
    return Voted(
        frozen(t), frozen(out[:, 0]), frozen(out[:, 1]), out[:, 2].astype(int), out[:, 3] > 0.5,
        names, health, named, tuple(messages),
    )  # fmt: skip
