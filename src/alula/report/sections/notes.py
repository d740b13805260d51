"""What was noticed, what was done to the data, and how to make the result again."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from alula.base.messages import Message
from alula.report.html import MOST_ROWS, Html, join, table, tag
from alula.report.input import ReportInput
from alula.report.numbers import MISSING
from alula.report.pictures import mark

_LEVEL = {"error": ("bad", "error"), "warning": ("caution", "warning"), "info": ("good", "note")}
_FOLDED = 3  # notes of one code from which they share a row
# a path from the root, as messages name files: only its last part is shown
_PATH = re.compile(r"(?<![^\s\"'(])(?:[A-Za-z]:)?[/\\](?:[^\s:/\\]+[/\\])+([^\s:/\\]+)")


def messages(report: ReportInput) -> Html:
    """Errors and warnings first, one by one, then every conversion and repair by its kind."""
    found = report.all_messages()
    order = {"error": 0, "warning": 1}
    serious = sorted((m for m in found if m.level != "info"), key=lambda m: order[m.level])
    notes = [m for m in found if m.level == "info"]
    return join(
        [
            _serious(serious) if serious else tag("p", mark("good", "No errors and no warnings.")),
            _notes(notes)
            if notes
            else tag("p", "No sample was dropped, resampled, filtered or converted."),
        ]
    )


def _serious(members: Sequence[Message]) -> Html:
    return table(
        "Errors and warnings",
        ["Where", "Kind", "Expected", "Found", "What to do"],
        (
            [
                _short(m.where),
                join([mark(*_LEVEL[m.level]), " ", tag("code", m.code)]),
                _short(m.expected),
                _short(m.found),
                _short(m.do) if m.do else MISSING,
            ]
            for m in members
        ),
        class_="text",
    )


def _notes(members: Sequence[Message]) -> Html:
    """A row for each kind of note; those of one kind unfold."""
    by_code: dict[str, list[Message]] = {}
    for m in members:
        by_code.setdefault(m.code, []).append(m)
    return table(
        "What was done to the data. Where there are many notes of one kind they unfold; on paper "
        "all are shown.",
        ["Kind", "Notes", "What was found and what was done"],
        ([tag("code", code), len(group), _group(group)] for code, group in by_code.items()),
        numeric=(1,),
        class_="notes",
    )


def _group(members: Sequence[Message]) -> Html:
    alike: dict[tuple[str, str, str], list[Message]] = {}
    for m in members:
        alike.setdefault((m.found, m.expected, m.do or ""), []).append(m)
    items = [tag("li", _line(same)) for same in list(alike.values())[:MOST_ROWS]]
    further = len(alike) - MOST_ROWS
    if further > 0:
        words = f"{further} further notes, left out so that the page stays under 3 MB: see --json."
        items.append(tag("li", words))
    lines = tag("ul", *items, class_="plain")
    if len(members) < _FOLDED:
        return lines
    beginning = join([_fact(members[0]), f", and {len(members) - 1} more"])
    return tag("details", tag("summary", beginning), lines)


def _line(same: Sequence[Message]) -> Html:
    """'channel q: column 8 in deg/s (expected: as recorded). It is now in rad/s.'

    same: messages that differ in their places alone; they share the line.
    """
    first, also = same[0], [m.where for m in same[1 : MOST_ROWS + 1]]
    line = [_fact(first), ". ", _short(first.do)]
    if also:
        others = "; ".join(map(_shortened, also))
        more = f"; and {len(same) - 1 - len(also)} more" if len(same) - 1 > len(also) else ""
        line.append(f" So too ({len(same) - 1}): {others}{more}.")
    return join(line)


def _fact(m: Message) -> Html:
    """'channel q: column 8 in deg/s (expected: as recorded)'"""
    return join([_short(m.where), f": {_shortened(m.found)} (expected: {_shortened(m.expected)})"])


def _shortened(text: str) -> str:
    return _PATH.sub(r"\1", text)


def _short(text: str) -> Html:
    """Text with its paths by their last part, whole where a pointer rests on it."""
    shown = _shortened(text)
    return tag("span", shown, title=text if shown != text else None)


def provenance(report: ReportInput) -> Html:
    """Every value that is needed to make the result again."""
    lines = flattened(report.provenance)
    if report.path:
        lines.append(("project file", report.path))
    for f in report.files():
        lines.append(("log", f"{f.path} · {f.bytes} bytes · SHA-256 {f.sha256}"))
    return table(
        "Provenance. The same project file, logs and versions give the same result.",
        ["What", "Value"],
        ([_LABELS.get(key, key), tag("code", value)] for key, value in lines),
        class_="text provenance",
    )


_LABELS = {
    "alula": "Alula",
    "isa": "instruction set",
    "project": "project file, SHA-256",
    "aircraft": "aircraft file, SHA-256",
}


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
