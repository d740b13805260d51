"""A linear pilot in the loop: holds an entry condition, or flies after references."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.simulate.airframe import CONTROLS

SIGHTS = ("V", "alpha", "beta", "p", "q", "r", "phi", "theta", "psi", "h")


@dataclass(frozen=True)
class Pilot:
    """Deflection = given one + gain (reference - what he sees), within the limits.

    gains: by (control, sight), in rad (throttle: 1) per rad, rad/s, m/s or m; sights: V alpha beta
    (against the air), p q r, phi theta psi, h. references: what he wants to see, (n,) or one
    number. limits: (lowest, highest) of each control, default 30 deg either way, throttle 0 to 1.
    active: (n,) of bool, from this sample to the next, or one for all. He looks once per
    integration step, and his deflection stays until the next.
    """

    gains: Mapping[tuple[str, str], float]
    references: Mapping[str, Array | float]
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    active: Array | bool = True

    def arguments(self, n: int) -> dict[str, Any]:
        """What the core's `fly` takes of him for n samples; raises BadInput for unknown names."""
        gains = np.zeros((len(CONTROLS), len(SIGHTS)))
        for (control, sight), gain in self.gains.items():
            _known("control", control, CONTROLS)
            _known("sight", sight, SIGHTS)
            if sight not in self.references or not np.isfinite(gain):
                raise refuse(
                    "pilot",
                    where=f"pilot, {control} by {sight}",
                    expected="a finite gain, and a reference of what he sees",
                    found=f"gain {gain:g}, references of {', '.join(self.references) or 'nothing'}",
                    do="Give both.",
                )
            gains[CONTROLS.index(control), SIGHTS.index(sight)] = gain
        references = np.zeros((n, len(SIGHTS)))
        for sight, value in self.references.items():
            _known("sight", sight, SIGHTS)
            references[:, SIGHTS.index(sight)] = value
        limits = np.array([[-np.pi / 6.0, np.pi / 6.0]] * 4 + [[0.0, 1.0]])
        for control, pair in self.limits.items():
            _known("control", control, CONTROLS)
            limits[CONTROLS.index(control)] = pair
        active = np.empty(n, dtype=np.bool_)
        active[:] = self.active
        return {"gains": gains, "limits": limits, "references": references, "active": active}


def _known(kind: str, name: str, names: tuple[str, ...]) -> None:
    if name not in names:
        raise refuse(
            f"unknown_{kind}",
            where="pilot",
            expected=f"one of {', '.join(names)}",
            found=f"'{name}'",
            do="Correct the name.",
        )
