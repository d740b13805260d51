"""Lines of a text file: encoding, comments, header, units, and which lines are rows."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from alula.base.messages import Message, note, refuse
from alula.base.project import LogSpec
from alula.base.units import find_unit
from alula.logs.sniff import wrong_type

Lines = NDArray[np.int64]
HEAD = 200  # lines looked at for separator, header and units
MISSING = ("", "nan", "NaN", "NAN", "-nan", "NA", "N/A", "n/a", "null", "NULL", "None", "-", "--",
           "#N/A", "NaN(ind)", "-nan(ind)", "-1.#IND", "1.#QNAN")  # fmt: skip
_STAMP = re.compile(r"^\d{4}-\d\d-\d\d([T ]\d\d:\d\d.*)?$|^\d{1,2}:\d\d(:\d\d(\.\d+)?)?$")


@dataclass(frozen=True)
class Text:
    """A text file as UTF-8 with the place of every line.

    starts: (n + 1,) byte offset of each line in `data`, and the end. original: as it was before
    the separators were made uniform, for counting bytes; it has the same lines.
    """

    path: Path
    data: bytes
    starts: Lines
    encoding: str
    size: int
    original: bytes
    original_starts: Lines
    messages: tuple[Message, ...] = ()

    def line(self, i: int) -> str:
        """Line i (from 0) without its end."""
        return self.data[self.starts[i] : self.starts[i + 1]].decode().rstrip("\r\n")

    def bytes_of(self, lines: Lines) -> int:
        """Bytes that these lines occupy in the file."""
        if self.encoding in ("utf-8", "ascii"):
            return int((self.original_starts[lines + 1] - self.original_starts[lines]).sum())
        s = self.original_starts
        used = sum(
            len(self.original[s[i] : s[i + 1]].decode().encode(self.encoding)) for i in lines
        )
        return min(used, self.size)  # encodings with a mark in each piece would count it twice

    def with_data(self, data: bytes) -> Text:
        """The same lines with other text in them."""
        return replace(self, data=data, starts=_line_starts(data))


def load(log: LogSpec) -> Text:
    """Read and decode a text file; raises BadInput for a wrong encoding or binary content."""
    raw = log.path.read_bytes()
    encoding, bom = _guess(raw)
    if log.encoding and not encoding.startswith(log.encoding.lower().removesuffix("-sig")):
        encoding, bom = log.encoding, 0
    messages = []
    try:
        body = raw[bom:]
        data = body if encoding == "utf-8" else body.decode(encoding).encode()
        if encoding == "utf-8":
            body.decode()
    except (LookupError, UnicodeError) as error:
        raise refuse(
            "wrong_encoding",
            where=str(log.path),
            expected=f"text in {encoding}",
            found=str(error),
            do="Set 'encoding' of this log, such as 'utf-8', 'utf-16' or 'latin-1'.",
        ) from None
    if b"\0" in data:
        raise wrong_type(log.path, log.format, "binary data (there are NUL bytes in it)")
    if not data.strip():
        raise refuse(
            "empty_file",
            where=str(log.path),
            expected="a log with samples",
            found=f"{len(raw)} bytes without a line of text",
            do="Copy the log again from where it was recorded.",
        )
    if encoding != "utf-8" and not log.encoding:
        messages.append(
            note(
                "encoding",
                where=str(log.path),
                expected="UTF-8",
                found=encoding,
                do="Read as that; set 'encoding' of this log if names look wrong.",
            )
        )
    if b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    starts = _line_starts(data)
    return Text(log.path, data, starts, encoding, len(raw), data, starts, tuple(messages))


def _guess(raw: bytes) -> tuple[str, int]:
    """(encoding, bytes of the byte order mark)."""
    if raw.startswith(b"\xef\xbb\xbf"):
        return "utf-8", 3
    if raw.startswith(b"\xff\xfe"):
        return "utf-16-le", 2
    if raw.startswith(b"\xfe\xff"):
        return "utf-16-be", 2
    sample = raw[:4096]
    if sample.count(0) > 0.3 * len(sample):
        return ("utf-16-le" if sample[1::2].count(0) else "utf-16-be"), 0
    try:
        raw.decode()
    except UnicodeDecodeError:
        return "latin-1", 0
    return "utf-8", 0


def _line_starts(data: bytes) -> Lines:
    ends = np.flatnonzero(np.frombuffer(data, np.uint8) == 10).astype(np.int64) + 1
    if len(ends) == 0 or ends[-1] != len(data):
        ends = np.append(ends, len(data))
    return np.concatenate(([0], ends))


@dataclass(frozen=True)
class Layout:
    """Names and units of the columns, and the lines (from 0) that are rows of numbers."""

    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: Lines


def content_lines(text: Text, skip: int) -> Lines:
    """Indices of the lines that are neither blank nor comments, after `skip` lines."""
    buffer = np.frombuffer(text.data, np.uint8)
    starts = text.starts[:-1]
    first = buffer[np.minimum(starts, len(buffer) - 1)]
    second = buffer[np.minimum(starts + 1, len(buffer) - 1)]
    skipped = np.isin(first, np.frombuffer(b"\r\n#%", np.uint8)) | (starts >= len(buffer))
    skipped |= (first == ord("/")) & (second == ord("/"))
    skipped[:skip] = True
    return np.flatnonzero(~skipped).astype(np.int64)


def split(line: str, separator: str) -> list[str]:
    """Fields of one line, quotes taken off."""
    try:
        return [f.strip() for f in next(csv.reader([line], delimiter=separator), [])]
    except csv.Error:
        return [f.strip() for f in line.split(separator)]


def is_number(field: str, decimal: str) -> bool:
    """Whether a field is a number (or a time of day, or a date)."""
    if decimal == ",":
        field = field.replace(",", ".")
    try:
        float(field)
    except ValueError:
        return bool(_STAMP.match(field))
    return "_" not in field


def layout(text: Text, log: LogSpec, separator: str, decimal: str) -> Layout:
    """Find header, unit row and first row of numbers.

    A row has numbers in at least half of its fields that are not empty. The header is the last
    line before the first row that has as many fields; a line of units may stand between.
    """
    lines = content_lines(text, log.skip_rows)
    fields = {int(i): split(text.line(int(i)), separator) for i in lines[:HEAD]}

    def is_row(cells: list[str]) -> bool:
        filled = [c for c in cells if c not in MISSING]
        numbers = sum(is_number(c, decimal) for c in filled)
        return numbers > 0 and 2 * numbers >= len(filled)

    fixed = max(log.header_row or 0, log.unit_row or 0)
    first = next((i for i, cells in fields.items() if i >= fixed and is_row(cells)), None)
    if first is None:
        raise refuse(
            "no_rows",
            where=str(text.path),
            expected="lines of numbers with one separator",
            found=f"none in the first {len(fields)} lines"
            + (f", which begin '{text.line(int(lines[0]))[:60]}'" if len(lines) else ""),
            do="Check that this is the log; state separator, decimal, header_row, skip_rows.",
        )
    width = len(fields[first])
    before = [i for i in fields if i < first]
    unit_line = _chosen(log.unit_row)
    header_line = _chosen(log.header_row)
    if log.unit_row is None and len(before) > 1:
        above, last = (fields[i] for i in before[-2:])
        if len(above) == len(last) and _is_units(last):
            unit_line = before.pop()
    if log.header_row is None and log.columns is None:
        same = [i for i in before if len(fields[i]) in (width, width - 1)]
        header_line = same[-1] if same else _comment_header(text, first, separator, width)
    names = list(log.columns or ())
    if not names and header_line is not None:
        names = split(text.line(header_line).lstrip("#%/ \t"), separator)
    units = split(text.line(unit_line).lstrip("#%/ \t"), separator) if unit_line is not None else []
    if names and not any(names[width:]):
        names = names[:width]
    if names and len(names) not in (width, width - 1):
        raise refuse(
            "ragged_header",
            where=f"{text.path}, line {first + 1}",
            expected=f"{len(names)} columns, as many as there are names",
            found=f"{width}",
            do="State separator and header_row, or the names in 'columns'.",
        )
    names += [""] * (width - len(names))
    units = [u.strip("[]() ") for u in units[:width]] + [""] * (width - len(units))
    for k, label in enumerate(names):
        name, unit = name_and_unit(label)
        names[k], units[k] = name, units[k] or unit
    return Layout(tuple(names), tuple(units), lines[lines >= first])


def _chosen(number: int | None) -> int | None:
    return number - 1 if number else None


def _comment_header(text: Text, first: int, separator: str, width: int) -> int | None:
    """The last comment line before the rows that has as many fields as they."""
    for i in range(first - 1, max(first - 20, -1), -1):
        line = text.line(i).lstrip()
        if line[:1] in ("#", "%") and len(split(line.lstrip("#%/ \t"), separator)) == width > 1:
            return i
    return None


def _is_units(cells: list[str]) -> bool:
    """Whether most cells are units; names such as 't', 'h', 'V', 'g' are units by accident."""
    filled = [c for c in cells if c]
    known = [c for c in filled if find_unit(c) is not None]
    sure = [c for c in known if len(c.strip("[]() ")) > 2 or c[:1] in "[(" or c in ("-", "1", "%")]
    telling = sure or [c for c in known if c in ("s", "ms", "m", "ft", "g", "kt", "K")]
    return 2 * len(known) > len(filled) and bool(telling)


def name_and_unit(label: str) -> tuple[str, str]:
    """('p', 'deg/s') from 'p [deg/s]' or 'p (deg/s)'; the unit only where it is known."""
    match = re.fullmatch(r"\s*(.+?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))\s*", label)
    if match:
        unit = match.group(2) if match.group(2) is not None else match.group(3)
        if unit and find_unit(unit) is not None:
            return match.group(1), unit
    return label.strip(), ""
