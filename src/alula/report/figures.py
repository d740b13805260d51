"""Zoomable plots: what the page carries for `alula_plot.js` to draw.

A figure is a column of panels over one time axis. Figures of one group zoom and pan together.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from alula.base.arrays import Array
from alula.report.html import Html, join, json_block, tag
from alula.report.thin import Indices, breaks, kept_breaks, kept_samples

Style = Literal["measured", "model", "estimate", "residual"]


@dataclass(frozen=True)
class Line:
    """A curve: values (n,) at the figure's times, NaN where there is none."""

    name: str
    values: Array
    style: Style


@dataclass(frozen=True)
class Band:
    """A band of half width `half` (n,) about `center` (n,), or about zero where that is None."""

    name: str
    half: Array
    center: Array | None = None


@dataclass(frozen=True)
class Panel:
    """One pair of axes. label: the ordinate with its unit. small: drawn lower, as residuals are.

    limit: the axis first shows minus to plus this much; None: all there is. What lies beyond is
    marked at the edge and seen after zooming in.
    """

    label: str
    lines: tuple[Line, ...]
    bands: tuple[Band, ...] = ()
    small: bool = False
    limit: float | None = None


@dataclass(frozen=True)
class Figure:
    """Panels over the times t (n,), s. note: a line of text below, held_out: marked as such.

    over: unit of t: s, or Hz where it is frequency; figures of one group have the same.
    """

    title: str
    group: str
    t: Array
    panels: tuple[Panel, ...]
    note: str = ""
    held_out: bool = False
    over: Literal["s", "Hz"] = "s"


@dataclass(frozen=True)
class Survey:
    """What a figure takes of the page: its part and group, samples and curves; bytes of markup,
    and of its description in the data block."""

    part: str
    group: str
    samples: int
    columns: int
    markup: int
    words: int

    def size(self, most: int) -> int:
        """Bytes on the page where a figure carries at most so many samples."""
        if self.samples <= most:  # float32; of uneven times float64
            return self.markup + self.words + (16 * self.samples * (self.columns + 2)) // 3
        # 16 bits each: values between their extremes, and steps of the samples' numbers
        return self.markup + self.words + (8 * most * (self.columns + 1)) // 3 + 48 * self.columns


