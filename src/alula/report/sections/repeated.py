"""Flights of the model, identified again: scatter and bias beside the stated errors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from alula.report.html import Html, join, table, tag
from alula.report.numbers import number, percent

if TYPE_CHECKING:
    from alula.validate.reidentify import Reidentified


def repeated(found: Sequence[Reidentified]) -> Html:
    """One table of all parameters."""
    draws = max(r.draws for r in found)
    words = (
        f"The identified model was flown {draws} times over the maneuvers that it came from, with "
        "noise of the spectrum of the residuals, and identified again by the same method. Scatter "
        "is the standard deviation of the estimates, bias their mean less what was flown; the "
        "scatter should be near the stated standard error, the bias well below it. What the "
        "formulas lack does not show here."
    )
    rows = [
        [
            tag("code", r.name),
            number(r.truth),
            number(r.mean - r.truth, 2),
            number(r.scatter, 2),
            number(r.stated, 2),
            number(r.scatter / r.stated if r.stated > 0.0 else None, 2),
            percent(r.inside),
            r.draws,
        ]
        for r in found
    ]
    head = [
        "Parameter", "Flown", "Bias", "Scatter", "Stated se", "Scatter / se", "Interval holds it",
        "Draws",
    ]  # fmt: skip
    return join([tag("p", words), table("Identified again", head, rows, numeric=range(1, 8))])
