"""From an identification to the AeroModel that later stages fly, predict and export."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.coefficients import CoefficientData
from alula.identify.result import Identification, Parameter
from alula.identify.typical import constant_name
from alula.model import AeroModel, Reference, aero_model, parse
from alula.model.stall import Stall


def identified_model(
    result: Identification,
    name: str,
    reference: Reference,
    *,
    data: Sequence[CoefficientData] = (),
    constant_of: str | None = None,
    axes: Literal["body", "stability"] | None = None,
    reference_point: Array | None = None,
    provenance: Mapping[str, str] | None = None,
) -> AeroModel:
    """The model that was identified, with its covariance.

    constant_of: the maneuver whose constant terms to take, where maneuvers have their own; None
    takes their mean. axes: None for those of the result's coefficients; where both sets are there,
    stability axes. data: what was identified from; the range of each variable becomes the model's
    range of validity. Terms that were fixed or tied to others come with these values. A parameter
    that nothing excited is left out, and the provenance says so. A stall becomes the model's
    `stall`. Raises BadInput where parameters are tied to one another by the data, or the flight did
    not tell some parameter of a stall: then no values exist to choose.
    """
    asked = dict(result.formulas) or {c: fit.formula for c, fit in result.fits.items()}
    chosen = axes or ("stability" if {"CD", "CL"} & asked.keys() else "body")
    foreign = {"CX", "CZ"} if chosen == "stability" else {"CD", "CL"}
    tied = [p.name for p in result.parameters if p.tied_to and p.coefficient not in foreign]
    if tied:
        raise refuse(
            "not_identifiable",
            where=f"model '{name}'",
            expected="a value for every term",
            found=f"{', '.join(tied)} are known only in combination",
            do="Take one of the tied terms out of the formula, or add a maneuver that parts them.",
        )
    formulas: dict[str, str] = {}
    rows: dict[str, Array] = {}
    held: dict[str, float] = {}
    left_out = []
    for coefficient, formula in asked.items():
        if coefficient in foreign:
            continue
        kept = []
        for term in parse(formula):
            label = term.name(coefficient)
            source, factor = result.tied.get(label, (label, 1.0))
            row: Array | None = np.zeros(len(result.parameters))
            if source in result.fixed:
                held[label] = factor * result.fixed[source]
            else:
                constant = source == constant_name(coefficient)
                row = _row(result.parameters, source, constant, constant_of)
            if row is None:
                left_out.append(label)
            else:
                kept.append(term.formula)
                rows[label] = factor * row
        if kept:
            formulas[coefficient] = " + ".join(kept)
    if not rows:
        raise refuse(
            "not_identifiable",
            where=f"model '{name}'",
            expected="at least one parameter with a value",
            found=result.status,
            do="Without an estimate there is no model to write.",
        )
    transform = np.vstack(list(rows.values()))
    used = np.flatnonzero(np.any(transform != 0.0, axis=0))
    transform = transform[:, used]
    values = transform @ np.array([result.parameters[i].value for i in used])
    values += np.array([held.get(label, 0.0) for label in rows])
    origin = {"method": result.method, **(provenance or {})}
    if held:
        origin["not estimated"] = "fixed: " + ", ".join(held)
    if left_out:
        origin["left out"] = "not excited: " + ", ".join(left_out)
    return aero_model(
        name,
        formulas,
        dict(zip(rows, values.tolist(), strict=True)),
        reference,
        axes=chosen,
        covariance=transform @ result.covariance[np.ix_(used, used)] @ transform.T,
        reference_point=reference_point,
        validity=_ranges(data),
        provenance=origin,
        stall=_stall(result, name),
    )


def _stall(result: Identification, name: str) -> Stall | None:
    """The separation of an identified stall, of the whole wing."""
    if result.method != "stall":
        return None
    values = {p.name: p.value for p in result.parameters} | dict(result.fixed)
    unknown = [n for n in ("a1", "alpha_star", "tau1", "tau2") if not np.isfinite(values[n])]
    if unknown:
        raise refuse(
            "not_identifiable",
            where=f"model '{name}', stall",
            expected="a value for every parameter of the stall",
            found=f"none for {', '.join(unknown)}",
            do="Fly dynamic stalls beside quasi-steady ones, or state it: fixed.",
        )
    return Stall(
        a1=values["a1"],
        alpha_star=values["alpha_star"],
        tau1=values["tau1"],
        tau2=values["tau2"],
        CL_alpha=values["CL_alpha"],
        alpha_0=-values["CL_0"] / values["CL_alpha"],
        CD_X=values.get("CD_X", 0.0),
        Cm_X=values.get("Cm_X", 0.0),
    )


def _row(
    parameters: Sequence[Parameter], label: str, constant: bool, constant_of: str | None
) -> Array | None:
    """Weights (k,) of the result's parameters that make up one of the model's; None if unknown."""
    own = [i for i, p in enumerate(parameters) if p.name == label]
    if constant and not own:
        every = [i for i, p in enumerate(parameters) if p.name.startswith(f"{label}[")]
        own = [i for i in every if parameters[i].name == f"{label}[{constant_of}]"] or every
    if not own or any(parameters[i].verdict == "not_identifiable" for i in own):
        return None
    row = np.zeros(len(parameters))
    row[own] = 1.0 / len(own)
    return row


def _ranges(data: Sequence[CoefficientData]) -> dict[str, tuple[float, float]]:
    names = list(dict.fromkeys(name for item in data for name in item.variables))
    return {
        name: (
            min(float(item.variables[name].min()) for item in data if name in item.variables),
            max(float(item.variables[name].max()) for item in data if name in item.variables),
        )
        for name in names
    }
