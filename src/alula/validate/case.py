"""What validation needs of one maneuver."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from alula.base.arrays import Array
from alula.flight import Motion
from alula.simulate import Airframe
from alula.validate.result import Seen


@dataclass(frozen=True)
class Case:
    """One maneuver to fly through a model.

    motion: as reconstructed, at the center of gravity. airframe: mass properties and line of
    thrust at its start. area: m2, of the measured coefficients. thrust: (n,) N of all engines at
    motion.t, None for none. coefficients: (n,) each as measured, by name; for coefficients that the
    model lacks and for offsets. variables: (n,) each, the regressors as the estimate takes them.
    missing: channels of the motion that were not recorded. force: (n, 3) N of all engines in body
    axes, to check that the forces close; None where the thrust is not known.
    """

    motion: Motion
    airframe: Airframe
    seen: Seen
    area: float
    thrust: Array | None = None
    coefficients: Mapping[str, Array] = field(default_factory=dict)
    variables: Mapping[str, Array] = field(default_factory=dict)
    missing: tuple[str, ...] = ()
    force: Array | None = None
