"""What is in the logs: every file's bytes accounted for, every channel's rate, gaps and range."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from alula.report.html import Html, join, table, tag
from alula.report.input import ReportInput
from alula.report.numbers import MISSING, number, shown


def log_cards(report: ReportInput) -> Html:
    """The files' byte accounts, then one table of channels per log."""
    return join([_files(report), *(_card(card) for card in report.cards)])


def _files(report: ReportInput) -> Html:
    if not report.files:
        return Html("")
    return table(
        "Files read. Decoded, skipped and unknown bytes add up to the file's size.",
        ["File", "Bytes", "Decoded", "Skipped", "Unknown", "SHA-256"],
        (
            [tag("code", f.path), f.bytes, f.decoded, f.skipped, f.unknown, tag("code", f.sha256)]
            for f in report.files
        ),
        numeric=(1, 2, 3, 4),
        class_="files",
    )


def _card(card: Mapping[str, Any]) -> Html:
    rows = []
    for channel in card.get("channels", ()):
        factor, unit = shown(str(channel.get("unit", "")))

        def in_shown(key: str, channel: Mapping[str, Any] = channel, by: float = factor) -> str:
            value = channel.get(key)
            return MISSING if value is None else number(by * float(value))

        rows.append(
            [
                tag("code", channel.get("name", "")),
                unit,
                _plain(channel, "rate", 4),
                channel.get("n", MISSING),
                f"{_plain(channel, 'start', 5)} … {_plain(channel, 'end', 5)}",
                _count(channel.get("gaps")),
                _count(channel.get("nan")),
                in_shown("min"),
                in_shown("median"),
                in_shown("max"),
                tag("span", channel.get("source", ""), class_="source"),
            ]
        )
    return table(
        join(["Channels of log ", tag("code", card.get("id", "")), ", as recorded, at their own rates"]),
        ["Channel", "Unit", "Rate, Hz", "Samples", "Span, s", "Gaps", "Missing", "Min", "Median",
         "Max", "Source and conversion"],
        rows,
        numeric=(2, 3, 5, 6, 7, 8, 9),
        class_="dense",
    )


def _plain(channel: Mapping[str, Any], key: str, digits: int) -> str:
    value = channel.get(key)
    return MISSING if value is None else number(float(value), digits)


def _count(value: Any) -> object:
    """A number of gaps, also from a list of them; none reads as zero, emphasized if any."""
    size = len(value) if isinstance(value, list | tuple) else (value or 0)
    return tag("strong", size) if size else "0"
