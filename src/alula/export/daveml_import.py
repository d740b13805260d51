"""A DAVE-ML model as an AeroModel: the coefficients expanded into sums of products."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, note, refuse
from alula.export.daveml_expand import Expander
from alula.export.daveml_model import DaveModel, DaveVariable
from alula.export.daveml_names import (
    ALIASES,
    INPUTS,
    OUTPUTS,
    POINT_NAMES,
    REFERENCE,
    sign_of,
    unit_scale,
)
from alula.export.daveml_polynomial import (
    Monomial,
    Polynomial,
    Value,
    add,
    constant,
    scaled,
    single,
    tidy,
)
from alula.export.daveml_tables import Tables
from alula.model import AXES, VARIABLES, AeroModel, Factor, Reference, aero_model
from alula.model.aero_model import Axes
from alula.model.terms import product

_SI = {"V": "m/s", "p": "rad/s", "q": "rad/s", "r": "rad/s", "dt": "1", "mach": "1"}


@dataclass(frozen=True)
class Imported:
    """The model, and what the user should know of the import."""

    model: AeroModel
    messages: tuple[Message, ...]


def import_daveml(
    dave: DaveModel,
    *,
    names: Mapping[str, str] | None = None,
    reference: Reference | None = None,
    reference_point: Array | None = None,
    outputs: Sequence[str] | None = None,
) -> Imported:
    """The aerodynamic model of a DAVE-ML file, in SI, radians and Alula's signs.

    names: variable, 'p', 'q', 'r' or coefficient of Alula by varID, for signals that bear no name
    of AIAA S-119. reference: where the file has no reference area, span and chord, S m2, b m, c m.
    reference_point: (3,) m, where the file's moments act, in the aircraft file's datum frame.
    outputs: coefficients to take, default all. Raises BadInput by the name of what cannot be
    expanded.
    """
    given = dict(names or {})
    for name in given:
        dave.by_name(name)
    geometry = _reference(dave, reference)
    lengths = {"p": geometry.b, "q": geometry.c, "r": geometry.b}
    expander, tables = Expander(lengths, dave.path), Tables(dave.path)
    messages: list[Message] = list(dave.messages)
    wanted = _coefficients(dave, given, outputs)
    needed = _needed(dave, list(wanted.values()))
    made = {f.output: f for f in dave.functions}
    limits: dict[str, tuple[float, float]] = {}
    for name in dave.order():
        if name not in needed:
            continue
        v = dave.variables[name]
        if v.is_input:
            expander.polynomials[name] = _input(v, given, dave.path, limits, messages)
            continue
        if v.low is not None or v.high is not None:
            raise _limited(v, dave.path)
        if name in made:
            f = made[name]
            arguments = [expander.polynomials[a.id] for a in f.axes]
            expander.polynomials[name] = single(tables.factor(f, arguments))
        elif v.calculation is not None:
            expander.polynomials[name] = tidy(expander.variable(name, v.calculation))
        else:
            expander.polynomials[name] = _constant(v)
    return _assembled(dave, expander, tables, wanted, geometry, reference_point, limits, messages)


def _assembled(
    dave: DaveModel,
    expander: Expander,
    tables: Tables,
    wanted: Mapping[str, str],
    geometry: Reference,
    reference_point: Array | None,
    limits: dict[str, tuple[float, float]],
    messages: list[Message],
) -> Imported:
    formulas: dict[str, str] = {}
    values: dict[str, Value] = {}
    used: set[str] = set()
    for coefficient, name in wanted.items():
        v = dave.variables[name]
        where = f"{dave.path}, variableDef '{name}'"
        unit_scale(v.units or "nd", "1", where)
        whole: Polynomial = {}
        for m, value in expander.polynomials[name].items():
            whole = add(whole, {tables.without_signs(m): value})
        terms = []
        for monomial, value in scaled(whole, sign_of(v, coefficient, where)).items():
            term = product(_factors(monomial, where))
            used |= {f.table for f in term.factors if f.table}
            terms.append(term.formula)
            values[term.name(coefficient)] = value
        if terms:
            formulas[coefficient] = " + ".join(terms)
    kept = {n: t for n, t in tables.tables.items() if n in used}
    for table in kept.values():
        if table.outside == "hold":
            for variable, b in zip(table.variables, table.breakpoints, strict=True):
                low, high = limits.get(variable, (-np.inf, np.inf))
                limits[variable] = (max(low, float(b[0])), min(high, float(b[-1])))
    model = aero_model(
        dave.header.get("name") or Path(dave.path).stem,
        formulas,
        {n: v.value for n, v in values.items()},
        geometry,
        axes="stability" if {"CD", "CL"} & set(wanted) else "body",
        covariance=_covariance(dave, list(values.values())),
        reference_point=_point(dave) if reference_point is None else reference_point,
        validity={n: r for n, r in limits.items() if np.isfinite(r).all()},
        provenance={
            "file": Path(dave.path).name,
            "sha256": dave.sha256,
            **{k: v for k, v in dave.header.items() if k != "name"},
        },
        tables=kept,
    )
    return Imported(model, tuple(messages))


def _reference(dave: DaveModel, given: Reference | None) -> Reference:
    found: dict[str, float] = {}
    for v in dave.variables.values():
        if v.name in REFERENCE and v.initial is not None:
            key, si = REFERENCE[v.name]
            scale = unit_scale(v.units, si, f"{dave.path}, variableDef '{v.id}'")
            found[key] = v.initial * scale
    if given is not None:
        return given
    missing = sorted({"S", "b", "c"} - found.keys())
    if missing:
        raise refuse(
            "daveml_reference",
            where=dave.path,
            expected=", ".join(REFERENCE),
            found=f"no {' and no '.join(missing)}",
            do="Give the reference area, span and chord yourself.",
        )
    return Reference(found["S"], found["b"], found["c"])


def _point(dave: DaveModel) -> Array | None:
    """Where the file itself, one of Alula's, says that the moments act."""
    found = {v.name: v.initial for v in dave.variables.values()}
    point = [found.get(name) for name in POINT_NAMES]
    return None if None in point else np.array(point, dtype=np.float64)


