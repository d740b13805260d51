"""Span loads as SVG: section lift and load along each surface."""

from __future__ import annotations

import math

import numpy as np

from alula.base.arrays import Array
from alula.predict.lattice_result import SpanLoad
from alula.report.html import Html, join, tag
from alula.report.numbers import compact
from alula.report.pictures import round_step

STYLE = (
    ".spanload{max-width:100%;height:auto}"
    ".spanload .axis{stroke:var(--axis);fill:none}.spanload .rule{stroke:var(--line)}"
    ".spanload .lift{stroke:var(--plot-model);stroke-width:2;fill:none}"
    ".spanload .load{stroke:var(--plot-residual);stroke-width:2;stroke-dasharray:6 3;fill:none}"
    ".spanload text{fill:var(--muted)}"
    ".spanload .lift-name{fill:var(--plot-model)}.spanload .load-name{fill:var(--plot-residual)}"
)
_WIDTH, _HEIGHT, _LEFT, _BOTTOM, _TOP = 460.0, 230.0, 50.0, 36.0, 26.0


def span_load(load: SpanLoad, chord: float) -> Html:
    """Section lift c_l and load c_l times local chord over `chord` (m), along the surface."""
    across = np.ptp(load.position[:, 1]) >= np.ptp(load.position[:, 2])
    place = load.position[:, 1] if across else -load.position[:, 2]
    weight = load.c_l * load.chord / chord
    low, high = _range(np.concatenate([load.c_l, weight, [0.0]]))
    x0, x1 = float(place[0] - 0.5 * load.width[0]), float(place[-1] + 0.5 * load.width[-1])

    def x(v: float) -> float:
        return _LEFT + (v - x0) / (x1 - x0) * (_WIDTH - _LEFT - 12.0)

    def y(v: float) -> float:
        return _TOP + (high - v) / (high - low) * (_HEIGHT - _TOP - _BOTTOM)

    ticks, step = [], round_step(high - low)
    for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1):
        at, kind = k * step, "axis" if k == 0 else "rule"
        ticks.append(_line(_LEFT, y(at), _WIDTH - 12.0, y(at), kind))
        ticks.append(_text(_LEFT - 5.0, y(at) + 4.0, compact(round(at, 6), 3), "end"))
    step = round_step(x1 - x0)
    for k in range(math.ceil(x0 / step - 1e-9), math.floor(x1 / step + 1e-9) + 1):
        at = x(k * step)
        ticks.append(_line(at, _HEIGHT - _BOTTOM, at, _HEIGHT - _BOTTOM + 4.0, "axis"))
        ticks.append(_text(at, _HEIGHT - _BOTTOM + 17.0, compact(round(k * step, 6), 3), "middle"))

    def curve(values: Array, look: str) -> Html:
        points = (
            f"{x(float(a)):.1f} {y(float(b)):.1f}" for a, b in zip(place, values, strict=True)
        )
        return tag("path", d="M" + "L".join(points), class_=look)

    label = f"{load.surface}: section lift and load along the span"
    where = "y, m" if across else "height above the datum, m"
    return tag(
        "svg",
        tag("title", label),
        join(ticks),
        curve(load.c_l, "lift"),
        curve(weight, "load"),
        _text(_LEFT, 15.0, "— c_l", "start", "lift-name"),
        _text(_LEFT + 70.0, 15.0, "- - c_l × local chord / c", "start", "load-name"),
        _text(0.5 * (_LEFT + _WIDTH), _HEIGHT - 4.0, where, "middle"),
        class_="spanload",
        width=f"{_WIDTH:g}",
        height=f"{_HEIGHT:g}",
        viewBox=f"0 0 {_WIDTH:g} {_HEIGHT:g}",
        role="img",
        aria_label=label,
    )


def _range(values: Array) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    if high - low < 1e-6:  # no load, or rounding of none
        return -0.1, 0.1
    pad = 0.06 * (high - low)
    return low - (pad if low < 0.0 else 0.0), high + (pad if high > 0.0 else 0.0)


def _line(x1: float, y1: float, x2: float, y2: float, look: str) -> Html:
    return tag("line", x1=f"{x1:.1f}", y1=f"{y1:.1f}", x2=f"{x2:.1f}", y2=f"{y2:.1f}", class_=look)


def _text(x: float, y: float, words: str, anchor: str, look: str | None = None) -> Html:
    return tag("text", words, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=look)
