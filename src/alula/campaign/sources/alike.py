"""Like compared with like: sums of a rate's and its lag's derivative where flight shows only those.

Short period and Dutch roll show Cm_q + Cm_alphadot and Cn_r - Cn_betadot; identified derivatives,
and models that fly, are these sums. A source that states both is given the sum; one that states
only the rate's is marked. A lag of the sideslip that nobody states counts as none, with a note.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from alula.base.messages import Message, note, warn
from alula.identify.compare import ALONE, Column, Entry
from alula.predict.combine import PAIRS

FLOWN = ("identification", "model")


def alike(columns: Sequence[Column]) -> tuple[list[Column], list[Message]]:
    """The columns with sums in place of their parts, and what could not be made alike."""
    entries = [dict(c.entries) for c in columns]
    alone: dict[str, list[str]] = {}
    for rate, (lag, sign) in PAIRS.items():
        flown = [
            rate in e and (c.kind in FLOWN or e[rate].verdict == "sum")
            for c, e in zip(columns, entries, strict=True)
        ]
        both = [rate in e and lag in e for e in entries]
        if not any(flown) and not any(both):
            continue
        key = f"{rate} {'+' if sign > 0.0 else '-'} {lag}"
        named = key if any(both) or any(_is_sum(e.get(rate)) for e in entries) else rate
        apart = sum(both) > 1
        for column, e, is_flown, has_both in zip(columns, entries, flown, both, strict=True):
            if rate not in e:
                if not apart:
                    e.pop(lag, None)
                continue
            own = e[rate] if apart and not is_flown else e.pop(rate)
            if is_flown:
                e[named] = replace(own, verdict="") if _is_sum(own) else own
            elif has_both:
                other = e[lag] if apart else e.pop(lag)
                # Both hang on one lift of the tail: their errors are taken to go together.
                e[named] = Entry(own.value + sign * other.value, own.se + other.se, "", own.unit)
            else:
                e[named] = replace(own, verdict=ALONE) if lag.endswith("alphadot") else own
                alone.setdefault(column.name, []).append(rate)
    said = [_said(name, rates) for name, rates in alone.items()]
    out = [
        replace(c, entries=_ordered(e, list(c.entries)))
        for c, e in zip(columns, entries, strict=True)
    ]
    return out, said


def _ordered(entries: dict[str, Entry], before: Sequence[str]) -> dict[str, Entry]:
    """A sum stands where its rate stood."""
    place = {name: i for i, name in enumerate(before)}
    return dict(sorted(entries.items(), key=lambda item: place[item[0].split(" ")[0]]))


def _is_sum(entry: Entry | None) -> bool:
    return entry is not None and entry.verdict == "sum"


def _said(name: str, rates: Sequence[str]) -> Message:
    lags = ", ".join(PAIRS[r][0] for r in rates)
    serious = any(PAIRS[r][0].endswith("alphadot") for r in rates)
    return (warn if serious else note)(
        "lag_not_stated",
        where=name,
        expected=f"{lags} beside {', '.join(rates)}: flight shows their sums",
        found="not stated",
        do="Marked * where the angle of attack's lag is missing: a part of the sum."
        if serious
        else "Counted as none; the sidewash's lag is small on ordinary airplanes.",
    )
