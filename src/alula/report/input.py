"""What the report is made of: values of the stages before it, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from alula.aircraft import Aircraft
from alula.base.messages import Message
from alula.flight import Maneuver, SourceFile
from alula.identify.result import Identification
from alula.reconstruct.result import Reconstruction

if TYPE_CHECKING:
    from alula.logs.card import LogCard
    from alula.navigate import Navigation
    from alula.validate.reidentify import Reidentified
    from alula.validate.result import Validation


@dataclass(frozen=True)
class ReportInput:
    """Everything the page shows.

    aircraft: label to value with its unit, as text ('wing area' to '64.0 m²').
    cards: one per log, with its files and messages.
    provenance: what is needed to make the result again: hashes, versions, commit, instruction
    set, seed; a value may itself be a mapping. date: as it shall stand on the page.
    navigation: by log, what the navigation filters found.
    shape: the aircraft whose geometry is drawn, where it has one.
    """

    name: str
    path: str
    date: str
    aircraft: Mapping[str, str] = field(default_factory=dict)
    cards: tuple[LogCard, ...] = ()
    maneuvers: tuple[Maneuver, ...] = ()
    reconstruction: Reconstruction | None = None
    identification: Identification | None = None
    validation: Validation | None = None
    navigation: Mapping[str, Navigation] = field(default_factory=dict)
    reidentified: tuple[Reidentified, ...] = ()
    messages: tuple[Message, ...] = ()
    provenance: Mapping[str, Any] = field(default_factory=dict)
    shape: Aircraft | None = None

    def files(self) -> tuple[SourceFile, ...]:
        """Every file that was read, once."""
        return tuple(dict.fromkeys(f for card in self.cards for f in card.files))

    def all_messages(self) -> tuple[Message, ...]:
        """The messages of every stage, each once, in the order in which they arose."""
        found = [m for card in self.cards for m in card.messages] + list(self.messages)
        if self.reconstruction is not None:
            found += self.reconstruction.messages
        if self.identification is not None:
            found += self.identification.messages
        if self.validation is not None:
            found += self.validation.messages
        return tuple(dict.fromkeys(found))
