"""Results of different methods, data or sources set side by side, parameter by parameter."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

_CONSTANT = "_0"
_Z = 1.96  # of a normal distribution's 95 % interval
ALONE = "alone"  # verdict of a derivative to a rate whose lag is not known, beside sums of both


@dataclass(frozen=True)
class Entry:
    """One parameter in one column. se: NaN where the source states none.

    verdict: of the identification; 'assumed'; 'sum' of a rate's derivative with its lag's; ALONE.
    """

    value: float
    se: float = math.nan
    verdict: str = ""
    unit: str = ""


@dataclass(frozen=True)
class Column:
    """One source. kind: 'identification', 'model', 'prediction', 'avl', 'datcom' or 'table'.
    formulas: by coefficient.

    se_is: what its standard errors are, in words.
    """

    name: str
    kind: str
    method: str
    entries: Mapping[str, Entry]
    formulas: Mapping[str, str] = field(default_factory=dict)
    se_is: str = ""
    status: str = ""


@dataclass(frozen=True)
class Difference:
    """One entry against the first column's. ratio: value over the first's, NaN over zero.

    ratio_ci95: its 95 % interval by the errors that are stated, as if independent; NaN where none
    is or the first's value is not told from zero. sigmas: difference over the root of both squared
    standard errors; NaN where one states none, or one is a sum with a lag and one is not.
    """

    entry: Entry
    ratio: float
    difference: float
    sigmas: float
    ratio_ci95: tuple[float, float] = (math.nan, math.nan)


@dataclass(frozen=True)
class Row:
    """One parameter; differences: one per column, None where the column lacks it."""

    name: str
    unit: str
    differences: tuple[Difference | None, ...]

    @property
    def widest(self) -> float:
        """The largest difference from the first column, in combined standard errors."""
        found = [abs(d.sigmas) for d in self.differences[1:] if d and math.isfinite(d.sigmas)]
        return max(found, default=math.nan)


def compare(columns: Sequence[Column]) -> tuple[Row, ...]:
    """Every parameter of any column, in the first's order, then what only later ones have.

    A column whose maneuvers have constants of their own ('Cm_0[id]') is given their mean as 'Cm_0'
    beside, where another column has one constant; its error is their scatter about it, or the mean
    of their errors where that is larger.
    """
    whole = [_with_mean_constants(c, columns) for c in columns]
    names = dict.fromkeys(name for entries in whole for name in entries)
    return tuple(_row(name, [entries.get(name) for entries in whole]) for name in names)


def _row(name: str, entries: Sequence[Entry | None]) -> Row:
    base = entries[0]
    unit = next((e.unit for e in entries if e is not None and e.unit), "")
    out: list[Difference | None] = []
    for entry in entries:
        if entry is None:
            out.append(None)
        elif base is None:
            out.append(Difference(entry, math.nan, math.nan, math.nan))
        else:
            off = entry.value - base.value
            both = math.hypot(entry.se, base.se)
            ratio = entry.value / base.value if base.value else math.nan
            sigmas = 0.0 if entry is base else off / both if both > 0.0 else math.nan
            if (entry.verdict == ALONE) != (base.verdict == ALONE):
                sigmas = math.nan
            interval = (1.0, 1.0) if entry is base else ratio_interval(entry, base)
            out.append(Difference(entry, ratio, off, sigmas, interval))
    return Row(name, unit, tuple(out))


def ratio_interval(entry: Entry, base: Entry) -> tuple[float, float]:
    """95 % interval of entry over base, by Fieller's theorem (1954, J. R. Stat. Soc. B 16).

    An error that is not stated counts as none; without any, and where base is not told from zero,
    the interval is NaN: every ratio is possible.
    """
    nothing = (math.nan, math.nan)
    errors = [x.se if math.isfinite(x.se) else 0.0 for x in (entry, base)]
    if not base.value or not any(errors) or not math.isfinite(entry.value):
        return nothing
    ratio, g = entry.value / base.value, (_Z * errors[1] / base.value) ** 2
    if not g < 1.0:
        return nothing
    own = (errors[0] / base.value) ** 2
    half = _Z * math.sqrt(own * (1.0 - g) + ratio**2 * (errors[1] / base.value) ** 2)
    return (ratio - half) / (1.0 - g), (ratio + half) / (1.0 - g)


def _with_mean_constants(column: Column, columns: Sequence[Column]) -> dict[str, Entry]:
    entries = dict(column.entries)
    for name in dict.fromkeys(n for c in columns for n in c.entries if n.endswith(_CONSTANT)):
        if name in entries:
            continue
        own = [e for n, e in column.entries.items() if n.startswith(f"{name}[")]
        own = [e for e in own if math.isfinite(e.value)]
        if own:
            mean = sum(e.value for e in own) / len(own)
            scatter = math.sqrt(sum((e.value - mean) ** 2 for e in own) / len(own))
            errors = sum(e.se for e in own) / len(own)
            entries[name] = Entry(mean, max(scatter, errors), "mean of maneuvers", own[0].unit)
    return entries
