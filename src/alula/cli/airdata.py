"""`alula airdata PROJECT`: errors of the air data from the flight itself; sources of its angles."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from alula.cli.contract import (
    Command,
    JsonOption,
    ProjectArgument,
    QuietOption,
    SeedOption,
    ThreadsOption,
    writable,
)


def airdata(
    project: ProjectArgument,
    log: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="Only this log; several times.")
    ] = None,
    start: Annotated[
        float | None, typer.Option(metavar="S", help="Time of the log to begin at.")
    ] = None,
    end: Annotated[float | None, typer.Option(metavar="S", help="Time to end at.")] = None,
    angles: Annotated[
        bool,
        typer.Option("--angles", help="Vanes, ASSE, joint filter, lift model, and their vote."),
    ] = False,
    model: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Lift model for --angles, TOML.")
    ] = None,
    report: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a page, HTML.")] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Calibrate air data in flight: airspeed scale, upwash, vane bias, static error, wind.

    Any maneuvering flight with GPS velocity and attitude will do. --angles sets all sources of
    angle of attack and sideslip beside one another and votes. Exit 0: done. 1: the flight does not
    determine something, or a source was voted out, which is named. 2: bad input.
    """
    command = Command("airdata", json, seed, threads, quiet)
    with command.run():
        writable(report, "report")
        from alula.campaign.airdata import run_air_data

        done = run_air_data(
            str(project), logs=log or (), start=start, end=end,
            angles=angles or model is not None, model=model, progress=command.progress,
        )  # fmt: skip
        command.inputs, command.messages = done.files, done.messages
        command.status = (
            "check_failed" if done.failed else "ok" if done.determined else "not_identifiable"
        )
        command.result = done.as_dict()
        command.say(done.summary())
        if report is not None:
            from alula.base.files import write_whole
            from alula.report.air_data_page import air_data_page

            found = {id: one.compared for id, one in done.angles.items()}
            page = air_data_page(done.project.name, done.calibrated, found, done.refused)
            write_whole(report, page)
            command.say(f"Report: {report}")
