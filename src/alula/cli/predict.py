"""`alula predict AIRCRAFT`: derivatives from the shape, before anything has flown."""

from __future__ import annotations

import re
from enum import StrEnum
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from alula.cli.condition import AircraftArgument
from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    SeedOption,
    ThreadsOption,
    writable,
)

if TYPE_CHECKING:
    from alula.predict.derivatives import PredictionAxes


class Method(StrEnum):
    """What predicts."""

    combined = "combined"
    lattice = "lattice"
    semi = "semi"
    bodies = "bodies"
    strip_theory = "strip"


class Wake(StrEnum):
    """What the lattice's wake does as the angle of attack changes."""

    turning = "turning"
    held = "held"


class Axes(StrEnum):
    """Of rates and moments."""

    stability = "stability"
    body = "body"


SpeedOption = Annotated[
    float | None,
    typer.Option("--V", metavar="M/S", help="True airspeed; default the envelope's middle."),
]
HeightOption = Annotated[float, typer.Option("--h", metavar="M", help="Height.")]
AlphaOption = Annotated[
    float | None,
    typer.Option("--alpha-deg", metavar="DEG", help="Angle of attack; default of level flight."),
]
MachOption = Annotated[
    float | None, typer.Option(metavar="M", help="Mach number; default of V and h.")
]


def predict(
    aircraft: AircraftArgument,
    method: Annotated[
        Method,
        typer.Option(help="combined: lattice with bodies and handbook formulas, by their errors."),
    ] = Method.combined,
    V: SpeedOption = None,
    h: HeightOption = 0.0,
    alpha_deg: AlphaOption = None,
    mach: MachOption = None,
    panels: Annotated[
        list[str] | None,
        typer.Option(metavar="SURFACE=CxS", help="Along chord and half span; several times."),
    ] = None,
    wake: Annotated[
        Wake | None, typer.Option(help="Of the lattice, as its angle of attack changes.")
    ] = None,
    mesh_study: Annotated[
        bool, typer.Option("--mesh-study", help="Finer meshes too, however large.")
    ] = False,
    axes: Annotated[Axes, typer.Option(help="Of the rates and moments shown.")] = Axes.stability,
    per_deg: Annotated[
        bool, typer.Option("--per-deg", help="Per degree of angle and deflection, not per rad.")
    ] = False,
    model: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the model; `alula trim` flies it.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write a page, HTML, with the shape.")
    ] = None,
    three_view: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the three views, SVG.")
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Derivatives from the shape, each with its standard deviation and where it comes from.

    Exit 0: done. 2: bad input.
    """
    command = Command("prediction", json, seed, threads, quiet)
    with command.run():
        writable(model, "model")
        writable(report, "report")
        writable(three_view, "three_view")
        from alula.campaign.predict import Asked, run_prediction
        from alula.cli.condition import source_of
        from alula.cli.predict_output import result_of, text_of

        found = run_prediction(
            str(aircraft),
            Asked(
                method.value,
                V,
                h,
                None if alpha_deg is None else radians(alpha_deg),
                mach,
                _panels(panels or []),
                None if wake is None else wake.value,
                True if mesh_study else None,
            ),
            command.progress,
        )
        command.inputs = [source_of(aircraft)]
        command.messages = [*found.aircraft.messages, *found.messages]
        shown: PredictionAxes = "stability" if axes is Axes.stability else "model"
        command.result = result_of(found, shown, per_deg)
        _write(found, model, report, three_view)
        command.say(text_of(found, shown, per_deg))
        written = {"Model": model, "Report": report, "Three views": three_view}
        for name, path in written.items():
            if path is not None:
                command.say(f"{name}: {path}")


def _write(found: object, model: Path | None, report: Path | None, three_view: Path | None) -> None:
    from alula.base.files import write_whole
    from alula.base.messages import refuse
    from alula.predict.prediction import Prediction

    assert isinstance(found, Prediction)
    if model is not None and found.model is None:
        raise refuse(
            "incomplete_prediction",
            where="--model",
            expected="a method that gives the whole aircraft",
            found=found.derivatives.method,
            do="Use --method combined, semi, lattice or strip.",
        )
    if model is not None and found.model is not None:
        from alula.model import save_model

        save_model(found.model, model)
    if report is not None:
        from alula.report.prediction_page import prediction_page

        write_whole(report, prediction_page(found))
    if three_view is not None:
        from alula.report.three_view import three_view as drawn

        write_whole(three_view, drawn(found.aircraft, found.neutral_point) + "\n")


def _panels(words: list[str]) -> dict[str, tuple[int, int]] | None:
    """'wing=7x9' as {'wing': (7, 9)}."""
    out = {}
    for word in words:
        found = re.fullmatch(r"(.+)=(\d{1,5})x(\d{1,5})", word)
        if found is None:
            from alula.base.messages import refuse

            raise refuse(
                "panels",
                where="--panels",
                expected="a surface with panels along the chord and the half span: wing=7x9",
                found=f"'{word}'",
                do="Correct it.",
            )
        out[found[1]] = (int(found[2]), int(found[3]))
    return out or None
