"""`alula calibrate PROJECT`: accelerometer, gyro, magnetometer and their noise, from the bench."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    ReportOption,
    SeedOption,
    ThreadsOption,
    writable,
)

if TYPE_CHECKING:
    from alula.navigate.calibration import Calibrated, Parameter


def calibrate(
    project: Annotated[Path, typer.Argument(metavar="PROJECT", help="The calibration project.")],
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the calibration there, as TOML.")
    ] = None,
    report: ReportOption = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Calibrate inertial sensors and a magnetometer from bench recordings.

    Exit 0: done. 1: the recordings do not determine some parameter. 2: bad input.
    """
    command = Command("calibration_result", json, seed, threads, quiet)
    with command.run():
        writable(out, "calibration")
        writable(report, "report")
        from alula.base.files import write_whole
        from alula.navigate.calibration import calibrate as run
        from alula.navigate.calibration import calibration_text
        from alula.navigate.calibration.file import not_written

        found = run(project, command.progress)
        command.inputs = found.files
        command.messages = [*found.messages, *(not_written(found) if out is not None else ())]
        command.status = "ok" if found.determined else "not_identifiable"
        command.result = _result(found)
        if out is not None:
            from alula import __version__

            write_whole(out, calibration_text(found, {"alula": __version__}))
        if report is not None:
            from alula.report.calibration_page import calibration_page

            write_whole(report, calibration_page(found))
        command.say(_text(found))
        command.written(Calibration=out, Report=report)


def _result(found: Calibrated) -> dict[str, Any]:
    parameters = [
        {**p.as_dict(), "name": f"{name}.{p.name}"}
        for name, sensor in found.sensors.items()
        for p in sensor.parameters
    ]
    return {
        "parameters": parameters,
        "sensors": {name: sensor.as_dict() for name, sensor in found.sensors.items()},
        "noise": {
            name: {a: axis.as_dict() for a, axis in zip("xyz", axes, strict=False)}
            for name, axes in found.noise.items()
        },
    }


def _text(found: Calibrated) -> str:
    lines = [found.project.name]
    for name, sensor in found.sensors.items():
        b, a = sensor.before, sensor.after
        lines += [
            "",
            f"{name}: {len(sensor.raw)} vectors; error of the length, largest and rms",
            f"  as recorded {100 * b.largest:10.4f} % {100 * b.rms:10.4f} %",
            f"  calibrated  {100 * a.largest:10.4f} % {100 * a.rms:10.4f} %",
            *_table(sensor.parameters),
        ]
    for name, axes in found.noise.items():
        lines += ["", f"noise of the {name} ({axes[0].rate:.6g} Hz)"]
        lines += _table([p for axis in axes for p in axis.parameters])
    return "\n".join(lines)


def _table(parameters: Any) -> list[str]:
    wide = max(len(p.name) for p in parameters)
    return [_row(p, wide) for p in parameters]


def _row(p: Parameter, wide: int) -> str:
    verdict = p.verdict.replace("_", " ")
    tied = f", tied to {', '.join(n for n, _ in p.tied_to)}" if p.tied_to else ""
    return f"  {p.name:<{wide}} {p.value:>13.5g} ± {p.se:<10.3g} {p.unit:<16}{verdict}{tied}"
