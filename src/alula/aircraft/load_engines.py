"""Engines and actuators from the aircraft file's tables."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from alula.aircraft.actuators import Actuator
from alula.aircraft.frames import to_body
from alula.aircraft.propulsion import (
    ElectricMotor,
    EngineModel,
    PistonEngine,
    Propeller,
    Turbofan,
)
from alula.aircraft.schema import ActuatorTable, Surface
from alula.aircraft.schema_engines import EngineTable, PropellerTable
from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn

RPM = np.pi / 30.0  # rad/s


def engine_models(tables: list[EngineTable], turn: Array, path: Path) -> tuple[EngineModel, ...]:
    """The engines in SI and body axes; turn: (3, 3) from the datum's frame.

    Thrust that is given to the whole aircraft is shared alike. Raises BadInput where two engines
    have one name.
    """
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
        EngineModel(
            name=table.name,
            position=to_body(table.position, turn),
            direction=_direction(table, turn),
            channel=table.channel,
            thrust=table.thrust,
            thrust_se=table.thrust_se,
            share=1.0 / len(tables),
            machine=_machine(table),
        )
        for table in tables
    )


def engine_messages(engines: tuple[EngineModel, ...], path: Path) -> tuple[Message, ...]:
    """What may be a slip in a machine's figures."""
    messages = []
    for engine in engines:
        machine = engine.machine
        if isinstance(machine, PistonEngine | ElectricMotor):
            p = machine.propeller
            efficiency = np.max(p.J * p.CT / np.where(p.CP > 0.0, p.CP, np.inf))
            if efficiency > 1.0:
                messages.append(
                    warn(
                        "propeller_efficiency",
                        where=f"{path}, engines.{engine.name}.propeller",
                        expected="an efficiency J CT/CP below 1",
                        found=f"{efficiency:.3g}",
                        do="Check that n is in revolutions per second in J, CT and CP, and that "
                        "CP is not the torque coefficient (CP = 2 pi CQ).",
                    )
                )
        if isinstance(machine, ElectricMotor) and machine.k_T * machine.k_V > 1.05:
            messages.append(
                warn(
                    "motor_constants",
                    where=f"{path}, engines.{engine.name}.electric",
                    expected="k_T k_V at most 1: a motor gives no more power than it takes",
                    found=f"{machine.k_T * machine.k_V:.3g}",
                    do="Check k_T (N m/A) and k_V_rpm (rpm/V), or leave k_T out.",
                )
            )
    return tuple(messages)


def actuators(
    tables: Mapping[Surface, ActuatorTable],
    limits: Mapping[str, tuple[float, float]],
    path: Path,
) -> dict[str, Actuator]:
    """The actuators in Alula's notation; limits: of the controls, rad, or 1 for the throttle."""
    out: dict[str, Actuator] = {}
    for name, table in tables.items():
        angular = name != "dt"
        wrong = ("rate_limit", "dead_band") if angular else ("rate_limit_deg_s", "dead_band_deg")
        for key in wrong:
            if getattr(table, key) is not None:
                raise refuse(
                    "actuator_unit",
                    where=f"{path}, actuators.{name}.{key}",
                    expected="deg for a surface: rate_limit_deg_s, dead_band_deg"
                    if angular
                    else "throttle, 0 to 1: rate_limit, dead_band",
                    found=f"'{key}'",
                    do="Use the key with this control's unit.",
                )
        unit = np.pi / 180.0 if angular else 1.0
        rate = table.rate_limit_deg_s if angular else table.rate_limit
        band = table.dead_band_deg if angular else table.dead_band
        low, high = limits.get(name, (-np.inf, np.inf))
        out[name] = Actuator(
            tau=table.tau,
            rate_limit=np.inf if rate is None else unit * rate,
            low=low,
            high=high,
            dead_band=unit * (band or 0.0),
        )
    return out


def _machine(table: EngineTable) -> PistonEngine | ElectricMotor | Turbofan | None:
    if table.turbofan is not None:
        t = table.turbofan
        return Turbofan(
            mach=frozen(t.mach),
            height=frozen(t.height),
            idle=frozen(t.idle),
            military=frozen(t.military),
            maximum=None if t.maximum is None else frozen(t.maximum),
            military_at=t.military_at,
            lag=t.lag,
            angular_momentum=t.angular_momentum,
            idle_speed=t.idle_speed,
            consumption=t.consumption_kg_N_h / 3600.0,
        )
    if table.propeller is None:
        return None
    propeller = _propeller(table.propeller)
    if table.piston is not None:
        p = table.piston
        return PistonEngine(
            propeller=propeller,
            reduction=p.reduction,
            gear_sense=1.0 if p.gear == "same" else -1.0,
            crank_inertia=p.crank_inertia,
            omega=frozen(RPM * np.array(p.speed_rpm)),
            torque=frozen(p.torque),
            friction=p.friction,
            idle=p.idle,
            consumption=p.consumption_g_kWh * 1e-3 / 3.6e6,
        )
    if table.electric is None:
        return None
    e = table.electric
    k_V = RPM * e.k_V_rpm
    return ElectricMotor(
        propeller=propeller,
        k_V=k_V,
        k_T=1.0 / k_V if e.k_T is None else e.k_T,
        I_0=e.I_0,
        R_motor=e.R_motor,
        R_esc=e.R_esc,
        R_battery=e.R_battery,
        U_full=e.U_full,
        U_empty=e.U_empty,
        capacity=3600.0 * e.capacity_Ah,
        I_max=e.I_max,
        I_regen=e.I_regen,
    )


def _propeller(p: PropellerTable) -> Propeller:
    return Propeller(
        diameter=p.diameter,
        inertia=p.inertia,
        sense=1.0 if p.sense == "right" else -1.0,
        J=frozen(p.J),
        CT=frozen(p.CT),
        CP=frozen(p.CP),
    )


def _direction(table: EngineTable, turn: Array) -> Array:
    """The thrust's unit vector in body axes; angles are from the nose, whatever the frame."""
    if table.direction is not None:
        along = turn @ np.array(table.direction)
        along /= np.abs(along).max()  # before the squares, which may underflow
        return frozen(along / np.linalg.norm(along))
    up, right = np.radians(table.tilt_deg or 0.0), np.radians(table.toe_deg or 0.0)
    return frozen([np.cos(up) * np.cos(right), np.cos(up) * np.sin(right), -np.sin(up)])
