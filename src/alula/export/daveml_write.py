"""Writes an AeroModel as DAVE-ML 2.0 (AIAA S-119-2011), its elements in the standard's order."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from alula.base.messages import refuse
from alula.export.daveml_cases import add_cases
from alula.export.daveml_expression import Expression, number, to_mathml, variable
from alula.export.daveml_names import INPUTS, OUTPUTS, POINT_NAMES, REFERENCE
from alula.model import AeroModel, Factor, LookupTable, Term

_HEAD = """<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<!DOCTYPE DAVEfunc PUBLIC "-//AIAA//DTD for Flight Dynamic Models - Functions 2.0//EN"
  "http://www.daveml.org/DTDs/2p0/DAVEfunc.dtd">
"""
_HATS = {"phat": ("p", "b"), "qhat": ("q", "c"), "rhat": ("r", "b")}
_INPUT_OF = {meaning: (name, units, sign) for name, (meaning, units, sign) in INPUTS.items()}
_OUTPUT_OF = {c: (name, sign) for name, (c, sign) in OUTPUTS.items()}
# Identifiers that the file uses besides those of variables, parameters and tables.
_OWN = (
    {f"{k}_ref" for k in "Sbc"} | {f"mrc_{k}" for k in "xyz"} | {f"total_{c}" for c in _OUTPUT_OF}
)


@dataclass
class _Writer:
    model: AeroModel
    root: Element
    ids: dict[str, str] = field(default_factory=dict)  # of parameters, by name

    def unique(self, text: str) -> str:
        """An XML identifier for a parameter's name."""
        base = re.sub(r"[^A-Za-z0-9_]", "_", text)
        taken = {*self.ids.values(), *self.model.tables, *_OWN}
        out, k = base, 2
        while out in taken:
            out, k = f"{base}_{k}", k + 1
        return out

    def variable(
        self,
        id: str,
        name: str,
        units: str,
        description: str,
        *,
        sign: str = "",
        value: float | None = None,
        calculation: Expression | None = None,
        marks: Sequence[str] = (),
    ) -> Element:
        element = SubElement(self.root, "variableDef", name=name, varID=id, units=units)
        if sign:
            element.set("sign", sign)
        if value is not None:
            element.set("initialValue", repr(value))
        SubElement(element, "description").text = description
        if calculation is not None:
            math = SubElement(SubElement(element, "calculation"), "math")
            math.set("xmlns", "http://www.w3.org/1998/Math/MathML")
            to_mathml(calculation, math)
        for mark in marks:
            SubElement(element, mark)
        return element


def daveml_text(model: AeroModel, *, author: str, date: str, cases: int = 20) -> str:
    """The model as DAVE-ML.

    Signals bear the names of S-119, in SI and rad; each parameter is a constant with its standard
    deviation and correlations; `cases` static shots at points spread over the validity (a fixed
    sequence) let the receiver check his reading. author: for the file's header. date: ISO 8601.
    Raises BadInput for a cubic table, which the standard's splines are not.
    """
    model.check_without_lift("DAVE-ML")
    model.check_without_wash("DAVE-ML")
    for name, table in model.tables.items():
        if table.interpolation != "linear":
            raise refuse(
                "daveml_interpolation",
                where=f"aerodynamic model '{model.name}', tables.{name}",
                expected="linear tables: the standard leaves the ends of its splines open",
                found=table.interpolation,
                do="Tabulate it finely and make it linear.",
            )
    clash = sorted(_OWN & model.tables.keys())
    if clash:
        raise refuse(
            "daveml_names",
            where=f"aerodynamic model '{model.name}', tables",
            expected="names that the exported signals do not use",
            found=", ".join(clash),
            do="Rename the table.",
        )
    root = Element("DAVEfunc", xmlns="http://daveml.org/2010/DAVEML")
    _header(root, model, author, date)
    writer = _Writer(model, root)
    inputs = _signals(writer)
    _parameters(writer)
    for name, table in model.tables.items():
        writer.variable(name, name, "nd", f"Table over {', '.join(table.variables)}")
    for coefficient in model.coefficients:
        _coefficient(writer, coefficient)
    for name, table in model.tables.items():
        for i, b in enumerate(table.breakpoints):
            element = SubElement(root, "breakpointDef", bpID=f"{name}_axis_{i + 1}")
            SubElement(element, "bpVals").text = ", ".join(map(repr, b.tolist()))
    for name, table in model.tables.items():
        element = SubElement(root, "griddedTableDef", gtID=f"{name}_table")
        refs = SubElement(element, "breakpointRefs")
        for i in range(len(table.variables)):
            SubElement(refs, "bpRef", bpID=f"{name}_axis_{i + 1}")
        SubElement(element, "dataTable").text = ", ".join(map(repr, table.values.ravel().tolist()))
    for name, table in model.tables.items():
        _function(root, name, table)
    add_cases(root, model, inputs, cases)
    indent(root)
    return _HEAD + tostring(root, encoding="unicode") + "\n"


def _header(root: Element, model: AeroModel, author: str, date: str) -> None:
    header = SubElement(root, "fileHeader", name=_clean(model.name))
    SubElement(header, "author", name=_clean(author), org="")
    SubElement(header, "creationDate", date=date)
    words = [f"Aerodynamic model '{model.name}', {model.axes} axes, written by Alula."]
    words += [f"{k}: {v}" for k, v in model.provenance.items()]
    words += [
        f"Values were found with {n} from {low!r} to {high!r}."
        for n, (low, high) in model.validity.items()
    ]
    if model.stall is not None:
        words.append("The stall is left out: the coefficients are the attached flow's.")
    SubElement(header, "description").text = _clean("\n".join(words))


