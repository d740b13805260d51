"""Mass, persons, fuel and tanks from the aircraft file's table [mass]."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from alula.aircraft.frames import to_body
from alula.aircraft.mass import Component, MassModel, check_inertia, combine, inertia_tensor
from alula.aircraft.persons import person_inertia
from alula.aircraft.schema_mass import Inertia, Mass
from alula.aircraft.schema_mass import Tank as TankTable
from alula.aircraft.tanks import CylinderTank, Tank, TaperedTank
from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse


def mass_model(table: Mass, turn: Array, path: Path) -> MassModel:
    """The mass model of [mass]; turn: (3, 3) from the datum's frame to body axes.

    Raises BadInput for more fuel than mass or than a tank holds, and for an inertia that no body
    can have, full or empty of fuel.
    """
    where = f"{path}, mass"
    tanks = tuple(_tank(t, turn, f"{where}.tanks.{t.name}") for t in table.tanks)
    messages: tuple[Message, ...] = ()
    if table.components:
        parts = _parts(table, turn)
        for part in table.components:
            if part.inertia is not None:
                own = f"{where}.components.{part.name}.inertia"
                messages += check_inertia(_own(part.inertia, turn), own)
        dry, cg, _ = combine(parts)
        fuel = _fuel(table, cg, turn, tanks)
        mass, cg, inertia = combine([*parts, fuel] if fuel else parts)
    else:
        # The schema has made sure that the totals are there.
        values = [getattr(table, key) or 0.0 for key in ("Ixx", "Iyy", "Izz", "Ixz", "Ixy", "Iyz")]
        mass = float(table.mass or 0.0)
        cg = to_body(table.cg or [], turn)
        inertia = turn @ inertia_tensor(*values) @ turn
        fuel = _fuel(table, cg, turn, tanks)
        dry = mass - (fuel.mass if fuel else 0.0)
    if dry <= 0.0 and fuel is not None:
        raise refuse(
            "fuel_mass",
            where=f"{where}.{'tanks' if tanks else 'fuel.mass'}",
            expected=f"less than the total mass, {mass:g} kg, which includes it",
            found=f"{fuel.mass:g} kg",
            do="Correct the one or the other.",
        )
    messages += check_inertia(inertia, where)
    model = MassModel(mass, frozen(cg), frozen(inertia), fuel, tanks, messages)
    if fuel is not None and not messages:
        dry_inertia = model.at(np.array([fuel.mass])).inertia[0]
        messages += check_inertia(dry_inertia, f"{where} (all fuel burned)")
    return MassModel(mass, frozen(cg), frozen(inertia), fuel, tanks, messages)


def _parts(table: Mass, turn: Array) -> list[Component]:
    things = [
        Component(p.name, p.mass, to_body(p.position, turn), _own(p.inertia, turn))
        for p in table.components
    ]
    people = [
        Component(
            p.name,
            p.mass,
            to_body(p.position, turn),
            person_inertia(p.mass, p.height, p.posture),  # diagonal: the same in either frame
        )
        for p in table.persons
    ]
    return things + people


def _fuel(table: Mass, cg: Array, turn: Array, tanks: tuple[Tank, ...]) -> Component | None:
    if tanks:
        full = [tank.content(np.array([tank.fuel])) for tank in tanks]
        return Component(
            "fuel",
            *combine([Component("", float(m[0]), r[0], J[0]) for m, r, J in full]),
        )
    if table.fuel is None:
        return None
    position = cg if table.fuel.position is None else to_body(table.fuel.position, turn)
    return Component("fuel", table.fuel.mass, position, _own(table.fuel.inertia, turn))


def _tank(table: TankTable, turn: Array, where: str) -> Tank:
    shape: TaperedTank | CylinderTank
    if table.root is not None and table.tip is not None:
        ends = (table.root, table.tip)
        shape = TaperedTank(
            frozen([to_body(end.position, turn) for end in ends]),
            frozen([end.length for end in ends]),
            frozen([end.depth for end in ends]),
        )
    elif table.size is not None:
        length, width, depth = table.size
        middle, half = to_body(table.center or [], turn), np.array([0.0, 0.5 * width, 0.0])
        shape = TaperedTank(
            frozen([middle - half, middle + half]), frozen([length] * 2), frozen([depth] * 2)
        )
    else:
        shape = CylinderTank(
            to_body(table.center or [], turn),
            table.diameter or 0.0,
            table.length or 0.0,
            "xyz".index(table.axis or "x"),
        )
    tank = Tank(table.name, shape, table.fuel, table.density, table.burn, table.liquid == "reduced")
    if tank.fuel > tank.capacity * (1.0 + 1e-9):
        raise refuse(
            "tank_capacity",
            where=where,
            expected=f"at most {tank.capacity:.5g} kg, what {1e3 * shape.volume:.5g} liters hold",
            found=f"{tank.fuel:g} kg",
            do="Correct the fuel, the density or the tank's size.",
        )
    return tank


def _own(inertia: Inertia | None, turn: Array) -> Array:
    if inertia is None:
        return frozen(np.zeros((3, 3)))
    return frozen(turn @ inertia_tensor(**inertia.model_dump()) @ turn)
