"""The modes of an aircraft in the complex plane, as SVG.

Two panels: all roots, and those near the origin, which are ten to a thousand times slower.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from alula.report.html import Html, join, tag
from alula.report.numbers import number
from alula.simulate import Mode

# The report's own style sheet has these colors; a file of its own brings them along.
STYLE = (
    "svg.splane{background:#fff;color:#1c2733}"
    ".splane text{font:11px system-ui,sans-serif;fill:currentColor}"
    ".splane .axis{stroke:currentColor;stroke-width:1}"
    ".splane .grid{stroke:currentColor;stroke-opacity:.18;fill:none}"
    ".splane .small{fill-opacity:.65;font-size:10px}"
    ".splane .unstable-side{fill:#c0392b;fill-opacity:.07}"
    ".splane .stable{stroke:#1f5fa8;stroke-width:2;fill:none}"
    ".splane .unstable{stroke:#c0392b;stroke-width:2;fill:none}"
)
_WIDTH, _HEIGHT, _GAP = 360.0, 300.0, 24.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 44.0, 10.0, 26.0, 36.0
_NEAR = 0.1  # of the fastest root: what the second panel shows


@dataclass(frozen=True)
class _Panel:
    """Axes of one panel: real parts low to high, imaginary parts from 0 to top, 1/s."""

    x0: float
    low: float
    high: float
    top: float
    title: str

    def x(self, real: float) -> float:
        width = _WIDTH - _LEFT - _RIGHT
        return self.x0 + _LEFT + width * (real - self.low) / (self.high - self.low)

    def y(self, imag: float) -> float:
        return _HEIGHT - _BOTTOM - (_HEIGHT - _TOP - _BOTTOM) * imag / self.top


def s_plane(modes: Sequence[Mode], title: str = "Modes", *, alone: bool = False) -> Html:
    """The upper half of the s-plane. alone: as a file of its own, with its style."""
    far = max((abs(m.eigenvalue) for m in modes), default=1.0) or 1.0
    slow = [m for m in modes if abs(m.eigenvalue) < _NEAR * far]
    panels = [(_panel(0.0, list(modes), "all modes"), list(modes))]
    if slow and len(slow) < len(modes):
        panels.append((_panel(_WIDTH + _GAP, slow, "near the origin"), slow))
    width = panels[-1][0].x0 + _WIDTH
    label = f"{title}: " + ", ".join(
        f"{m.words} {number(m.eigenvalue.real, 3)}"
        + (f" ± {number(m.eigenvalue.imag, 3)}i" if m.eigenvalue.imag else "")
        for m in modes
    )
    return tag(
        "svg",
        tag("title", label),
        tag("style", Html(STYLE)) if alone else "",
        *(
            _drawn(panel, shown, slow if i == 0 and len(panels) > 1 else ())
            for i, (panel, shown) in enumerate(panels)
        ),
        class_="splane",
        xmlns="http://www.w3.org/2000/svg" if alone else None,
        width=f"{width:g}",
        height=f"{_HEIGHT:g}",
        viewBox=f"0 0 {width:g} {_HEIGHT:g}",
        role="img",
        aria_label=label,
    )


def _panel(x0: float, modes: Sequence[Mode], title: str) -> _Panel:
    real = [m.eigenvalue.real for m in modes]
    size = max((abs(m.eigenvalue) for m in modes), default=1.0) or 1.0
    low, high = min([*real, 0.0]), max([*real, 0.0])
    span = max(high - low, 0.5 * size)
    top = max(*(m.eigenvalue.imag for m in modes), 0.4 * size) * 1.15
    return _Panel(x0, low - 0.12 * span, high + 0.30 * span, top, title)


def _drawn(panel: _Panel, modes: Sequence[Mode], nameless: Sequence[Mode]) -> Html:
    floor, roof = panel.y(0.0), panel.y(panel.top)
    parts = [
        tag("text", panel.title, x=f"{panel.x0 + _LEFT:.1f}", y="16"),
        tag(
            "rect",
            x=f"{panel.x(0.0):.1f}",
            y=f"{roof:.1f}",
            width=f"{panel.x(panel.high) - panel.x(0.0):.1f}",
            height=f"{floor - roof:.1f}",
            class_="unstable-side",
        ),
        *_damping_lines(panel),
        _line(panel.x(panel.low), floor, panel.x(panel.high), floor, "axis"),
        _line(panel.x(0.0), floor, panel.x(0.0), roof, "axis"),
    ]
    for value in _ticks(panel.low, panel.high):
        parts.append(_line(panel.x(value), floor, panel.x(value), floor + 4, "axis"))
        parts.append(_text(panel.x(value), floor + 15, _short(value), "middle"))
    for value in _ticks(0.0, panel.top)[1:]:
        left = panel.x(panel.low)
        parts.append(_line(left - 4, panel.y(value), left, panel.y(value), "axis"))
        parts.append(_text(left - 6, panel.y(value) + 4, _short(value), "end"))
    middle = (panel.x(panel.low) + panel.x(panel.high)) / 2
    parts.append(_text(middle, _HEIGHT - 5, "real part, 1/s", "middle"))
    parts.append(_text(panel.x0 + 4, 16, "rad/s", "start"))
    taken: list[tuple[float, float]] = []
    for mode in sorted(modes, key=lambda m: -m.eigenvalue.imag):
        parts.append(_marked(panel, mode, taken, mode not in nameless))
    return tag("g", join(parts))


def _marked(panel: _Panel, mode: Mode, taken: list[tuple[float, float]], named: bool) -> Html:
    """A cross at the root, and its name where no other name stands."""
    x, y = panel.x(mode.eigenvalue.real), panel.y(mode.eigenvalue.imag)
    look = "stable" if mode.eigenvalue.real <= 0.0 else "unstable"
    cross = tag("path", d=f"M{x - 4:.1f} {y - 4:.1f}l8 8m0 -8l-8 8", class_=look)
    if not named:
        return cross
    where = y - 6.0
    while any(abs(where - other) < 12.0 and abs(x - at) < 110.0 for at, other in taken):
        where -= 12.0
    taken.append((x, where))
    right = x > panel.x0 + 0.72 * _WIDTH
    place, anchor = (x - 6, "end") if right else (x + 6, "start")
    return join([cross, _text(place, where, mode.words, anchor)])


def _damping_lines(panel: _Panel) -> list[Html]:
    """Rays of equal damping ratio."""
    out = []
    for zeta in (0.1, 0.3, 0.5, 0.7, 0.9):
        slope = zeta / math.sqrt(1.0 - zeta * zeta)
        imag = min(panel.top, -panel.low / slope)
        x, y = panel.x(-slope * imag), panel.y(imag)
        out.append(_line(panel.x(0.0), panel.y(0.0), x, y, "grid"))
        low = y < _TOP + 1
        out.append(
            _text(x + (0 if low else 3), y - 3, f"{zeta:g}", "middle" if low else "start", "small")
        )
    return out


def _ticks(low: float, high: float) -> list[float]:
    """Four to eight round values between."""
    raw = (high - low) / 5.0
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= raw)
    first = math.ceil(low / step)
    return [k * step for k in range(first, math.floor(high / step) + 1)]


def _short(value: float) -> str:
    return f"{value:.6g}".replace("-", "−")


def _line(x1: float, y1: float, x2: float, y2: float, class_: str) -> Html:
    return tag(
        "line", x1=f"{x1:.1f}", y1=f"{y1:.1f}", x2=f"{x2:.1f}", y2=f"{y2:.1f}", class_=class_
    )


def _text(x: float, y: float, text: str, anchor: str, class_: str | None = None) -> Html:
    return tag("text", text, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=class_)
