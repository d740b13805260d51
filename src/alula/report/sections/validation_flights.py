"""Each maneuver flown through the model, over what the aircraft did."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from alula.base.arrays import Array
from alula.report.figures import Band, Figure, FigureStore, Line, Panel
from alula.report.html import Html, join, tag
from alula.report.names import meaning, titled, unit_of
from alula.report.numbers import number, shown
from alula.report.pictures import mark
from alula.report.sections.validation import SEEN, anchor

if TYPE_CHECKING:
    from alula.validate.result import ChannelMatch, Flown, Validation

_PAIRS = (
    ("alpha", "V"), ("theta", "q"), ("az", "ax"), ("beta", "ay"), ("p", "phi"), ("r", "psi"),
    ("h",),
)  # fmt: skip


def flights(result: Validation, figures: FigureStore) -> Html:
    """One part per maneuver, that the evidence index links to."""
    return join(_flight(result, one, figures) for one in result.flown)


def _flight(result: Validation, one: Flown, figures: FigureStore) -> Html:
    m = one.maneuver
    axis = {c.name for c in one.channels.values() if c.in_axis}
    excited = [p for p in _PAIRS if axis & set(p)]
    others = [p for p in _PAIRS if not axis & set(p)]
    rest = list(_figures(one, others))
    return tag(
        "section",
        tag("h3", f"{m.id}: {m.kind.replace('_', ' ')}, {m.aspect} "),
        _standing(one),
        *(tag("p", words, class_="note lead") for words in _how(one)),
        tag(
            "div",
            figures.add(_controls(one)),
            *(figures.add(f) for f in _figures(one, excited)),
            class_="grid",
        ),
        join(
            [
                tag("h4", "The other axes, which this maneuver does not excite"),
                tag("div", *(figures.add(f) for f in rest), class_="grid"),
            ]
            if rest
            else []
        ),
        id=anchor(result, m.id),
        class_="maneuver",
    )


def _standing(one: Flown) -> Html:
    """Whether this is a validation, and whether the model's flight lasted."""
    parts = []
    if one.seen in SEEN:
        level = "bad" if one.seen == "yes" else "caution"
        parts.append(tag("p", mark(level, SEEN[one.seen][0].upper() + SEEN[one.seen][1:] + ".")))
    else:
        parts.append(tag("p", mark("good", "The estimate never saw this maneuver.")))
    if one.diverged_at is not None:
        words = (
            f"The model's flight diverged at {number(one.diverged_at, 5)} s; shown and compared "
            "until then."
        )
        parts.append(tag("p", mark("bad", words)))
    return join(parts)


def _how(one: Flown) -> Iterator[str]:
    """How it was flown, in sentences."""
    yield (
        f"Flown open loop for {number(one.horizon, 4)} s of {number(one.asked, 4)} s, from the "
        "reconstructed state at the first sample; "
        + (
            f"the band is ±2 standard deviations of {one.draws} flights with parameters drawn "
            "from their covariance."
            if one.draws
            else "no band: the model carries no covariance, or none was asked for."
        )
    )
    if one.offsets:
        listed = ", ".join(f"{n} {number(v, 3)}" for n, v in one.offsets.items())
        yield f"Trim offsets were added to the model's coefficients, as asked for: {listed}."
    else:
        yield "Nothing was adjusted: no initial state, no bias, no trim offset."
    if one.as_recorded:
        yield (
            f"The model has no {', '.join(one.as_recorded)}; the recorded history was flown "
            "instead, and what follows it proves nothing."
        )
    if one.outside:
        yield (
            "Beyond the range in which the model was found: "
            + "; ".join(
                f"{name} {_in_units(name, value)} (range {_in_units(name, low)} to "
                f"{_in_units(name, high)})"
                for name, (value, low, high) in one.outside.items()
            )
            + "."
        )


def _in_units(name: str, value: float) -> str:
    factor, unit = shown("1" if name == "dt" else unit_of(name))
    return f"{number(factor * value, 3)}" + ("" if unit == "–" else f" {unit}")


def _controls(one: Flown) -> Figure:
    panels = []
    moved = [name for name, values in one.controls.items() if np.ptp(values) > 0.0]
    for name in moved:
        factor, unit = shown("1" if name == "dt" else unit_of(name))
        line = Line(name, factor * one.controls[name], "measured")
        panels.append(Panel(f"{titled(name)} ({unit})", (line,), small=len(moved) > 1))
    if not panels:
        nothing = Line("no control moved", np.zeros(len(one.t)), "measured")
        panels.append(Panel("controls", (nothing,), small=True))
    return Figure("Recorded controls", _group(one), one.t, tuple(panels))


def _figures(one: Flown, pairs: Sequence[tuple[str, ...]]) -> Iterator[Figure]:
    from alula.validate.part60 import tolerances  # loads the simulator

    judged = tolerances(one)
    for pair in pairs:
        channels = [one.channels[n] for n in pair if one.channels[n].recorded]
        panels = [p for c in channels for p in _panels(c, judged.get(c.name))]
        if panels:
            title = " · ".join(meaning(c.name).capitalize() for c in channels)
            notes = [f"{c.name} follows a coefficient taken as recorded." for c in channels
                     if c.as_recorded]  # fmt: skip
            yield Figure(title, _group(one), one.t, tuple(panels), note=" ".join(notes))


def _panels(c: ChannelMatch, tolerance: Array | None) -> Iterator[Panel]:
    factor, unit = shown(c.unit)
    lines = (
        Line("flight", factor * c.measured, "measured"),
        Line("model", factor * c.model, "model"),
    )
    spread = c.model_se is not None and bool(np.any(c.model_se > 0.0))
    bands = (
        (Band("±2 σ of the model", 2.0 * factor * c.model_se, factor * c.model),)
        if spread and c.model_se is not None
        else ()
    )
    yield Panel(f"{c.name} ({unit})", lines, bands)
    if tolerance is not None:
        error = Line("model − flight", factor * (c.model - c.measured), "residual")
        band = Band("tolerance, where judged", factor * tolerance)
        most = max(float(np.nanmax(band.half)), float(np.abs(error.values).max()))
        label = f"{c.name}, model − flight ({unit})"
        yield Panel(label, (error,), (band,), small=True, limit=1.1 * most)


def _group(one: Flown) -> str:
    return f"flown {one.maneuver.id}"
