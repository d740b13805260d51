"""Reads the functions of a DAVE-ML file."""

from __future__ import annotations

import math
from xml.etree.ElementTree import Element

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.export.daveml_elements import numbers, optional_number, text_of, wrong
from alula.export.daveml_table import INTERPOLATIONS, Axis, GriddedFunction


def read_function(element: Element, root: Element, where: str) -> GriddedFunction:
    """The function of a `function` element; root: where its tables and breakpoints lie."""
    name = element.get("name", "")
    at = f"{where}, function '{name}'"
    simple = element.find("dependentVarPts")
    if simple is not None:
        axes = [
            _axis(e, numbers(e.text or "", at), at) for e in element.findall("independentVarPts")
        ]
        return _gridded(name, simple.get("varID", ""), axes, simple, element, at)
    output = element.find("dependentVarRef")
    definition = element.find("functionDefn")
    if output is None or definition is None or len(definition) != 1:
        raise wrong(at, "dependentVarRef and functionDefn with one table", "something else")
    table: Element | None = definition[0]
    if table is not None and table.tag == "griddedTableRef":
        wanted = table.get("gtID")
        table = next((e for e in root.iter("griddedTableDef") if e.get("gtID") == wanted), None)
        if table is None:
            raise wrong(at, f"a griddedTableDef '{wanted}'", "none")
    assert table is not None
    refs = element.findall("independentVarRef")
    points = [_breakpoints(root, e.get("bpID", ""), at) for e in table.findall(".//bpRef")]
    data = table.find("dataTable")
    if len(refs) != len(points) or data is None:
        raise wrong(
            at, f"{len(refs)} breakpoint sets and a dataTable", f"{len(points)} breakpoint sets"
        )
    axes = [_axis(e, b, at) for e, b in zip(refs, points, strict=True)]
    return _gridded(name, output.get("varID", ""), axes, data, element, at)


def _gridded(
    name: str, output: str, axes: list[Axis], data: Element, element: Element, where: str
) -> GriddedFunction:
    shape = tuple(len(a.breakpoints) for a in axes)
    values = numbers(data.text or "", where)
    if len(values) != math.prod(shape) or not axes:
        raise wrong(where, f"{math.prod(shape)} values for breakpoints {shape}", f"{len(values)}")
    return GriddedFunction(
        name,
        output,
        tuple(axes),
        frozen(values.reshape(shape)),
        text_of(element.find("description")),
    )


def _axis(element: Element, breakpoints: Array, where: str) -> Axis:
    if not (np.diff(breakpoints) > 0.0).all() or len(breakpoints) == 0:
        raise wrong(where, "increasing breakpoints", str(breakpoints.tolist()))
    interpolate = element.get("interpolate", "linear")
    if interpolate not in INTERPOLATIONS:
        raise refuse(
            "daveml_interpolation",
            where=where,
            expected=f"interpolation {', '.join(INTERPOLATIONS)}",
            found=f"'{interpolate}'",
            do="Tabulate the spline finely and interpolate it linearly; the standard leaves the "
            "spline's end conditions open.",
        )
    extrapolate = element.get("extrapolate", "neither")
    if extrapolate not in ("neither", "min", "max", "both"):
        raise wrong(where, "extrapolate neither, min, max or both", f"'{extrapolate}'")
    return Axis(
        element.get("varID", ""),
        frozen(breakpoints),
        optional_number(element, "min", where),
        optional_number(element, "max", where),
        extrapolate,
        interpolate,
    )


def _breakpoints(root: Element, name: str, where: str) -> Array:
    for element in root.findall("breakpointDef"):
        if element.get("bpID") == name:
            values = element.find("bpVals")
            return numbers("" if values is None else values.text or "", where)
    raise wrong(where, f"a breakpointDef '{name}'", "none")
