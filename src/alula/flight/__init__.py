"""The values that pass between stages: Flight and its channels, Maneuver, Motion."""

from alula.flight.flight import Channel, Flight, SourceFile
from alula.flight.gaps import Gap, gaps, gaps_within, split_at_gaps
from alula.flight.maneuver import Maneuver
from alula.flight.motion import Motion

__all__ = [
    "Channel",
    "Flight",
    "Gap",
    "Maneuver",
    "Motion",
    "SourceFile",
    "gaps",
    "gaps_within",
    "split_at_gaps",
]
