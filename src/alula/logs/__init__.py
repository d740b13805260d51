"""Flight logs to Flight: readers, channel mapping, checks, log card, a first project file."""

from alula.logs.reader import READERS, read, read_all, read_tables

__all__ = ["READERS", "read", "read_all", "read_tables"]
