"""Read a log: one registry of formats, one function."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module

import numpy as np

from alula.base.files import sha256
from alula.base.messages import Message, refuse
from alula.base.project import ChannelSpec, LogSpec, Project
from alula.flight import Flight, SourceFile
from alula.logs.mapping import LogMapping
from alula.logs.plausibility import check
from alula.logs.sniff import choose
from alula.logs.table import Tables

# 'module:function' of alula.logs by format; loaded when a file asks for it, because the parsers'
# libraries take longer to import than a log to read.
READERS: dict[str, str] = {
    "csv": "csv:read",
    "ascii": "ascii:read",
    "text": "ascii:read_text",
    "npz": "npz:read",
    "mat": "mat:read",
    "parquet": "parquet:read",
}


def read(log: LogSpec, channels: Mapping[str, ChannelSpec] | None = None) -> Flight:
    """Read one log into a Flight: channels in SI units at their native rates.

    channels: where each channel comes from; the log's own entries take precedence. The file is
    opened for reading only. Raises BadInput with a message for everything that stands in the way.
    """
    specs = {**(channels or {}), **log.channels}
    if not specs:
        raise refuse(
            "no_channels",
            where=f"log {log.id}",
            expected="[channels] that say which column is what",
            found="none",
            do="Let 'alula new LOG' write a project with guesses to confirm.",
        )
    tables, messages = read_tables(log)
    mapping = LogMapping(log, specs, tables)
    with np.errstate(all="ignore"):  # absurd numbers overflow; what is infinite is counted
        found = mapping.channels()
        flight_messages = [*messages, *tables.messages, *mapping.messages]
        flight_messages += check(log, specs, found)
    decoded = sum(mapping.used.values())
    source = SourceFile(
        path=str(log.path),
        sha256=sha256(log.path),
        bytes=tables.size,
        decoded=decoded,
        skipped=tables.size - decoded - tables.unknown,
        unknown=tables.unknown,
    )
    return Flight(log.id, found, (source,), tuple(flight_messages))


def read_tables(log: LogSpec) -> tuple[Tables, list[Message]]:
    """The arrays of a log's file, by the reader that its content asks for."""
    name, messages = choose(log)
    module, function = READERS[name].split(":")
    reader: Callable[[LogSpec], Tables] = getattr(import_module(f"alula.logs.{module}"), function)
    return reader(log), messages


def read_all(project: Project) -> dict[str, Flight]:
    """Every log of a project, by id; decoders that run in a child process run side by side."""
    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        jobs = [pool.submit(read, log, project.channels_of(log)) for log in project.logs]
        return {log.id: job.result() for log, job in zip(project.logs, jobs, strict=True)}
