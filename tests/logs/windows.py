"""A project of one made log with the windows that a test asks for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.base.messages import BadInput, Message
from alula.base.project import load_project
from alula.flight import Maneuver
from alula.logs import maneuvers, read_all
from logs.made import csv_text, flight_table

PROJECT = """
schema = "alula.project/1"
name = "windows"
[[logs]]
id = "log"
path = "log.csv"
[channels]
t = {from = "t", unit = "s"}
V = {from = "V", unit = "m/s"}
q = {from = "q", unit = "deg/s"}
"""


def windows(
    folder: Path, *entries: str, hole: tuple[int, int] | None = None
) -> tuple[tuple[Maneuver, ...], tuple[Message, ...]]:
    """The maneuvers of entries such as 'start = 0.0; end = 3.0', and the messages.

    hole: rows of the log that are missing.
    """
    table = flight_table()
    if hole:
        table = np.delete(table, slice(*hole), axis=0)
    (folder / "log.csv").write_text(csv_text(table))
    text = PROJECT
    for k, entry in enumerate(entries):
        text += f'[[maneuvers]]\nid = "m{k}"\nlog = "log"\n' + entry.replace("; ", "\n") + "\n"
    (folder / "project.toml").write_text(text)
    project = load_project(folder / "project.toml")
    return maneuvers(project, read_all(project))


def refusal(folder: Path, *entries: str, hole: tuple[int, int] | None = None) -> list[str]:
    """The codes with which they are refused."""
    with pytest.raises(BadInput) as caught:
        windows(folder, *entries, hole=hole)
    assert all(m.where and m.expected and m.found and m.do for m in caught.value.messages)
    return [m.code for m in caught.value.messages]
