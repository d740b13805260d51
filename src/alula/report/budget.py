"""What the page carries, so that it stays under 3 MB whatever the project.

Tables come first. Then every plot is drawn whole where that fits; else with fewer points than
there are samples; and where even the fewest points that show a plot's course do not fit, the plots
of some maneuvers are left out, and named.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from alula.report.figures import FigureStore, Survey
from alula.report.html import Html, tag
from alula.report.input import ReportInput
from alula.report.numbers import rms
from alula.report.sections.coefficients import group_of
from alula.report.sections.navigation import group_of as navigation_group
from alula.report.sections.reconstruction import misfit

MOST_BYTES = 2_900_000  # of a page, which promises to stay under 3 MB
LEAST = 240  # points of a thinned figure: every fourth pixel of its width, or closer
_FRAME = 50_000  # style, scripts, head

# In the order in which they are worth the room. Anchors of the page's sections are the keys.
_PARTS = ("flown", "navigation", "coefficients", "histories", "reconstruction")

Unit = tuple[str, str]  # (part, group)


def store_for(report: ReportInput, sections: Callable[[FigureStore], Html]) -> FigureStore:
    """An empty store that carries and draws as much as fits. sections: the page's content."""
    survey = FigureStore(LEAST, counting=True)
    text = sections(survey)
    found = survey.surveys
    if not found:
        return FigureStore(LEAST, still=survey.still)
    markup = sum(s.markup for s in found)
    room = MOST_BYTES - _FRAME - (len(text.encode()) - markup) - _spare(found)
    chosen = _chosen(report, found, room)
    kept = [s for s in found if (s.part, s.group) in chosen]
    drawn = {part: frozenset(g for p, g in chosen if p == part) for part in _PARTS}
    every = len(kept) == len(found)
    return FigureStore(_most(kept, room), None if every else drawn, still=survey.still)


def left_out(report: ReportInput, figures: FigureStore, part: str) -> Iterable[Html]:
    """What the reader must know of this part's plots: thinned, or left out."""
    if part in figures.thinned:
        yield tag(
            "p",
            "Shown thinned: where a plot says so, it carries, of each stretch of time, the samples "
            "at which a curve is lowest and highest, and the first and last of all; nothing is "
            "averaged. Everything was computed with all samples.",
            class_="note",
        )
    every = list(dict.fromkeys(_groups(report, part)))
    missing = [g for g in every if figures.drawn is not None and g not in figures.drawn[part]]
    if missing:
        names = [tag("code", g.removeprefix("flown ").removeprefix("navigation ")) for g in missing]
        yield tag(
            "p",
            f"Plots of {len(every) - len(missing)} of {len(every)} "
            f"{'logs' if part == 'navigation' else 'maneuvers'} are drawn, so that the page stays "
            f"under 3 MB: {_WHY[part]}. The tables hold all. Not drawn here, but by "
            f"alula {_COMMANDS.get(part, 'identify PROJECT --maneuver')} ID --report FILE: ",
            Html(", ".join(names[:400])),
            f" and {len(names) - 400} more." if len(names) > 400 else ".",
            class_="note lead",
        )


_COMMANDS = {"flown": "validate PROJECT --maneuver", "navigation": "navigate PROJECT --log"}
_WHY = {
    "navigation": "in the order of the project",
    "flown": "in the order of the project",
    "coefficients": "first the held out ones, then those with the largest residuals",
    "histories": "in the order of the project",
    "reconstruction": "first the held out ones, then those whose sensors fit worst",
}


def _spare(found: list[Survey]) -> int:
    """Bytes for the words that say what is left out: the maneuvers' names, once for each part."""
    return min(sum(len(g) + 16 for g in {(s.part, s.group) for s in found}), 60_000) + 20_000


def _chosen(report: ReportInput, found: list[Survey], room: int) -> set[Unit]:
    """The groups whose figures fit with the fewest points, those that tell most first."""
    sizes: dict[Unit, int] = {}
    for s in found:
        unit = (s.part, s.group)
        sizes[unit] = sizes.get(unit, 0) + s.size(LEAST)
    chosen: set[Unit] = set()
    for part in _PARTS:
        for group in dict.fromkeys(_groups(report, part)):
            size = sizes.get((part, group), 0)
            if size > room:
                break
            room -= size
            chosen.add((part, group))
    return chosen


def _most(kept: list[Survey], room: int) -> int:
    """The most samples of a figure with which all of them fit."""
    low, high = LEAST, max((s.samples for s in kept), default=LEAST)
    if sum(s.size(high) for s in kept) <= room:
        return max(high, LEAST)
    while high - low > 1:
        middle = (low + high) // 2
        if sum(s.size(middle) for s in kept) <= room:
            low = middle
        else:
            high = middle
    return low


def _groups(report: ReportInput, part: str) -> list[str]:
    """The part's groups of figures, those that tell most first."""
    if part == "flown" and report.validation is not None:
        return [f"flown {one.maneuver.id}" for one in report.validation.flown]
    if part == "navigation":
        return [navigation_group(log) for log in report.navigation]
    if part == "coefficients" and report.identification is not None:
        worst: dict[str, tuple[bool, float]] = {}
        for s in report.identification.series:
            spread = float(np.nanmax(s.measured) - np.nanmin(s.measured))
            held, size = worst.get(group_of(s), (False, 0.0))
            error = rms(s.measured - s.model) / (spread or 1.0)
            worst[group_of(s)] = (s.held_out or held, max(size, error))
        return sorted(worst, key=lambda m: (not worst[m][0], -worst[m][1]))
    if part == "histories" and report.identification is not None:
        return list(dict.fromkeys(h.maneuver for h in report.identification.histories))
    if part == "reconstruction" and report.reconstruction is not None:
        segments = sorted(
            report.reconstruction.segments,
            key=lambda g: (not g.maneuver.held_out, -max(map(misfit, g.sensors), default=0.0)),
        )
        return [g.maneuver.id for g in segments]
    return []
