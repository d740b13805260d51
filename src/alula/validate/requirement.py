"""An entry of a regulation's table, and the row of evidence that it gives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from alula.validate.result import Criterion, Evidence, Flown, Verdict


@dataclass(frozen=True)
class Requirement:
    """An entry of the table: its number and title."""

    entry: str
    title: str


def evidence_row(
    flown: Flown,
    requirement: Requirement,
    tolerance: str,
    criteria: Sequence[Criterion],
    verdict: Verdict,
    window: tuple[float, float] | None,
    reason: str,
) -> Evidence:
    """The row of one requirement on one flown maneuver, with whether the estimate saw it."""
    return Evidence(
        entry=requirement.entry,
        title=requirement.title,
        maneuver=flown.maneuver.id,
        tolerance=tolerance,
        criteria=tuple(criteria),
        verdict=verdict,
        seen=flown.seen,
        window=window,
        reason=reason,
    )


def follows(channels: Sequence[str]) -> str:
    """Why these channels prove nothing."""
    many = (
        "follow coefficients that were" if len(channels) > 1 else "follows a coefficient that was"
    )
    return f"{', '.join(channels)} {many} taken as recorded"
