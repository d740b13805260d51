"""What the equations of motion need of an aircraft besides its aerodynamics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from alula.aircraft import ROUNDING, Aircraft
from alula.aircraft.actuators import Actuator
from alula.aircraft.propulsion import (
    ElectricMotor,
    EngineModel,
    PistonEngine,
    Propeller,
    Turbofan,
)
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.model import AeroModel, to_table
from alula.simulate.wind import Wind, as_wind

GRAVITY = 9.80665  # m/s2, standard
CONTROLS = ("de", "da", "dr", "df", "dt")
Earth = Literal["flat", "wgs84"]


@dataclass(frozen=True)
class Fuel:
    """Fuel aboard that burns in flight, part of the airframe's totals.

    mass: kg. position: (3,) m from the datum. inertia: (3, 3) kg m2 about its own center. Mass and
    inertia shrink in proportion; the center stays.
    """

    mass: float
    position: Array
    inertia: Array


@dataclass(frozen=True)
class Airframe:
    """Mass properties, engines and actuators at one loading, and the Earth it flies over.

    mass: kg. inertia: (3, 3) kg m2 about the center of gravity, body axes, a tensor: its element
    (0, 2) is -Ixz; rotors of propellers belong to their engines. cg: (3,) m in the datum frame
    (body axes). engines: from the aircraft file; none: one thrust that is given, at thrust_point
    ((3,) m from the datum, None: through the center of gravity) along thrust_direction, a unit
    vector. actuators: by control. fuel: None where the mass is constant.
    """

    mass: float
    inertia: Array
    cg: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    thrust_point: Array | None = None
    thrust_direction: Array = field(default_factory=lambda: frozen([1.0, 0.0, 0.0]))
    engines: tuple[EngineModel, ...] = ()
    actuators: Mapping[str, Actuator] = field(default_factory=dict)
    earth: Earth = "flat"
    fuel: Fuel | None = None


def core_model(
    airframe: Airframe,
    model: AeroModel,
    wind: Array | Wind | None = None,
    gravity: float = GRAVITY,
    *,
    stall: bool = True,
) -> Any:
    """The core's AircraftModel.

    wind: (3,) NED m/s, the way it blows to, or a `Wind`. gravity: m/s2, of the flat Earth. stall:
    False leaves the model's stall out. Raises BadInput where the inertia is not that of a body, or
    an engine's or actuator's numbers cannot be.
    """
    inertia = np.ascontiguousarray(airframe.inertia, dtype=np.float64)
    _check_body(airframe.mass, inertia)
    cg = np.asarray(airframe.cg, dtype=np.float64)
    r = model.reference
    plant = core.AircraftModel(
        float(airframe.mass),
        inertia,
        np.array([r.S, r.b, r.c]),
        np.asarray(model.reference_point - cg, dtype=np.float64),
        gravity,
        model.axes == "stability",
        to_table(model),
        np.asarray(model.values, dtype=np.float64),
        airframe.earth == "wgs84",
    )
    _add_engines(plant, airframe, cg)
    for name, actuator in airframe.actuators.items():
        _add_actuator(plant, name, actuator)
    if model.stall is not None and stall:
        s = model.stall
        plant.set_stall(
            s.a1, s.alpha_star, s.tau1, s.tau2, s.CL_alpha, s.alpha_0, s.CD_X, s.Cm_X,
            s.y_station, s.alpha_star_difference,
        )  # fmt: skip
    if airframe.fuel is not None:
        fuel = airframe.fuel
        position = np.asarray(fuel.position, dtype=np.float64) - cg
        plant.set_fuel(float(fuel.mass), position, _rows(fuel.inertia))
    if wind is not None:
        set_wind(plant, wind)
    return plant


def set_wind(plant: Any, wind: Array | Wind) -> None:
    """Another wind for the core's AircraftModel, see `core_model`."""
    w = as_wind(wind)
    plant.set_wind(
        _vector(w.steady), _vector(w.shear), w.reference_height, w.logarithmic, w.roughness,
        w.ground,
    )  # fmt: skip


