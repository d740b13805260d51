"""What Alula says when something is not as it should be, and how bad input is refused.

Every message names what was expected, what was found, where, and what to do.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Literal

Level = Literal["info", "warning", "error"]


@dataclass(frozen=True)
class Message:
    """One remark on the data or the result, as it stands in the JSON envelope and the report."""

    code: str  # short and stable, words joined by underscores: 'backward_time'
    level: Level
    where: str  # file, line or byte, channel, maneuver
    expected: str
    found: str
    do: str  # what the user can do about it

    def __str__(self) -> str:
        return (
            f"{self.where}: expected {self.expected}, found {self.found}. {self.do} [{self.code}]"
        )

    def as_dict(self) -> dict[str, str]:
        """The message as the JSON envelope carries it."""
        return asdict(self)


class BadInput(Exception):
    """Input that cannot be used: the command ends with exit code 2 and these messages."""

    def __init__(self, *messages: Message) -> None:
        super().__init__("\n".join(str(m) for m in messages))
        self.messages = messages


def refuse(code: str, *, where: str, expected: str, found: str, do: str) -> BadInput:
    """The exception for one thing that is wrong, to be raised by the caller."""
    return BadInput(Message(code, "error", where, expected, found, do))


def warn(code: str, *, where: str, expected: str, found: str, do: str) -> Message:
    """A message for something that was noticed and survived."""
    return Message(code, "warning", where, expected, found, do)


def note(code: str, *, where: str, expected: str, found: str, do: str) -> Message:
    """A message for something that was done to the data and that the user should know."""
    return Message(code, "info", where, expected, found, do)
