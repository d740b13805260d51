"""Ids in a project file that are double, and names of what is not in it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from alula.base.messages import Message

if TYPE_CHECKING:
    from alula.base.project import Project


def duplicate_ids(path: Path, key: str, ids: Sequence[str]) -> list[Message]:
    """One message for each id of the tables `key` that stands there several times."""
    return [
        Message(
            "duplicate_id", "error", f"{path}: {key}", "each id once",
            f"'{id}' {ids.count(id)} times", "Rename.",
        )
        for id in sorted({id for id in ids if ids.count(id) > 1})
    ]  # fmt: skip


def unknown_log(path: Path, key: str, log: str, known: Sequence[str]) -> list[Message]:
    """A message where `log`, named at `key`, is not one of the project's."""
    if log in known:
        return []
    return [
        Message(
            "unknown_log", "error", f"{path}: {key}", f"one of {', '.join(known)}",
            f"'{log}'", "Name a log of this project.",
        )
    ]  # fmt: skip


def references(project: Project, path: Path) -> list[Message]:
    """Ids that are double, maneuvers of logs that are not there, time bases that are not mapped."""
    known = [log.id for log in project.logs]
    planned = [maneuver.id for maneuver in project.maneuvers]
    problems = duplicate_ids(path, "logs", known) + duplicate_ids(path, "maneuvers", planned)

    def error(code: str, key: str, expected: str, found: str, do: str) -> None:
        problems.append(Message(code, "error", f"{path}: {key}", expected, found, do))

    for id in project.reconstruct.initial:
        if id not in planned:
            error(
                "unknown_maneuver",
                f"reconstruct.initial.{id}",
                f"one of {', '.join(planned) or 'the maneuvers, of which there are none'}",
                f"'{id}'",
                "Name a maneuver of this project.",
            )
    for i, maneuver in enumerate(project.maneuvers):
        problems += unknown_log(path, f"maneuvers[{i + 1}].log", maneuver.log, known)
    for log in project.logs:
        channels = project.channels_of(log)
        for name, channel in channels.items():
            if isinstance(channel.time, str) and channel.time not in channels:
                error(
                    "unknown_time_channel",
                    f"channels.{name}.time",
                    f"one of the channels: {', '.join(channels)}",
                    f"'{channel.time}'",
                    "Map that channel, or give time = {from = ..., unit = 's'}.",
                )
    return problems
