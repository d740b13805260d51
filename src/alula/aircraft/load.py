"""Reads an aircraft file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft.aircraft import SENSOR_GROUPS, Aircraft, Envelope, Uncertainty
from alula.aircraft.control_signs import sign_factor
from alula.aircraft.frames import rotation, to_body
from alula.aircraft.geometry_check import check_geometry
from alula.aircraft.load_engines import actuators, engine_messages, engine_models
from alula.aircraft.load_geometry import geometry
from alula.aircraft.load_mass import mass_model
from alula.aircraft.schema import AircraftFile, Control, UncertaintyTable
from alula.base.arrays import frozen
from alula.base.messages import Message, refuse, warn
from alula.base.project_messages import expand, read_toml, validated
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
    file = validated(AircraftFile, tables, path, text)
    turn = rotation(file.datum.frame)
    mass = mass_model(file.mass, turn, path) if file.mass else None
    if file.reference.point is not None:
        point = to_body(file.reference.point, turn)
    else:
        point = frozen(np.zeros(3)) if mass is None else mass.cg
    for key in file.assumed:
        _check_key(key, tables, path)
    engines = engine_models(file.engines, turn, path)
    limits = {
        n: _limits(n, c, str(path))
        for n, c in file.controls.items()
        if c.limits_deg is not None or c.limits is not None
    }
    shape = geometry(file.geometry, turn, path) if file.geometry else None
    return Aircraft(
        name=file.name,
        S=file.reference.S,
        b=file.reference.b,
        c=file.reference.c,
        reference_point=point,
        mass=mass,
        sensors={name: to_body(s.position, turn) for name, s in file.sensors.items()},
        engines=engines,
        control_signs={n: sign_factor(n, c.sign, str(path)) for n, c in file.controls.items()},
        control_limits=limits,
        actuators=actuators(file.actuators, limits, path),
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
        aero=None if file.aero is None else expand(file.aero, path, "aero"),
        geometry=shape,
        uncertainty=_uncertainty(file.uncertainty),
        messages=(
            *(mass.messages if mass else ()),
            *_geometry(file, path),
            *_sensor_names(file, path),
            *engine_messages(engines, path),
            *(check_geometry(shape, file, path) if shape else ()),
        ),
    )


def _uncertainty(table: UncertaintyTable | None) -> Uncertainty | None:
    """Both frames' axes are parallel, so a standard deviation is the same in either."""
    if table is None:
        return None
    return Uncertainty(
        table.mass,
        frozen(np.abs(table.cg)),
        table.inertia,
        frozen(np.abs(table.hub)),
        table.propeller_inertia,
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


def _limits(name: str, control: Control, where: str) -> tuple[float, float]:
    """Limits in Alula's notation: where the log's sense is the other, the ends change places."""
    factor = sign_factor(name, control.sign, where)
    if control.limits_deg is not None:
        low, high = (factor * float(np.radians(x)) for x in control.limits_deg)
    else:
        low, high = (factor * x for x in control.limits or [])
    return min(low, high), max(low, high)


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