def _signals(writer: _Writer) -> list[str]:
    """Inputs, reference geometry, nondimensional rates; returns the inputs' varIDs."""
    model = writer.model
    used = {v for _, term in model.terms for f in term.factors for v in f.variables}
    rates = [h for h in _HATS if h in used]
    wanted = (used - set(_HATS)) | {_HATS[h][0] for h in rates} | ({"V"} if rates else set())
    inputs = [meaning for meaning in _INPUT_OF if meaning in wanted]
    for meaning in inputs:
        name, units, sign = _INPUT_OF[meaning]
        writer.variable(
            meaning, name, units, f"{meaning} of Alula's notation", sign=sign,
            marks=("isInput", "isStdAIAA"),
        )  # fmt: skip
    for name, (key, units) in REFERENCE.items():
        writer.variable(
            f"{key}_ref", name, units, "Reference of the coefficients",
            value=float(getattr(model.reference, key)), marks=("isOutput", "isStdAIAA"),
        )  # fmt: skip
    for name, x in zip(POINT_NAMES, model.reference_point.tolist(), strict=True):
        words = "Where the moments act, body axes from the datum of the aircraft"
        writer.variable(f"mrc_{name[-1].lower()}", name, "m", words, value=x)
    for hat in rates:
        rate, length = _HATS[hat]
        doubled = Expression("times", (number(2.0), variable("V")))
        product = Expression("times", (variable(rate), variable(f"{length}_ref")))
        words = f"{rate} times the reference length over twice the airspeed"
        writer.variable(hat, hat, "nd", words, calculation=Expression("divide", (product, doubled)))
    return inputs


def _parameters(writer: _Writer) -> None:
    model = writer.model
    sigma = None if model.covariance is None else np.sqrt(np.diagonal(model.covariance))
    for name in model.names:
        writer.ids[name] = writer.unique(name)
    ids = list(writer.ids.values())
    for i, (name, (_, term)) in enumerate(zip(model.names, model.terms, strict=True)):
        words = f"Parameter {name}" + (", assumed" if name in model.assumed else "")
        element = writer.variable(ids[i], name, _units(term), words, value=float(model.values[i]))
        if sigma is None or model.covariance is None or not sigma[i] > 0.0:
            continue
        uncertainty = SubElement(element, "uncertainty", effect="additive")
        pdf = SubElement(uncertainty, "normalPDF", numSigmas="1")
        SubElement(pdf, "bounds").text = repr(float(sigma[i]))
        others = [j for j in range(len(ids)) if sigma[j] > 0.0 and model.covariance[i, j] != 0.0]
        for j in others:
            if j > i:
                SubElement(pdf, "correlatesWith", varID=ids[j])
        for j in others:
            if j < i:
                r = float(model.covariance[i, j] / (sigma[i] * sigma[j]))
                SubElement(pdf, "correlation", varID=ids[j], corrCoef=repr(r))


def _coefficient(writer: _Writer, coefficient: str) -> None:
    products = []
    for (c, term), id in zip(writer.model.terms, writer.ids.values(), strict=True):
        if c == coefficient:
            factors = tuple(_factor(f) for f in term.factors)
            value = variable(id)
            products.append(Expression("times", (value, *factors)) if factors else value)
    whole = products[0] if len(products) == 1 else Expression("plus", tuple(products))
    name, sign = _OUTPUT_OF[coefficient]
    writer.variable(
        f"total_{coefficient}", name, "nd", f"{coefficient}, at the moment reference point",
        sign=sign, calculation=whole, marks=("isOutput", "isStdAIAA"),
    )  # fmt: skip


def _factor(f: Factor) -> Expression:
    x = variable(f.table or f.variable)
    zero = number(0.0)
    if f.kind == "abs":
        x = Expression("abs", (x,))
    elif f.kind == "ramp":
        x = Expression("max", (Expression("minus", (x, number(f.knot))), zero))
    elif f.kind == "sign":
        below, above = Expression("lt", (x, zero)), Expression("gt", (x, zero))
        x = Expression("piecewise", (number(-1.0), below, number(1.0), above, zero))
    return x if f.power == 1 else Expression("power", (x, number(float(f.power))))


def _function(root: Element, name: str, table: LookupTable) -> None:
    element = SubElement(root, "function", name=name)
    beyond = "neither" if table.outside == "hold" else "both"
    for v in table.variables:
        SubElement(element, "independentVarRef", varID=v, extrapolate=beyond, interpolate="linear")
    SubElement(element, "dependentVarRef", varID=name)
    SubElement(SubElement(element, "functionDefn"), "griddedTableRef", gtID=f"{name}_table")


def _units(term: Term) -> str:
    """Of a parameter: what makes the product dimensionless, in S-119's way."""
    angle = sum(
        f.power for f in term.factors
        if f.kind in ("plain", "abs", "ramp") and f.variable in _ANGLES
    )  # fmt: skip
    speed = sum(f.power for f in term.factors if f.kind != "table" and f.variable == "V")
    top = "" if not speed else "s" + (str(speed) if speed > 1 else "")
    under = ["m" + (str(speed) if speed > 1 else "")] if speed else []
    under += ["rad" + (str(angle) if angle > 1 else "")] if angle else []
    return top + "".join(f"_{u}" for u in under) or "nd"


_ANGLES: Mapping[str, str] = dict.fromkeys(("alpha", "beta", "de", "da", "dr", "df"), "rad")


def _clean(text: str) -> str:
    """Without what XML cannot hold."""
    return "".join(c if c in "\n\t" or c.isprintable() else "?" for c in text)
