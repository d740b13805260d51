"""The windows of the logs that were used, and for what."""

from __future__ import annotations

from collections.abc import Mapping

from alula.report.html import Html, table, tag
from alula.report.input import ReportInput
from alula.report.names import unit_of
from alula.report.numbers import MISSING, number, shown, span


def maneuvers(report: ReportInput) -> Html:
    """One row per maneuver; held-out ones are marked."""
    cards = {m.id: m for card in report.cards for m in card.maneuvers}
    apart = any(m.log != m.id for m in report.maneuvers)  # a log that goes by the maneuver's name
    rows = []
    for m in report.maneuvers:
        card = cards.get(m.id)
        rows.append(
            [
                tag("code", m.id),
                m.kind.replace("_", " "),
                *([m.log] if apart else []),
                span(m.start, m.end),
                card.samples if card else MISSING,
                len(card.gaps) if card else MISSING,
                m.aspect,
                tag("span", "held out", class_="tag") if m.held_out else "fit",
                ", ".join(f"{k} {v}" for k, v in m.configuration.items()) or MISSING,
                tag("span", _entry(card.entry) if card else MISSING, class_="entry"),
            ]
        )
    return table(
        "Maneuvers. One that is held out was never seen by the fit and serves to validate it."
        + ("" if apart else " Each is a log of its own, of the same name."),
        [
            "Maneuver",
            "Kind",
            *(["Log"] if apart else []),
            "Window, s",
            "Samples",
            "Gaps",
            "Aspect",
            "Use",
            "Configuration",
            "Entry condition",
        ],
        rows,
        numeric=(3, 4, 5) if apart else (2, 3, 4),
    )


def _entry(entry: Mapping[str, float]) -> str:
    """'V 102.1 m/s, alpha 3.5 °' of SI values by name."""
    parts = []
    for name, value in entry.items():
        factor, unit = shown(unit_of(name))
        value = 0.0 if abs(value) < 1e-9 else value  # rounding of a simulated log
        # the unit stays on the line of its number
        parts.append(f"{name} {number(factor * value)}" + (f"\u00a0{unit}" if unit != "–" else ""))
    return ", ".join(parts) or MISSING
