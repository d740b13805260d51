"""Reads a DAVE-ML file (AIAA S-119-2011, DAVE-ML 2.0, and its earlier element names)."""

from __future__ import annotations

import hashlib
from pathlib import Path
from xml.etree.ElementTree import Element

from alula.base.messages import Message, refuse, warn
from alula.base.units import find_unit
from alula.export.daveml_elements import (
    number,
    numbers,
    optional_number,
    plain_units,
    text_of,
    wrong,
)
from alula.export.daveml_expression import Expression, from_mathml
from alula.export.daveml_functions import read_function
from alula.export.daveml_model import (
    CheckCase,
    CheckSignal,
    DaveModel,
    DaveVariable,
    Uncertainty,
)
from alula.export.daveml_table import GriddedFunction
from alula.export.safe_xml import parse_xml, read_xml


def read_daveml(path: Path | str) -> DaveModel:
    """The model in a DAVE-ML file.

    Raises BadInput naming the file and the element: what is no XML or not safe, no DAVEfunc,
    ungridded tables, splines, references to what is not there, tables of the wrong size.
    """
    path = Path(path)
    root = read_xml(path)
    return _model(root, str(path), hashlib.sha256(path.read_bytes()).hexdigest())


def parse_daveml(text: str, where: str = "DAVE-ML text") -> DaveModel:
    """The model in a text; see `read_daveml`."""
    data = text.encode()
    return _model(parse_xml(data, where), where, hashlib.sha256(data).hexdigest())


def _model(root: Element, where: str, sha256: str) -> DaveModel:
    if root.tag != "DAVEfunc":
        raise wrong(where, "<DAVEfunc> as the outermost element", f"<{root.tag}>")
    if root.find(".//ungriddedTableDef") is not None or root.find(".//ungriddedTable") is not None:
        raise refuse(
            "daveml_ungridded",
            where=where,
            expected="gridded tables",
            found="an ungridded table",
            do="Interpolate it to a grid; scattered points have no one interpolation.",
        )
    messages: list[Message] = []
    variables = {}
    functions = [read_function(e, root, where) for e in root.findall("function")]
    made = {f.output for f in functions}
    for element in root.findall("variableDef"):
        v = _variable(element, where, made)
        if v.id in variables:
            raise wrong(f"{where}, variableDef '{v.id}'", "each varID once", "it twice")
        variables[v.id] = v
    _check_references(variables, functions, where)
    cases = tuple(
        _case(e, variables, where, messages) for e in root.findall("checkData/staticShot")
    )
    header = root.find("fileHeader")
    return DaveModel(
        path=where,
        sha256=sha256,
        header={} if header is None else _header(header),
        references={
            e.get("refID", ""): ", ".join(
                x for x in (e.get("author"), e.get("title"), e.get("accession"), e.get("date")) if x
            )
            for e in root.findall("fileHeader/reference")
        },
        modifications={
            e.get("modID", ""): f"{e.get('date', '')}: {text_of(e.find('description'))}"
            for e in root.findall("fileHeader/modificationRecord")
        },
        variables=variables,
        functions=tuple(functions),
        cases=cases,
        messages=tuple(messages),
    )


def _header(element: Element) -> dict[str, str]:
    author = element.find("author")
    date = element.find("creationDate")
    date = element.find("fileCreationDate") if date is None else date
    found = {
        "name": element.get("name", ""),
        "author": "" if author is None else f"{author.get('name', '')}, {author.get('org', '')}",
        "date": "" if date is None else date.get("date", ""),
        "version": text_of(element.find("fileVersion")),
        "description": text_of(element.find("description")),
    }
    return {k: v for k, v in found.items() if v}


