"""`alula validate PROJECT`: recorded controls through the model, beside what the aircraft did."""

from __future__ import annotations

from dataclasses import asdict
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
    from alula.campaign.validate import ValidationJob
    from alula.validate import Evidence, Flown


class Trim(StrEnum):
    """Constants that may be added to the model's coefficients in each maneuver."""

    none = "none"
    entry = "entry"
    whole = "whole"


def validate(
    project: ProjectArgument,
    model: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Fly this model instead of identifying one."),
    ] = None,
    maneuver: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ID", help="Fly this maneuver, held out of the estimate; may be repeated."
        ),
    ] = None,
    report: ReportOption = None,
    filter: Annotated[FilterName | None, typer.Option(help="Instead of the project's.")] = None,
    trim: Annotated[
        Trim,
        typer.Option(help="Offsets of the coefficients from before the input, or the whole."),
    ] = Trim.none,
    horizon: Annotated[
        float | None, typer.Option(metavar="S", help="Seconds of each maneuver to compare.")
    ] = None,
    draws: Annotated[
        int, typer.Option(metavar="N", min=0, help="Parameter sets behind the band; 0: no band.")
    ] = 40,
    reidentify: Annotated[
        int,
        typer.Option(metavar="N", min=0, help="Identify flights of the model again, N times."),
    ] = 0,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Fly recorded controls through the model and judge it by 14 CFR Part 60.

    Exit 0: no tolerance is exceeded. 1: one is. 2: bad input.
    """
    command = Command("validation", json, seed, threads, quiet)
    with command.run():
        writable(report, "report")
        from alula.campaign.validate import report_of_validation, run_validation

        done = run_validation(
            str(project),
            model=model,
            only=maneuver or (),
            filter=filter,
            trim=trim.value,
            horizon=horizon,
            draws=draws,
            reidentified=reidentify,
            seed=seed,
            progress=command.progress,
        )
        command.messages = done.all_messages()
        command.inputs = done.job.checked.files
        command.timing = done.job.seconds
        command.result = result_of(done)
        if (
            done.validation.failed
            or done.job.checked.failed
            or not (done.job.reconstruction.converged)
        ):
            command.status = "check_failed"
        if report is not None:
            command.write_report(report, partial(report_of_validation, done))
        command.say(text_of(done))
        command.written(Report=report)


def result_of(done: ValidationJob) -> dict[str, Any]:
    """The envelope's `result`."""
    found = done.validation
    return {
        "model": {"name": found.model, "source": found.source, "sha256": done.model_sha256 or None},
        "regulation": found.regulation,
        "status": found.status,
        "evidence": [_evidence(row) for row in found.evidence],
        "maneuvers": [_flown(one) for one in found.flown],
        "reidentified": [asdict(r) for r in done.reidentified],
    }


def _evidence(row: Evidence) -> dict[str, Any]:
    return {
        "entry": row.entry,
        "requirement": row.title,
        "maneuver": row.maneuver,
        "tolerance": row.tolerance,
        "verdict": row.verdict,
        "seen_by_estimate": row.seen,
        "window": None if row.window is None else list(row.window),
        "reason": row.reason,
        "criteria": [
            {
                "quantity": c.quantity,
                "unit": c.unit,
                "measured": c.measured,
                "model": c.model,
                "deviation": c.deviation,
                "deviation_se": c.deviation_se,
                "tolerance": c.tolerance,
                "met": c.met,
                "within_share": c.within_share,
            }
            for c in row.criteria
        ],
    }


def _flown(one: Flown) -> dict[str, Any]:
    return {
        "id": one.maneuver.id,
        "kind": one.maneuver.kind,
        "aspect": one.maneuver.aspect,
        "seen_by_estimate": one.seen,
        "start": float(one.t[0]),
        "horizon_s": one.horizon,
        "asked_s": one.asked,
        "diverged_at": one.diverged_at,
        "offsets": dict(one.offsets),
        "as_recorded": list(one.as_recorded),
        "draws": one.draws,
        "outside_validity": {
            name: {"value": value, "low": low, "high": high}
            for name, (value, low, high) in one.outside.items()
        },
        "channels": {
            c.name: {
                "unit": c.unit,
                "rms": c.quality.rms,
                "r2": c.quality.r2,
                "rrmse": c.quality.rrmse,
                "theil": c.quality.theil,
                "bias": c.quality.bias,
                "variance": c.quality.variance,
                "covariance": c.quality.covariance,
                "in_axis": c.in_axis,
                "as_recorded": c.as_recorded,
            }
            for c in one.channels.values()
            if c.recorded
        },
    }


_WORDS = {"pass": "pass", "fail": "FAIL", "not_judged": "not judged"}


def text_of(done: ValidationJob) -> str:
    """What the command prints: match by channel and maneuver, then the evidence."""
    found = done.validation
    lines = [f"Model: {found.model} ({found.source})"]
    for one in found.flown:
        seen = {"no": "not seen by the estimate", "yes": "SEEN BY THE ESTIMATE: no validation",
                "unknown": "not known whether the estimate saw it"}[one.seen]  # fmt: skip
        ended = "" if one.diverged_at is None else f", DIVERGED at {one.diverged_at:.5g} s"
        lines += [
            "",
            f"{one.maneuver.id}: {one.horizon:.4g} s flown, {seen}{ended}",
            f"  {'channel':<9}{'R2':>9}{'RRMSE':>9}{'Theil U':>9}{'bias':>7}{'var.':>7}{'cov.':>7}",
        ]
        for c in one.channels.values():
            if c.in_axis and c.recorded:
                q = c.quality
                mark = "  (as recorded: proves nothing)" if c.as_recorded else ""
                lines.append(
                    f"  {c.name:<9}{q.r2:>9.4f}{q.rrmse:>9.4f}{q.theil:>9.4f}"
                    f"{q.bias:>7.2f}{q.variance:>7.2f}{q.covariance:>7.2f}{mark}"
                )
    lines += ["", found.regulation]
    wide = max([12, *(len(row.maneuver) for row in found.evidence)]) + 2
    for row in found.evidence:
        seen = {"no": "", "yes": " (SEEN)", "unknown": " (seen?)"}[row.seen]
        lines.append(
            f"  {row.entry:<8}{row.maneuver:<{wide}}{_WORDS[row.verdict] + seen:<18}{row.tolerance}"
        )
        for k in row.criteria:
            lines.append(
                f"          {k.quantity}: measured {k.measured:.4g}, model {k.model:.4g}, "
                f"off {k.deviation:+.3g} of ±{k.tolerance:.3g}"
                + ("" if k.unit == "1" else f" {k.unit}")
            )
        if row.reason:
            lines.append(f"          {row.reason}")
    if done.reidentified:
        lines += [
            "",
            "Flights of the model, identified again",
            f"  {'parameter':<22}{'flown':>11}{'bias':>11}{'scatter':>11}{'stated se':>11}"
            f"{'inside':>8}",
        ]
        lines += [
            f"  {r.name:<22}{r.truth:>11.5g}{r.mean - r.truth:>11.2g}{r.scatter:>11.2g}"
            f"{r.stated:>11.2g}{r.inside:>8.0%}"
            for r in done.reidentified
        ]
    return "\n".join([*lines, "", found.status])
