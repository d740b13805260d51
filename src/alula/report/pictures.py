"""Small static pictures as SVG: verdict marks, intervals, heat maps.

Colors are classes of the style sheet (the page's content policy allows no style attributes), so
they follow light, dark and paper.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from alula.base.arrays import Array
from alula.report.html import Html, escape, join, tag
from alula.report.numbers import number


def _svg(width: float, height: float, label: str, *parts: object, class_: str = "") -> Html:
    return tag(
        "svg",
        tag("title", label),
        *parts,
        class_=class_ or None,
        width=f"{width:g}",
        height=f"{height:g}",
        viewBox=f"0 0 {width:g} {height:g}",
        role="img",
        aria_label=label,
    )


def _text(x: float, y: float, text: object, anchor: str = "start", **attributes: object) -> Html:
    return tag("text", text, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, **attributes)


def round_step(span: float) -> float:
    """A round step that gives three to seven ticks on an axis of that length."""
    power = 10.0 ** math.floor(math.log10(span / 3.0))
    return max(k * power for k in (1.0, 2.0, 5.0) if k * power <= span / 3.0)


_MARKS = {
    "good": '<circle cx="6" cy="6" r="5"/><path class="in" d="M3.4 6.2 5.3 8 8.7 4.2"/>',
    "caution": '<path d="M6 .8 11.6 11H.4Z"/><path class="in" d="M6 4.4V7.4M6 8.8V9.6"/>',
    "bad": '<rect x="1" y="1" width="10" height="10" rx="1.5"/>'
    '<path class="in" d="M3.6 3.6 8.4 8.4M8.4 3.6 3.6 8.4"/>',
}


def mark(level: str, words: object, *, long: bool = False) -> Html:
    """A verdict: a mark whose shape tells as much as its color, and the words beside it.

    long: the words are a sentence, in the color of text.
    """
    picture = Html(
        f'<svg class="mark" width="12" height="12" viewBox="0 0 12 12" aria-hidden="true">'
        f"{_MARKS[level]}</svg>"
    )
    return tag(
        "span", picture, " ", escape(words), class_=f"verdict {level}{' long' if long else ''}"
    )


def interval_picture(value: float, low: float, high: float, truth: float | None = None) -> Html:
    """A 95 % interval and its value on one axis with zero; with the truth instead where known."""
    if not (math.isfinite(low) and math.isfinite(high) and math.isfinite(value)):
        return Html("")
    points = [low, high, 0.0 if truth is None else truth]
    left, right = min(points), max(points)
    span = (right - left) or 1.0
    width, height, pad = 150.0, 18.0, 6.0

    def x(v: float) -> str:
        return f"{pad + (v - left) / span * (width - 2 * pad):.1f}"

    def upright(v: float, y1: float, y2: float, class_: str) -> Html:
        return tag("line", x1=x(v), x2=x(v), y1=f"{y1:g}", y2=f"{y2:g}", class_=class_)

    label = f"95 % interval {number(low, 3)} to {number(high, 3)}, value {number(value, 3)}"
    diamond: Html | str = ""
    if truth is not None:
        diamond = tag("path", d=f"M{x(truth)} 3l5 6-5 6-5-6Z", class_="truth")
        label += f", truth {number(truth, 3)}"
    return _svg(
        width,
        height,
        label,
        tag("line", x1=f"{pad:g}", x2=f"{width - pad:g}", y1="9", y2="9", class_="rail"),
        upright(0.0, 1, 17, "zero") if left <= 0.0 <= right else "",
        diamond,
        tag("line", x1=x(low), x2=x(high), y1="9", y2="9", class_="bar"),
        upright(low, 5, 13, "bar"),
        upright(high, 5, 13, "bar"),
        tag("circle", cx=x(value), cy="9", r="3", class_="dot"),
        class_="interval",
    )


def within_picture(value: float, low: float, high: float, label: str) -> Html:
    """A value beside the band in which it should lie."""
    if not all(map(math.isfinite, (value, low, high))):
        return Html("")
    left, right = min(value, low, 0.0), 1.08 * max(value, high)
    width, height = 300.0, 34.0
    ends = ("start", "end")

    def x(v: float) -> float:
        return 4 + (v - left) / (right - left) * (width - 8)

    return _svg(
        width,
        height,
        label,
        tag("line", x1="4", x2=f"{width - 4:g}", y1="9", y2="9", class_="rail"),
        tag(
            "rect",
            x=f"{x(low):.1f}",
            y="3",
            width=f"{max(x(high) - x(low), 1):.1f}",
            height="12",
            class_="expected",
        ),
        tag("circle", cx=f"{x(value):.1f}", cy="9", r="4", class_="dot"),
        *(_text(x(v), 30, number(v, 3), a) for v, a in zip((low, high), ends[::-1], strict=True)),
        class_="interval within",
    )


def heat_map(names: Sequence[str], correlation: Array, title: str) -> Html:
    """The lower triangle of a correlation matrix (n, n), values written in the cells.

    A cell's color is one of ten steps to either sign; NaN cells stay empty.
    """
    n = len(names)
    numbers = n <= 16
    cell = 34 if numbers else 16
    left = 12 + 6.6 * max(len(name) for name in names)
    parts: list[Html] = []
    for i in range(n):
        y = cell * i
        parts.append(_text(left - 6, y + cell / 2 + 4, names[i], "end"))
        for j in range(i + 1):
            r = float(correlation[i, j])
            step = 0 if math.isnan(r) else min(10, round(abs(r) * 10))
            look = (
                "none" if math.isnan(r) else "self" if i == j else f"{'p' if r > 0 else 'm'}{step}"
            )
            parts.append(_cell(left + cell * j, y, cell - 1, look, names[i], names[j], r))
            if numbers and not math.isnan(r):
                text = "1" if i == j else f"{r:.2f}".replace("-", "−").replace("0.", ".")
                parts.append(
                    _text(
                        left + cell * (j + 0.5) - 0.5,
                        y + cell / 2 + 4,
                        text,
                        "middle",
                        class_="over" if step >= 7 and i != j else "on",
                    )
                )
    top = cell * n
    for j, name in enumerate(names):
        x = left + cell * (j + 0.5)
        parts.append(
            _text(x + 3, top + 8, name, "end", transform=f"rotate(-50 {x + 3:.1f} {top + 8:.1f})")
        )
    height = top + 16 + 5.4 * max(len(name) for name in names)
    return _svg(left + cell * n + 6, height, title, join(parts), class_="heat")


def _cell(x: float, y: float, side: float, class_: str, a: str, b: str, r: float) -> Html:
    return Html(
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{side}" height="{side}" class="{class_}">'
        f"<title>{escape(a)}, {escape(b)}: {number(r, 2)}</title></rect>"
    )