def _variable(element: Element, where: str, made: set[str]) -> DaveVariable:
    name = element.get("varID", "")
    at = f"{where}, variableDef '{name}'"
    math_element = element.find("calculation/math")
    calculation: Expression | None = None
    if math_element is not None:
        calculation = from_mathml(math_element, at)
    if calculation is not None and name in made:
        raise wrong(at, "a calculation or a function", "both")
    initial = optional_number(element, "initialValue", at)
    marked = any(element.find(t) is not None for t in ("isInput", "isControl", "isDisturbance"))
    return DaveVariable(
        id=name,
        name=element.get("name", ""),
        units=element.get("units", ""),
        sign=element.get("sign", ""),
        description=text_of(element.find("description")),
        initial=initial,
        low=optional_number(element, "minValue", at),
        high=optional_number(element, "maxValue", at),
        calculation=calculation,
        # files before 2.0 mark no inputs: what nothing gives is one
        is_input=marked or (calculation is None and initial is None and name not in made),
        is_output=element.find("isOutput") is not None,
        is_standard=element.find("isStdAIAA") is not None,
        uncertainty=_uncertainty(element.find("uncertainty"), at),
    )


def _uncertainty(element: Element | None, where: str) -> Uncertainty | None:
    if element is None:
        return None
    normal = element.find("normalPDF")
    shape = element.find("uniformPDF") if normal is None else normal
    if shape is None:
        raise wrong(where, "normalPDF or uniformPDF in <uncertainty>", "neither")
    bounds = tuple(
        float(x) for b in shape.findall("bounds") for x in numbers(b.text or "", where).tolist()
    )
    sigma = None
    if normal is not None and len(bounds) == 1:
        sigma = bounds[0] / number(normal.get("numSigmas", "1"), where)
    return Uncertainty(
        effect=element.get("effect", ""),
        sigma=sigma,
        bounds=bounds,
        correlations={
            e.get("varID", ""): number(e.get("corrCoef", ""), where)
            for e in shape.findall("correlation")
        },
    )


def _check_references(
    variables: dict[str, DaveVariable], functions: list[GriddedFunction], where: str
) -> None:
    for v in variables.values():
        used = v.calculation.names() if v.calculation else set()
        if used - variables.keys():
            missing = ", ".join(sorted(used - variables.keys()))
            raise wrong(f"{where}, variableDef '{v.id}'", "variables of the file", f"'{missing}'")
    for f in functions:
        for name in (f.output, *(a.id for a in f.axes)):
            if name not in variables:
                raise wrong(f"{where}, function '{f.name}'", "variables of the file", f"'{name}'")


def _case(
    element: Element, variables: dict[str, DaveVariable], where: str, messages: list[Message]
) -> CheckCase:
    name = element.get("name", "")
    at = f"{where}, staticShot '{name}'"

    def signals(tag: str) -> tuple[CheckSignal, ...]:
        found = []
        for e in element.findall(f"{tag}/signal"):
            label = next(
                (text_of(e.find(t)) for t in ("varID", "signalID") if text_of(e.find(t))), ""
            )
            label = label or text_of(e.find("signalName"))
            v = variables.get(label) or next(
                (v for v in variables.values() if v.name == label), None
            )
            if v is None:
                messages.append(
                    warn(
                        "daveml_check_signal",
                        where=at,
                        expected="signals of the model",
                        found=f"'{label}'",
                        do="It is left out of the check.",
                    )
                )
                continue
            units = text_of(e.find("signalUnits")) or None
            tolerance = e.find("tol")
            factor = _factor(units, v.units, at)
            found.append(
                CheckSignal(
                    v.id,
                    v.units,
                    factor * number(text_of(e.find("signalValue")), at),
                    None if tolerance is None else factor * number(text_of(tolerance), at),
                )
            )
        return tuple(found)

    return CheckCase(
        name, signals("checkInputs"), signals("internalValues"), signals("checkOutputs")
    )


def _factor(units: str | None, wanted: str, where: str) -> float:
    """From the units of a check signal to those of the model's variable."""
    if units is None or units == wanted:
        return 1.0
    given, own = find_unit(plain_units(units)), find_unit(plain_units(wanted))
    if given is None or own is None or given.si != own.si or given.offset or own.offset:
        raise wrong(where, f"units '{wanted}'", f"'{units}'")
    return given.scale / own.scale
