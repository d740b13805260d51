"""Flight path reconstruction: constants, consistency tests, states and innovations."""

from __future__ import annotations

import math

import numpy as np

from alula.reconstruct.result import Reconstruction, Segment, SensorFit
from alula.report.figures import FigureStore
from alula.report.html import MOST_ROWS, Html, join, table, tag
from alula.report.names import meaning, titled, unit_of
from alula.report.numbers import MISSING, number, plus_minus, rms, shown
from alula.report.pictures import mark, within_picture
from alula.report.sections.motion import motion_figures, sensor_figure, state_figures, steady_states
from alula.report.sections.summary import method_words, sentence


def reconstruction(result: Reconstruction, figures: FigureStore) -> Html:
    """Tables of the whole reconstruction, then the plots of each maneuver."""
    level = "good" if result.converged else "bad"
    method = "" if result.method == "none" else f"Method: {method_words(result.method)}. "
    words = method + sentence(result.status)
    findings = None
    if result.method != "none":
        findings = figures.once("findings", lambda: _findings(result))
    return join(
        [
            tag("p", mark(level, words, long=True)),
            findings,
            *(_segment(s, figures) for s in result.segments if figures.draws(s.maneuver.id)),
        ]
    )


def _findings(result: Reconstruction) -> Html:
    """What was estimated, and whether it agrees with the data."""
    return join([_constants(result), _nis(result), _mismatch(result), _whiteness(result)])


def _constants(result: Reconstruction) -> Html:
    if not result.constants:
        return tag("p", "No constants were estimated.")
    if len({c.name.partition("[")[2] for c in result.constants}) > 1:
        return _constants_by_group(result)
    rows = []
    for c in result.constants:
        factor, unit = shown(c.unit)
        rows.append(
            [
                tag("code", c.name),
                meaning(c.name),
                plus_minus(factor * c.value, factor * c.se),
                unit,
                mark("good", "observable")
                if c.observable
                else mark("caution", "not observable: reported, not used"),
            ]
        )
    return table(
        "Biases, scale factors and other constants, with one standard error. Those of a walking "
        "unknown are of its mean.",
        ["Constant", "Meaning", "Value ± se", "Unit", "Do the data determine it?"],
        rows,
        numeric=(2,),
    )


def _constants_by_group(result: Reconstruction) -> Html:
    """Constants that each maneuver or log has for itself, 'b_ax[spiral]': a column for each."""
    cells: dict[str, dict[str, Html]] = {}
    units: dict[str, str] = {}
    for c in result.constants:
        name, _, group = c.name.partition("[")
        factor, units[name] = shown(c.unit)
        value = plus_minus(factor * c.value, factor * c.se)
        unseen = "" if c.observable else mark("caution", "not observable")
        cells.setdefault(name, {})[group.removesuffix("]")] = join([value, " ", unseen])
    groups = list(dict.fromkeys(g for row in cells.values() for g in row))
    return table(
        "Biases, scale factors and other constants, with one standard error, for each maneuver or "
        "log by itself. What the data do not determine is marked not observable: it is reported, "
        "not used. Those of a walking unknown are of its mean.",
        ["Constant", "Meaning", "Unit", *(tag("code", g) if g else "all" for g in groups)],
        (
            [tag("code", n), meaning(n), units[n], *(row.get(g, MISSING) for g in groups)]
            for n, row in cells.items()
        ),
        numeric=range(3, 3 + len(groups)),
        class_="dense",
    )


def _nis(result: Reconstruction) -> Html:
    low, high = result.nis_interval
    if not math.isfinite(result.nis_mean):
        return tag("p", "This method has no innovations; the residuals are shown instead.")
    inside = low <= result.nis_mean <= high
    words = (
        f"Mean normalized innovation squared (NIS) {number(result.nis_mean, 3)} per measurement, "
        f"expected {number(low, 3)} to {number(high, 3)} if the stated noise is right"
    )
    meaning = (
        "the filter's uncertainty agrees with its errors"
        if inside
        else "the errors are larger than the filter believes"
        if result.nis_mean > high
        else "the errors are smaller than the filter believes"
    )
    return tag(
        "div",
        tag("p", mark("good" if inside else "caution", f"{words}: {meaning}.", long=True)),
        within_picture(result.nis_mean, low, high, words),
        class_="keep",
    )


