"""The values that pass between stages: Flight and its channels, Maneuver, Motion."""

from alula.flight.flight import Channel, Flight, SourceFile
from alula.flight.maneuver import Maneuver
from alula.flight.motion import Motion

__all__ = ["Channel", "Flight", "Maneuver", "Motion", "SourceFile"]
