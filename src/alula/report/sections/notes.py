"""What was noticed, what was done to the data, and how to make the result again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from alula.base.messages import Message
from alula.report.html import Html, join, table, tag
from alula.report.input import ReportInput
from alula.report.numbers import MISSING
from alula.report.pictures import mark

_LEVEL = {"error": ("bad", "error"), "warning": ("caution", "warning"), "info": ("good", "note")}


def messages(report: ReportInput) -> Html:
    """Errors and warnings first, then every conversion and repair."""
    found = report.all_messages()
    order = {"error": 0, "warning": 1}
    serious = sorted((m for m in found if m.level != "info"), key=lambda m: order[m.level])
    notes = [m for m in found if m.level == "info"]
    return join(
        [
            _table("Errors and warnings", serious)
            if serious
            else tag("p", mark("good", "No errors and no warnings.")),
            _table("What was done to the data", notes)
            if notes
            else tag("p", "No sample was dropped, resampled, filtered or converted."),
        ]
    )


def _table(caption: str, members: Sequence[Message]) -> Html:
    return table(
        caption,
        ["Where", "Kind", "Expected", "Found", "What to do, or what was done"],
        (
            [
                m.where,
                join([mark(*_LEVEL[m.level]), " ", tag("code", m.code)]),
                m.expected,
                m.found,
                m.do or MISSING,
            ]
            for m in members
        ),
        class_="text",
    )


def provenance(report: ReportInput) -> Html:
    """Every value that is needed to make the result again."""
    return table(
        "Provenance. The same project file, logs and versions give the same result.",
        ["What", "Value"],
        ([key, tag("code", value)] for key, value in flattened(report.provenance)),
        class_="text provenance",
    )


def flattened(values: Mapping[str, Any], before: str = "") -> list[tuple[str, str]]:
    """Nested mappings as lines: 'versions · numpy', '2.1'."""
    lines: list[tuple[str, str]] = []
    for key, value in values.items():
        name = f"{before} · {key}" if before else str(key)
        if isinstance(value, Mapping):
            lines += flattened(value, name)
        elif isinstance(value, list | tuple):
            lines.append((name, ", ".join(map(str, value))))
        else:
            lines.append((name, MISSING if value is None else str(value)))
    return lines
