"""What a method of identification is given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from alula.base.messages import Message
from alula.identify import CoefficientData, Reference
from alula.identify.flown.carried import Shifts
from alula.identify.flown.measured_maneuver import MeasuredManeuver

Measured = tuple[tuple[MeasuredManeuver, ...], tuple[Message, ...], list[Shifts]]


@dataclass(frozen=True)
class IdentifyTask:
    """All that a method may ask for.

    data: coefficients of each maneuver. measure: readings of each maneuver, made when they are
    wanted. models: formula by coefficient. reference: of the aircraft. seed: of what is random.
    """

    data: tuple[CoefficientData, ...]
    measure: Callable[[], Measured]
    models: Mapping[str, str]
    reference: Reference
    options: Mapping[str, Any] = field(default_factory=dict)
    truth: Mapping[str, float] | None = None
    seed: int = 0
