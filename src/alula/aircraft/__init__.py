"""The aircraft: reference geometry, mass, sensors, engines, control signs, from one TOML file."""

from alula.aircraft.aircraft import Aircraft, Engine, Envelope
from alula.aircraft.control_check import control_sign_check
from alula.aircraft.control_signs import sign_factor
from alula.aircraft.load import aircraft_schema, load_aircraft
from alula.aircraft.mass import MassModel, MassProperties, check_inertia
from alula.aircraft.weighing import Weighing, center_of_gravity

__all__ = [
    "Aircraft",
    "Engine",
    "Envelope",
    "MassModel",
    "MassProperties",
    "Weighing",
    "aircraft_schema",
    "center_of_gravity",
    "check_inertia",
    "control_sign_check",
    "load_aircraft",
    "sign_factor",
]
