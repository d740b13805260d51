"""Channels whose names are none of Alula's: the user's own, or a slip of the pen."""

from __future__ import annotations

from collections.abc import Collection
from difflib import get_close_matches

from alula.base.messages import Message, note, warn
from alula.base.project import Project
from alula.base.units import CHANNELS, known_channel
from alula.logs.synonyms import guess_name

_ALIKE = 0.66  # of difflib: 'betta' is to 'beta' 0.89, 'alfa' to 'alpha' 0.67, 'rpm' to 'r' 0.5


def own_channels(project: Project, used: Collection[str] = ()) -> list[Message]:
    """A warning for each mapped name that looks like one of Alula's which is not mapped itself; a
    note for the other names that nothing takes.

    used: names that something beyond the channels takes: an engine's thrust, a formula.
    """
    out: list[Message] = []
    idle: list[str] = []
    tables = [("channels", project.channels)]
    tables += [(f"logs.{log.id}.channels", log.channels) for log in project.logs]
    mapped = {name for _, table in tables for name in table}
    times = {spec.time for _, table in tables for spec in table.values()}
    for where, table in tables:
        for name in table:
            if known_channel(name) or name in used or name in times or _prefix_used(name):
                continue
            meant = near(name)
            if meant and meant not in mapped:
                out.append(
                    warn(
                        "unknown_channel",
                        where=f"{project.path}: {where}.{name}",
                        expected="a name that Alula knows (docs/notation.md)",
                        found=f"'{name}', which nothing uses",
                        do=f"Did you mean '{meant}'? If the name is your own, leave it: the "
                        "channel is read and shown, no more.",
                    )
                )
            else:
                idle.append(name)
    if idle:
        out.append(
            note(
                "own_channel",
                where=f"{project.path}: channels",
                expected="names that Alula knows (docs/notation.md)",
                found=", ".join(dict.fromkeys(idle)),
                do="Nothing: they are read and shown; no stage uses them.",
            )
        )
    return out


def near(name: str) -> str:
    """The channel that a name may stand for, by its spelling or as another word; '' if none."""
    if name in CHANNELS:
        return name
    known = {channel.lower(): channel for channel in CHANNELS}
    if name.lower() in known:
        return known[name.lower()]
    meant, _ = guess_name(name)
    if meant:
        return meant
    close = get_close_matches(name.lower(), known, n=1, cutoff=_ALIKE)
    return known[close[0]] if close else ""


def _prefix_used(name: str) -> bool:
    """Tanks are summed by their first word."""
    return name.startswith("fuel_used")
