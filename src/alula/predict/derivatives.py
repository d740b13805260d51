"""What every predictor returns: derivatives with a standard deviation and its reason."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

# 'stability': rates and moments along stability axes; 'model': along body axes, as models have
# them. Drag and lift are along stability axes in both.
PredictionAxes = Literal["stability", "model"]


@dataclass(frozen=True)
class Estimate:
    """A predicted derivative. se: one standard deviation; source: method and why this se."""

    value: float
    se: float
    source: str


@dataclass(frozen=True)
class Derivatives:
    """Predicted derivatives by name (docs/notation.md), per radian.

    Rates are normalized (pb/2V, qc/2V, rb/2V), moments are about the aircraft's reference point
    unless `conditions` says otherwise. method: its name. conditions: alpha_deg, mach, panels and
    the like, as text for the report; 'alpha_deg' is what `axes` are changed with. notes: what lies
    outside a formula's range, in words.
    """

    method: str
    values: Mapping[str, Estimate]
    conditions: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    axes: PredictionAxes = "stability"
