"""The one way to say that a channel's numbers look recorded in another unit."""

from __future__ import annotations

from alula.base.messages import Message
from alula.base.project import LogSpec


def other_unit_message(
    log: LogSpec, channel: str, expected: str, found: str, looks: str, *, confirmed: bool = False
) -> Message:
    """An error; a warning where the project confirms the channel as it is. looks: the unit."""
    found = f"{found}: it looks like {looks}"
    where = f"{log.path}: channel {channel}"
    if confirmed:
        found += "; the project says 'confirmed'"
        do = "Nothing, if you are sure."
        return Message("unit_implausible", "warning", where, expected, found, do)
    do = f"If so, write unit = '{looks}'. If it is right as it is, write confirmed = true."
    return Message("unit_implausible", "error", where, expected, found, do)
