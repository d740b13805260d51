"""Attitude, wind and biases of each log, and how its sensors agreed with each other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from alula.report.figures import Band, Figure, FigureStore, Line, Panel
from alula.report.html import Html, join, table, tag
from alula.report.numbers import number

if TYPE_CHECKING:
    from alula.navigate import Navigation, Taking

_DEG = 180.0 / np.pi
ANGLES, AXES, BODY = ("phi", "theta", "psi"), ("north", "east", "down"), ("x", "y", "z")


def group_of(log: str) -> str:
    """The group of a log's figures, which zoom together."""
    return f"navigation {log}"


def navigation(found: Mapping[str, Navigation], figures: FigureStore) -> Html:
    """A part for each log."""
    return join(_log(name, one, figures) for name, one in found.items())


def _log(name: str, one: Navigation, figures: FigureStore) -> Html:
    words = {
        "joint": "One filter of attitude, velocity, position, biases and wind.",
        "pair": "An attitude filter, and a position filter that trusts it; no wind.",
    }
    turned = tag("h3", "Log ", tag("code", name))
    grid = [
        figures.add(_states(name, one, "Attitude", "euler", one.euler, ANGLES, "°", _DEG)),
        figures.add(_states(name, one, "Velocity", "velocity", one.velocity, AXES, "m/s")),
    ]
    if "wind" in one.states:
        grid.append(figures.add(_states(name, one, "Wind", "wind", one.wind, AXES, "m/s")))
    grid.append(
        figures.add(_states(name, one, "Gyro bias", "gyro_bias", one.gyro_bias, BODY, "°/s", _DEG))
    )
    grid.append(
        figures.add(
            _states(name, one, "Accelerometer bias", "force_bias", one.force_bias, BODY, "m/s²")
        )
    )
    agreed = [figures.add(_innovations(name, s)) for s in one.takings if np.isfinite(s.nis).any()]
    return tag(
        "section",
        turned,
        tag("p", words[one.filter]),
        _sensors(one),
        tag("div", *grid, class_="grid"),
        tag("h4", "Size of the innovations (measured minus predicted), in standard deviations"),
        tag("div", *agreed, class_="grid"),
        class_="maneuver",
    )


def _sensors(one: Navigation) -> Html:
    rows = []
    for s in one.takings:
        other = ", ".join(
            f"{n} {k.replace('_', ' ')}" for k, n in s.counts.items() if k not in ("taken", "gated")
        )
        rows.append(
            [
                tag("code", s.kind),
                s.counts.get("taken", 0),
                s.counts.get("gated", 0),
                other or "none",
                number(s.mean_nis, 3),
            ]
        )
    return table(
        "Sensors: readings taken, refused because they were further off than chance allows, and "
        "refused otherwise; mean normalized innovation squared per degree of freedom, 1 where the "
        "stated noise is right.",
        ["Sensor", "Taken", "Gated", "Otherwise refused", "NIS"],
        rows,
        numeric=(1, 2, 4),
    )


def _states(
    log: str,
    one: Navigation,
    title: str,
    part: str,
    values: np.ndarray,
    names: tuple[str, ...],
    unit: str,
    factor: float = 1.0,
) -> Figure:
    se = one.se(part)
    panels = []
    for i, name in enumerate(names):
        column = factor * values[:, i]
        if name == "psi":  # no jumps at 180 degrees
            column = factor * np.unwrap(values[:, i])
        panels.append(
            Panel(
                f"{name} ({unit})",
                (Line("estimate", column, "estimate"),),
                (Band("±2 σ", 2.0 * factor * se[:, i], column),),
                small=True,
            )
        )
    return Figure(title, group_of(log), one.t, tuple(panels))


def _innovations(log: str, s: Taking) -> Figure:
    # as one number for the whole reading, so that 1 is usual and 2 rare
    size = np.sqrt(s.nis / s.width)
    order = np.argsort(s.t, kind="stable")
    panel = Panel(s.kind, (Line("root of NIS per degree of freedom", size[order], "residual"),))
    return Figure(f"Innovations of {s.kind}", group_of(log), s.t[order], (panel,))
