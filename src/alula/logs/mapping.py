"""From the arrays of a file to channels in SI units, with a line for everything that was done."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, Message, note, refuse, warn
from alula.base.project import ChannelSpec, LogSpec, TimeSpec
from alula.base.units import Unit, known_channel, to_si
from alula.flight import Channel
from alula.logs.address import Column, find
from alula.logs.fill import take_out
from alula.logs.table import Tables
from alula.logs.timebase import TimeBase, time_base

SPARSE = 0.5  # share of empty samples above which a channel has a slower rate of its own


class LogMapping:
    """The work of one log: columns found, time bases made, messages collected."""

    def __init__(self, log: LogSpec, specs: Mapping[str, ChannelSpec], tables: Tables) -> None:
        self.log = log
        self.specs = specs
        self.tables = tables
        self.messages: list[Message] = []
        self.used: dict[str, int] = {}
        self._bases: dict[str, TimeBase] = {}

    def channels(self) -> dict[str, Channel]:
        """All channels but the time stamps; raises BadInput with all that is wrong."""
        times = {"t"} | {s.time for s in self.specs.values() if isinstance(s.time, str)}
        out, problems = {}, []
        for name, spec in self.specs.items():
            if name in times:
                continue
            try:
                out[name] = self._channel(name, spec)
            except BadInput as error:
                problems += [m for m in error.messages if m not in problems]
        if problems:
            raise BadInput(*problems)
        return out

    def _where(self, name: str) -> str:
        return f"{self.log.path}: channel {name}"

    def _column(self, source: int | str, column: int | None, name: str) -> Column:
        found = find(self.log, self.tables, source, column, self._where(name))
        self.used[found.table.name] = found.table.bytes
        return found

    def _channel(self, name: str, spec: ChannelSpec) -> Channel:
        base = self._base(name, spec)
        values, unit, words = self._values(name, spec)
        if spec.constant is not None:
            ends = frozen([base.t[0], base.t[-1]])
            return Channel(name, ends, frozen([values[0]] * 2), unit.si, words)
        if len(values) != base.recorded:
            raise refuse(
                "length_mismatch",
                where=self._where(name),
                expected=f"{base.recorded} samples, as many as time stamps",
                found=str(len(values)),
                do="Give this channel its own time: time = {from = ..., unit = 's'}.",
            )
        if base.keep is not None:
            values = values[base.keep]
        t, valid = base.t, np.isfinite(values)
        if not valid.any():
            raise refuse(
                "no_valid_sample",
                where=self._where(name),
                expected="numbers",
                found=f"{len(values)} samples, none valid",
                do="Map another source, or remove this channel.",
            )
        if 1 < valid.sum() < (1.0 - SPARSE) * len(valid):
            t, values = t[valid], values[valid]
            self._note(
                "own_rate",
                name,
                f"samples in {valid.sum()} of {len(valid)} rows",
                "Taken at its own rate; empty rows are no samples.",
            )
        if spec.repeats == "drop":
            new = np.concatenate(([True], values[1:] != values[:-1]))
            self._note(
                "repeats_dropped",
                name,
                f"{len(new) - int(new.sum())} of {len(new)} samples equal to the one before",
                "Taken for held values and left out, as the project asks.",
            )
            t, values = t[new], values[new]
        if spec.delay_s:
            t = t - spec.delay_s
        return Channel(name, t if t is base.t else frozen(t), frozen(values), unit.si, words)

    def _base(self, name: str, spec: ChannelSpec) -> TimeBase:
        time = spec.time or "t"
        key = time if isinstance(time, str) else repr(time)
        if key not in self._bases:
            if isinstance(time, TimeSpec):
                column = self._column(time.source, time.column, f"{name}.time")
                unit = to_si(time.unit, where=self._where(f"{name}.time"))
                stamps = unit.scale * (time.scale * column.values + time.offset)
                label = column.label
            elif time in self.specs:
                stamps, unit, label = self._values(time, self.specs[time])
            else:
                raise refuse(
                    "missing_channel",
                    where=self._where(time),
                    expected="a channel of time stamps",
                    found=", ".join(self.specs),
                    do="Map it: t = {from = 'time', unit = 's'}.",
                )
            if unit.si != "s":
                raise self._wrong_unit(time if isinstance(time, str) else name, "s", unit.si)
            self._bases[key] = time_base(self.log, label, stamps)
            self.messages += self._bases[key].messages
        return self._bases[key]

    def _values(self, name: str, spec: ChannelSpec) -> tuple[Array, Unit, str]:
        """(n,) SI values, NaN where there is none; the unit; what was done, in words."""
        if spec.constant is not None:
            unit = self._unit(name, spec, [])
            value = (
                unit.scale * spec.sign * (spec.scale * spec.constant + spec.offset) + unit.offset
            )
            return np.array([value]), unit, f"constant {spec.constant:g} {spec.unit or ''}".strip()
        columns = [self._column(s, spec.column, name) for s in spec.sources]
        lengths = {len(c.values) for c in columns}
        if len(lengths) > 1:
            raise refuse(
                "length_mismatch",
                where=self._where(name),
                expected="sources of one length",
                found=", ".join(f"{c.label}: {len(c.values)}" for c in columns),
                do="Sum only channels with the same time stamps.",
            )
        fill = spec.fill_values if spec.fill_values is not None else self.log.fill_values
        weights = spec.weights or [1.0] * len(columns)
        total = np.zeros(lengths.pop())
        for column, weight in zip(columns, weights, strict=True):
            self._text(name, column)
            values, said = take_out(column.values, fill, self._where(name))
            self.messages += said
            total += weight * values
        unit = self._unit(name, spec, columns)
        total = spec.scale * total + spec.offset
        if spec.table is not None:
            total = self._calibrate(name, spec.table, total)
        values = unit.scale * (spec.sign * total) + unit.offset
        infinite = np.isinf(values)
        if infinite.any():
            values = np.where(infinite, np.nan, values)
            self.messages.append(
                warn(
                    "not_finite",
                    where=self._where(name),
                    expected="numbers that can be converted",
                    found=f"{int(infinite.sum())} too large, which became NaN",
                    do="Check the source; no sensor reads that.",
                )
            )
        words = _words(spec, columns, weights)
        plain = f"{columns[0].label} in {spec.unit or columns[0].unit}"
        if unit != Unit(1.0, 0.0, unit.si) or words not in (plain, columns[0].label):
            self._note("converted", name, words, f"It is now in {unit.si}.")
        return values, unit, words

    def _calibrate(self, name: str, table: list[list[float]], x: Array) -> Array:
        inputs, outputs = np.array(table).T
        y: Array = np.interp(x, inputs, outputs, left=np.nan, right=np.nan)
        outside = int((np.isfinite(x) & ~np.isfinite(y)).sum())
        if outside:
            self.messages.append(
                warn(
                    "outside_table",
                    where=self._where(name),
                    expected=f"values from {inputs[0]:g} to {inputs[-1]:g}, as the table has",
                    found=f"{outside} samples outside, which became NaN",
                    do="Extend the calibration table.",
                )
            )
        return y

    def _text(self, name: str, column: Column) -> None:
        if column.not_numeric is None:
            return
        count, first = column.not_numeric
        found = f"{count} of {len(column.values)} entries are text, the first '{first}'"
        if not np.isfinite(column.values).any():
            raise refuse(
                "not_numeric",
                where=self._where(name),
                expected="numbers",
                found=found,
                do="Map a column of numbers; state 'decimal' if it has decimal commas.",
            )
        self.messages.append(
            warn(
                "not_numeric",
                where=self._where(name),
                expected="numbers",
                found=f"{found}; they became NaN",
                do="Check these rows.",
            )
        )

    def _unit(self, name: str, spec: ChannelSpec, columns: list[Column]) -> Unit:
        stated = columns[0].unit if columns else ""
        text = spec.unit if spec.unit is not None else stated
        known = known_channel(name)
        if not text and spec.unit is None:
            if known and known.unit == "1":
                text = "1"
            else:
                raise refuse(
                    "missing_unit",
                    where=self._where(name),
                    expected="the unit that the source is in",
                    found="none in the project, none in the file",
                    do=f"Add unit = '{known.unit if known else '1'}' if it is in that.",
                )
        unit = to_si(text, where=self._where(name))
        if spec.unit is not None and stated and to_si(stated) != unit:
            self.messages.append(
                warn(
                    "unit_contradiction",
                    where=self._where(name),
                    expected=f"'{stated}', as the file says",
                    found=f"unit = '{spec.unit}' in the project, which is used",
                    do="Correct the project if the file is right.",
                )
            )
        if known and unit.si not in (known.unit, *known.also):
            raise self._wrong_unit(name, known.unit, unit.si, text)
        return unit

    def _wrong_unit(self, name: str, expected: str, si: str, text: str = "") -> BadInput:
        return refuse(
            "wrong_unit",
            where=self._where(name),
            expected=f"a unit that converts to {expected}",
            found=f"'{text or si}', which converts to {si}",
            do="Correct the unit or the channel's name.",
        )

    def _note(self, code: str, name: str, found: str, do: str) -> None:
        self.messages.append(
            note(
                code,
                where=self._where(name),
                expected="the channel as recorded",
                found=found,
                do=do,
            )
        )


def _words(spec: ChannelSpec, columns: list[Column], weights: list[float]) -> str:
    text = columns[0].label
    if len(columns) > 1 or spec.weights:
        text = " ".join(f"{w:+g} {c.label}" for c, w in zip(columns, weights, strict=True))
    unit = spec.unit if spec.unit is not None else columns[0].unit
    text += f" in {unit}" if unit else ""
    text += f", times {spec.scale:g}" if spec.scale != 1.0 else ""
    text += f", plus {spec.offset:g}" if spec.offset else ""
    text += ", by calibration table" if spec.table else ""
    text += ", sign turned" if spec.sign < 0 else ""
    text += f", {spec.delay_s:g} s late" if spec.delay_s else ""
    return text
