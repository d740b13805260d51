"""One source of a flow angle over time as SVG: its band of two standard deviations over the vote,
shaded where it is not observable, a dashed line where the monitor took it out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.airdata.angles import AngleSource, Compared
from alula.base.arrays import Array
from alula.report.html import Html, tag

ANGLES_STYLE = """
.angle{display:block;max-width:100%;height:auto;margin:2px 0}
.sources td:nth-child(2){min-width:170px}
@media (max-width:900px){.angle text{font-size:16px}}
.angle .frame{fill:var(--plot-paper);stroke:var(--plot-axis)}
.angle .off{fill:var(--soft)}
.angle .grid{stroke:var(--plot-grid)}
.angle .band{fill:var(--plot-band)}
.angle path.vote{fill:none;stroke:var(--plot-measured);stroke-width:1}
.angle path.own{fill:none;stroke:var(--plot-model);stroke-width:1.4}
.angle .fault{stroke:var(--bad);stroke-width:1.6;stroke-dasharray:5 3}
.angle .said{fill:var(--bad);font-weight:600}
.angle .axis{fill:var(--plot-muted)}
"""
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 1120.0, 130.0, 44.0, 20.0, 18.0
WIDE, TALL = WIDTH - LEFT - 16.0, HEIGHT - TOP - BOTTOM
STEPS = 700  # stretches of the time axis, of which a curve keeps lowest and highest
FAULTS = 8  # labels of a picture
DEG = float(np.degrees(1.0))


@dataclass(frozen=True)
class Axes:
    """What a picture shows: times begin to end, s, and angles low to high, deg."""

    begin: float
    end: float
    low: float
    high: float

    def x(self, t: float) -> float:
        """Across, of a time."""
        return LEFT + (t - self.begin) / max(self.end - self.begin, 1e-9) * WIDE

    def y(self, angle: float) -> float:
        """Down, of an angle; what lies beyond stays at the edge."""
        shown = min(max(angle, self.low), self.high)
        return TOP + (self.high - shown) / (self.high - self.low) * TALL


def axes_of(found: Compared) -> Axes:
    """The same for all sources of one angle: all but the odd value, with the narrowest band."""
    low, high, band = np.inf, -np.inf, np.inf
    for source in found.sources.values():
        shown = DEG * source.values[source.reported]
        if len(shown):
            low = min(low, float(np.percentile(shown, 0.2)))
            high = max(high, float(np.percentile(shown, 99.8)))
            band = min(band, 2.0 * DEG * float(np.median(source.sigma[source.reported])))
    if not np.isfinite(low):
        low, high, band = -4.0, 4.0, 1.0
    pad = max(1.0, 0.15 * (high - low), 1.1 * band)
    return Axes(float(found.t[0]), float(found.t[-1]), low - pad, high + pad)


def angle_picture(found: Compared, name: str, axes: Axes) -> Html:
    """The picture of the source of that name."""
    t, source = found.t, found.sources[name]
    shown = np.where(source.reported, DEG * source.values, np.nan)
    half = 2.0 * DEG * source.sigma
    at, bottom, top = _thinned(t, shown)
    lower, upper = _thinned(t, shown - half)[1], _thinned(t, shown + half)[2]
    vote: Html | str = ""
    if found.voted is not None:
        vote = tag("path", d=_line(axes, *_thinned(t, DEG * found.voted.angle)), class_="vote")
    label = f"{name}: {found.kind} over time with its band of two standard deviations"
    return tag(
        "svg",
        tag("title", label),
        tag("rect", x=f"{LEFT:g}", y=f"{TOP:g}", width=f"{WIDE:g}", height=f"{TALL:g}",
            class_="frame"),
        *_silent(t, source, axes),
        *_grid(axes),
        *_band(axes, at, lower, upper),
        vote,
        tag("path", d=_line(axes, at, bottom, top), class_="own"),
        *_faults(found, name, axes),
        _text(LEFT, 14.0, f"{name}, ° over s", "start", "name"),
        class_="angle", width=f"{WIDTH:g}", height=f"{HEIGHT:g}",
        viewBox=f"0 0 {WIDTH:g} {HEIGHT:g}", role="img", aria_label=label,
    )  # fmt: skip


def _silent(t: Array, source: AngleSource, axes: Axes) -> list[Html]:
    """Shades where it is not observed."""
    least = (axes.end - axes.begin) / STEPS
    stretches: list[tuple[float, float]] = []
    for i, j in _runs(np.logical_not(source.observed)):
        a, b = float(t[i]), float(t[min(j, len(t) - 1)])
        if stretches and a - stretches[-1][1] < least:
            stretches[-1] = (stretches[-1][0], b)
        elif b - a >= least:
            stretches.append((a, b))
    return [
        tag("rect", x=f"{axes.x(a):.1f}", y=f"{TOP + 0.5:g}",
            width=f"{axes.x(b) - axes.x(a):.1f}", height=f"{TALL - 1:g}", class_="off")
        for a, b in stretches
    ]  # fmt: skip


def _grid(axes: Axes) -> list[Html]:
    out = []
    for tick in _ticks(axes.low, axes.high, 4):
        y = axes.y(tick)
        out.append(_rule("grid", LEFT, LEFT + WIDE, y, y))
        out.append(_text(LEFT - 5.0, y + 4.0, f"{tick:g}", "end", "axis"))
    for tick in _ticks(axes.begin, axes.end, 8):
        out.append(_text(axes.x(tick), HEIGHT - 4.0, f"{tick:g}", "middle", "axis"))
    return out


def _band(axes: Axes, at: Array, lower: Array, upper: Array) -> list[Html]:
    out = []
    for i, j in _runs(np.isfinite(lower)):
        there = [f"{axes.x(at[k]):.1f} {axes.y(upper[k]):.1f}" for k in range(i, j)]
        back = [f"{axes.x(at[k]):.1f} {axes.y(lower[k]):.1f}" for k in reversed(range(i, j))]
        out.append(tag("path", d="M" + "L".join(there + back) + "Z", class_="band"))
    return out


def _faults(found: Compared, name: str, axes: Axes) -> list[Html]:
    out = []
    for k, fault in enumerate(n for n in found.named if n.source == name):
        x = axes.x(fault.t)
        out.append(_rule("fault", x, x, TOP, TOP + TALL))
        if k < FAULTS:
            words, right = f"{fault.reason} {fault.t:.6g} s", x < LEFT + 0.8 * WIDE
            anchor = "start" if right else "end"
            out.append(_text(x + (4.0 if right else -4.0), TOP + 12.0, words, anchor, "said"))
    return out


def _runs(there: Any) -> list[tuple[int, int]]:
    """First index and the one behind the last of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]]).astype(int)))
    return [(int(i), int(j)) for i, j in edges.reshape(-1, 2)]


