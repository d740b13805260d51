"""Derivatives of strip theory at one angle of attack: slopes across a small step to either side.

Strips follow their polars through the stall, so a slope holds near its angle only; how far the
slopes to the two sides are apart goes into its standard error. Power off: no slipstream.
"""

from __future__ import annotations

from math import degrees, hypot, radians

import numpy as np

from alula.aircraft import Aircraft
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.strip_model import COEFFICIENTS, StripModel, strip_model

METHOD = "strip theory"
ACCURACY = 0.1  # assumed: relative, as of the lattice
# Polars are tables of one degree and more: smaller steps would see their corners.
STEPS = {
    "alpha": radians(1.0), "beta": radians(2.0), "phat": 0.02, "qhat": 0.005, "rhat": 0.02,
    "de": radians(3.0), "da": radians(3.0), "dr": radians(3.0), "df": radians(3.0),
}  # fmt: skip
_LABEL = {"phat": "p", "qhat": "q", "rhat": "r"}
_ALONG = (("CD", "CL", "Cm"), ("alpha", "qhat", "de", "df"))
_ASIDE = (("CY", "Cl", "Cn"), ("beta", "phat", "rhat", "da", "dr"))


def strip_derivatives(
    aircraft: Aircraft, alpha: float, V: float, strips: StripModel | None = None
) -> Derivatives:
    """Slopes at alpha (rad), along the axes of models, about the aircraft's reference point.

    V: m/s, said only. strips: as made by `strip_model`, which is called where it is None. CL_0,
    CD_0 and Cm_0 are the tangent's at zero alpha. Raises BadInput as `strip_model` does.
    """
    made = strip_model(aircraft) if strips is None else strips
    moved = _controls(aircraft)
    values: dict[str, Estimate] = {}
    for coefficients, variables in (_ALONG, _ASIDE):
        for variable in variables:
            if variable.startswith("d") and variable not in moved:
                continue
            step = STEPS[variable]
            at = np.array([-step, 0.0, step])
            angles = {"alpha": np.array(alpha), variable: at}
            found = made.evaluate({"alpha": alpha + at} if variable == "alpha" else angles)
            for c in coefficients:
                low, mid, high = map(float, found[c])
                slope = (high - low) / (2.0 * step)
                bend = abs(high - 2.0 * mid + low) / (2.0 * step)  # half the slopes' distance
                values[f"{c}_{_LABEL.get(variable, variable)}"] = Estimate(
                    slope,
                    hypot(ACCURACY * slope, bend),
                    f"strip theory without slipstream; se: {100 * ACCURACY:g} % assumed for the "
                    "method, half the distance of the slopes to either side",
                )
    here = made.evaluate({"alpha": np.array(alpha)})
    for c in _ALONG[0]:
        tangent = values[f"{c}_alpha"]
        zero = float(here[c][0]) - tangent.value * alpha
        se = hypot(ACCURACY * zero, tangent.se * alpha)
        values[f"{c}_0"] = Estimate(zero, se, f"{tangent.source}; the tangent's at zero alpha")
    ordered = {
        f"{c}_{label}": values[f"{c}_{label}"]
        for c in COEFFICIENTS
        for label in ("0", "alpha", "beta", "p", "q", "r", "de", "da", "dr", "df")
        if f"{c}_{label}" in values
    }
    conditions = {
        "alpha_deg": f"{degrees(alpha):.6g}",
        "V": f"{V:.6g} m/s, power off",
        "polars": "; ".join(f"{s.name}: {s.polar}" for s in made.surfaces),
    }
    return Derivatives(METHOD, ordered, conditions, axes="model")


def _controls(aircraft: Aircraft) -> set[str]:
    assert aircraft.geometry is not None  # `strip_model` has refused it
    return {n for s in aircraft.geometry.surfaces for c in s.controls for n in c.gains}
