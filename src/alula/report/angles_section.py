"""Sources of the flow angles as time histories, one below the other, and how they agree.

Each panel shows one source with its band of two standard deviations over the vote; where the source
is not observable the panel is shaded, where the monitor took it out a line stands.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from alula.airdata.angles import AngleSource, Compared, Kind
from alula.base.arrays import Array
from alula.report.html import Html, join, table, tag
from alula.report.numbers import MISSING, number
from alula.report.pictures import mark

ANGLES_STYLE = """
.angle{display:block;max-width:100%;height:auto;margin:2px 0}
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
TITLES: dict[Kind, str] = {"alpha": "Angle of attack", "beta": "Sideslip"}
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 1120.0, 130.0, 44.0, 20.0, 18.0
STEPS = 700  # stretches of the time axis, of which a curve keeps lowest and highest
FAULTS = 8  # labels of a panel


def angles_section(compared: Mapping[Kind, Compared]) -> Html:
    """Tables and pictures of each angle."""
    return join(_of(kind, one) for kind, one in compared.items())


def _of(kind: Kind, found: Compared) -> Html:
    data = found.as_dict()
    rows = [
        [
            r["name"], r["how"], f"{100.0 * r['reported']:.0f} %", _shown(r["sigma_deg"]),
            r["against"] or MISSING, _shown(r["rms_deg"]), _shown(r["bias_deg"]),
            _shown(r["normalized_rms"]), _verdict(found, r["name"]),
        ]
        for r in data["sources"]
    ]  # fmt: skip
    rows += [
        [r["name"], r["reason"], *(MISSING for _ in range(6)), mark("caution", "not there")]
        for r in data["absent"]
    ]
    heads = [
        "Source", "From", "Observable", "Stated σ, °", "Against", "rms, °", "Bias, °", "rms of z",
        "Monitor",
    ]  # fmt: skip
    low, high = _range(found)
    return join(
        [
            tag("h3", TITLES[kind]),
            table(
                f"{TITLES[kind]} at the center of gravity, {data['samples']} times from "
                f"{data['start']:.6g} to {data['end']:.6g} s",
                heads, rows, numeric=[2, 3, 5, 6, 7], class_="dense whole",
            ),
            tag("p", "z: difference over the root of both stated variances, 1 where these are "
                "right. Not observable: a stated σ above 2.5°, or the method says so.",
                class_="note"),
            *(_panel(found, name, s, low, high) for name, s in found.sources.items()),
            tag("p", "Blue: the source with ± 2 σ. Grey: the vote. Shaded: not observable. Dashed: "
                "taken out by the monitor.", class_="note") if found.sources else "",
        ]
    )  # fmt: skip


def _verdict(found: Compared, name: str) -> Html:
    faults = [n for n in found.named if n.source == name]
    source = found.sources[name]
    if faults:
        words = ", ".join(f"{n.reason} at {n.t:.6g} s" for n in faults[:3])
        return mark("bad", words + (f" and {len(faults) - 3} more" if len(faults) > 3 else ""))
    if not source.reported.any():
        return mark("caution", "never observable")
    return mark("good", "agrees") if source.votes else mark("good", "shown only")


def _shown(x: float) -> str:
    return number(x, 2) if np.isfinite(x) else MISSING


def _range(found: Compared) -> tuple[float, float]:
    """What the panels of one angle show, deg: all but the odd value that is reported."""
    parts = [np.degrees(s.values[s.reported]) for s in found.sources.values()]
    parts = [x for x in parts if len(x)]
    if not parts:
        return -5.0, 5.0
    low = min(float(np.percentile(x, 0.2)) for x in parts)
    high = max(float(np.percentile(x, 99.8)) for x in parts)
    pad = max(1.0, 0.25 * (high - low))
    return low - pad, high + pad


