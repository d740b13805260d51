"""`alula identify PROJECT`: from logs to derivatives with error bars, and the report."""

from __future__ import annotations

import math
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.base.filters import FilterName
from alula.cli.contract import (
    Command,
    JsonOption,
    ProjectArgument,
    QuietOption,
    ReportOption,
    SeedOption,
    ThreadsOption,
    writable,
)

if TYPE_CHECKING:
    from alula.campaign import Job


class Method(StrEnum):
    """How the model is identified."""

    ee = "ee"
    oe = "oe"
    fe = "fe"
    fd = "fd"
    rls = "rls"
    stall = "stall"


def identify(
    project: ProjectArgument,
    method: Annotated[Method | None, typer.Option(help="Instead of the project's.")] = None,
    filter: Annotated[FilterName | None, typer.Option(help="Instead of the project's.")] = None,
    maneuver: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="Only this maneuver; may be given several times."),
    ] = None,
    report: ReportOption = None,
    model: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the identified model there.")
    ] = None,
    truth: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help='JSON {"parameters": {name: value}} to set beside.'),
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Identify derivatives, with error bars and verdicts.

    Exit 0: every parameter is determined. 1: the data cannot tell some; they read
    not_identifiable. 2: bad input.
    """
    command = Command("identification", json, seed, threads, quiet)
    with command.run():
        writable(report, "report")
        writable(model, "model")
        from alula.campaign import report_of, run_project

        job = run_project(
            str(project),
            filter=filter,
            method=None if method is None else method.value,
            only=maneuver or (),
            truth=None if truth is None else _truth(truth),
            seed=seed,
            progress=command.progress,
        )
        command.messages = job.all_messages()
        command.inputs = job.checked.files
        command.timing = job.seconds
        command.result = result_of(job)
        if not job.identification.identifiable:
            command.status = "not_identifiable"
        elif job.checked.failed or not job.reconstruction.converged:
            command.status = "check_failed"
        if model is not None:
            _write_model(job, model, command)
        if report is not None:
            command.write_report(report, partial(report_of, job))
        command.say(text_of(job))
        command.written(Model=model, Report=report)


def result_of(job: Job) -> dict[str, Any]:
    """The envelope's `result`."""
    from alula.identify.typical import flown_sum

    found, path = job.identification, job.reconstruction
    plane = job.checked.aircraft
    return {
        "method": found.method,
        "status": found.status,
        "uncertainty": found.uncertainty,
        "parameters": [
            {
                "name": p.name,
                "coefficient": p.coefficient,
                "value": p.value,
                "se_white": p.se_white,
                "se": p.se,
                "ci95": list(p.ci95),
                "verdict": p.verdict,
                "tied_to": [{"name": t.name, "weight": t.weight} for t in p.tied_to],
                "unit": p.unit,
                "vif": p.vif,
                **({"means": flown} if (flown := flown_sum(p.name)) else {}),
                **({} if p.bias is None else {"bias": p.bias}),
                **({} if p.truth is None else {"truth": p.truth}),
            }
            for p in found.parameters
        ],
        "reference": {"S": plane.S, "b": plane.b, "c": plane.c},
        "reference_point": plane.reference_point.tolist(),
        "fixed": dict(found.fixed),
        "tied": {n: {"name": k, "factor": v} for n, (k, v) in found.tied.items()},
        "formulas": dict(found.formulas) or {c: f.formula for c, f in found.fits.items()},
        "maneuvers": {
            "learned": [m.id for m in job.checked.maneuvers if not m.held_out],
            "held_out": [m.id for m in job.checked.maneuvers if m.held_out],
        },
        "fit": {
            name: {
                "formula": f.formula,
                "r2": f.r2,
                "rrmse": f.rrmse,
                "n": f.n,
                "n_held_out": f.n_held_out,
                "r2_held_out": f.r2_held_out,
                **({} if f.diagnostics is None else {"diagnostics": f.diagnostics.words}),
            }
            for name, f in found.fits.items()
        },
        "reconstruction": {
            "method": path.method,
            "status": path.status,
            "biases": [
                {
                    "name": c.name,
                    "value": c.value,
                    "se": c.se,
                    "unit": c.unit,
                    "observable": c.observable,
                }
                for c in path.constants
            ],
            "nis": {
                "mean": path.nis_mean,
                "lo": path.nis_interval[0],
                "hi": path.nis_interval[1],
            },
            "mismatch": _mismatch(job),
            "maneuvers": {s.maneuver.id: _in_degrees(s.mismatch) for s in path.segments},
        },
    }


def _in_degrees(mismatch: Any) -> dict[str, float]:
    """Angles in degrees under a name that says so; others as they are."""
    angles = ("alpha", "beta", "beta_flank", "phi", "theta", "psi")
    return {
        (f"{name}_deg" if name in angles else name): math.degrees(v) if name in angles else v
        for name, v in mismatch.items()
    }


def _mismatch(job: Job) -> dict[str, float]:
    """Rms over all maneuvers, each by its number of samples."""
    squares: dict[str, float] = {}
    counts: dict[str, int] = {}
    for segment in job.reconstruction.segments:
        n = len(segment.motion.t)
        for name, rms in _in_degrees(segment.mismatch).items():
            squares[name] = squares.get(name, 0.0) + n * rms**2
            counts[name] = counts.get(name, 0) + n
    return {name: math.sqrt(squares[name] / counts[name]) for name in squares}


def text_of(job: Job) -> str:
    """What the command prints: the reconstruction's constants, then the parameters."""
    lines = []
    path = job.reconstruction
    if path.constants:
        lines.append(f"Flight path reconstruction by {path.method}: {path.status}")
        for c in path.constants:
            mark = "" if c.observable else "   not observable"
            lines.append(f"  {c.name:<14}{c.value:>12.5g} ± {c.se:.2g} {c.unit}{mark}")
        mismatch = ", ".join(f"{k} {v:.3g}" for k, v in _mismatch(job).items())
        lines.append(f"  open-loop mismatch (rms, SI or deg): {mismatch}")
        lines.append("")
    lines.append(job.identification.summary())
    return "\n".join(lines)


def _truth(path: Path) -> dict[str, float]:
    import json

    from alula.base.messages import refuse

    try:
        found = json.loads(path.read_text())["parameters"]
        return {str(k): float(v) for k, v in found.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise refuse(
            "bad_truth",
            where=str(path),
            expected='JSON of the form {"parameters": {"Cm_alpha": -0.4}}',
            found=str(error) or type(error).__name__,
            do="Correct the file, or leave --truth out.",
        ) from None


def _write_model(job: Job, path: Path, command: Command) -> None:
    from alula.base.provenance import provenance
    from alula.campaign.learned import LEARNED, learned_from
    from alula.identify import identified_model
    from alula.model import Reference, save_model

    aircraft = job.checked.aircraft
    learned = [d for d in job.data if not d.maneuver.held_out]
    made = identified_model(
        job.identification,
        job.checked.project.name,
        Reference(aircraft.S, aircraft.b, aircraft.c),
        data=learned,
        reference_point=aircraft.reference_point,
        provenance={
            **{f.path: f.sha256 for f in job.checked.files},
            LEARNED: learned_from(learned, job.checked.flights),
            "alula": provenance(command.seed)["alula"],
        },
    )
    save_model(made, path)
