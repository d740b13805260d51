"""Flight logs to Flight: readers, channel mapping, checks, log card, a first project file."""

from alula.logs.card import ChannelCard, LogCard, ManeuverCard, log_card
from alula.logs.guess import new_project
from alula.logs.maneuvers import maneuvers
from alula.logs.reader import READERS, read, read_all, read_tables

__all__ = [
    "READERS",
    "ChannelCard",
    "LogCard",
    "ManeuverCard",
    "log_card",
    "maneuvers",
    "new_project",
    "read",
    "read_all",
    "read_tables",
]
