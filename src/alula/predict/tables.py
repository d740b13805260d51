"""Lookup tables for the flight computer: a C++ header in single precision, over the core's types.

The header defines a term table, its values and the views of its lookup tables; the firmware calls
`fill_slots` and `coefficients` with them. It needs no heap and can lie in flash as it is.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from alula.base.arrays import Array
from alula.base.files import write_whole
from alula.base.messages import refuse
from alula.model import AXES, VARIABLES, AeroModel, LookupTable, table_parts
from alula.predict.table_error import TableError

_PER_LINE = 10
_SHARED = 16  # core/include/alula/aero/lookup.hpp


def write_table_header(
    path: Path | str, model: AeroModel, namespace: str, errors: Sequence[TableError] = ()
) -> int:
    """Write the header to `path`, whole or not at all; returns the bytes that the tables take.

    namespace: of the C++ names in it. errors: stated at its head.
    """
    text, size = table_header(model, namespace, errors)
    write_whole(Path(path), text.encode())
    return size


def table_header(
    model: AeroModel, namespace: str, errors: Sequence[TableError] = ()
) -> tuple[str, int]:
    """The header's text, and the bytes that breakpoints and values take.

    Raises BadInput for a namespace that is no C++ name.
    """
    if re.fullmatch(r"[a-z][a-z0-9_]{0,39}", namespace) is None:
        raise refuse(
            "bad_name",
            where="header of lookup tables",
            expected="a name of small letters, digits and underscores",
            found=f"'{namespace}'",
            do="Name the aircraft, for example 'armhawk'.",
        )
    parts = table_parts(model)
    axes: dict[bytes, tuple[str, Array]] = {}
    shared: dict[tuple[str, str], int] = {}
    lines: list[str] = []
    views: list[str] = []
    for number, (name, table) in enumerate(parts.tables.items()):
        names, numbers_of = [], []
        for variable, breakpoints in zip(table.variables, table.breakpoints, strict=True):
            known = axes.setdefault(
                breakpoints.tobytes(), (f"axis_{len(axes)}", np.asarray(breakpoints))
            )
            names.append(known[0])
            numbers_of.append(shared.setdefault((known[0], variable), len(shared)))
        lines.append(f"// {name}({', '.join(table.variables)})")
        lines += _array(f"values_{number}", np.ravel(table.values))
        views.append(_view(f"values_{number}", names, numbers_of, table))
    numbers = sum(t.values.size for t in parts.tables.values())
    numbers += sum(len(b) for _, b in axes.values())
    head = [
        "#pragma once",
        f"// {_one_line(model.name)}: coefficients {' '.join(AXES[model.axes])} as lookup tables.",
        f"// Variables: 1 {' '.join(VARIABLES)}; rad, rates pb/2V qc/2V rb/2V.",
        f"// S {model.reference.S:g} m2, b {model.reference.b:g} m, c {model.reference.c:g} m;"
        f" moments about {', '.join(f'{x:g}' for x in model.reference_point)} m.",
        *(f"// Error of {_one_line(e.text)}." for e in errors),
        '#include "alula/aero/term_table.hpp"',
        "",
        f"namespace {namespace} {{",
        "",
    ]
    for name, breakpoints in axes.values():
        head += _array(name, breakpoints)
    tail = [
        "inline constexpr alula::Lookup<float> lookups[] = {",
        *(f"    {view}," for view in views),
        "};",
        *_array("values", np.asarray(model.values)),
        "inline constexpr alula::TermTable table = {",
        "    {{" + ", ".join(_step(step) for step in parts.steps) + "}},",
        "    {{" + ", ".join(f"{{{c:.0f}, {slot:.0f}}}" for c, slot in parts.terms) + "}},",
        f"    {len(parts.steps)},",
        f"    {len(parts.terms)}}};",
        f"static_assert(alula::well_formed(table, {len(views)}));",
        "",
        f"}}  // namespace {namespace}",
        "",
    ]
    return "\n".join([*head, *lines, *tail]), 4 * numbers


def _array(name: str, values: Array) -> list[str]:
    texts = [_number(x) for x in values]
    rows = [texts[i : i + _PER_LINE] for i in range(0, len(texts), _PER_LINE)]
    return [
        f"inline constexpr float {name}[] = {{",
        *(f"    {', '.join(row)}," for row in rows),
        "};",
    ]


def _number(x: float) -> str:
    text = f"{float(np.float32(x)):.9g}"
    return text + ("f" if any(c in text for c in ".e") else ".0f")


def _view(values: str, axes: Sequence[str], shared: Sequence[int], table: LookupTable) -> str:
    shared = [*shared, *[-1] * (3 - len(axes))]
    sizes = [str(n) for n in table.values.shape] + ["1"] * (3 - len(axes))
    pointers = [*axes, *["nullptr"] * (3 - len(axes))]
    return (
        f"{{{values}, {{{', '.join(pointers)}}}, {{{', '.join(sizes)}}}, {len(axes)}, "
        f"alula::Interpolation::{table.interpolation}, alula::Outside::{table.outside}, "
        f"{{{', '.join(str(n if n < _SHARED else -1) for n in shared)}}}}}"
    )


def _step(step: Array) -> str:
    operation, a, b, knot, c, table = step
    return (
        f"{{{float(knot)!r}, static_cast<alula::Operation>({operation:.0f}), {a:.0f}, {b:.0f}, "
        f"{c:.0f}, {table:.0f}}}"
    )


def _one_line(text: str) -> str:
    return " ".join(text.split()).rstrip("\\")
