"""What the report is made of: values of the stages before it, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from alula.base.messages import Message
from alula.flight import Maneuver, SourceFile
from alula.identify.result import Identification
from alula.reconstruct.result import Reconstruction


@dataclass(frozen=True)
class ReportInput:
    """Everything the page shows.

    aircraft: label to value with its unit, as text ('wing area' to '64.0 m²').
    cards: one mapping per log: `id`, `channels` (each `name rate n start end gaps nan min median
    max unit source`, SI) and `maneuvers` (each `id` and what the card knows of it).
    provenance: what is needed to make the result again: hashes, versions, commit, instruction
    set, seed; a value may itself be a mapping. date: as it shall stand on the page.
    """

    name: str
    path: str
    date: str
    aircraft: Mapping[str, str] = field(default_factory=dict)
    files: tuple[SourceFile, ...] = ()
    cards: tuple[Mapping[str, Any], ...] = ()
    maneuvers: tuple[Maneuver, ...] = ()
    reconstruction: Reconstruction | None = None
    identification: Identification | None = None
    messages: tuple[Message, ...] = ()
    provenance: Mapping[str, Any] = field(default_factory=dict)

    def all_messages(self) -> tuple[Message, ...]:
        """The messages of every stage, each once, in the order in which they arose."""
        found = list(self.messages)
        if self.reconstruction is not None:
            found += self.reconstruction.messages
        if self.identification is not None:
            found += self.identification.messages
        return tuple(dict.fromkeys(found))
