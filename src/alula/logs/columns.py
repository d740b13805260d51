"""Rows of text to columns of numbers, by pyarrow's parser; every line accounted for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pacsv

from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn
from alula.base.project import LogSpec
from alula.logs.table import Table, Tables
from alula.logs.text import MISSING, Layout, Lines, Text

_NUMBER = r"^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$"


def parse(
    text: Text, log: LogSpec, layout: Layout, separator: str, decimal: str, format: str
) -> Tables:
    """The columns of all rows; ragged rows are refused, or dropped where the log allows it."""
    if separator == decimal:
        raise refuse(
            "bad_value",
            where=f"{text.path}",
            expected="a decimal sign that is not the separator",
            found=f"'{separator}' for both",
            do="Set 'separator' and 'decimal' of this log.",
        )
    width = len(layout.names)
    rows, messages = _even_rows(text, log, layout.rows, separator, width)
    data = _rows_as_bytes(text, rows)
    try:
        table = pacsv.read_csv(
            pa.py_buffer(data),
            read_options=pacsv.ReadOptions(
                column_names=[str(k) for k in range(width)], block_size=1 << 23
            ),
            parse_options=pacsv.ParseOptions(delimiter=separator),
            convert_options=pacsv.ConvertOptions(
                null_values=list(MISSING),
                strings_can_be_null=True,
                decimal_point=decimal,
            ),
        )
    except (pa.ArrowInvalid, pa.ArrowNotImplementedError, pa.ArrowKeyError) as error:
        raise refuse(
            "not_readable",
            where=str(text.path),
            expected=f"rows of {width} columns divided by '{separator}'",
            found=str(error).splitlines()[0][:200],
            do="State separator, decimal and header_row of this log, or mend the file.",
        ) from None
    columns, not_numeric = [], {}
    for k in range(width):
        values, texts = numbers(table.column(k), decimal)
        columns.append(values)
        if texts:
            not_numeric[k] = texts
    names, units = layout.names, layout.units
    if width > 1 and not names[-1] and np.isnan(columns[-1]).all():
        columns, names, units = columns[:-1], names[:-1], units[:-1]  # rows end in a separator
    used = text.bytes_of(rows)
    return Tables(
        format,
        (Table("", tuple(columns), names, units, used, not_numeric),),
        text.size,
        messages=(*text.messages, *messages),
    )


def _even_rows(
    text: Text, log: LogSpec, rows: Lines, separator: str, width: int
) -> tuple[Lines, list[Message]]:
    """The rows that have `width` fields; a last line without its end is looked at like any."""
    fields = _count_fields(text, separator)[rows]
    ragged = rows[fields != width]
    blank = [i for i in ragged if not text.line(int(i)).strip(" \t" + separator)]
    if blank:
        rows = rows[~np.isin(rows, blank)]
        ragged = ragged[~np.isin(ragged, blank)]
    if len(ragged) == 0:
        return rows, []
    listed = ", ".join(str(i + 1) for i in ragged[:5]) + (" ..." if len(ragged) > 5 else "")
    where = f"{text.path}, line {listed}"
    found = f"{len(ragged)} of {len(rows)} rows with another number, the first with " + str(
        fields[fields != width][0]
    )
    if "drop_ragged_rows" not in log.repair:
        raise refuse(
            "ragged_rows",
            where=where,
            expected=f"{width} fields in every row",
            found=found,
            do="Mend the lines, or allow repair = ['drop_ragged_rows'] for this log.",
        )
    kept = rows[~np.isin(rows, ragged)]
    if len(kept) == 0:
        raise refuse("no_rows", where=where, expected="rows", found=found, do="Mend the file.")
    dropped = f"{found}; they were dropped ({text.bytes_of(ragged)} bytes)"
    return kept, [
        warn(
            "dropped_ragged_rows",
            where=where,
            expected=f"{width} fields in every row",
            found=dropped,
            do="Look at these lines.",
        )
    ]


def _count_fields(text: Text, separator: str) -> Lines:
    """Fields in each line; separators inside quotes do not count."""
    buffer = np.frombuffer(text.data, np.uint8)
    marks = buffer == ord(separator)
    if b'"' in text.data:
        inside = np.cumsum(buffer == ord('"'), dtype=np.uint8) % 2  # wraps at 256: parity stays
        marks &= inside == 0
    before = np.searchsorted(np.flatnonzero(marks), text.starts)
    return np.diff(before).astype(np.int64) + 1


def _rows_as_bytes(text: Text, rows: Lines) -> bytes:
    """The rows' text; a slice where they are consecutive."""
    first, last = int(rows[0]), int(rows[-1])
    if last - first + 1 == len(rows):
        return text.data[text.starts[first] : text.starts[last + 1]]
    view = memoryview(text.data)
    return b"".join(view[text.starts[i] : text.starts[i + 1]] for i in rows.tolist())


def numbers(column: Any, decimal: str = ".") -> tuple[Array, tuple[int, str] | None]:
    """A pyarrow column as floats, NaN where there is none.

    Dates and times become seconds since 1970 or since midnight. Returns also how many entries
    are text, with the first of them; None if none is.
    """
    kind = column.type
    texts = None
    if pa.types.is_dictionary(kind):
        column = column.cast(kind.value_type)
        kind = column.type
    if pa.types.is_timestamp(kind):
        column = column.cast(pa.timestamp("ns", tz=kind.tz), safe=False).cast(pa.int64())
        return _floats(column) * 1e-9, None
    if pa.types.is_date(kind):
        column = column.cast(pa.timestamp("s")).cast(pa.int64())
    elif pa.types.is_time(kind):
        return _floats(column.cast(pa.time64("ns")).cast(pa.int64())) * 1e-9, None
    elif pa.types.is_string(kind) or pa.types.is_large_string(kind):
        column, texts = _from_text(column, decimal)
    elif pa.types.is_boolean(kind):
        column = column.cast(pa.int8())
    elif not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind)):
        found = pc.drop_null(column)
        first = (len(found), str(kind)) if len(found) else None
        return np.full(len(column), np.nan), first
    return _floats(column), texts


def _floats(column: Any) -> Array:
    values = column.cast(pa.float64(), safe=False).to_numpy(zero_copy_only=False)
    return np.asarray(values, dtype=np.float64)


def _from_text(column: Any, decimal: str) -> tuple[Any, tuple[int, str] | None]:
    trimmed = pc.utf8_trim_whitespace(column)
    if decimal != ".":
        trimmed = pc.replace_substring(trimmed, pattern=decimal, replacement=".")
    trimmed = pc.replace_substring_regex(trimmed, pattern=r"^\+", replacement="")
    good = pc.fill_null(pc.match_substring_regex(trimmed, pattern=_NUMBER), False)
    missing = pc.is_in(trimmed, value_set=pa.array(MISSING, type=trimmed.type))
    bad = pc.and_(pc.and_(pc.invert(good), pc.is_valid(column)), pc.invert(missing))
    texts = None
    count = pc.sum(bad).as_py() or 0
    if count:
        texts = (int(count), str(column.filter(bad)[0].as_py())[:40])
    none = pa.scalar(None, type=trimmed.type)
    return pc.if_else(good, trimmed, none), texts
