"""Text with separators: comma, semicolon, tab or bar; decimal point or comma."""

from __future__ import annotations

import re

from alula.base.messages import refuse
from alula.base.project import LogSpec
from alula.logs.columns import parse
from alula.logs.table import Tables
from alula.logs.text import HEAD, MISSING, Text, content_lines, is_number, layout, load, split

SEPARATORS = (";", "\t", "|", ",")


def read(log: LogSpec) -> Tables:
    """Read a CSV file; see `alula.logs.text` for how header and rows are found."""
    text = load(log)
    separator = log.separator or guess_separator(text, log.skip_rows)
    if separator is None:
        raise refuse(
            "no_separator",
            where=str(log.path),
            expected="one of , ; tab | between the columns",
            found=f"none that gives lines of equal length; line 1: '{text.line(0)[:60]}'",
            do="State 'separator' of this log, or format = 'ascii' for columns in blanks.",
        )
    decimal = log.decimal or guess_decimal(text, separator, log.skip_rows)
    return parse(text, log, layout(text, log, separator, decimal), separator, decimal, "csv")


def guess_separator(text: Text, skip: int = 0) -> str | None:
    """The first of ; tab | , that divides most of the first lines into as many fields; or None."""
    lines = [text.line(int(i)) for i in content_lines(text, skip)[:HEAD]]
    # Lines of several words before the header must not decide: look at the latter half.
    lines = lines[len(lines) // 2 :]
    for separator in SEPARATORS:
        counts = [line.count(separator) for line in lines]
        common = max(set(counts), key=counts.count, default=0)
        if common > 0 and counts.count(common) >= 0.8 * len(counts):
            blanks = sum(bool(re.search(r"\d[ \t]+[-+.\d]", line)) for line in lines)
            stamps = sum(bool(re.search(r"\d-\d\d [ \d]\d:", line)) for line in lines)
            if separator == "," and blanks > 0.5 * len(lines) and not stamps:
                inside = [f for line in lines for f in line.split(",")]
                if sum(bool(re.search(r"\d\s+[-+\d]", f)) for f in inside) > len(lines) / 2:
                    continue  # blanks between the columns, comma in the numbers
            return separator
    return None


def guess_decimal(text: Text, separator: str, skip: int = 0) -> str:
    """',' if numbers such as '1,5' and none such as '1.5' stand between the separators."""
    if separator == ",":
        return "."
    cells = [
        c for i in content_lines(text, skip)[:HEAD] for c in split(text.line(int(i)), separator)
    ]
    cells = [c for c in cells if c not in MISSING and is_number(c, ",")]
    commas = sum("," in c for c in cells)
    points = sum("." in c and not re.search(r"[:-]", c[1:]) for c in cells)
    return "," if commas and not points else "."
