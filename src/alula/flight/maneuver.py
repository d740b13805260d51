"""A window of a flight in which something was done on purpose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Maneuver:
    """A window of a log: from `start` to `end` (s, the log's own time).

    kind: '3211', 'doublet', 'bank_to_bank', 'sweep', ... free text. aspect: which part of the
    model it serves, 'longitudinal', 'lateral' or 'both'. configuration: flaps, gear, controls
    fixed or free, as the project file states them.
    """

    id: str
    log: str
    kind: str
    start: float
    end: float
    aspect: str = "both"
    configuration: Mapping[str, str] = field(default_factory=dict)
    held_out: bool = False