def _mismatch(result: Reconstruction) -> Html:
    """Rms of measurement minus open-loop kinematics: a row per maneuver, a column per sensor."""
    names = list(dict.fromkeys(n for g in result.segments for n in g.mismatch))
    units = {n: unit_of(n) for n in names}
    units |= {s.name: s.unit for g in result.segments for s in g.sensors}
    if not names:
        return Html("")

    def cell(segment: Segment, name: str) -> str:
        return number(shown(units[name]).factor * segment.mismatch.get(name, math.nan), 3)

    return table(
        "Mismatch: rms of measurement minus the kinematics integrated open loop with the estimated "
        "constants and initial state. No filter smooths it.",
        ["Maneuver", *(f"{n}, {shown(units[n]).text}" for n in names)],
        ([tag("code", g.maneuver.id), *(cell(g, n) for n in names)] for g in result.segments),
        numeric=range(1, len(names) + 1),
    )


def _whiteness(result: Reconstruction) -> Html:
    """Residual size and lag-1 autocorrelation of each sensor, against the bound of white noise."""
    rows: list[list[object]] = []
    sizes: list[float] = []
    for segment in result.segments:
        for s in segment.sensors:
            factor, unit = shown(s.unit)
            samples = int(np.isfinite(s.measured).sum())
            bound = 2.0 / math.sqrt(max(samples, 1))
            judged: Html | str = MISSING
            if math.isfinite(s.whiteness):
                white = abs(s.whiteness) <= bound
                judged = mark("good", "white") if white else mark("caution", "colored")
            sizes.append(misfit(s))
            rows.append(
                [
                    tag("code", s.name),
                    segment.maneuver.id,
                    samples,
                    unit,
                    number(factor * s.sigma, 3),
                    number(factor * rms(s.measured - s.fitted), 3),
                    _inside(s),
                    number(s.whiteness, 2),
                    judged,
                ]
            )
    if not rows:
        return tag("p", "No sensor was compared with the motion.")
    if len(rows) > MOST_ROWS:  # those that fit worst first: the table ends before the others
        rows = [row for _, row in sorted(zip(sizes, rows, strict=True), key=lambda r: -r[0])]
    return table(
        "Sensors: stated noise, residual (measured minus fitted), share of innovations inside "
        "their 2 σ band (95 % expected) and lag-1 autocorrelation, called white within ±2/√n."
        + (
            " The largest residuals, against the stated noise, first."
            if len(rows) > MOST_ROWS
            else ""
        ),
        [
            "Sensor",
            "Maneuver",
            "Samples",
            "Unit",
            "Stated σ",
            "Residual rms",
            "In 2 σ",
            "Lag 1",
            "Innovations",
        ],
        rows,
        numeric=(2, 4, 5, 6, 7),
        class_="dense",
    )


def misfit(s: SensorFit) -> float:
    """Rms of measured minus fitted, in stated standard deviations; 0 where nothing was measured."""
    size = rms(s.measured - s.fitted) / s.sigma if s.sigma > 0.0 else 0.0
    return size if math.isfinite(size) else 0.0


def _inside(s: SensorFit) -> str:
    known = np.isfinite(s.innovation) & np.isfinite(s.innovation_se)
    if not known.any():
        return MISSING
    share = np.mean(np.abs(s.innovation[known]) <= 2.0 * s.innovation_se[known])
    return f"{100.0 * share:.0f} %"


def _plots(title: str, members: list[Html]) -> Html:
    """A heading and its figures; nothing where there are none."""
    if not members:
        return Html("")
    return join([tag("h4", title), tag("div", *members, class_="grid")])


def _steady(segment: Segment) -> Html:
    """Says which states are not drawn and where they are told."""
    names = steady_states(segment)
    if not names:
        return Html("")
    codes = Html(", ".join(tag("code", name) for name in names))
    words = ": one value throughout, in the table of constants above."
    return tag("p", codes, words, class_="note")


def _segment(segment: Segment, figures: FigureStore) -> Html:
    maneuver = segment.maneuver
    grid = [
        _plots(
            "States with their ±2 standard error bands, at the inertial sensor",
            [figures.add(f) for f in state_figures(segment)],
        ),
        _steady(segment),
        _plots(
            "Motion at the center of gravity, as identification takes it",
            [figures.add(f) for f in motion_figures(segment.motion)],
        ),
        _plots(
            "Sensors: measured and fitted, innovations with their 2 σ bands",
            [figures.add(sensor_figure(s, maneuver, titled(s.name))) for s in segment.sensors],
        ),
    ]
    held = tag("span", "held out", class_="tag") if maneuver.held_out else ""
    kind = (
        f" ({maneuver.kind.replace('_', ' ')}) " if maneuver.kind not in ("", maneuver.id) else " "
    )
    heading = tag("h3", "Maneuver ", tag("code", maneuver.id), kind, held)
    return tag("section", heading, *grid, class_="maneuver")
