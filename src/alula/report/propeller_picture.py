"""A propeller's coefficient over the advance ratio as SVG: models as lines, tests as dots."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from alula.base.arrays import Array
from alula.report.html import Html, join, tag
from alula.report.numbers import compact
from alula.report.pictures import round_step

LOOKS = 4  # models that are told apart; more repeat
STYLE = (
    ".propeller{max-width:100%;height:auto}"
    ".propeller .axis{stroke:var(--axis)}.propeller .rule{stroke:var(--line)}"
    ".propeller path{stroke-width:2;fill:none}"
    ".propeller .m0{stroke:var(--plot-model)}"
    ".propeller .m1{stroke:var(--plot-residual);stroke-dasharray:7 4}"
    ".propeller .m2{stroke:var(--plot-model);stroke-dasharray:2 3}"
    ".propeller .m3{stroke:var(--plot-residual);stroke-dasharray:9 3 2 3}"
    ".propeller circle{fill:var(--plot-measured)}.propeller .left{fill:none;"
    "stroke:var(--plot-measured)}.propeller text{fill:var(--muted)}"
)
_WIDTH, _HEIGHT, _LEFT, _BOTTOM, _TOP = 460.0, 250.0, 56.0, 36.0, 12.0


def propeller_picture(
    label: str,
    curves: Sequence[tuple[Array, Array]],
    test: tuple[Array, Array] | None = None,
    fitted_below: float | None = None,
) -> Html:
    """curves: J and values (k,) of each model. test: J and measured values, hollow at J of
    `fitted_below` and more, which were not fitted."""
    dots = (np.zeros(0), np.zeros(0)) if test is None else test
    values = np.concatenate([v for _, v in curves] + [dots[1], [0.0]])
    J = np.concatenate([j for j, _ in curves] + [dots[0], [0.0]])
    low, high, last = float(values.min()), float(values.max()), float(J.max()) or 1.0
    high += 0.05 * (high - low) or 0.1

    def x(v: float) -> float:
        return _LEFT + v / last * (_WIDTH - _LEFT - 14.0)

    def y(v: float) -> float:
        return _TOP + (high - v) / (high - low) * (_HEIGHT - _TOP - _BOTTOM)

    ticks, step = [], round_step(high - low)
    for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1):
        at = y(k * step)
        ticks.append(_line(_LEFT, at, _WIDTH - 14.0, at, "axis" if k == 0 else "rule"))
        ticks.append(_text(_LEFT - 5.0, at + 4.0, compact(round(k * step, 6), 3), "end"))
    step = round_step(last)
    for k in range(math.floor(last / step + 1e-9) + 1):
        at = x(k * step)
        ticks.append(_line(at, _HEIGHT - _BOTTOM, at, _HEIGHT - _BOTTOM + 4.0, "axis"))
        ticks.append(_text(at, _HEIGHT - _BOTTOM + 17.0, compact(round(k * step, 6), 3), "middle"))
    circles = [
        tag(
            "circle", cx=f"{x(float(j)):.1f}", cy=f"{y(float(v)):.1f}", r="2.5",
            class_="left" if fitted_below is not None and j >= fitted_below else None,
        )
        for j, v in zip(*dots, strict=True)
    ]  # fmt: skip
    paths = [
        tag(
            "path",
            d="M"
            + "L".join(f"{x(float(a)):.1f} {y(float(b)):.1f}" for a, b in zip(*c, strict=True)),
            class_=f"m{i % LOOKS}",
        )
        for i, c in enumerate(curves)
    ]
    return tag(
        "svg",
        tag("title", label),
        join(ticks),
        join(circles),
        join(paths),
        _text(0.5 * (_LEFT + _WIDTH), _HEIGHT - 4.0, "advance ratio J = V/(n D)", "middle"),
        class_="propeller",
        width=f"{_WIDTH:g}",
        height=f"{_HEIGHT:g}",
        viewBox=f"0 0 {_WIDTH:g} {_HEIGHT:g}",
        role="img",
        aria_label=label,
    )


def key(look: int) -> Html:
    """A short piece of a model's line, for the list of models."""
    return tag(
        "svg", tag("path", d="M0 6L34 6", class_=f"m{look % LOOKS}"), class_="propeller",
        width="34", height="12", viewBox="0 0 34 12", aria_hidden="true",
    )  # fmt: skip


def _line(x1: float, y1: float, x2: float, y2: float, look: str) -> Html:
    return tag("line", x1=f"{x1:.1f}", y1=f"{y1:.1f}", x2=f"{x2:.1f}", y2=f"{y2:.1f}", class_=look)


def _text(x: float, y: float, words: str, anchor: str) -> Html:
    return tag("text", words, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor)
