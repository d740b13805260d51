"""Reads an aircraft file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from alula.aircraft.aircraft import SENSOR_GROUPS, Aircraft, Engine, Envelope
from alula.aircraft.control_signs import sign_factor
from alula.aircraft.frames import rotation
from alula.aircraft.mass import Component, MassModel, check_inertia, combine, inertia_tensor
from alula.aircraft.schema import AircraftFile, Control, EngineTable, Inertia, Mass
from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, Message, refuse, warn
from alula.base.project_messages import explain, read_toml
from alula.base.units import known_channel


def aircraft_schema() -> dict[str, Any]:
    """The JSON schema of an aircraft file, for editors."""
    return AircraftFile.model_json_schema(by_alias=True)


def load_aircraft(path: str | Path) -> Aircraft:
    """The aircraft of a TOML file, converted to SI and body axes.

    Raises BadInput with one message per thing that is wrong: file, key, expected, found.
    """
    path = Path(path)
    text, tables, sha256 = read_toml(path)
    try:
        file = AircraftFile.model_validate(tables)
    except ValidationError as error:
        raise BadInput(*explain(error, path, text)) from None
    turn = rotation(file.datum.frame)
    mass = _mass(file.mass, turn, path) if file.mass else None
    if file.reference.point is not None:
        point = _vector(file.reference.point, turn)
    else:
        point = frozen(np.zeros(3)) if mass is None else mass.cg
    for key in file.assumed:
        _check_key(key, tables, path)
    return Aircraft(
        name=file.name,
        S=file.reference.S,
        b=file.reference.b,
        c=file.reference.c,
        reference_point=point,
        mass=mass,
        sensors={name: _vector(s.position, turn) for name, s in file.sensors.items()},
        engines=_engines(file.engines, turn, path),
        control_signs={n: sign_factor(n, c.sign, str(path)) for n, c in file.controls.items()},
        control_limits={
            n: _limits(n, c, str(path))
            for n, c in file.controls.items()
            if c.limits_deg is not None or c.limits is not None
        },
        envelope=Envelope(
            V=_pair(file.envelope.V),
            alpha=_pair(file.envelope.alpha_deg, np.pi / 180.0),
            n=_pair(file.envelope.n),
            h=_pair(file.envelope.h),
        ),
        datum=file.datum.name,
        assumed=tuple(file.assumed),
        path=str(path),
        sha256=sha256,
        messages=(
            *(mass.messages if mass else ()),
            *_geometry(file, path),
            *_sensor_names(file, path),
        ),
    )


def _geometry(file: AircraftFile, path: Path) -> tuple[Message, ...]:
    """The mean aerodynamic chord of a wing without excess of taper lies near S/b."""
    ratio = file.reference.c * file.reference.b / file.reference.S
    if 0.8 <= ratio <= 1.6:  # 1 for a rectangle, 4/3 for a triangle; the rest is fillets
        return ()
    return (
        warn(
            "reference_geometry",
            where=f"{path}, reference",
            expected="c b / S between 1 (rectangular wing) and 1.33 (triangular)",
            found=f"{ratio:.3g}",
            do="Check that b is the full span, not the half, and the units: m2, m, m.",
        ),
    )


def _sensor_names(file: AircraftFile, path: Path) -> tuple[Message, ...]:
    """A sensor that no channel will ask for is a spelling mistake more often than not."""
    return tuple(
        warn(
            "unknown_sensor",
            where=f"{path}, sensors.{name}",
            expected="a channel's name or one of " + ", ".join(SENSOR_GROUPS),
            found=f"'{name}'",
            do="Check its spelling; a second sensor of alpha is 'alpha_2'.",
        )
        for name in file.sensors
        if name not in SENSOR_GROUPS and known_channel(name) is None
    )


def _mass(table: Mass, turn: Array, path: Path) -> MassModel:
    where = f"{path}, mass"
    if table.components:
        parts = [
            Component(p.name, p.mass, _vector(p.position, turn), _own(p.inertia, turn))
            for p in table.components
        ]
        messages = tuple(
            message
            for p in table.components
            if p.inertia is not None
            for message in check_inertia(
                _own(p.inertia, turn), f"{path}, mass.components.{p.name}.inertia"
            )
        )
        dry, cg, _ = combine(parts)
        fuel = _fuel(table, cg, turn)
        mass, cg, inertia = combine([*parts, fuel] if fuel else parts)
    else:
        # The schema has made sure that the totals are there.
        values = [getattr(table, key) or 0.0 for key in ("Ixx", "Iyy", "Izz", "Ixz", "Ixy", "Iyz")]
        messages = ()
        mass = float(table.mass or 0.0)
        cg = _vector(table.cg or [], turn)
        inertia = turn @ inertia_tensor(*values) @ turn
        fuel = _fuel(table, cg, turn)
        dry = mass - (fuel.mass if fuel else 0.0)
    if dry <= 0.0 and fuel is not None:
        raise refuse(
            "fuel_mass",
            where=f"{path}, mass.fuel.mass",
            expected=f"less than the total mass, {mass:g} kg, which includes it",
            found=f"{fuel.mass:g} kg",
            do="Correct the one or the other.",
        )
    messages += check_inertia(inertia, where)
    model = MassModel(mass, frozen(cg), frozen(inertia), fuel, messages)
    if fuel is not None and not messages:
        dry_inertia = model.at(np.array([fuel.mass])).inertia[0]
        messages += check_inertia(dry_inertia, f"{where} (all fuel burned)")
    return MassModel(mass, frozen(cg), frozen(inertia), fuel, messages)


def _fuel(table: Mass, cg: Array, turn: Array) -> Component | None:
    if table.fuel is None:
        return None
    position = cg if table.fuel.position is None else _vector(table.fuel.position, turn)
    return Component("fuel", table.fuel.mass, position, _own(table.fuel.inertia, turn))


def _own(inertia: Inertia | None, turn: Array) -> Array:
    if inertia is None:
        return frozen(np.zeros((3, 3)))
    return frozen(turn @ inertia_tensor(**inertia.model_dump()) @ turn)


def _engines(tables: list[EngineTable], turn: Array, path: Path) -> tuple[Engine, ...]:
    names = [table.name for table in tables]
    for name in names:
        if names.count(name) > 1:
            raise refuse(
                "duplicate_engine",
                where=f"{path}, engines",
                expected="a name of its own for each engine",
                found=f"'{name}' {names.count(name)} times",
                do="Rename one, for example 'left' and 'right'.",
            )
    return tuple(
        Engine(
            name=table.name,
            position=_vector(table.position, turn),
            direction=_direction(table, turn),
            channel=table.channel,
            thrust=table.thrust,
            thrust_se=table.thrust_se,
        )
        for table in tables
    )


def _direction(table: EngineTable, turn: Array) -> Array:
    """The thrust's unit vector in body axes; angles are from the nose, whatever the frame."""
    if table.direction is not None:
        along = turn @ np.array(table.direction)
        along /= np.abs(along).max()  # before the squares, which may underflow
        return frozen(along / np.linalg.norm(along))
    up, right = np.radians(table.tilt_deg or 0.0), np.radians(table.toe_deg or 0.0)
    return frozen([np.cos(up) * np.cos(right), np.cos(up) * np.sin(right), -np.sin(up)])


