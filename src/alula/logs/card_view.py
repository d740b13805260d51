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
    """One line per channel; columns in which nothing stands are left out."""
    spans = {(c.start, c.end) for c in card.channels}
    title = f"Log {escape(card.log)}"
    if len(spans) == 1:
        title += " from {:.6g} to {:.6g} s".format(*spans.pop())
        spans = set()
    columns = [_cells(c, own_span=bool(spans)) for c in card.channels]
    names = [n for n in columns[0] if any(c[n] for c in columns)] if columns else []
    table = _table(title)
    for name in names:
        if name in ("channel", "unit"):
            table.add_column(name, no_wrap=True)
        elif name == "source":
            table.add_column(name, overflow="fold", min_width=8)
        else:
            table.add_column(name, justify="right", no_wrap=True)
    for cells in columns:
        table.add_row(*(cells[name] for name in names))
    return table


def _table(title: str) -> Table:
    return Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False)


def _cells(c: ChannelCard, own_span: bool) -> dict[str, str]:
    unit, factor = SHOWN.get(c.unit, (c.unit, 1.0))
    return {
        "channel": escape(c.name),
        "unit": unit,
        "Hz": _number(c.rate),
        "samples": str(c.n),
        "NaN": str(c.missing or ""),
        "gaps": str(len(c.gaps) or ""),
        "from s": f"{c.start:.6g}" if own_span else "",
        "to s": f"{c.end:.6g}" if own_span else "",
        "min": _number(factor * c.minimum),
        "median": _number(factor * c.median),
        "max": _number(factor * c.maximum),
        "step": _number(factor * c.step),
        "source": escape(c.source),
    }


def _maneuvers(cards: tuple[ManeuverCard, ...]) -> Table:
    table = _table("Maneuvers")
    for name in ("maneuver", "kind", "aspect", "use"):
        table.add_column(name, no_wrap=True)
    for name in ("from s", "to s", "samples", "gaps"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("at entry", min_width=16)
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
