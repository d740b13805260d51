"""Where in a file a channel is: by name, by 1-based column, by 'name[column]'."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.base.project import LogSpec
from alula.logs.synonyms import guess_name
from alula.logs.table import Table, Tables


@dataclass(frozen=True)
class Column:
    """One column of a table, found."""

    table: Table
    index: int

    @property
    def values(self) -> Array:
        """(n,) as the file has it."""
        return self.table.data[self.index]

    @property
    def unit(self) -> str:
        """As the file states it, or ''."""
        return self.table.units[self.index]

    @property
    def label(self) -> str:
        """For people: 'ALCG', 'column 22 of fAttasElv1'."""
        name = self.table.columns[self.index]
        if name:
            return f"'{name}'"
        of = f" of {self.table.name}" if self.table.name else ""
        return (
            f"column {self.index + 1}{of}" if len(self.table.data) > 1 else f"'{self.table.name}'"
        )

    @property
    def not_numeric(self) -> tuple[int, str] | None:
        """How many entries are text, with the first of them."""
        return self.table.not_numeric.get(self.index)


def default_table(log: LogSpec, tables: Tables, where: str) -> Table:
    """The table that column numbers refer to: `variable`, or the only one."""
    if log.variable:
        named = [t for t in tables.tables if t.name == log.variable]
        if named:
            return named[0]
        if not _inside(log, tables):
            raise _missing(log, tables, log.variable, "variable")
    elif len(tables.tables) == 1:
        return tables.tables[0]
    matrices = [t for t in _inside(log, tables) if len(t.data) > 1]
    if len(matrices) == 1:
        return matrices[0]
    raise refuse(
        "which_variable",
        where=where,
        expected="one matrix in the file, for column numbers to refer to",
        found=_listed(tables),
        do="Set 'variable' of this log to its name, or address by name.",
    )


def find(log: LogSpec, tables: Tables, source: int | str, column: int | None, where: str) -> Column:
    """The column of that address.

    Raises BadInput where there is none (with near names), where several have the name, and where
    a matrix is named without a column.
    """
    if isinstance(source, int):
        return _numbered(default_table(log, tables, where), source, where)
    bracket = re.fullmatch(r"(.+)\[(\d+)\]", source)
    exact = list(_named(log, tables, source))
    if not exact and bracket and column is None:
        source, column = bracket.group(1), int(bracket.group(2))
        exact = list(_named(log, tables, source))
    if not exact:
        raise _missing(log, tables, source, where)
    matrices = [c for c in exact if c.index < 0]
    plain = [c for c in exact if c.index >= 0]
    if column is not None and matrices:
        return _numbered(matrices[0].table, column, where)
    if plain and column is None:
        if len(plain) > 1:
            places = ", ".join(f"column {c.index + 1}" for c in plain)
            raise refuse(
                "duplicate_channel",
                where=where,
                expected=f"one column named '{source}'",
                found=f"{len(plain)}: {places}",
                do="Address it by its number: from = " + str(plain[0].index + 1),
            )
        return plain[0]
    shape = (matrices or plain)[0].table.shape
    raise refuse(
        "which_column",
        where=where,
        expected="'column' with the name of a matrix, and only then",
        found=f"'{source}' is {shape}, column {column or 'not given'}",
        do=f"Write from = '{source}', column = 1 (or '{source}[1]').",
    )


def _named(log: LogSpec, tables: Tables, source: str) -> Iterator[Column]:
    """Columns of that name; a matrix of that name has index -1. Tables before their columns."""
    found: list[Table] = []
    for name in [f"{log.variable}.{source}"] * bool(log.variable) + [source]:
        wanted = name.replace("/", ".") if tables.format == "mat" else name
        found = found or [t for t in tables.tables if t.name and t.name == wanted]
    for table in found:
        yield Column(table, 0 if len(table.data) == 1 else -1)
    if not found:
        for table in _inside(log, tables):
            for k, name in enumerate(table.columns):
                if name == source:
                    yield Column(table, k)


def _inside(log: LogSpec, tables: Tables) -> list[Table]:
    """The tables of the log's variable: itself or the fields in it."""
    variable = log.variable
    if not variable:
        return list(tables.tables)
    return [t for t in tables.tables if t.name == variable or t.name.startswith(variable + ".")]


def _numbered(table: Table, number: int, where: str) -> Column:
    if number > len(table.data):
        raise refuse(
            "missing_channel",
            where=where,
            expected=f"a column from 1 to {len(table.data)}",
            found=str(number),
            do=f"The matrix {table.name} is {table.shape}; correct 'from'.",
        )
    return Column(table, number - 1)


def _missing(log: LogSpec, tables: Tables, source: str, where: str) -> BadInput:
    names = [t.name for t in tables.tables if t.name]
    names += [n for t in tables.tables for n in t.columns if n and n not in names]
    meant, _ = guess_name(source)  # 'elevator' where the file has 'de_deg'
    near = [n for n in names if meant and guess_name(n)[0] == meant][:3]
    near = near or get_close_matches(source, names, n=3, cutoff=0.5)
    shown = ", ".join(names[:12]) + (f" and {len(names) - 12} more" if len(names) > 12 else "")
    return refuse(
        "missing_channel",
        where=where,
        expected=f"'{source}' in {log.path}",
        found=shown or f"columns without names ({_listed(tables)})",
        do=f"Did you mean {' or '.join(repr(n) for n in near)}?" if near else "Correct 'from'.",
    )


def _listed(tables: Tables) -> str:
    shown = ", ".join(f"{t.name or 'columns'} ({t.shape})" for t in tables.tables[:12])
    return shown or "no numeric array"