def airframe_of(
    aircraft: Aircraft,
    fuel_used: float = 0.0,
    *,
    engines: Literal["given", "modeled"] = "given",
    actuators: bool = False,
    burn: bool = False,
    earth: Earth = "flat",
) -> Airframe:
    """The airframe of an aircraft file after burning `fuel_used` kg.

    engines: 'given' takes the thrust as an input, shared by all engines; 'modeled' takes the
    machines of the file, driven by the throttle dt. actuators: with those of the file. burn: fuel
    burns in flight and changes the mass. Raises BadInput where the file states no mass.
    """
    properties = aircraft.mass_properties(np.array([fuel_used]))
    parts = aircraft.engines
    if engines == "given" and parts:
        share = 1.0 / len(parts)
        parts = tuple(
            e if e.machine is None else replace(e, machine=None, share=share) for e in parts
        )
        total = sum(e.share for e in parts)
        parts = tuple(replace(e, share=e.share / total) for e in parts)
    mass = aircraft.mass
    fuel = None
    if burn and mass is not None and mass.fuel is not None and mass.fuel.mass > fuel_used:
        left = 1.0 - fuel_used / mass.fuel.mass
        f = mass.fuel
        fuel = Fuel(f.mass * left, frozen(f.position), frozen(f.inertia * left))
    return Airframe(
        mass=float(properties.mass[0]),
        inertia=frozen(properties.inertia[0]),
        cg=frozen(properties.cg[0]),
        engines=parts,
        actuators=aircraft.actuators if actuators else {},
        earth=earth,
        fuel=fuel,
    )


def _check_body(mass: float, inertia: Array) -> None:
    """Rounded figures may miss the limit of a body by as much as in an aircraft file."""
    finite = np.isfinite(inertia).all() and np.isfinite(mass)
    moments = np.linalg.eigvalsh(inertia) if finite else np.full(3, np.nan)
    possible = moments[0] > 0.0 and moments[0] + moments[1] >= moments[2] * (1.0 - ROUNDING)
    if not (possible and mass > 0.0 and np.allclose(inertia, inertia.T)):
        raise refuse(
            "impossible_inertia",
            where="airframe",
            expected="positive mass; positive principal moments, none larger than the sum of two",
            found=f"mass {mass:g} kg, principal moments " + ", ".join(f"{x:g}" for x in moments),
            do="Correct the mass properties; the inertia tensor's element (0, 2) is -Ixz.",
        )


def _add_engines(plant: Any, airframe: Airframe, cg: Array) -> None:
    if not airframe.engines:
        at = cg if airframe.thrust_point is None else np.asarray(airframe.thrust_point)
        plant.add_given(at - cg, _vector(airframe.thrust_direction), 1.0)
    if len(airframe.engines) > 4:
        raise refuse(
            "too_many_engines",
            where="airframe",
            expected="at most four engines",
            found=str(len(airframe.engines)),
            do="Join engines that act at one place.",
        )
    for engine in airframe.engines:
        place = (_vector(engine.position) - cg, _vector(engine.direction))
        machine = engine.machine
        if isinstance(machine, PistonEngine):
            plant.add_piston(
                *place, *_propeller(machine.propeller), _vector(machine.omega),
                _vector(machine.torque), machine.reduction, machine.gear_sense,
                machine.crank_inertia, machine.friction, machine.idle, machine.consumption,
            )  # fmt: skip
        elif isinstance(machine, ElectricMotor):
            plant.add_electric(
                *place, *_propeller(machine.propeller), machine.k_V, machine.k_T, machine.I_0,
                machine.R_motor + machine.R_esc + machine.R_battery, machine.U_full,
                machine.U_empty, machine.capacity, machine.I_max, machine.I_regen,
            )  # fmt: skip
        elif isinstance(machine, Turbofan):
            plant.add_turbofan(
                *place, _thrust(machine, machine.idle), _thrust(machine, machine.military),
                None if machine.maximum is None else _thrust(machine, machine.maximum),
                machine.military_at, machine.lag, machine.consumption,
                abs(machine.angular_momentum), float(np.sign(machine.angular_momentum)) or 1.0,
                machine.idle_speed,
            )  # fmt: skip
        else:
            plant.add_given(*place, engine.share)


def _add_actuator(plant: Any, name: str, actuator: Actuator) -> None:
    if name not in CONTROLS or not actuator.tau > 0.0:
        raise refuse(
            "actuator",
            where=f"airframe, actuator of {name}",
            expected=f"one of {', '.join(CONTROLS)}, with a lag above zero",
            found=f"'{name}', tau = {actuator.tau:g} s",
            do="Correct it, or leave the actuator out.",
        )
    finite = np.nan_to_num([actuator.low, actuator.high], posinf=1e300, neginf=-1e300)
    rate = actuator.rate_limit if np.isfinite(actuator.rate_limit) else 0.0  # 0: none
    plant.set_actuator(
        CONTROLS.index(name), actuator.tau, rate, *map(float, finite), actuator.dead_band, 0.0
    )


def _propeller(p: Propeller) -> tuple[float, float, float, Array, Array, Array]:
    return p.diameter, p.inertia, p.sense, _vector(p.J), _vector(p.CT), _vector(p.CP)


def _thrust(fan: Turbofan, values: Array) -> tuple[list[Array], Array, bool, bool]:
    """A thrust table as the core takes it: linear, held outside."""
    return [_vector(fan.mach), _vector(fan.height)], _vector(np.ravel(values)), False, False


def _vector(values: Array) -> Array:
    return np.array(values, dtype=np.float64)


def _rows(values: Array) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64)