def _coefficients(
    dave: DaveModel, given: Mapping[str, str], outputs: Sequence[str] | None
) -> dict[str, str]:
    """varID by coefficient, in the order of the axes."""
    known = {name: c for name, (c, _) in OUTPUTS.items()} | ALIASES
    found = {}
    for v in dave.variables.values():
        if v.is_input:
            continue
        c = given.get(v.id) or given.get(v.name) or (known.get(v.name) if v.is_output else None)
        if c is not None and (outputs is None or c in outputs):
            found[c] = v.id
    axes: Axes = "stability" if {"CD", "CL"} & found.keys() else "body"
    wrong = [c for c in found if c not in AXES[axes]]
    missing = [c for c in outputs or () if c not in found]
    if not found or wrong or missing:
        raise refuse(
            "daveml_outputs",
            where=dave.path,
            expected=f"outputs of one set of axes, named as {', '.join(OUTPUTS)}",
            found=f"{', '.join(found) or 'none'}" + (f"; no {', '.join(missing)}" * bool(missing)),
            do="Name the outputs by varID (names), or choose those of one set of axes (outputs).",
        )
    return {c: found[c] for c in AXES[axes] if c in found}


def _needed(dave: DaveModel, roots: list[str]) -> set[str]:
    made = {f.output: f for f in dave.functions}
    needed: set[str] = set()
    todo = list(roots)
    while todo:
        name = todo.pop()
        if name in needed:
            continue
        needed.add(name)
        v = dave.variables[name]
        if name in made:
            todo += [a.id for a in made[name].axes]
        elif v.calculation is not None:
            todo += v.calculation.names()
    return needed


def _input(
    v: DaveVariable,
    given: Mapping[str, str],
    file: str,
    limits: dict[str, tuple[float, float]],
    messages: list[Message],
) -> Polynomial:
    where = f"{file}, variableDef '{v.id}'"
    meaning = given.get(v.id) or given.get(v.name) or INPUTS.get(v.name, ("",))[0]
    if meaning not in (*VARIABLES, "p", "q", "r"):
        raise refuse(
            "daveml_inputs",
            where=where,
            expected=f"an input named as {', '.join(INPUTS)}",
            found=f"'{v.name}'",
            do=f"Name it: names = {{'{v.id}': 'alpha'}} or another variable of Alula.",
        )
    si = _SI.get(meaning, "1" if meaning.endswith("hat") else "rad")
    factor = sign_of(v, meaning, where) / unit_scale(v.units, si, where)
    if v.low is not None or v.high is not None:
        ends = sorted(
            x / factor
            for x in (-np.inf if v.low is None else v.low, np.inf if v.high is None else v.high)
        )
        limits[meaning] = (ends[0], ends[1])
        messages.append(
            note(
                "daveml_limit",
                where=where,
                expected="inputs without limits: an aerodynamic model has a range of validity",
                found=f"{meaning} held to {ends[0]:g} to {ends[1]:g}",
                do="Outside that range the model goes on where the file stands still.",
            )
        )
    return single(Factor(meaning), factor)


def _constant(v: DaveVariable) -> Polynomial:
    value = 0.0 if v.initial is None else v.initial
    uncertain = v.uncertainty is not None and v.uncertainty.sigma is not None
    return constant(value, {v.id: 1.0} if uncertain else {})


def _factors(monomial: Monomial, where: str) -> list[Factor]:
    out = []
    for f, power in monomial:
        if f.variable not in VARIABLES or not 1 <= power <= 9:
            raise refuse(
                "daveml_not_a_model",
                where=where,
                expected="rates in pb/2V, qc/2V, rb/2V and powers from 1 to 9",
                found=f"'{f.formula}' to the power {power}",
                do="This output cannot become terms of an aerodynamic model.",
            )
        out.append(replace(f, power=power))
    return out


def _covariance(dave: DaveModel, values: list[Value]) -> Array | None:
    """Of the values, from the uncertain constants they are made of; None where none is."""
    ids = sorted({n for v in values for n in v.slopes})
    if not ids:
        return None
    of = {n: dave.variables[n].uncertainty for n in ids}
    sigma = np.array([_sigma(dave.variables[n]) for n in ids])
    correlation = np.eye(len(ids))
    for i, n in enumerate(ids):
        u = of[n]
        for other, r in (u.correlations if u else {}).items():
            if other in ids:
                correlation[i, ids.index(other)] = correlation[ids.index(other), i] = r
    slopes = np.array([[v.slopes.get(n, 0.0) for n in ids] for v in values])
    spread = slopes * sigma
    found = spread @ correlation @ spread.T
    return np.asarray((found + found.T) / 2.0)


def _sigma(v: DaveVariable) -> float:
    u = v.uncertainty
    if u is None or u.sigma is None:
        return 0.0
    return abs(v.initial or 0.0) * u.sigma / 100.0 if u.effect == "percentage" else u.sigma


def _limited(v: DaveVariable, file: str) -> BadInput:
    return refuse(
        "daveml_not_a_model",
        where=f"{file}, variableDef '{v.id}'",
        expected="limits on inputs only",
        found=f"minValue {v.low}, maxValue {v.high}",
        do="This output cannot become terms of an aerodynamic model.",
    )
