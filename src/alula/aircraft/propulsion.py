"""Engines and propellers as the simulation takes them: SI, radians, body axes.

A propeller's coefficients are those of the field: J = V/(n D), CT = T/(rho n^2 D^4),
CP = P/(rho n^3 D^5) with n in revolutions per second (Dittrich 2016, Eq. 2.48 and 2.52).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from alula.base.arrays import Array

EngineKind = Literal["given", "piston", "electric", "turbofan"]


@dataclass(frozen=True)
class Propeller:
    """A fixed-pitch propeller: diameter m, inertia kg m2 about its axis, CT and CP over J.

    sense: +1 where it turns clockwise seen from behind, so that its angular momentum points along
    the thrust; -1 the other way. J, CT, CP: (k,), J increasing; cubic between, lines outside.
    """

    diameter: float
    inertia: float
    sense: float
    J: Array
    CT: Array
    CP: Array


@dataclass(frozen=True)
class PistonEngine:
    """A piston engine that turns a propeller through a gear (Dittrich 2016, Table 4.2).

    reduction: crankshaft speed over propeller speed. gear_sense: +1 where the crankshaft turns with
    the propeller, -1 against it. crank_inertia: kg m2 of all that turns at crankshaft speed.
    omega: (k,) rad/s of the crankshaft, torque: (k,) N m that it gives at full throttle at sea
    level. friction: N m that drags it with the throttle closed and ignition off. idle: opening that
    the closed throttle leaves, 0 to 1. consumption: kg/J, fuel over shaft energy.
    """

    propeller: Propeller
    reduction: float
    gear_sense: float
    crank_inertia: float
    omega: Array
    torque: Array
    friction: float
    idle: float
    consumption: float


@dataclass(frozen=True)
class ElectricMotor:
    """A motor, its speed controller and its battery (Pusztai 2018, Eq. 2.29, 3.41 to 3.43, B.3).

    k_V: rad/s per V. k_T: N m per A. I_0: no-load current, A. Resistances in ohm. U_full, U_empty:
    V of the battery without load, full and empty, linear between. capacity: A s. I_max: A, the
    controller's limit; I_regen: A it lets flow back, 0 where it does not brake.
    """

    propeller: Propeller
    k_V: float
    k_T: float
    I_0: float
    R_motor: float
    R_esc: float
    R_battery: float
    U_full: float
    U_empty: float
    capacity: float
    I_max: float
    I_regen: float


@dataclass(frozen=True)
class Turbofan:
    """A turbofan by tables of its net thrust, N.

    mach: (k,), height: (l,) m, both increasing. idle, military, maximum: (k, l) N; maximum is None
    where there is no afterburner. military_at: throttle of military thrust, 1 without afterburner.
    lag: s, of the first order between throttle and power. angular_momentum: kg m2/s of the rotors
    at full power, along the thrust where positive; idle_speed: share of it at idle.
    consumption: kg/(N s), fuel over thrust.
    """

    mach: Array
    height: Array
    idle: Array
    military: Array
    maximum: Array | None
    military_at: float
    lag: float
    angular_momentum: float
    idle_speed: float
    consumption: float


@dataclass(frozen=True)
class EngineModel:
    """One engine: where its thrust acts, whereto, and what makes it.

    position: (3,) m from the datum. direction: unit vector (3,) of the force on the aircraft.
    channel: the log's thrust channel; thrust: a constant, N; thrust_se: relative standard error,
    0 where the file does not state one. share: of the thrust that is given to the whole aircraft
    (kind 'given'); the shares of all engines add up to 1. machine: None for kind 'given'.
    """

    name: str
    position: Array
    direction: Array
    channel: str | None
    thrust: float | None
    thrust_se: float
    share: float = 1.0
    machine: PistonEngine | ElectricMotor | Turbofan | None = None

    @property
    def kind(self) -> EngineKind:
        """What makes the thrust."""
        kinds: dict[type, EngineKind] = {
            PistonEngine: "piston",
            ElectricMotor: "electric",
            Turbofan: "turbofan",
        }
        return kinds.get(type(self.machine), "given")
