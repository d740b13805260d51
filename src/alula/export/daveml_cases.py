"""Check cases of an exported model: points spread over its validity, and what must come out."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

import numpy as np

from alula.base.arrays import Array
from alula.export.daveml_names import INPUTS, OUTPUTS
from alula.model import AeroModel

# Where the model states no range: what subsonic aircraft meet (SI, rad).
_RANGES: dict[str, tuple[float, float]] = {
    "V": (15.0, 150.0), "alpha": (-0.1, 0.3), "beta": (-0.2, 0.2), "p": (-1.0, 1.0),
    "q": (-0.5, 0.5), "r": (-0.5, 0.5), "de": (-0.35, 0.35), "da": (-0.35, 0.35),
    "dr": (-0.35, 0.35), "df": (0.0, 0.5), "dt": (0.0, 1.0), "mach": (0.05, 0.8),
}  # fmt: skip
_TOLERANCE = 1e-10  # of one, or of the largest product: rounding of sums in another order


def spread_points(model: AeroModel, count: int, seed: int = 0) -> dict[str, Array]:
    """Points (count,) of V, p, q, r and every other variable, inside the model's validity."""
    random = np.random.default_rng(seed)
    return {
        name: random.uniform(*(model.validity.get(name, usual)), size=count)
        for name, usual in _RANGES.items()
    }


def model_variables(model: AeroModel, points: dict[str, Array]) -> dict[str, Array]:
    """The variables of a model at points with V, p, q, r in m/s and rad/s."""
    r, V = model.reference, points["V"]
    lengths = {"p": r.b, "q": r.c, "r": r.b}
    hats = {f"{n}hat": points[n] * length / (2.0 * V) for n, length in lengths.items()}
    return {**{n: x for n, x in points.items() if n not in lengths}, **hats}


def add_cases(root: Element, model: AeroModel, inputs: list[str], count: int) -> None:
    """Append `checkData` of `count` static shots."""
    if count < 1 or not inputs:
        return
    points = spread_points(model, count)
    points = {n: np.array([float(f"{x:.6g}") for x in v]) for n, v in points.items()}
    found = model.evaluate(model_variables(model, points))
    names = {meaning: (name, units) for name, (meaning, units, _) in INPUTS.items()}
    outputs = {c: name for name, (c, _) in OUTPUTS.items()}
    data = SubElement(root, "checkData")
    for i in range(count):
        shot = SubElement(data, "staticShot", name=f"Point {i + 1}")
        given = SubElement(shot, "checkInputs")
        for meaning in inputs:
            _signal(given, *names[meaning], float(points[meaning][i]))
        out = SubElement(shot, "checkOutputs")
        for c in model.coefficients:
            value = float(found[c][i])
            _signal(out, outputs[c], "nd", value, _TOLERANCE * max(1.0, abs(value)))


def _signal(
    parent: Element, name: str, units: str, value: float, tolerance: float | None = None
) -> None:
    signal = SubElement(parent, "signal")
    SubElement(signal, "signalName").text = name
    SubElement(signal, "signalUnits").text = units
    SubElement(signal, "signalValue").text = repr(value)
    if tolerance is not None:
        SubElement(signal, "tol").text = repr(tolerance)