@dataclass
class FigureStore:
    """Collects the figures of one page; equal arrays are carried once.

    most: samples of a figure above which the page carries fewer than there are, and says so.
    drawn: the groups of each part of the page that are drawn; None: all. part: of the page, to
    which what is added now belongs. counting: only the surveys are wanted, nothing is carried.
    still: markup without plots that the survey has made and the page takes over.
    """

    most: int
    drawn: Mapping[str, frozenset[str]] | None = None
    part: str = ""
    counting: bool = False
    still: dict[str, Html] = field(default_factory=dict)
    thinned: set[str] = field(default_factory=set)
    surveys: list[Survey] = field(default_factory=list)
    _arrays: dict[str, str] = field(default_factory=dict)
    _index: dict[bytes, str] = field(default_factory=dict)
    _figures: list[dict[str, Any]] = field(default_factory=list)

    def draws(self, group: str) -> bool:
        """Are the figures of this group drawn in the present part?"""
        return self.drawn is None or group in self.drawn.get(self.part, frozenset())

    def once(self, key: str, make: Callable[[], Html]) -> Html:
        """Markup without plots, by a name of its own; made only where there is none yet."""
        if key not in self.still:
            self.still[key] = make()
        return self.still[key]

    def add(self, figure: Figure) -> Html:
        """The figure's place on the page; nothing where its group is left out."""
        if not self.draws(figure.group):
            return Html("")
        total = len(figure.t)
        if total < 2:
            words = f"{figure.title}: {total or 'no'} sample, nothing to draw."
            return tag("p", words, class_="note")
        columns = _columns(figure)
        gaps = breaks(figure.t)
        keep = None if self.counting else kept_samples(columns, self.most, gaps)
        if keep is not None:
            gaps = kept_breaks(gaps, keep)
            self.thinned.add(self.part)
        figures = {
            "group": figure.group,
            "t": self._times(figure.t, keep, gaps),
            "panels": [self._panel(panel, keep) for panel in figure.panels],
        }
        if figure.over != "s":
            figures["over"] = figure.over
        number = len(self._figures)
        self._figures.append(figures)
        kept = len(figure.t) if self.counting else None if keep is None else len(keep)
        place = _place(figure, number, kept)
        sizes = len(place.encode()), len(json.dumps(figures)) + 40
        self.surveys.append(Survey(self.part, figure.group, total, len(columns), *sizes))
        return place

    def block(self) -> Html:
        """The data block that the page's script reads."""
        return json_block("alula-plots", {"arrays": self._arrays, "figures": self._figures})

    def _panel(self, panel: Panel, keep: Indices | None) -> dict[str, Any]:
        found: dict[str, Any] = {
            "label": panel.label,
            "lines": [
                {"name": n.name, "style": n.style, "y": self._values(n.values, keep)}
                for n in panel.lines
            ],
        }
        bands = []
        for b in panel.bands:
            carried = {"name": b.name, "half": self._values(b.half, keep)}
            if b.center is not None:
                carried["center"] = self._values(b.center, keep)
            bands.append(carried)
        if bands:
            found["bands"] = bands
        if panel.small:
            found["small"] = True
        if panel.limit is not None:
            found["limit"] = panel.limit
        return found

    def _values(self, values: Array, keep: Indices | None) -> Any:
        """The name of an array of float32; of a thinned curve [lowest, step, name of 16 bits].

        65535 stands for a missing value. The step is a 65534th of the curve's range, far below a
        pixel.
        """
        if self.counting:  # about as many bytes as there will be
            return [0.123456789, 0.1234567, "12345"]
        chosen = np.where(np.isfinite(values), values, np.nan)
        if keep is None:
            return self._carry(np.ascontiguousarray(chosen, dtype="<f4").tobytes())
        chosen = chosen[keep]
        there = ~np.isnan(chosen)
        low = float(chosen[there].min()) if there.any() else 0.0
        step = float(np.ptp(chosen[there])) / 65534.0 if there.any() else 0.0
        whole = np.full(len(chosen), 65535, dtype="<u2")
        whole[there] = np.round((chosen[there] - low) / step) if step > 0.0 else 0
        return [float(f"{low:.9g}"), float(f"{step:.7g}"), self._carry(whole.tobytes())]

    def _times(self, t: Array, keep: Indices | None, gaps: Indices) -> Any:
        """Evenly spaced times as three numbers, and what was kept of them by steps of 16 bits.

        Others as float64 (float32 would round them). gaps: the samples before which the data have
        one; the page cannot tell them from samples that were thinned out.
        """
        if self.counting:
            return {"start": 0.1234, "step": 0.01, "jumps": "12345", "breaks": gaps.tolist()}
        step = (t[-1] - t[0]) / max(len(t) - 1, 1)
        even = np.max(np.abs(t - (t[0] + step * np.arange(len(t))))) <= 1e-6
        if even and keep is None and not len(gaps):
            return {"start": float(t[0]), "step": float(step), "n": len(t)}
        if even and keep is not None and np.diff(keep).max() < 65536:
            jumps = self._carry(np.diff(keep, prepend=0).astype("<u2").tobytes())
            return {
                "start": float(t[0]), "step": float(step), "jumps": jumps, "breaks": gaps.tolist()
            }  # fmt: skip
        chosen = t if keep is None else t[keep]
        carried = self._carry(np.ascontiguousarray(chosen, dtype="<f8").tobytes())
        return {"y": carried, "breaks": gaps.tolist()}

    def _carry(self, content: bytes) -> str:
        key = hashlib.sha256(content).digest()
        if key not in self._index:
            self._index[key] = name = str(len(self._index))
            self._arrays[name] = base64.b64encode(content).decode()
        return self._index[key]


def _place(figure: Figure, number: int, kept: int | None) -> Html:
    """The figure's markup: title, canvas, what there is to say below it."""
    note = [figure.note] if figure.note else []
    if kept is not None:
        note.append(f"Shown thinned: {kept} of {len(figure.t)} samples.")
    held_out = tag("span", "held out: not used in the fit", class_="tag") if figure.held_out else ""
    what = "; ".join(p.label for p in figure.panels)
    low, high = float(figure.t[0]), float(figure.t[-1])
    over = f"{low:.1f} to {high:.1f} s of the log"
    if figure.over == "Hz":
        over = f"{low:.3g} to {high:.3g} Hz"
    return tag(
        "figure",
        tag("figcaption", tag("strong", figure.title), " ", held_out),
        tag(
            "div",
            tag("canvas", aria_hidden="true"),
            tag("p", class_="live", aria_live="polite"),
            class_="plot",
            data_plot=number,
            tabindex=0,
            role="group",
            aria_roledescription="zoomable plot",
            aria_label=f"{figure.title}. {what}, over {over}.",
        ),
        tag("p", join(" ".join(note)), class_="note") if note else "",
    )


def _columns(figure: Figure) -> tuple[Array, ...]:
    """Every curve whose extremes must survive thinning; of a band its upper edge tells enough."""
    columns = [line.values for panel in figure.panels for line in panel.lines]
    columns += [band.half for panel in figure.panels for band in panel.bands]
    return tuple(columns)