def _thinned(t: Array, values: Array) -> tuple[Array, Array, Array]:
    """Middle, lowest and highest value of each stretch of time; NaN where there is none."""
    edges = np.linspace(float(t[0]), float(t[-1]), STEPS + 1)
    index = np.clip(np.searchsorted(edges, t, side="right") - 1, 0, STEPS - 1)
    low, high = np.full(STEPS, np.inf), np.full(STEPS, -np.inf)
    good = np.isfinite(values)
    np.minimum.at(low, index[good], values[good])
    np.maximum.at(high, index[good], values[good])
    full = np.bincount(index, minlength=STEPS) > 0  # stretches without a time are no gap
    at = (0.5 * (edges[:-1] + edges[1:]))[full]
    low, high = low[full], high[full]
    empty = np.logical_not(np.isfinite(low))
    return at, np.where(empty, np.nan, low), np.where(empty, np.nan, high)


def _line(axes: Axes, at: Array, low: Array, high: Array) -> str:
    """A path through highest and lowest of each stretch, lifted where there is none."""
    out, down = [], False
    for t, below, above in zip(at, low, high, strict=True):
        if not np.isfinite(below):
            down = False
            continue
        first, last = axes.y(above), axes.y(below)
        out.append(f"{'L' if down else 'M'}{axes.x(t):.1f} {first:.1f}")
        if last - first > 0.2:
            out.append(f"V{last:.1f}")
        down = True
    return "".join(out) or "M0 0"


def _ticks(low: float, high: float, about: int) -> list[float]:
    raw = max(high - low, 1e-9) / about
    power = 10.0 ** float(np.floor(np.log10(raw)))
    step = min((m * power for m in (1.0, 2.0, 5.0, 10.0)), key=lambda s: abs(s - raw))
    first = float(np.ceil(low / step)) * step
    return [round(first + k * step, 9) for k in range(int((high - first) / step + 1e-9) + 1)]


def _rule(class_: str, x1: float, x2: float, y1: float, y2: float) -> Html:
    return tag("line", x1=f"{x1:.1f}", x2=f"{x2:.1f}", y1=f"{y1:.1f}", y2=f"{y2:.1f}",
               class_=class_)  # fmt: skip


def _text(x: float, y: float, text: str, anchor: str, class_: str) -> Html:
    return tag("text", text, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=class_)
