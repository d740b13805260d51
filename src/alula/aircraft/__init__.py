"""The aircraft: reference geometry, mass, sensors, engines, control signs, from one TOML file."""

from alula.aircraft.actuators import Actuator
from alula.aircraft.aircraft import Aircraft, Envelope
from alula.aircraft.control_check import control_sign_check
from alula.aircraft.control_signs import sign_factor
from alula.aircraft.geometry import (
    Airfoil,
    Body,
    ControlSurface,
    CrossSection,
    Geometry,
    LiftingSurface,
    Polar,
    Section,
)
from alula.aircraft.load import aircraft_schema, load_aircraft
from alula.aircraft.mass import ROUNDING, MassModel, MassProperties, check_inertia
from alula.aircraft.persons import person_inertia
from alula.aircraft.propulsion import (
    ElectricMotor,
    EngineKind,
    EngineModel,
    PistonEngine,
    Propeller,
    Turbofan,
)
from alula.aircraft.tanks import Tank
from alula.aircraft.weighing import Weighing, center_of_gravity

__all__ = [
    "ROUNDING",
    "Actuator",
    "Aircraft",
    "Airfoil",
    "Body",
    "ControlSurface",
    "CrossSection",
    "ElectricMotor",
    "EngineKind",
    "EngineModel",
    "Envelope",
    "Geometry",
    "LiftingSurface",
    "MassModel",
    "MassProperties",
    "PistonEngine",
    "Polar",
    "Propeller",
    "Section",
    "Tank",
    "Turbofan",
    "Weighing",
    "aircraft_schema",
    "center_of_gravity",
    "check_inertia",
    "control_sign_check",
    "load_aircraft",
    "person_inertia",
    "sign_factor",
]
