"""Estimates over time, of a recursive method: what was known at each moment of the flight."""

from __future__ import annotations

import numpy as np

from alula.identify.result import History, Identification
from alula.report.figures import Band, Figure, FigureStore, Line, Panel
from alula.report.html import Html, join, tag

SETTLED = 10.0  # times a parameter's smallest standard error, above which the start is not drawn


def histories(result: Identification, figures: FigureStore) -> Html:
    """For each coefficient one figure per maneuver, a panel for each parameter."""
    names = dict.fromkeys(h.coefficient for h in result.histories)
    return join(
        [
            tag(
                "p",
                "Each value is what the samples until then tell, maneuver after maneuver in the "
                "order in which they were given. The band is ±2 standard errors as they are known "
                "in flight, with residuals taken as white; those of the last values in the table "
                "of parameters allow for their color. A curve begins where its standard error has "
                f"come below {SETTLED:g} times the smallest that it reaches.",
            ),
            *(
                tag(
                    "section",
                    tag("h3", tag("code", name)),
                    tag(
                        "div",
                        *(
                            figures.add(_figure(h))
                            for h in result.histories
                            if h.coefficient == name
                        ),
                        class_="grid",
                    ),
                )
                for name in names
            ),
        ]
    )


def _figure(h: History) -> Figure:
    own = f"[{h.maneuver}]"
    shown = [j for j, n in enumerate(h.names) if "[" not in n or n.endswith(own)]
    return Figure(
        f"{h.coefficient} over time · {h.maneuver}",
        h.maneuver,
        h.t,
        tuple(_panel(h, j) for j in shown),
        note=_forgotten(h),
    )


def _panel(h: History, j: int) -> Panel:
    se, name = h.se[:, j], h.names[j].split("[")[0]
    known = np.isfinite(se)
    least = float(np.min(se[known])) if known.any() else np.nan
    good = known & (np.where(known, se, np.inf) <= SETTLED * least)
    value, half = np.where(good, h.value[:, j], np.nan), np.where(good, 2.0 * se, np.nan)
    return Panel(name, (Line(name, value, "estimate"),), (Band("±2 se", half, value),), small=True)


def _forgotten(h: History) -> str:
    least = float(np.min(h.factor))
    if least >= 1.0:
        return "Nothing was forgotten."
    return f"Forgetting factor down to {least:.4g} per sample."
