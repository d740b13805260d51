"""`alula check PROJECT`: the log card and everything that looks wrong."""

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
)

_FAILED = ("control_sign",)  # beginnings of codes after which a result would be wrong


def check(
    project: Annotated[Path, typer.Argument(help="The project file.")],
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 0,
    quiet: QuietOption = False,
) -> None:
    """Read a project's logs and say what is in them and what looks wrong.

    Exit 0: usable. 1: usable, but a check failed. 2: bad input.
    """
    command = Command("check", json, seed, threads, quiet)
    with command.run():
        from alula.campaign import check_project

        checked = check_project(str(project), progress=command.progress)
        command.messages = checked.all_messages()
        command.inputs = [f for card in checked.cards for f in card.files]
        command.result = {"logs": [card.as_dict() for card in checked.cards]}
        if any(m.code.startswith(_FAILED) for m in command.messages):
            command.status = "check_failed"
        if command.talks:
            from rich.console import Console

            from alula.logs.card_view import card_view

            console = Console()
            for card in checked.cards:
                console.print(card_view(card))
            if not quiet:
                for message in command.messages:
                    if message.level == "info":
                        console.print(f"note: {message}", style="dim", markup=False)
