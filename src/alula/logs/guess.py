"""A first project file for a log: guesses from names, units and sizes, all to be confirmed."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import numpy as np

from alula.base.arrays import Array
from alula.base.project import LogSpec
from alula.base.units import CHANNELS, find_unit, known_channel
from alula.logs.address import Column
from alula.logs.fill import HUGE, looks_filled
from alula.logs.first_model import model_lines, reconstruct_lines
from alula.logs.guess_units import BY_SIZE, Guess, alike, by_motion, unit_by_size
from alula.logs.reader import read_tables
from alula.logs.synonyms import guess_name
from alula.logs.table import Table, Tables

EXAMPLE_S = 20.0  # length of the example maneuver


def new_project(log_path: Path | str, folder: Path | str | None = None) -> str:
    """TOML text of a project for one log, with every guess marked `# confirm`.

    folder: where the project file will lie, so that the log's path is relative to it; default:
    the log's own folder. Raises BadInput if the log cannot be read.
    """
    path = Path(log_path)
    log = LogSpec(id=_identifier(path.stem), path=path)
    tables, messages = read_tables(log)
    main = _main_table(tables)
    guesses = _guesses(tables, main)
    relative = os.path.relpath(path.absolute(), Path(folder or path.parent).absolute())
    lines = [
        "# A first guess by `alula new`: confirm or correct every line marked so.",
        'schema = "alula.project/1"',
        f"name = {_toml(path.stem)}",
        'aircraft = "aircraft.toml"  # confirm: the file with reference values and mass',
        "",
        "[[logs]]",
        f"id = {_toml(log.id)}",
        f"path = {_toml(relative)}",
    ]
    if main is not None and main.name and len(tables.tables) > 1:
        lines.append(f"variable = {_toml(main.name)}  # confirm: the matrix of the channels")
    fill = _fills(guesses)
    if fill:
        values = ", ".join(f"{v:g}" for v in fill)
        lines.append(f"fill_values = [{values}]  # confirm: looks like 'no data'")
    lines += [f"# {_comment(str(m))}" for m in (*messages, *tables.messages)]
    lines += ["", "[channels]", *_channel_lines(guesses), *_maneuver_lines(log.id, guesses)]
    names = {g.name for g in guesses}
    lines += reconstruct_lines(names)
    lines += ["", "[identify]  # confirm: the formulas to fit"]
    lines += ["[identify.models]", *model_lines(names), ""]
    return "\n".join(lines)


def _main_table(tables: Tables) -> Table | None:
    """The table of most numbers among those with several columns; None if there is none."""
    several = [t for t in tables.tables if len(t.data) > 1]
    return max(several, key=lambda t: t.rows * len(t.data), default=None)


def _guesses(tables: Tables, main: Table | None) -> list[Guess]:
    """One guess for each column, the better one where two have the same name."""
    out: list[Guess] = []
    for table in tables.tables:
        for k in range(len(table.data)):
            column = Column(table, k)
            label = table.columns[k] or (table.name if len(table.data) == 1 else "")
            repeated = table.columns.count(label) > 1
            if label and not repeated:
                source: int | str = label
            elif table is main:
                source = k + 1
            else:
                source = f"{table.name}[{k + 1}]"
            out.append(_guess(source, column, label.rsplit(".", 1)[-1]))
    if not any(g.name == "t" for g in out):
        out = _find_time(out)
    seen: set[str] = set()
    for i, guess in enumerate(out):
        if guess.name and guess.name in seen:
            out[i] = _without(guess, f"looks like '{guess.name}' too")
        seen.add(guess.name)
    out = alike(out)
    out = by_motion(out)
    times = next((g.column.values for g in out if g.name == "t"), None)
    if times is not None:
        for i, guess in enumerate(out):
            if guess.name and len(guess.column.values) != len(times):
                out[i] = _without(guess, f"'{guess.name}'? has a time of its own to be given")
    return out


def _without(guess: Guess, why: str) -> Guess:
    return Guess(guess.source, guess.column, "", guess.unit, 1, why)


def _guess(source: int | str, column: Column, label: str) -> Guess:
    name, unit = guess_name(label) if label else ("", "")
    values = column.values[np.isfinite(column.values)]
    if not name or len(values) == 0:
        return Guess(source, column, "", column.unit, 1, "no number" if not len(values) else "")
    known = known_channel(name)
    assert known is not None
    if column.unit:
        found = find_unit(column.unit)
        if found is None or found.si not in (known.unit, *known.also):
            return Guess(source, column, "", column.unit, 1, f"'{name}'? but in {column.unit}")
        unit, why = column.unit, "its name and unit"
    else:
        why = "its name" if unit else BY_SIZE
        unit = unit or unit_by_size(name, known.unit, values)
    if name != "az":
        return Guess(source, column, name, unit, 1, why)
    unit, sign, offset = _vertical(label, unit, values, why == BY_SIZE)
    return Guess(source, column, name, unit, sign, why, offset)


def _vertical(label: str, unit: str, values: Array, by_size: bool) -> tuple[str, int, float]:
    """Unit, sign and offset of az: it may point up and may have gravity taken out.

    'Normal acceleration' is positive up by custom, so that 1 g taken out is put back before the
    sign is turned; another name is taken to point down.
    """
    found = find_unit(unit)
    assert found is not None
    middle = found.scale * float(np.median(values))
    if abs(middle) < 0.3:
        if by_size:
            unit = "g" if float(np.quantile(np.abs(values), 0.999)) < 2.0 else "m/s2"
        one = 1.0 if unit == "g" else 9.81
        up = re.search("norm|nz", label.lower()) is not None
        return unit, (-1 if up else 1), (one if up else -one)
    return unit, (-1 if 5.0 < middle < 15.0 else 1), 0.0


def _find_time(guesses: list[Guess]) -> list[Guess]:
    """The first column whose values increase evenly is taken for the time."""
    for i, guess in enumerate(guesses):
        x = guess.column.values
        dt = np.diff(x)
        if len(dt) < 3 or guess.name or not np.isfinite(dt).all() or (dt <= 0).any():
            continue
        if np.quantile(dt, 0.9) < 1.5 * np.median(dt):
            unit = unit_by_size("t", "s", x)
            new = Guess(guess.source, guess.column, "t", unit, 1, "it increases evenly")
            return [*guesses[:i], new, *guesses[i + 1 :]]
    return guesses


def _fills(guesses: list[Guess]) -> list[float]:
    found = {f[0] for g in guesses if g.name and (f := looks_filled(g.column.values))}
    return sorted(v for v in found if abs(v) < HUGE)


def _channel_lines(guesses: list[Guess]) -> list[str]:
    order = list(CHANNELS)
    matched = sorted((g for g in guesses if g.name), key=lambda g: order.index(g.name))
    lines = []
    if not any(g.name == "t" for g in matched):
        lines.append('# t = {from = "?", unit = "s"}  # confirm: no time was found')
    for g in matched:
        sign = f", offset = {g.offset:g}" if g.offset else ""
        sign += ", sign = -1" if g.sign < 0 else ""
        entry = f"{g.name} = {{from = {_toml(g.source)}, unit = {_toml(g.unit)}{sign}}}"
        lines.append(f"{entry}  # confirm: by {g.why}; {_span(g.column.values)}")
    rest = [g for g in guesses if not g.name]
    if rest:
        lines.append("# Columns without a guess (from, values as recorded):")
    for g in rest:
        unit = f" [{g.unit}]" if g.unit else ""
        why = f"  {g.why}" if g.why else ""
        lines.append(
            f"#   {_comment(_toml(g.source) + unit)}: {_span(g.column.values)}{_comment(why)}"
        )
    return lines


def _maneuver_lines(log: str, guesses: list[Guess]) -> list[str]:
    time = next((g for g in guesses if g.name == "t"), None)
    if time is None:
        return []
    unit = find_unit(time.unit)
    t = time.column.values[np.isfinite(time.column.values)]
    if unit is None or len(t) < 2:
        return []
    start, end = float(t.min()) * unit.scale, float(t.max()) * unit.scale
    stop = min(end, start + EXAMPLE_S)
    return [
        "",
        f"# An example window; the log runs from {start:.10g} to {end:.10g} s.",
        "[[maneuvers]]",
        'id = "example"',
        f"log = {_toml(log)}",
        'kind = "3211"  # confirm',
        f"start = {start:.10g}  # confirm",
        f"end = {stop:.10g}  # confirm",
        'aspect = "both"  # confirm: longitudinal, lateral or both',
    ]


def _span(values: Array) -> str:
    good = values[np.isfinite(values)]
    if len(good) == 0:
        return "no number in it"
    return f"{good.min():.4g} to {good.max():.4g}, median {np.median(good):.4g}"


def _toml(value: int | str) -> str:
    if isinstance(value, int):
        return str(value)
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")


def _comment(text: str) -> str:
    return re.sub(r"[\x00-\x1f\x7f\x85\u2028\u2029]", " ", text)


def _identifier(stem: str) -> str:
    return re.sub(r"[^\w.+-]+", "_", stem).strip("_.+-")[:60] or "log"
