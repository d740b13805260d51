"""An aircraft as it might be: mass, center of gravity, inertia, hubs within their errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alula.aircraft.aircraft import Aircraft, Uncertainty
from alula.aircraft.mass import MassModel
from alula.aircraft.propulsion import ElectricMotor, EngineModel, PistonEngine
from alula.base.arrays import Array, frozen


def sampled(aircraft: Aircraft, rng: np.random.Generator) -> Aircraft:
    """The aircraft with what its [uncertainty] covers drawn anew, normally distributed.

    One that states none comes back as it is. Mass and inertia are multiplied by exp(se n), so that
    they stay positive; the inertia's second moments of mass along the three axes are, each with a
    draw of its own, so that it stays that of a body. Fuel stays what it is; positions of the
    components move together with the center of gravity, aerodynamic surfaces do not.
    """
    u = aircraft.uncertainty
    if u is None:
        return aircraft
    mass = None if aircraft.mass is None else _mass(aircraft.mass, u, rng)
    engines = tuple(_engine(e, u, rng) for e in aircraft.engines)
    return replace(aircraft, mass=mass, engines=engines)


def _mass(mass: MassModel, u: Uncertainty, rng: np.random.Generator) -> MassModel:
    factor = float(np.exp(u.mass * rng.standard_normal()))
    fuel = 0.0 if mass.fuel is None else mass.fuel.mass
    total = fuel + (mass.mass - fuel) * factor
    cg = mass.cg + u.cg * rng.standard_normal(3)
    inertia = (total / mass.mass) * _inertia(mass.inertia, u.inertia, rng)
    return replace(mass, mass=total, cg=frozen(cg), inertia=frozen(inertia))


def _inertia(inertia: Array, se: float, rng: np.random.Generator) -> Array:
    """J = tr(P) 1 - P with the second moments P; P goes to F P F."""
    P = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    F = np.diag(np.exp(0.5 * se * rng.standard_normal(3)))
    P = F @ P @ F
    return np.asarray(np.trace(P) * np.eye(3) - P)


def _engine(engine: EngineModel, u: Uncertainty, rng: np.random.Generator) -> EngineModel:
    position = frozen(engine.position + u.hub * rng.standard_normal(3))
    factor = float(np.exp(u.propeller_inertia * rng.standard_normal()))
    machine = engine.machine
    if isinstance(machine, PistonEngine | ElectricMotor):
        propeller = replace(machine.propeller, inertia=factor * machine.propeller.inertia)
        machine = replace(machine, propeller=propeller)
    return replace(engine, position=position, machine=machine)
