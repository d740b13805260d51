"""The slipstream's swirl and radius over its excess of axial speed, from a propeller's curves.

Momentum theory depends on the advance ratio alone (Pusztai 2018, B.1), so thrust and torque over J
give swirl and radius for every ratio of free stream to slipstream.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from alula.aircraft import Aircraft
from alula.aircraft.propulsion import ElectricMotor, PistonEngine, Propeller
from alula.base.arrays import Array, frozen

_FADES = 0.1
LEAST_RATIO = 0.2  # U_i/u_0 of a braking propeller, the lower end of Pusztai's range


@dataclass(frozen=True)
class Wake:
    """t: (k,) u_0/U_i, increasing from 0 (at rest); swirl: (k,) Omega_i R/U_i, with the
    propeller's sense; radius: m, of the propeller.
    """

    t: Array
    swirl: Array
    radius: float

    def at(self, axial: Array, wash: Array) -> tuple[Array, Array, Array]:
        """Excess of axial speed over V, Omega_i/V (1/m) and R_i (m), each (n,).

        axial: u_0/V, wash: (U_i - u_0)/V. Braked air keeps a fifth of its speed; flow from behind
        counts as a propeller at rest. Radius by continuity, pi R^2 u_1 = pi R_i^2 U_i. No wash
        stands for no propeller: below 0.1 the swirl, which a turning one has without thrust too,
        fades.
        """
        ahead = np.maximum(axial, 0.0)
        U = np.maximum(axial + wash, LEAST_RATIO * ahead)
        blows = U > 1e-12
        t = np.where(blows, ahead / np.where(blows, U, 1.0), 1.0)
        swirl = np.interp(t, self.t, self.swirl) * np.where(blows, U, 0.0) / self.radius
        swirl = swirl * np.minimum(np.abs(wash) / _FADES, 1.0)
        radius = self.radius * np.sqrt(0.5 * (1.0 + t))
        return U - axial, swirl, np.where(wash != 0.0, radius, 0.0)


def wake_of(propeller: Propeller) -> Wake:
    """The wake of a propeller by momentum (the core's `slipstream`, Pusztai 2018, Eq. 2.8 to 2.11).

    Advance ratios from rest to where the braked air would keep a fifth of its speed.
    """
    R = 0.5 * propeller.diameter
    # n = 1 rev/s, rho = 1: thrust CT D^4, torque CP D^5/(2 pi), u_0 = J D.
    J = np.linspace(0.0, float(propeller.J[-1]), 400)
    # Fritsch and Butland's monotone cubic, as the core's curve.
    CT, CP = (PchipInterpolator(propeller.J, y)(J) for y in (propeller.CT, propeller.CP))
    D = propeller.diameter
    u0 = J * D
    square = u0**2 + 2.0 * CT * D**4 / (np.pi * R**2)
    good = square > (LEAST_RATIO * u0) ** 2
    good &= np.cumprod(good) > 0
    u0, U = u0[good], np.sqrt(square[good])
    torque = CP[good] * D**5 / (2.0 * np.pi)
    u1 = 0.5 * (u0 + U)
    Omega = propeller.sense * 2.0 * torque * U / (np.pi * u1**2 * R**4)
    t = u0 / U
    rising = np.concatenate([[True], np.diff(np.maximum.accumulate(t)) > 1e-12])
    return Wake(frozen(t[rising]), frozen((Omega * R / U)[rising]), R)


def propeller_wake(aircraft: Aircraft) -> tuple[Wake | None, Array]:
    """The wake of the first propeller, and its hub (3,) m; without one, none and the reference."""
    for engine in aircraft.engines:
        if isinstance(engine.machine, PistonEngine | ElectricMotor):
            return wake_of(engine.machine.propeller), np.asarray(engine.position)
    return None, np.asarray(aircraft.reference_point)
