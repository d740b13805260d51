"""The windows of the logs that were used, and for what."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from alula.report.html import Html, join, table, tag
from alula.report.input import ReportInput
from alula.report.numbers import MISSING, number, shown
from alula.report.names import unit_of


def maneuvers(report: ReportInput) -> Html:
    """One row per maneuver; held-out ones are marked."""
    cards = {
        str(m.get("id")): m for card in report.cards for m in card.get("maneuvers", ())
    }
    rows = []
    for m in report.maneuvers:
        card = cards.get(m.id, {})
        rows.append(
            [
                tag("code", m.id),
                m.kind,
                m.log,
                f"{number(m.start, 5)} … {number(m.end, 5)}",
                card.get("n", card.get("samples", MISSING)),
                m.aspect,
                tag("span", "held out", class_="tag") if m.held_out else "fit",
                ", ".join(f"{k} {v}" for k, v in m.configuration.items()) or MISSING,
                _entry(card.get("entry", card.get("entry_condition"))),
            ]
        )
    return table(
        "Maneuvers. One that is held out was never seen by the fit and serves to validate it.",
        ["Maneuver", "Kind", "Log", "Window, s", "Samples", "Aspect", "Use", "Configuration",
         "Entry condition"],
        rows,
        numeric=(4,),
    )


def _entry(entry: Any) -> Html | str:
    """'V 102.1 m/s, alpha 3.2 °' of a mapping from name to SI value, or the card's own words."""
    if isinstance(entry, Mapping):
        parts = []
        for name, value in entry.items():
            if isinstance(value, int | float):
                factor, unit = shown(unit_of(str(name)))
                parts.append(f"{name} {number(factor * value, 4)}{'' if unit == '–' else ' ' + unit}")
            else:
                parts.append(f"{name} {value}")
        return join([", ".join(parts) or MISSING])
    return str(entry) if entry else MISSING
