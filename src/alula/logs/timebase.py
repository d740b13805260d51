"""Time stamps of a log: increasing, or repaired where that is allowed; gaps listed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.base.project import LogSpec
from alula.flight.gaps import describe, gaps_of

MOST_DROPPED = 0.1  # of all stamps: beyond, the clock was set anew and dropping is no repair


@dataclass(frozen=True)
class TimeBase:
    """t: (n,) s, increasing. keep: indices of the samples that stay, None for all.

    recorded: number of samples before repair; channels on this base must have as many.
    """

    t: Array
    keep: NDArray[np.int64] | None
    recorded: int
    messages: tuple[Message, ...]


def time_base(log: LogSpec, label: str, stamps: Array) -> TimeBase:
    """Check the stamps (s) of one time channel.

    Raises BadInput for stamps that are double, run backward or are no numbers, unless the log's
    `repair` allows to drop them; the message then counts them.
    """
    where = f"{log.path}: time {label}"
    t = np.asarray(stamps, dtype=np.float64)
    recorded, messages = len(t), []
    if recorded < 2:
        raise refuse(
            "too_few_samples",
            where=where,
            expected="two samples or more",
            found=str(recorded),
            do="Check that the file is complete.",
        )
    good = np.isfinite(t)
    highest = np.maximum.accumulate(np.where(good, t, -np.inf))
    previous = np.concatenate(([-np.inf], highest[:-1]))
    backward = ~good | (t < previous)
    double = good & (t == previous)
    for code, bad, repair, what in (
        ("backward_time", backward, "drop_backward_times", "before an earlier one, or no number"),
        ("duplicate_time", double, "drop_duplicate_times", "equal to the one before"),
    ):
        count = int(bad.sum())
        if count == 0:
            continue
        i = int(np.flatnonzero(bad)[0])
        before = t[i - 1] if i else np.nan
        found = f"{count} of {recorded} {what}; first at sample {i + 1} ({before:.9g} s, then "
        found += f"{t[i]:.9g} s)"
        if repair not in log.repair or count > MOST_DROPPED * recorded:
            many = count > MOST_DROPPED * recorded
            raise refuse(
                code,
                where=where,
                expected="time stamps that increase",
                found=found,
                do="So many are no slip: check the time channel and its unit, or cut the log."
                if many
                else f"Mend the log, or allow repair = ['{repair}'] for it.",
            )
        messages.append(
            warn(
                f"dropped_{code}",
                where=where,
                expected="time stamps that increase",
                found=f"{found}; these samples were dropped",
                do="Look at the log there.",
            )
        )
    keep = None
    if messages:
        keep = np.flatnonzero(~(backward | double)).astype(np.int64)
        t = t[keep]
    messages += _gap_message(where, t)
    return TimeBase(frozen(t), keep, recorded, tuple(messages))


def _gap_message(where: str, t: Array) -> list[Message]:
    dt = np.diff(t)
    found = gaps_of(t)
    messages = []
    if found:
        messages.append(
            warn(
                "gaps",
                where=where,
                expected=f"a sample every {np.median(dt):.4g} s",
                found=f"{len(found)} gaps: {describe(found)}",
                do="Maneuvers across a gap are refused, or split where on_gap = 'split'.",
            )
        )
    usual = dt[dt <= 3.0 * np.median(dt)]
    if len(usual) > 2 and np.ptp(usual) > 0.5 * np.median(dt):
        messages.append(
            warn(
                "irregular_sampling",
                where=where,
                expected=f"a sample every {np.median(dt):.4g} s",
                found=f"intervals from {usual.min():.4g} to {usual.max():.4g} s",
                do="Nothing, if the stamps are true; methods use the stamps as they are.",
            )
        )
    return messages
