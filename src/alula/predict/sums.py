"""Derivatives as sums of the parts' contributions."""

from __future__ import annotations

from collections.abc import Mapping

from alula.predict.derivatives import Estimate
from alula.predict.handbook import Found, plus, scaled


class Sums:
    """Contributions by name of the derivative; parts are independent of one another."""

    def __init__(self) -> None:
        self._parts: dict[str, list[Found]] = {}

    def add(self, name: str, part: Found, factor: float = 1.0) -> None:
        """Add `factor` times a part's contribution."""
        self._parts.setdefault(name, []).append(scaled(part, factor))

    def add_all(self, parts: Mapping[str, Found], factor: float = 1.0) -> None:
        """Add one part's contributions to several derivatives."""
        for name, part in parts.items():
            self.add(name, part, factor)

    def total(self, name: str) -> Found:
        """The sum so far; zero where nothing was added."""
        return plus(*self._parts.get(name, []))

    def estimates(self) -> dict[str, Estimate]:
        """All sums."""
        return {
            name: Estimate(t.value, t.se, t.source)
            for name in self._parts
            if (t := self.total(name)) is not None
        }

    def notes(self) -> tuple[str, ...]:
        """What lies outside a formula's range, each once, with the derivatives it concerns."""
        said: dict[str, list[str]] = {}
        for name in self._parts:
            for note in self.total(name).notes:
                said.setdefault(note, []).append(name)
        return tuple(f"{note} ({', '.join(names)})" for note, names in said.items())
