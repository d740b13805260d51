"""A propeller as a momentum disk with swirl and partial blade stall (Pusztai 2018, 2.1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.aircraft.blades import Blades, MomentumParameters
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.predict.propeller_curves import (
    REGIMES,
    PropellerCurves,
    advance_ratios,
    core_shape,
    outside,
)

METHOD = "momentum disk with swirl and partial stall (Pusztai 2018, 2.1)"
NO_IDLE_DRAG = "sections without lift have no drag here: efficiency too high at high J"
THRUST = np.pi**2 / 4.0  # rho w^2 R^4 over rho n^2 D^4
POWER = np.pi**3 / 4.0  # 2 pi rho w^2 R^5 n over rho n^3 D^5


@dataclass(frozen=True)
class HubLoads:
    """What the propeller does at its hub. Axes: x along the thrust, y right, z down of it.

    force: (3,) N, moment: (3,) N m, on the aircraft; torque: N m that the shaft must give.
    """

    force: Array
    moment: Array
    torque: float


@dataclass(frozen=True)
class Wake:
    """The slipstream: speeds m/s aft, turning rad/s along the thrust (right-hand positive), m.

    u1: through the disk. U_i, Omega_i, R_i: far behind it. Omega_1: turning at the disk.
    """

    u1: float
    U_i: float
    Omega_1: float
    Omega_i: float
    R_i: float


class MomentumPropeller:
    """Pusztai's propeller, tabulated over J for flight: loads and slipstream at any motion.

    Raises BadInput where the blades give no static thrust or never windmill.
    """

    def __init__(self, blades: Blades, parameters: MomentumParameters | None = None) -> None:
        self.blades = blades
        self.parameters = _parameters(blades, parameters)
        p = self.parameters
        self._shape = core_shape(blades, p.pitch)
        try:
            self._table = core.MomentumTable(
                self._shape, p.c_l_alpha, p.alpha_max, p.c_d_alpha, blades.sense
            )
        except ValueError:
            raise refuse(
                "no_propeller_solution",
                where=blades.name,
                expected="a propeller that gives thrust at rest and windmills at some J",
                found=f"pitch {p.pitch:.4g} m, c_l_alpha {p.c_l_alpha:.3g}, alpha_max "
                f"{np.degrees(p.alpha_max):.3g} deg, c_d_alpha {p.c_d_alpha:.3g}",
                do="Check blade angles and parameters.",
            ) from None
        self.last: float = self._table.last  # J where the windmill begins

    def loads(
        self,
        omega: float,
        v: Sequence[float] | Array,
        w: Sequence[float] | Array = (0.0, 0.0, 0.0),
        density: float = 1.225,
    ) -> HubLoads:
        """Forces and moments, Eqs. (2.20), (2.27), linear in sideways speed and rates.

        omega: rad/s. v: (3,) m/s of the hub against the air, w: (3,) rad/s, hub axes.
        Raises BadInput for a propeller that stands, reverse flow and the windmill.
        """
        velocity = np.array(v, dtype=np.float64)
        *six, torque, regime = self._table.loads(
            omega, velocity, np.array(w, dtype=np.float64), density
        )
        if REGIMES[regime] != "inside":
            J = float(np.pi * velocity[0] / (omega * self.blades.radius)) if omega > 0.0 else 0.0
            raise outside(REGIMES[regime], J, self.blades.name, self.last)
        return HubLoads(frozen(six[:3]), frozen(six[3:]), torque)

    def slipstream(self, omega: float, axial_speed: float, density: float = 1.225) -> Wake:
        """u1, U_i, Omega_i and R_i, Eqs. (2.8) to (2.11) with their errata. Refuses as `loads`."""
        loads = self.loads(omega, (axial_speed, 0.0, 0.0), density=density)
        b = self.blades
        *five, _ = core.slipstream(
            axial_speed, float(loads.force[0]), loads.torque, density, b.radius, b.sense
        )
        return Wake(*five)


def momentum_propeller(
    blades: Blades,
    J: Sequence[float] | Array | float,
    parameters: MomentumParameters | None = None,
) -> PropellerCurves:
    """CT and CP at advance ratios J; parameters: the blades' own where None.

    Solved exactly at each J, not from the table. Raises BadInput for reverse flow, the windmill
    and blades without a solution: no number there.
    """
    values = advance_ratios(J, blades.name)
    p = _parameters(blades, parameters)
    shape = core_shape(blades, p.pitch)
    out = np.zeros((len(values), 10))
    core.momentum_disk(shape, p.c_l_alpha, p.alpha_max, p.c_d_alpha, values, out)
    for j, row in zip(values, out, strict=True):
        regime = REGIMES[int(row[9])]
        if regime != "inside":
            last = core.windmill_J(shape, p.c_l_alpha, p.alpha_max, p.c_d_alpha)
            raise outside(regime, float(j), blades.name, last if last > 0.0 else None)
    square = out[:, 2] ** 2
    return PropellerCurves(
        METHOD,
        frozen(values),
        frozen(THRUST * square * out[:, 3]),
        frozen(-POWER * square * out[:, 6]),
        (NO_IDLE_DRAG,),
    )


def windmill_J(blades: Blades, parameters: MomentumParameters | None = None) -> float:
    """The advance ratio at which the air begins to drive the shaft; 0 without a solution."""
    p = _parameters(blades, parameters)
    shape = core_shape(blades, p.pitch)
    last: float = core.windmill_J(shape, p.c_l_alpha, p.alpha_max, p.c_d_alpha)
    return last


def _parameters(blades: Blades, given: MomentumParameters | None) -> MomentumParameters:
    found = blades.momentum if given is None else given
    if found is None:
        raise refuse(
            "no_momentum_parameters",
            where=blades.name,
            expected="c_l_alpha, alpha_max, c_d_alpha and effective pitch",
            found="none of them",
            do="State [blades.momentum], or a test to which they are fitted.",
        )
    numbers = (found.c_l_alpha, found.alpha_max, found.c_d_alpha, found.pitch)
    if not np.all(np.isfinite(numbers)) or min(found.c_l_alpha, found.alpha_max, found.pitch) <= 0:
        raise refuse(
            "bad_momentum_parameters",
            where=blades.name,
            expected="finite numbers, c_l_alpha, alpha_max and pitch above zero",
            found=", ".join(f"{x:.4g}" for x in numbers),
            do="Correct them.",
        )
    return found
