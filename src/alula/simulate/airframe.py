"""What the equations of motion need of an aircraft besides its aerodynamics."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.model import AeroModel, to_table

GRAVITY = 9.80665  # m/s2, standard


@dataclass(frozen=True)
class Airframe:
    """Mass properties and line of thrust at one loading.

    mass: kg. inertia: (3, 3) kg m2 about the center of gravity, body axes, a tensor: its element
    (0, 2) is -Ixz. cg, thrust_point: (3,) m in the datum frame (body axes). thrust_direction: (3,)
    unit vector of the force on the aircraft.
    """

    mass: float
    inertia: Array
    cg: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    thrust_point: Array | None = None  # None: through the center of gravity
    thrust_direction: Array = field(default_factory=lambda: frozen([1.0, 0.0, 0.0]))


def core_model(
    airframe: Airframe, model: AeroModel, wind: Array | None = None, gravity: float = GRAVITY
) -> Any:
    """The core's AircraftModel; wind: (3,) NED m/s, the way it blows to.

    Raises BadInput where the inertia is not that of a body.
    """
    inertia = np.ascontiguousarray(airframe.inertia, dtype=np.float64)
    moments = np.linalg.eigvalsh(inertia)
    possible = moments[0] > 0.0 and moments[0] + moments[1] >= moments[2] * (1.0 - 1e-9)
    if not (possible and airframe.mass > 0.0 and np.allclose(inertia, inertia.T)):
        raise refuse(
            "impossible_inertia",
            where="airframe",
            expected="positive mass; positive principal moments, none larger than the sum of two",
            found=f"mass {airframe.mass:g} kg, principal moments "
            + ", ".join(f"{x:g}" for x in moments),
            do="Correct the mass properties; the inertia tensor's element (0, 2) is -Ixz.",
        )
    cg = np.asarray(airframe.cg, dtype=np.float64)
    thrust_point = cg if airframe.thrust_point is None else airframe.thrust_point
    r = model.reference
    return core.AircraftModel(
        float(airframe.mass),
        inertia,
        np.array([r.S, r.b, r.c]),
        model.reference_point - cg,
        thrust_point - cg,
        np.array(airframe.thrust_direction, dtype=np.float64),
        np.zeros(3) if wind is None else np.array(wind, dtype=np.float64),
        gravity,
        model.axes == "stability",
        to_table(model),
        model.values,
    )


def airframe_of(aircraft: Aircraft, fuel_used: float = 0.0) -> Airframe:
    """The airframe of an aircraft file after burning `fuel_used` kg.

    All engines act as one: at the mean of their positions, along their mean direction. Raises
    BadInput where the file states no mass.
    """
    properties = aircraft.mass_properties(np.array([fuel_used]))
    point, direction = None, np.array([1.0, 0.0, 0.0])
    if aircraft.engines:
        point = np.mean([engine.position for engine in aircraft.engines], axis=0)
        direction = np.mean([engine.direction for engine in aircraft.engines], axis=0)
        direction = direction / np.linalg.norm(direction)
    return Airframe(
        mass=float(properties.mass[0]),
        inertia=frozen(properties.inertia[0]),
        cg=frozen(properties.cg[0]),
        thrust_point=None if point is None else frozen(point),
        thrust_direction=frozen(direction),
    )
