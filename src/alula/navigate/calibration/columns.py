"""The columns that a calibration project names, in SI, with every byte of their files counted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from alula.base.arrays import Array
from alula.base.files import sha256
from alula.base.messages import BadInput, Message, refuse
from alula.base.project import LogSpec
from alula.base.units import Unit, to_si
from alula.flight import SourceFile
from alula.logs import read_tables
from alula.logs.address import Column, find
from alula.logs.fill import take_out
from alula.logs.table import Table, Tables
from alula.logs.timebase import time_base
from alula.navigate.calibration.project import RecordingSpec, VectorsSpec


class Columns:
    """The files of a project, each read once."""

    def __init__(self, logs: Sequence[LogSpec]) -> None:
        self._logs = {log.id: log for log in logs}
        self._tables: dict[str, Tables] = {}
        self._used: dict[str, dict[str, int]] = {}
        self.messages: list[Message] = []

    def vectors(self, spec: VectorsSpec, si: str, where: str) -> Array:
        """(n, 3) in the SI unit `si`, NaN where there is no number. Raises BadInput for columns
        that are not there, of unequal length, or in another kind of unit."""
        log, columns = self._logs[spec.log], self._columns(spec, where)
        unit = self.unit(spec, si, where)
        taken = []
        for column in columns:
            values, said = take_out(column.values, log.fill_values, f"{log.path}: {where}")
            taken.append(values)
            self.messages += said
        if len({len(v) for v in taken}) > 1:
            raise refuse(
                "length_mismatch",
                where=f"{log.path}: {where}",
                expected="three columns of one length",
                found=", ".join(str(len(v)) for v in taken),
                do="Correct 'from'.",
            )
        table = np.column_stack(taken)
        if table.shape == (3, 1):  # a vector alone, stored as a column
            table = table.T
        return np.asarray(unit.scale * table * np.array(spec.signs) + unit.offset)

    def recording(self, spec: RecordingSpec, si: str, where: str) -> tuple[Array, Array]:
        """(n,) s and (n, 3) between start and end; the time stamps are checked as in any log."""
        log = self._logs[spec.log]
        tables = self._read(log)
        column = self._find(log, tables, spec.time, f"{where}.time")
        scale = to_si(spec.time_unit or column.unit or "s", where=f"{where}.time_unit")
        if scale.si != "s":
            raise refuse(
                "wrong_unit",
                where=f"{log.path}: {where}.time",
                expected="a unit of time",
                found=f"'{spec.time_unit or column.unit}'",
                do="Correct 'time_unit'.",
            )
        base = time_base(log, column.label, scale.scale * column.values)
        self.messages += base.messages
        values = self.vectors(spec, si, where)
        if len(values) != base.recorded:
            raise refuse(
                "length_mismatch",
                where=f"{log.path}: {where}",
                expected=f"{base.recorded} samples, as many as time stamps",
                found=str(len(values)),
                do="Correct 'from' or 'time'.",
            )
        if base.keep is not None:
            values = values[base.keep]
        start = base.t[0] if spec.start is None else spec.start
        end = base.t[-1] if spec.end is None else spec.end
        inside = (base.t >= start) & (base.t <= end)
        if inside.sum() < 2:
            raise refuse(
                "bad_window",
                where=f"{log.path}: {where}",
                expected=f"a window inside of {base.t[0]:g} to {base.t[-1]:g} s",
                found=f"{start:g} to {end:g} s",
                do="Correct 'start' and 'end'.",
            )
        return base.t[inside], values[inside]

    def unit(self, spec: VectorsSpec, si: str, where: str) -> Unit:
        """The unit that the columns are in."""
        text = spec.unit or self._columns(spec, where)[0].unit
        if not text:
            raise refuse(
                "missing_unit",
                where=where,
                expected="the unit that the columns are in",
                found="none in the project, none in the file",
                do=f"Add unit = '{si}' if they are in that.",
            )
        unit = to_si(text, where=f"{where}.unit")
        if unit.si != si:
            raise refuse(
                "wrong_unit",
                where=f"{where}.unit",
                expected=f"a unit that converts to {si}",
                found=f"'{text}', which converts to {unit.si}",
                do="Correct the unit or the columns.",
            )
        return unit

    def files(self) -> tuple[SourceFile, ...]:
        """The files that were read: decoded is what was used."""
        out = []
        for id, tables in self._tables.items():
            path, decoded = self._logs[id].path, sum(self._used[id].values())
            out.append(
                SourceFile(
                    str(path), sha256(path), tables.size, decoded,
                    tables.size - decoded - tables.unknown, tables.unknown,
                )
            )  # fmt: skip
        return tuple(out)

    def _read(self, log: LogSpec) -> Tables:
        if log.id not in self._tables:
            tables, messages = read_tables(log)
            self._tables[log.id], self._used[log.id] = tables, {}
            self.messages += [*messages, *tables.messages]
        return self._tables[log.id]

    def _find(self, log: LogSpec, tables: Tables, source: int | str, where: str) -> Column:
        column = find(log, tables, source, None, f"{log.path}: {where}")
        self._used[log.id][column.table.name] = column.table.bytes
        return column

    def _columns(self, spec: VectorsSpec, where: str) -> list[Column]:
        log = self._logs[spec.log]
        tables = self._read(log)
        if isinstance(spec.source, list):
            return [self._find(log, tables, s, where) for s in spec.source]
        named = [t for t in tables.tables if t.name == spec.source]
        if not named:
            self._find(log, tables, spec.source, where)  # says what there is
            raise _no_vectors(log, where, f"one column '{spec.source}'")
        table = named[0]
        self._used[log.id][table.name] = table.bytes
        return _three(table, log, where)


def _three(table: Table, log: LogSpec, where: str) -> list[Column]:
    if len(table.data) == 3:
        return [Column(table, k) for k in range(3)]
    if len(table.data) == 1 and table.rows == 3:
        return [Column(table, 0)]
    raise _no_vectors(log, where, f"'{table.name}' of {table.shape}")


def _no_vectors(log: LogSpec, where: str, found: str) -> BadInput:
    return refuse(
        "not_vectors",
        where=f"{log.path}: {where}",
        expected="three columns, or the name of a matrix of three",
        found=found,
        do="Write from = ['x', 'y', 'z'].",
    )
