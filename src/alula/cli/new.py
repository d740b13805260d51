"""`alula new LOG`: a project file with guessed channels, to be confirmed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    SeedOption,
    ThreadsOption,
    writable,
)


def new(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="The flight log.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Default: LOG's name, .toml, here."),
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Write a project file for a log, channels guessed.

    Every guess is marked: confirm it before you believe a result.
    """
    command = Command("new", json, seed, threads, quiet)
    with command.run():
        from alula.base.files import write_whole
        from alula.base.messages import refuse
        from alula.logs.guess import new_project

        if log.is_dir():  # before its name makes the project's
            raise refuse(
                "file_not_readable",
                where=str(log),
                expected="a log file",
                found="a folder",
                do="Name one file in it.",
            )
        path = output or Path(log.name).with_suffix(".toml")
        if path.exists():
            raise refuse(
                "file_exists",
                where=str(path),
                expected="a name that is free",
                found="a folder" if path.is_dir() else "a file",
                do="Choose another with --output; nothing is overwritten.",
            )
        writable(path)
        command.progress(f"looking at {log}")
        write_whole(path, new_project(log, path.absolute().parent))
        command.result = {"project": str(path)}
        command.say(
            f"{path} written. Confirm the lines marked so: channels, aircraft file, maneuvers;\n"
            f"then: alula check {path}"
        )