def _limits(name: str, control: Control, where: str) -> tuple[float, float]:
    """Limits in Alula's notation: where the log's sense is the other, the ends change places."""
    factor = sign_factor(name, control.sign, where)
    if control.limits_deg is not None:
        low, high = (factor * float(np.radians(x)) for x in control.limits_deg)
    else:
        low, high = (factor * x for x in control.limits or [])
    return min(low, high), max(low, high)


def _vector(values: list[float], turn: Array) -> Array:
    return frozen(turn @ np.array(values, dtype=np.float64))


def _pair(values: list[float] | None, scale: float = 1.0) -> tuple[float, float] | None:
    return None if values is None else (scale * values[0], scale * values[1])


def _check_key(key: str, tables: dict[str, Any], path: Path) -> None:
    """Whether a dotted key leads to a value; members of a list go by their name."""
    here: Any = tables
    for part in key.split("."):
        if isinstance(here, list):
            here = next((x for x in here if isinstance(x, dict) and x.get("name") == part), None)
        else:
            here = here.get(part) if isinstance(here, dict) else None
        if here is None:
            raise refuse(
                "assumed_key",
                where=f"{path}, assumed",
                expected="keys that stand in the file",
                found=f"'{key}', which has no '{part}'",
                do="Write dotted keys as 'mass.Ixz', 'engines.left.position'.",
            )