def _panel(found: Compared, name: str, source: AngleSource, low: float, high: float) -> Html:
    t = found.t
    begin, span = float(t[0]), max(float(t[-1] - t[0]), 1e-9)
    wide, tall = WIDTH - LEFT - 6.0, HEIGHT - TOP - BOTTOM

    def x(time: Array | float) -> Array:
        return np.asarray(LEFT + (np.asarray(time) - begin) / span * wide)

    def y(value: Array) -> Array:
        shown = np.clip(value, low, high)
        return np.asarray(TOP + (high - shown) / (high - low) * tall)

    deg = float(np.degrees(1.0))
    values, half = deg * source.values, 2.0 * deg * source.sigma
    parts: list[object] = [
        tag("rect", x=f"{LEFT:g}", y=f"{TOP:g}", width=f"{wide:g}", height=f"{tall:g}",
            class_="frame")
    ]  # fmt: skip
    for a, b in _stretches(t, ~_held(t, source)):
        left, right = float(x(a)), float(x(b))
        parts.append(
            tag("rect", x=f"{left:.1f}", y=f"{TOP + 0.5:g}", width=f"{max(right - left, 0.5):.1f}",
                height=f"{tall - 1:g}", class_="off")
        )  # fmt: skip
    for tick in _ticks(low, high, 4):
        at = float(y(np.array(tick)))
        parts.append(tag("line", x1=f"{LEFT:g}", x2=f"{LEFT + wide:g}", y1=f"{at:.1f}",
                         y2=f"{at:.1f}", class_="grid"))  # fmt: skip
        parts.append(_text(LEFT - 5.0, at + 4.0, f"{tick:g}", "end", "axis"))
    for tick in _ticks(begin, begin + span, 8):
        parts.append(_text(float(x(tick)), HEIGHT - 4.0, f"{tick:g}", "middle", "axis"))
    shown = np.where(source.reported, values, np.nan)
    lower, upper = _thinned(t, shown - half)[1], _thinned(t, shown + half)[2]
    at, bottom, top = _thinned(t, shown)
    for i, j in _runs(np.isfinite(lower)):
        path = [f"{float(x(at[k])):.1f} {float(y(upper[k])):.1f}" for k in range(i, j)]
        path += [f"{float(x(at[k])):.1f} {float(y(lower[k])):.1f}" for k in reversed(range(i, j))]
        parts.append(tag("path", d="M" + "L".join(path) + "Z", class_="band"))
    if found.voted is not None:
        vote = _thinned(t, deg * found.voted.angle)
        parts.append(tag("path", d=_line(x(vote[0]), y(vote[1]), y(vote[2])), class_="vote"))
    parts.append(tag("path", d=_line(x(at), y(bottom), y(top)), class_="own"))
    for k, fault in enumerate(n for n in found.named if n.source == name):
        where = float(x(fault.t))
        parts.append(tag("line", x1=f"{where:.1f}", x2=f"{where:.1f}", y1=f"{TOP:g}",
                         y2=f"{TOP + tall:g}", class_="fault"))  # fmt: skip
        if k < FAULTS:
            end = "start" if where < LEFT + 0.8 * wide else "end"
            parts.append(_text(where + (4 if end == "start" else -4), TOP + 12.0,
                               f"{fault.reason} {fault.t:.6g} s", end, "said"))  # fmt: skip
    parts.append(_text(LEFT, 14.0, f"{name}, ° over s", "start", "name"))
    label = f"{name}: {TITLES[found.kind]} over time with its band of two standard deviations"
    return tag(
        "svg", tag("title", label), *parts, class_="angle", width=f"{WIDTH:g}",
        height=f"{HEIGHT:g}", viewBox=f"0 0 {WIDTH:g} {HEIGHT:g}", role="img", aria_label=label,
    )  # fmt: skip


def _held(t: Array, source: AngleSource) -> Array:
    """(n,) of bool: observable here or a moment ago, as long as its own interval lasts."""
    at = t[source.reported]
    each = float(np.median(np.diff(at))) if len(at) > 1 else 0.0
    with np.errstate(invalid="ignore"):
        return np.asarray(source.age <= max(3.0 * each, 1e-9))


def _stretches(t: Array, there: Array) -> list[tuple[float, float]]:
    """Begin and end of each stretch in which `there` holds; the short ones of a long log merge."""
    least = float(t[-1] - t[0]) / STEPS
    out: list[tuple[float, float]] = []
    for i, j in _runs(there):
        a, b = float(t[i]), float(t[min(j, len(t) - 1)])
        if out and a - out[-1][1] < least:
            out[-1] = (out[-1][0], b)
        elif b - a >= least:
            out.append((a, b))
    return out


def _runs(there: Array) -> list[tuple[int, int]]:
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
    at = 0.5 * (edges[:-1] + edges[1:])[full]
    low, high = low[full], high[full]
    empty = ~np.isfinite(low)
    return at, np.where(empty, np.nan, low), np.where(empty, np.nan, high)


def _line(x: Array, low: Array, high: Array) -> str:
    """A path through lowest and highest of each stretch, lifted where there is none."""
    out, down = [], False
    for a, b, c in zip(x, low, high, strict=True):
        if not np.isfinite(b):
            down = False
            continue
        out.append(f"{'L' if down else 'M'}{a:.1f} {c:.1f}" + (f"V{b:.1f}" if b - c > 0.2 else ""))
        down = True
    return "".join(out) or "M0 0"


def _ticks(low: float, high: float, about: int) -> list[float]:
    raw = (high - low) / about
    power = 10.0 ** float(np.floor(np.log10(raw)))
    step = min((m * power for m in (1.0, 2.0, 5.0, 10.0)), key=lambda s: abs(s - raw))
    first = float(np.ceil(low / step)) * step
    return [round(first + k * step, 9) for k in range(int((high - first) / step + 1e-9) + 1)]


def _text(x: float, y: float, text: str, anchor: str, class_: str) -> Html:
    return tag("text", text, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=class_)
