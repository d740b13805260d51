"""What is in the logs: every file's bytes accounted for, every channel's rate, gaps and range."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from alula.report.html import Html, file_name, join, table, tag
from alula.report.input import ReportInput
from alula.report.numbers import MISSING, compact, number, shown, span

if TYPE_CHECKING:
    from alula.logs.card import ChannelCard, LogCard

_MOST_CHANNELS = 1000  # rows of channels on the page, of all logs together


def log_cards(report: ReportInput) -> Html:
    """The files' byte accounts, then one table of channels per log."""
    shown: list[LogCard] = []
    for card in report.cards:
        if shown and sum(len(c.channels) for c in [*shown, card]) > _MOST_CHANNELS:
            break
        shown.append(card)
    left = len(report.cards) - len(shown)
    words = (
        f"The channels of {left} of {len(report.cards)} logs are left out, so that the page stays "
        "under 3 MB; alula check prints them all."
    )
    return join(
        [
            _files(report),
            *(_card(card) for card in shown),
            *([tag("p", words, class_="note")] if left else []),
        ]
    )


def _files(report: ReportInput) -> Html:
    return table(
        "Files read. Decoded, skipped and unknown bytes add up to the file's size. Whole paths and "
        "hashes stand under provenance.",
        ["File", "Bytes", "Decoded", "Skipped", "Unknown", "SHA-256"],
        (
            [
                file_name(f.path),
                f.bytes,
                f.decoded,
                f.skipped,
                f.unknown,
                tag("code", f"{f.sha256[:12]}…", title=f.sha256),
            ]
            for f in report.files()
        ),
        numeric=(1, 2, 3, 4),
        class_="files",
    )


def _card(card: LogCard) -> Html:
    return table(
        join(["Channels of log ", tag("code", card.log), ", as recorded, at their own rates"]),
        [
            "Channel",
            "Unit",
            "Rate, Hz",
            "Samples",
            "Span, s",
            "Gaps",
            "Missing",
            "Min",
            "Median",
            "Max",
            "Step",
            "Source and conversion",
        ],
        (_channel(channel) for channel in card.channels),
        numeric=range(2, 11),
        class_="dense",
    )


def _channel(channel: ChannelCard) -> list[object]:
    factor, unit = shown(channel.unit)
    return [
        tag("code", channel.name),
        unit,
        MISSING if math.isnan(channel.rate) else compact(channel.rate, 4),
        channel.n,
        span(channel.start, channel.end),
        _emphasized(len(channel.gaps)),
        _emphasized(channel.missing),
        number(factor * channel.minimum),
        number(factor * channel.median),
        number(factor * channel.maximum),
        number(factor * channel.step, 3),
        tag("span", channel.source, class_="source"),
    ]


def _emphasized(count: int) -> object:
    """A count that should be zero stands out where it is not."""
    return tag("strong", count) if count else "0"
