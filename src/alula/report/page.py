"""The whole page: sections in reading order, style and script inside, nothing from outside."""

from __future__ import annotations

from collections.abc import Callable

from alula.report.budget import left_out, store_for
from alula.report.figures import FigureStore
from alula.report.html import Html, css_string, join, tag
from alula.report.input import ReportInput
from alula.report.plain_page import END, SKIP, Chapter, contents, packaged, page_head, sections
from alula.report.sections.coefficients import coefficients
from alula.report.sections.correlation import correlation
from alula.report.sections.histories import histories
from alula.report.sections.log_card import log_cards
from alula.report.sections.maneuvers import maneuvers
from alula.report.sections.navigation import navigation
from alula.report.sections.notes import messages, provenance
from alula.report.sections.parameters import parameters
from alula.report.sections.reconstruction import reconstruction
from alula.report.sections.repeated import repeated
from alula.report.sections.summary import header
from alula.report.sections.validation import evidence
from alula.report.sections.validation_flights import flights

_SCRIPTS = ("alula_series.js", "alula_link.js", "alula_plot.js", "report.js")


def render(report: ReportInput) -> str:
    """The page as HTML. It asks for nothing from anywhere and runs no script but its own.

    The same input gives the same text.
    """
    figures = store_for(report, lambda store: join(c for *_, c in _sections(report, store)))
    chapters = _sections(report, figures)
    style = packaged("page.css") + _running_head(report)
    scripts = [packaged(name) for name in _SCRIPTS]
    head = page_head(f"{report.name} · Alula report", style, scripts)
    body = tag(
        "body",
        SKIP,
        contents(chapters, tag("button", "Dark page", id="theme", type="button", hidden=True)),
        tag(
            "main",
            header(report),
            tag(
                "noscript",
                tag("p", "The plots need this page's own script; every table reads without it."),
            ),
            *sections(chapters),
            END,
            id="report",
        ),
        figures.block(),
        *(Html(f"<script>{script}</script>") for script in scripts),
    )
    return "<!DOCTYPE html>\n" + tag("html", head, body, lang="en") + "\n"


def _sections(report: ReportInput, figures: FigureStore) -> list[Chapter]:
    """(anchor, title, content) of each section that has something to show."""
    found: list[Chapter] = []

    def still(key: str, title: str, make: Callable[[], Html]) -> None:
        found.append((key, title, figures.once(key, make)))

    if report.validation is not None:
        flown = report.validation
        still("evidence", "Evidence index", lambda: evidence(flown))
        figures.part = "flown"
        found.append(("flown", "Model and flight side by side", flights(flown, figures)))
    if report.cards:
        still("log", "Log card", lambda: log_cards(report))
    if report.maneuvers:
        still("maneuvers", "Maneuvers", lambda: maneuvers(report))
    if report.navigation:
        figures.part = "navigation"
        filtered = navigation(report.navigation, figures)
        found.append(("navigation", "Navigation: attitude and wind", filtered))
    if report.reconstruction is not None:
        figures.part = "reconstruction"
        content = reconstruction(report.reconstruction, figures)
        recorded = report.reconstruction.method == "none"
        title = "Motion as recorded" if recorded else "Flight path reconstruction"
        found.append(("reconstruction", title, content))
    if report.identification is not None and report.identification.parameters:
        result = report.identification
        figures.part = "coefficients"
        fits = coefficients(result, figures)
        found.append(("coefficients", "Coefficients: measured and model", fits))
        if result.histories:
            figures.part = "histories"
            found.append(("histories", "Estimates over time", histories(result, figures)))
        still("parameters", "Parameters", lambda: parameters(result))
        if report.reidentified:
            again = report.reidentified
            still("repeated", "Identified again", lambda: repeated(again))
        still("correlation", "Correlation", lambda: correlation(result))
    if report.shape is not None and report.shape.geometry is not None:
        from alula.report.sections import geometry as shapes  # slow to load

        shape = report.shape
        neutral = shapes.identified_neutral_point(shape, report.identification)
        still("geometry", "Geometry", lambda: shapes.geometry(shape, neutral))
    still("messages", "Messages", lambda: messages(report))
    still("provenance", "Provenance", lambda: provenance(report))
    for k, (key, title, content) in enumerate(found):
        if key in ("flown", "navigation", "reconstruction", "coefficients", "histories"):
            found[k] = (key, title, join([_HOW_TO, *left_out(report, figures, key), content]))
    return found


_HOW_TO = tag(
    "p",
    "The plots of one maneuver share their time axis. Drag to zoom, Shift-drag to pan, "
    "double-click to reset; the wheel zooms in a plot that was clicked. Keys in a focused plot: "
    "arrows pan, + and − zoom, 0 resets, [ and ] move the cursor from sample to sample.",
    class_="note screen",
)


def _running_head(report: ReportInput) -> str:
    left, right = css_string(f"Alula report: {report.name}"[:90]), css_string(report.date[:40])
    return f"\n@page{{@top-left{{content:{left}}}@top-right{{content:{right}}}}}\n"
