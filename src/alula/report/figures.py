"""Zoomable plots: what the page carries for `alula_plot.js` to draw.

A figure is a column of panels over one time axis. Figures of one group zoom and pan together.
"""

from __future__ import annotations

import base64
import hashlib
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
    """Panels over the times t (n,), s. note: a line of text below, held_out: marked as such."""

    title: str
    group: str
    t: Array
    panels: tuple[Panel, ...]
    note: str = ""
    held_out: bool = False


@dataclass
class FigureStore:
    """Collects the figures of one page; equal arrays are carried once.

    most: samples of a figure above which the page carries fewer than there are, and says so.
    """

    most: int
    _arrays: dict[str, str] = field(default_factory=dict)
    _index: dict[bytes, str] = field(default_factory=dict)
    _figures: list[dict[str, Any]] = field(default_factory=list)

    def add(self, figure: Figure) -> Html:
        """The figure's place on the page."""
        total = len(figure.t)
        if total < 2:
            words = f"{figure.title}: {total or 'no'} sample, nothing to draw."
            return tag("p", words, class_="note")
        gaps = breaks(figure.t)
        keep = kept_samples(_columns(figure), self.most, gaps)
        if keep is not None:
            gaps = kept_breaks(gaps, keep)
        t = figure.t if keep is None else figure.t[keep]
        panels = [
            {
                "label": panel.label,
                "small": panel.small,
                "limit": panel.limit,
                "lines": [
                    {"name": n.name, "style": n.style, "y": self._values(n.values, keep)}
                    for n in panel.lines
                ],
                "bands": [
                    {
                        "name": b.name,
                        "half": self._values(b.half, keep),
                        "center": None if b.center is None else self._values(b.center, keep),
                    }
                    for b in panel.bands
                ],
            }
            for panel in figure.panels
        ]
        number = len(self._figures)
        self._figures.append({"group": figure.group, "t": self._times(t, gaps), "panels": panels})
        note = [figure.note] if figure.note else []
        if keep is not None:
            note.append(
                f"Drawn from {len(keep)} of {total} samples, of each stretch the lowest and the "
                "highest of every curve; computed with all."
            )
        held_out = (
            tag("span", "held out: not used in the fit", class_="tag") if figure.held_out else ""
        )
        what = "; ".join(p.label for p in figure.panels)
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
                aria_label=f"{figure.title}. {what}, over {t[0]:.1f} to {t[-1]:.1f} s of the log.",
            ),
            tag("p", join(" ".join(note)), class_="note") if note else "",
        )

    def block(self) -> Html:
        """The data block that the page's script reads."""
        return json_block("alula-plots", {"arrays": self._arrays, "figures": self._figures})

    def _values(self, values: Array, keep: Indices | None) -> str:
        chosen = np.where(np.isfinite(values), values, np.nan)
        chosen = chosen if keep is None else chosen[keep]
        return self._carry(np.ascontiguousarray(chosen, dtype="<f4").tobytes())

    def _times(self, t: Array, gaps: Indices) -> Any:
        """Evenly spaced times as three numbers, others as float64 (float32 would round them).

        gaps: the samples before which the data have one; the page cannot tell them from samples
        that were thinned out.
        """
        step = (t[-1] - t[0]) / max(len(t) - 1, 1)
        if not len(gaps) and np.max(np.abs(t - (t[0] + step * np.arange(len(t))))) <= 1e-6:
            return {"start": float(t[0]), "step": float(step), "n": len(t)}
        carried = self._carry(np.ascontiguousarray(t, dtype="<f8").tobytes())
        return {"y": carried, "breaks": gaps.tolist()}

    def _carry(self, content: bytes) -> str:
        key = hashlib.sha256(content).digest()
        if key not in self._index:
            self._index[key] = name = str(len(self._index))
            self._arrays[name] = base64.b64encode(content).decode()
        return self._index[key]


def _columns(figure: Figure) -> tuple[Array, ...]:
    """Every curve whose extremes must survive thinning; of a band its upper edge tells enough."""
    columns = [line.values for panel in figure.panels for line in panel.lines]
    columns += [band.half for panel in figure.panels for band in panel.bands]
    return tuple(columns)
