"""The registry of rows: what must hold, and the function that finds out whether it does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

# Reduced (True for a quick look) -> what was found, in words and numbers, and whether it holds.
Check = Callable[[bool], tuple[str, bool]]

TOPICS = (
    "main-job",
    "simulator",
    "estimation",
    "logs",
    "prediction",
    "airdata",
    "campaign",
    "protection",
    "flight-computer",
    "workbench",
)


@dataclass(frozen=True)
class Row:
    """One line of a 'What must hold' table."""

    topic: str
    row: str
    must: str
    check: Check


ROWS: list[Row] = []


def row(topic: str, name: str, must: str) -> Callable[[Check], Check]:
    """Register the decorated function as the check of a row."""

    def register(check: Check) -> Check:
        ROWS.append(Row(topic, name, must, check))
        return check

    return register


def rows(topic: str, checks: dict[str, tuple[str, Check]]) -> None:
    """Register many: by name, what must hold and the check."""
    for name, (must, check) in checks.items():
        ROWS.append(Row(topic, name, must, check))


def not_built(topic: str, rows: dict[str, str]) -> None:
    """Rows of what does not exist yet: they are listed, and do not hold."""
    for name, must in rows.items():
        ROWS.append(Row(topic, name, must, lambda quick: ("not built yet", False)))
