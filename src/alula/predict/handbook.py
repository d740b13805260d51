"""One number from a handbook formula, with its error and what lies outside the formula's range."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import fsum, hypot

from alula.base.messages import refuse

# Outside its range a formula is extrapolated: its published scatter no longer holds.
OUTSIDE_FACTOR = 2.0


@dataclass(frozen=True)
class Found:
    """A formula's value. se: one standard deviation. source: formula and reason of the se.

    notes: what lies outside the formula's range, in words; each formula's se is then
    `OUTSIDE_FACTOR` times as large.
    """

    value: float
    se: float
    source: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Range:
    """The range of one quantity that a formula was made for."""

    name: str
    value: float
    low: float
    high: float

    @property
    def said(self) -> str | None:
        """None inside, else the range and the value in words."""
        if self.low <= self.value <= self.high:
            return None
        return f"{self.name} = {self.value:.3g} outside {self.low:g} to {self.high:g}"


def found(value: float, se: float, source: str, ranges: Iterable[Range] = ()) -> Found:
    """`value` with its error, doubled where a quantity lies outside its range."""
    outside = [said for r in ranges if (said := r.said) is not None]
    if not outside:
        return Found(value, abs(se), source)
    said = "; ".join(outside)
    return Found(
        value, OUTSIDE_FACTOR * abs(se), f"{source}; {said}: se doubled", (f"{source}: {said}",)
    )


def exactly(value: float, source: str) -> Found:
    """A number that is taken as it is."""
    return Found(value, 0.0, source)


def scaled(x: Found, factor: float) -> Found:
    """`x` times a number without error."""
    return replace(x, value=factor * x.value, se=abs(factor) * x.se)


def times(*factors: Found) -> Found:
    """The product; its error: the factors' own, as independent to first order."""
    value, errors = 1.0, []
    for i, x in enumerate(factors):
        value *= x.value
        rest = 1.0
        for k, other in enumerate(factors):
            rest *= 1.0 if k == i else other.value
        errors.append(x.se * rest)
    return Found(value, hypot(*errors), _joined(factors, " x "), _notes(factors))


def squared(x: Found) -> Found:
    """The square; both factors err together."""
    return replace(x, value=x.value**2, se=2.0 * abs(x.value) * x.se)


def plus(*parts: Found) -> Found:
    """The sum; its error: the parts' own, as independent."""
    value = fsum(x.value for x in parts)
    return Found(value, hypot(*(x.se for x in parts)), _joined(parts, " + "), _notes(parts))


def _joined(parts: Iterable[Found], sign: str) -> str:
    said = [p.source for p in parts if p.source]
    return sign.join(dict.fromkeys(said))


def _notes(parts: Iterable[Found]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(n for p in parts for n in p.notes))


def positive(where: str, **values: float) -> None:
    """Refuse what must be a finite positive number."""
    for name, x in values.items():
        if not 0.0 < x < float("inf"):
            raise refuse(
                "impossible_value",
                where=where,
                expected=f"a finite {name} above zero",
                found=f"{x:g}",
                do="Correct the geometry in the aircraft file.",
            )
