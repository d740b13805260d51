"""Alula's own predictions as sources: the JSON of `alula predict`, or an aircraft file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from math import degrees
from typing import Any

import numpy as np

from alula.base.arrays import frozen
from alula.base.messages import BadInput
from alula.campaign.predict import Asked, run_prediction
from alula.campaign.sources.stated import Stated, not_a_table
from alula.identify.compare import Entry
from alula.model import AeroModel, Reference
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.to_model import to_model

SCHEMA = "alula.prediction/1"
SE_IS = "of the prediction: methods, mesh, published accuracy"


def from_json(tree: Mapping[str, Any], name: str, where: str) -> tuple[Stated, AeroModel | None]:
    """A prediction's envelope. Raises BadInput for one without derivatives."""
    try:
        found = tree["result"]
        alpha = _number(found["condition"]["alpha"])
        r = found["reference"]
        reference = Reference(*(_number(r[k]) for k in "Sbc"))
        point = frozen(np.array([_number(x) for x in found["reference_point"]]))
        axes = {"stability": "stability", "body": "model"}[found["axes"]]
        values = dict(_estimate(p) for p in found["derivatives"])
        method = str(found["method"])
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        words = f"{type(error).__name__}: {error}"[:120]
        do = "Predict anew: alula predict AIRCRAFT --json FILE."
        raise not_a_table(where, f"JSON of schema {SCHEMA} with derivatives", words, do) from None
    if point.shape != (3,) or min(reference.S, reference.b, reference.c) <= 0.0 or not values:
        raise not_a_table(where, "derivatives with reference and point", "some missing")
    told = Derivatives(method, values, {"alpha_deg": f"{degrees(alpha)!r}"}, (), axes)  # type: ignore[arg-type]
    try:
        model = to_model(told, reference, point, name=name)
    except BadInput:  # not of the whole aircraft: it is compared, not flown
        model = None
    return _stated(told, name, alpha, reference, point), model


def from_aircraft(path: str, methods: Sequence[str], asked: Asked) -> list[tuple[Stated, Any]]:
    """Predicted now, one source for each method."""
    out = []
    for method in methods or ("combined",):
        found = run_prediction(path, _with(asked, method))
        stated = _stated(
            found.derivatives, f"{method}", found.alpha, found.reference,
            found.aircraft.reference_point,
        )  # fmt: skip
        out.append((stated, found.model))
    return out


def _with(asked: Asked, method: str) -> Asked:
    from dataclasses import replace

    return replace(asked, method=method)


def _stated(told: Derivatives, name: str, alpha: float, reference: Reference, point: Any) -> Stated:
    entries = {n: Entry(e.value, e.se) for n, e in told.values.items()}
    return Stated(
        name, "prediction", told.method, entries, told.axes, alpha, reference, point, se_is=SE_IS
    )


def _estimate(p: Mapping[str, Any]) -> tuple[str, Estimate]:
    name, value, se = str(p["name"]), _number(p["value"]), _number(p["se"])
    for ending, power in (("_per_deg2", 2), ("_per_deg", 1)):
        if name.endswith(ending):
            factor = degrees(1.0) ** power
            return name.removesuffix(ending), Estimate(factor * value, factor * se, "")
    return name, Estimate(value, se, "")


def _number(given: Any) -> float:
    if isinstance(given, bool) or not isinstance(given, (int, float)):
        raise ValueError(f"not a number: {given!r:.40}")
    value = float(given)
    if not math.isfinite(value):
        raise ValueError("not finite")
    return value
