"""A propeller's coefficients over the advance ratio, and what its models share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from alula.aircraft import Propeller
from alula.aircraft.blades import Blades
from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, Message, refuse, warn
from alula.core import core

REGIMES = ("inside", "standing", "reverse", "windmill", "unsolved")
_KNOTS = 24  # of the simulator's curves
_WHY = {
    "standing": "a propeller that turns",
    "reverse": "air from ahead, J at least 0",
    "windmill": "an engine that drives the propeller",
    "unsolved": "blades on which momentum and lift balance",
}


@dataclass(frozen=True)
class PropellerCurves:
    """CT = T/(rho n^2 D^4) and CP = P/(rho n^3 D^5) over J = V/(n D); all (k,), J increasing."""

    method: str
    J: Array
    CT: Array
    CP: Array
    notes: tuple[str, ...] = ()

    @property
    def eta(self) -> Array:
        """Efficiency J CT/CP; 0 at rest."""
        return frozen(np.where(self.J > 0.0, self.J * self.CT / self.CP, 0.0))

    def propeller(self, blades: Blades, inertia: float) -> tuple[Propeller, tuple[Message, ...]]:
        """The simulator's propeller, at most 24 points; inertia: kg m2 about its axis.

        Points are taken off the curve by monotone interpolation; a warning says where that costs
        more than 1 % of the largest coefficient.
        """
        if len(self.J) <= _KNOTS:
            return (
                Propeller(blades.diameter, inertia, blades.sense, self.J, self.CT, self.CP), ()
            )  # fmt: skip
        J = np.linspace(self.J[0], self.J[-1], _KNOTS)
        curves, worst = [], 0.0
        for values in (self.CT, self.CP):
            taken = PchipInterpolator(self.J, values)(J)
            error = np.max(np.abs(PchipInterpolator(J, taken)(self.J) - values))
            worst = max(worst, float(error / np.max(np.abs(values))))
            curves.append(frozen(taken))
        messages: tuple[Message, ...] = ()
        if worst > 0.01:
            messages = (
                warn(
                    "propeller_thinned",
                    where=blades.name,
                    expected=f"curves that {_KNOTS} points carry to 1 % of their largest value",
                    found=f"{100.0 * worst:.2g} %",
                    do="Compute them over a shorter range of J.",
                ),
            )
        return (
            Propeller(blades.diameter, inertia, blades.sense, frozen(J), curves[0], curves[1]),
            messages,
        )


def core_shape(blades: Blades, helix: float | None = None) -> core.BladeShape:
    """The blades as the core takes them; helix: m, a geometric pitch in place of the angles."""
    R = blades.radius
    return core.BladeShape(
        blades.count,
        R,
        blades.hub_radius / R,
        0.0 if helix is None else helix / R,
        np.ascontiguousarray(blades.r / R),
        np.ascontiguousarray(blades.chord / R),
        np.ascontiguousarray(blades.pitch),
    )


def advance_ratios(J: Sequence[float] | Array | float, where: str) -> Array:
    """J as a vector; refused where it is not finite or below zero (reverse flow)."""
    values = np.atleast_1d(np.asarray(J, dtype=np.float64))
    if values.ndim != 1 or not len(values) or not np.all(np.isfinite(values)):
        raise refuse(
            "bad_advance_ratio",
            where=where,
            expected="finite advance ratios J = V/(n D)",
            found="none" if not values.size else "values that are not finite",
            do="Give J as a list of numbers.",
        )
    if np.any(values < 0.0):
        raise outside("reverse", float(values.min()), where)
    return values


def outside(regime: str, J: float, where: str, last: float | None = None) -> BadInput:
    """The refusal of an advance ratio that the model does not hold for."""
    found = f"J = {J:.4g}: " + {"windmill": "the air drives the shaft", "reverse": "reverse"}.get(
        regime, regime
    )
    do = "Ask for advance ratios" + (" from 0." if last is None else f" from 0 to {last:.4g}.")
    return refuse("outside_propeller_model", where=where, expected=_WHY[regime], found=found, do=do)
