"""`alula check PROJECT`: the log card and everything that looks wrong."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from alula.cli.contract import (
    Command,
    JsonOption,
    ProjectArgument,
    QuietOption,
    SeedOption,
    ThreadsOption,
)

if TYPE_CHECKING:
    from alula.campaign import Checked

WIDTH = 130  # characters that the tables of a log card ask for


def check(
    project: ProjectArgument,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Say what is in a project's logs, and what looks wrong.

    Exit 0: usable. 1: usable, but a check failed. 2: bad input.
    """
    command = Command("check", json, seed, threads, quiet)
    with command.run():
        from alula.campaign import check_project

        checked = check_project(str(project), progress=command.progress)
        command.messages = checked.all_messages()
        command.inputs = checked.files
        command.result = {"logs": [card.as_dict() for card in checked.cards]}
        if checked.failed:
            command.status = "check_failed"
        if command.talks:
            command.say(_text(checked, notes=not quiet))


def _text(checked: Checked, notes: bool) -> str:
    """The cards as tables, and what was noted; warnings go to stderr as in every command."""
    from rich.console import Console

    from alula.logs.card_view import card_view

    # Where no terminal states its width, lines may be as long as the tables need.
    console = Console() if sys.stdout.isatty() else Console(width=max(Console().width, WIDTH))
    notes_said = [m for m in checked.all_messages() if notes and m.level == "info"]
    converted = [m for m in notes_said if m.code == "converted"]  # each stands in the table
    with console.capture() as text:
        for card in checked.cards:
            console.print(card_view(replace(card, messages=())))
        for message in notes_said:
            if message.code != "converted":
                console.print(f"note: {message}", style="dim", markup=False, highlight=False)
        if converted:
            said = f"note: {len(converted)} channels were converted to SI from what 'source' names."
            console.print(said, style="dim", highlight=False)
    return text.get().rstrip("\n")
