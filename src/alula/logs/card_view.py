"""The log card as tables on the screen; angles in degrees."""

from __future__ import annotations

import math

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from alula.logs.card import ChannelCard, LogCard, ManeuverCard

SHOWN = {"rad": ("deg", 180 / math.pi), "rad/s": ("deg/s", 180 / math.pi)}
SHOWN["rad/s2"] = ("deg/s2", 180 / math.pi)
ANGLES = ("alpha", "beta", "theta", "phi", "df")


def card_view(card: LogCard) -> RenderableType:
    """Everything on the card for `rich` to print."""
    parts: list[RenderableType] = []
    for file in card.files:
        counts = f"{file.decoded} decoded, {file.skipped} skipped, {file.unknown} unknown"
        parts.append(Text(f"{file.path}  {file.bytes} bytes: {counts}"))
    parts.append(_channels(card))
    if card.maneuvers:
        parts.append(_maneuvers(card.maneuvers))
    for message in card.messages:
        style = {"error": "red", "warning": "yellow"}.get(message.level, "dim")
        parts.append(Text(f"{message.level}: {message}", style=style))
    return Group(*parts)


def _channels(card: LogCard) -> Table:
    table = Table(title=f"Log {escape(card.log)}", title_justify="left")
    for name in ("channel", "unit"):
        table.add_column(name)
    for name in ("Hz", "samples", "NaN", "gaps", "from s", "to s", "min", "median", "max", "step"):
        table.add_column(name, justify="right")
    table.add_column("source", overflow="fold")
    for c in card.channels:
        table.add_row(*_row(c))
    return table


def _row(c: ChannelCard) -> list[str]:
    unit, factor = SHOWN.get(c.unit, (c.unit, 1.0))
    values = (c.minimum, c.median, c.maximum, c.step)
    numbers = [_number(factor * v) for v in values]
    counts = [_number(c.rate), str(c.n), str(c.missing or ""), str(len(c.gaps) or "")]
    times = [f"{c.start:.6g}", f"{c.end:.6g}"]
    return [escape(c.name), unit, *counts, *times, *numbers, escape(c.source)]


def _maneuvers(cards: tuple[ManeuverCard, ...]) -> Table:
    table = Table(title="Maneuvers", title_justify="left")
    for name in ("maneuver", "kind", "aspect", "use"):
        table.add_column(name)
    for name in ("from s", "to s", "samples", "gaps"):
        table.add_column(name, justify="right")
    table.add_column("at entry", overflow="fold")
    for m in cards:
        entry = ", ".join(
            f"{name}_deg {_number(math.degrees(value))}" if name in ANGLES
            else f"{name} {_number(value)}"
            for name, value in m.entry.items()
        )  # fmt: skip
        use = "held out" if m.held_out else "estimate"
        counts = [f"{m.start:.6g}", f"{m.end:.6g}", str(m.samples), str(len(m.gaps) or "")]
        table.add_row(escape(m.id), escape(m.kind), m.aspect, use, *counts, entry)
    return table


def _number(value: float) -> str:
    return f"{value:.4g}" if math.isfinite(value) else ""
