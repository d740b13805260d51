"""Each coefficient: measured against model, with residual, per maneuver."""

from __future__ import annotations

from alula.identify.result import Identification, Series
from alula.report.figures import Figure, FigureStore, Line, Panel
from alula.report.html import Html, join, table, tag
from alula.report.names import WORDS, unit_of
from alula.report.numbers import MISSING, number, percent, rms, shown


def coefficients(result: Identification, figures: FigureStore) -> Html:
    """The table of fits, then for each coefficient one plot per maneuver."""
    names = dict.fromkeys([*result.fits, *(s.coefficient for s in result.series)])
    return join([_fits(result), *(_coefficient(result, name, figures) for name in names)])


def _fits(result: Identification) -> Html:
    rows = [
        [
            tag("code", f.coefficient),
            tag("code", f.formula),
            f.n,
            number(f.r2, 4),
            percent(f.rrmse),
            number(f.durbin_watson, 3),
            f.n_held_out or MISSING,
            number(f.r2_held_out, 4) if f.n_held_out else "not validated",
        ]
        for f in result.fits.values()
    ]
    return table(
        "Fits. R² and relative rms error (RRMSE) are of the maneuvers of the fit; R² held out is "
        "of maneuvers the fit never saw. Durbin-Watson far below 2 means colored residuals.",
        [
            "Coefficient",
            "Model",
            "Samples",
            "R²",
            "RRMSE",
            "Durbin-Watson",
            "Samples held out",
            "R² held out",
        ],
        rows,
        numeric=(2, 3, 4, 5, 6, 7),
    )


def _coefficient(result: Identification, name: str, figures: FigureStore) -> Html:
    series = [s for s in result.series if s.coefficient == name]
    words = f", {WORDS[name]}" if name in WORDS else ""
    if name in result.labels:
        words += f" ({result.labels[name]})"
    model: Html | None = None
    if name in result.fits:
        formula = tag("code", f"{name} = {result.fits[name].formula}")
        model = tag("p", "Model: ", formula, class_="note lead")
    return tag(
        "section",
        tag("h3", tag("code", name), words),
        model,
        tag("div", *(figures.add(_figure(s)) for s in series), class_="grid"),
    )


def group_of(s: Series) -> str:
    """The plots that it zooms with: its maneuver's, those over frequency by themselves."""
    return s.maneuver if s.over == "s" else f"{s.maneuver}, {s.over}"


def _figure(s: Series) -> Figure:
    factor, unit = shown(unit_of(s.coefficient))
    measured, model = factor * s.measured, factor * s.model
    residual = measured - model
    size = rms(residual)
    return Figure(
        f"{s.coefficient} · {s.maneuver}",
        group_of(s),
        s.t,
        (
            Panel(
                f"{s.coefficient} ({unit})",
                (Line("measured", measured, "measured"), Line("model", model, "model")),
            ),
            Panel(
                f"residual ({unit})", (Line("measured − model", residual, "residual"),), small=True
            ),
        ),
        note=f"Residual rms {number(size, 3)}" + (f" {unit}." if unit != "–" else "."),
        held_out=s.held_out,
        over=s.over,
    )
