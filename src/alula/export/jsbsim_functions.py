"""An AeroModel's terms as functions of JSBSim's XML."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.export.jsbsim_property import PROPERTIES
from alula.model import AeroModel, Factor, LookupTable, Term

# Beyond its breakpoints a table of JSBSim holds the edge's value; one that goes on as a line gets
# breakpoints this many spans further out.
_FAR = 100.0


def add_coefficients(parent: Element, model: AeroModel) -> None:
    """Append a function `aero/coefficient/NAME` for every coefficient, and one for every table.

    They stand outside the axes, so that they are dimensionless and can be read back as properties.
    Raises BadInput for a cubic table: JSBSim interpolates linearly.
    """
    for name, table in model.tables.items():
        add_function(parent, f"aero/table/{name}", f"Table {name}").append(
            table_element(table, name)
        )
    for coefficient in model.coefficients:
        function = add_function(parent, f"aero/coefficient/{coefficient}", coefficient)
        whole = SubElement(function, "sum")
        for (c, term), value in zip(model.terms, model.values.tolist(), strict=True):
            if c == coefficient:
                product = SubElement(whole, "product")
                SubElement(product, "value").text = repr(value)
                add_term(product, term)
        SubElement(whole, "value").text = "0"  # a sum wants two parts


def add_function(parent: Element, name: str, description: str) -> Element:
    """Append an empty function with its property's name."""
    function = SubElement(parent, "function", name=name)
    SubElement(function, "description").text = description
    return function


def add_term(product: Element, term: Term) -> None:
    """Append a term's factors to a product."""
    for factor in term.factors:
        for _ in range(factor.power):
            product.append(_factor(factor))
    SubElement(product, "value").text = "1"  # a product wants two parts


def prop(name: str) -> Element:
    """A property's value."""
    element = Element("property")
    element.text = name
    return element


def value(x: float) -> Element:
    """A number."""
    element = Element("value")
    element.text = repr(float(x))
    return element


def op(name: str, *parts: Element) -> Element:
    """An operation."""
    element = Element(name)
    element.extend(parts)
    return element


def _factor(factor: Factor) -> Element:
    if factor.kind == "table":
        return prop(f"aero/table/{factor.table}")
    x = prop(PROPERTIES[factor.variable])
    if factor.kind == "abs":
        return op("abs", x)
    if factor.kind == "ramp":
        return op("max", op("difference", x, value(factor.knot)), value(0.0))
    if factor.kind == "sign":
        again = prop(PROPERTIES[factor.variable])
        return op("difference", op("gt", x, value(0.0)), op("lt", again, value(0.0)))
    return x


def table_element(table: LookupTable, name: str) -> Element:
    """A table of one to three axes over the variables' properties."""
    if table.interpolation != "linear":
        raise refuse(
            "jsbsim_interpolation",
            where=f"tables.{name}",
            expected="linear tables, as JSBSim interpolates",
            found=table.interpolation,
            do="Tabulate it finely and make it linear.",
        )
    axes, values = list(table.breakpoints), table.values
    if table.outside == "line":
        for i in range(len(axes)):
            axes[i], values = _continued(axes[i], values, i)
    return grid_element([PROPERTIES[v] for v in table.variables], axes, values)


def grid_element(names: Sequence[str], axes: Sequence[Array], values: Array) -> Element:
    """A table over properties; the last axis of `values` is the last of `names`."""
    element = Element("table")
    kinds = ("row", "column", "table")
    order = list(range(len(names)))
    if len(names) == 3:  # JSBSim's third key is the page: give it the first axis
        order = [1, 2, 0]
    for kind, i in zip(kinds, order, strict=False):
        SubElement(element, "independentVar", lookup=kind).text = names[i]
    if len(names) == 1:
        rows = [f"{b!r}\t{v!r}" for b, v in zip(axes[0].tolist(), values.tolist(), strict=True)]
        SubElement(element, "tableData").text = "\n" + "\n".join(rows) + "\n"
    elif len(names) == 2:
        SubElement(element, "tableData").text = _page(axes[0], axes[1], values)
    else:
        for b, page in zip(axes[0].tolist(), values, strict=True):
            data = SubElement(element, "tableData", breakPoint=repr(b))
            data.text = _page(axes[1], axes[2], page)
    return element


def _page(rows: Array, columns: Array, values: Array) -> str:
    lines = ["\t" + "\t".join(map(repr, columns.tolist()))]
    lines += [
        "\t".join(map(repr, [b, *row]))
        for b, row in zip(rows.tolist(), values.tolist(), strict=True)
    ]
    return "\n" + "\n".join(lines) + "\n"


def _continued(b: Array, values: Array, axis: int) -> tuple[Array, Array]:
    """Breakpoints far outside with the values of the straight lines through the edges."""
    v = np.moveaxis(values, axis, 0)
    far = _FAR * (b[-1] - b[0])
    low = v[0] - far * (v[1] - v[0]) / (b[1] - b[0])
    high = v[-1] + far * (v[-1] - v[-2]) / (b[-1] - b[-2])
    out = np.concatenate([low[None], v, high[None]])
    return np.concatenate([[b[0] - far], b, [b[-1] + far]]), np.moveaxis(out, 0, axis)
