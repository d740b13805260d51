"""Text in columns divided by blanks, as FORTRAN and MATLAB write it."""

from __future__ import annotations

import re

from alula.base.project import LogSpec
from alula.logs import csv
from alula.logs.columns import parse
from alula.logs.table import Tables
from alula.logs.text import Text, layout, load


def read(log: LogSpec) -> Tables:
    """Read columns divided by any number of blanks and tabs."""
    text = tabs(load(log))
    decimal = log.decimal or csv.guess_decimal(text, "\t", log.skip_rows)
    return parse(text, log, layout(text, log, "\t", decimal), "\t", decimal, "ascii")


def read_text(log: LogSpec) -> Tables:
    """Read text of either kind: with separators if they divide it evenly, else in blanks."""
    text = load(log)
    if log.separator or csv.guess_separator(text, log.skip_rows):
        return csv.read(log)
    return read(log)


def tabs(text: Text) -> Text:
    """The text with one tab between columns, none at the ends, and D exponents as E."""
    data = re.sub(rb"[ \t]*\r?\n[ \t]*", b"\n", text.data.strip(b" \t"))
    if data.count(b"\n") != text.data.count(b"\n"):  # blanks around empty lines joined them
        data = b"\n".join(line.strip(b" \t\r") for line in text.data.split(b"\n"))
    data = re.sub(rb"[ \t]+", b"\t", data)
    data = re.sub(rb"(?<=[\d.])[dD](?=[-+]?\d)", b"E", data)
    data = re.sub(rb"\t(?=[\[(][^\t\n]*[\])])", b" ", data)  # 'p [deg/s]' is one name
    return text.with_data(data)
