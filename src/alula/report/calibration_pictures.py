"""Pictures of a calibration as SVG: vectors before and after, and Allan deviations."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from alula.base.arrays import Array
from alula.navigate.calibration import AxisNoise, SensorCalibration
from alula.report.html import Html, join, tag
from alula.report.numbers import compact

STYLE = (
    ".calibration{max-width:100%;height:auto}"
    ".calibration .axis{stroke:var(--axis);fill:none}"
    ".calibration .before{fill:var(--plot-residual);fill-opacity:.45}"
    ".calibration .after{fill:var(--plot-model);fill-opacity:.45}"
    ".calibration .true{stroke:var(--ink);fill:none;stroke-dasharray:4 3}"
    ".calibration .grid{stroke:var(--line)}"
    ".calibration .x{stroke:var(--plot-model);fill:var(--plot-model)}"
    ".calibration .y{stroke:var(--plot-residual);fill:var(--plot-residual)}"
    ".calibration .z{stroke:var(--good);fill:var(--good)}"
    ".calibration .model{fill:none}"
)
MOST = 1500  # points of one cloud; more are not told apart
SIDE, PAD = 230.0, 34.0
SHOWN = {"m/s2": (1.0, "m/s²"), "T": (1e6, "µT"), "rad/s": (1.0, "rad")}


def clouds(sensor: SensorCalibration) -> Html:
    """Readings and calibrated vectors in three projections, with the circle of the true length."""
    factor, unit = SHOWN[sensor.unit]
    step = max(len(sensor.raw) // MOST, 1)
    before, after = factor * sensor.raw[::step], factor * sensor.calibrated[::step]
    radius = factor * float(np.max(sensor.length))
    reach = 1.08 * max(float(np.nanmax(np.abs(np.vstack([before, after])))), radius)
    panels = [
        _panel(
            k, before[:, [i, j]], after[:, [i, j]], radius, reach, unit, f"{'xyz'[i]}, {'xyz'[j]}"
        )
        for k, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)))
    ]
    label = (
        f"{sensor.sensor}: readings as recorded and calibrated, in {unit}; dashed, the true length"
    )
    return _svg(3 * SIDE, SIDE + 24, label, *panels)


def _panel(
    k: int, before: Array, after: Array, radius: float, reach: float, unit: str, title: str
) -> Html:
    middle, half = (k + 0.5) * SIDE, SIDE / 2 - PAD / 2
    scale = half / reach

    def points(values: Array, look: str) -> Html:
        good = values[np.isfinite(values).all(axis=1)]
        size = 1.1 if len(good) > 200 else 3.0
        return tag(
            "g",
            join(
                tag(
                    "circle",
                    cx=f"{middle + scale * x:.1f}",
                    cy=f"{SIDE / 2 - scale * y:.1f}",
                    r=f"{size:g}",
                )
                for x, y in good
            ),
            class_=look,
        )

    left, right = middle - half, middle + half
    return tag(
        "g",
        _line(left, SIDE / 2, right, SIDE / 2, "grid"),
        _line(middle, SIDE / 2 - half, middle, SIDE / 2 + half, "grid"),
        tag(
            "rect", x=f"{left:.1f}", y=f"{SIDE / 2 - half:.1f}",
            width=f"{2 * half:.1f}", height=f"{2 * half:.1f}", class_="axis",
        ),
        points(before, "before"),
        points(after, "after"),
        tag(
            "circle", cx=f"{middle:.1f}", cy=f"{SIDE / 2:.1f}", r=f"{scale * radius:.1f}",
            class_="true",
        ),
        _words(middle, SIDE + 12, f"{title}; edge at {compact(reach, 3)} {unit}", "middle"),
    )  # fmt: skip


def length_bars(sensor: SensorCalibration) -> Html:
    """Error of the length of each vector, percent, before and after; for up to 60 vectors."""
    turned = sensor.length > 0.0
    length = sensor.length[turned]
    pairs = [
        100.0 * (np.linalg.norm(v[turned], axis=1) / length - 1.0)
        for v in (sensor.raw, sensor.calibrated)
    ]
    top = 1.1 * float(np.nanmax(np.abs(np.concatenate(pairs))))
    width, height, left = 660.0, 190.0, 46.0
    pitch = (width - left - 8) / len(length)
    zero = height / 2

    def bar(k: int, value: float, shift: float, look: str) -> Html:
        if not math.isfinite(value):
            return Html("")
        y = zero - value / top * (zero - 8)
        return tag(
            "rect", x=f"{left + (k + shift) * pitch:.1f}", y=f"{min(y, zero):.1f}",
            width=f"{0.36 * pitch:.1f}", height=f"{max(abs(y - zero), 0.5):.1f}", class_=look,
        )  # fmt: skip

    bars = [
        bar(k, float(v), shift, look)
        for p, shift, look in zip(pairs, (0.1, 0.5), ("before", "after"), strict=True)
        for k, v in enumerate(p)
    ]
    label = f"{sensor.sensor}: error of the length, percent, as recorded and calibrated"
    return _svg(
        width, height, label, _line(left, zero, width - 8, zero, "axis"), *bars,
        _words(left - 4, 16, f"{compact(top, 3)} %", "end"),
        _words(left - 4, zero + 4, "0", "end"),
        _words(left - 4, height - 6, f"{compact(-top, 3)} %", "end"),
    )  # fmt: skip


def allan_picture(axes: Sequence[AxisNoise], title: str) -> Html:
    """Allan deviation over averaging time, double logarithmic, with error bars and the fit."""
    width, height, left, bottom = 660.0, 300.0, 60.0, 34.0
    tau = axes[0].tau
    low = min(float(np.min(np.maximum(a.deviation - a.error, 0.2 * a.deviation))) for a in axes)
    high = max(float(np.max(a.deviation + a.error)) for a in axes)
    y0, y1 = math.floor(math.log10(low)), math.ceil(math.log10(high))
    x0, x1 = math.log10(tau[0]) - 0.1, math.log10(tau[-1]) + 0.1

    def x(t: float) -> float:
        return left + (math.log10(t) - x0) / (x1 - x0) * (width - left - 10)

    def y(s: float) -> float:
        return 8 + (y1 - math.log10(s)) / max(y1 - y0, 1) * (height - bottom - 8)

    parts: list[object] = []
    for power in range(y0, y1 + 1):
        parts.append(_line(left, y(10.0**power), width - 10, y(10.0**power), "grid"))
        parts.append(_words(left - 5, y(10.0**power) + 4, f"1e{power}", "end"))
    for power in range(math.ceil(x0), math.floor(x1) + 1):
        parts.append(_line(x(10.0**power), 8, x(10.0**power), height - bottom, "grid"))
        parts.append(_words(x(10.0**power), height - bottom + 15, f"1e{power}", "middle"))
    for axis, look in zip(axes, "xyz", strict=False):
        for t, s, e in zip(axis.tau, axis.deviation, axis.error, strict=True):
            bottom_end = max(s - e, 10.0**y0)
            parts.append(_line(x(t), y(bottom_end), x(t), y(s + e), look))
            parts.append(tag("circle", cx=f"{x(t):.1f}", cy=f"{y(s):.1f}", r="2.5", class_=look))
        path = "L".join(
            f"{x(t):.1f} {y(max(m, 10.0**y0)):.1f}"
            for t, m in zip(axis.tau, axis.model, strict=True)
        )
        parts.append(tag("path", d=f"M{path}", class_=f"{look} model"))
        parts.append(_words(width - 16, 22 + 14 * "xyz".index(look), look, "end", look))
    unit = axes[0]["bias_instability"].unit
    parts.append(_words(width / 2, height - 3, "averaging time, s", "middle"))
    return _svg(width, height, f"{title}: Allan deviation, {unit}, over averaging time", *parts)


def _svg(width: float, height: float, label: str, *parts: object) -> Html:
    return tag(
        "svg",
        tag("title", label),
        *parts,
        class_="calibration",
        width=f"{width:g}",
        height=f"{height:g}",
        viewBox=f"0 0 {width:g} {height:g}",
        role="img",
        aria_label=label,
    )


def _line(x1: float, y1: float, x2: float, y2: float, look: str) -> Html:
    return tag("line", x1=f"{x1:.1f}", y1=f"{y1:.1f}", x2=f"{x2:.1f}", y2=f"{y2:.1f}", class_=look)


def _words(x: float, y: float, text: str, anchor: str, look: str | None = None) -> Html:
    return tag("text", text, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=look)
