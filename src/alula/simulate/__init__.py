"""Virtual flights: the equations of motion, trim, control inputs, sensors."""

from alula.simulate.airframe import Airframe, airframe_of
from alula.simulate.fly import SimulatedFlight, fly, initial_state
from alula.simulate.inputs import Pulse, Signal, Steps, Sum, bank_to_bank, doublet, input_3211
from alula.simulate.sensors import (
    SensorError,
    every,
    flow_angles,
    readings,
    specific_force_at,
    velocity_at,
)
from alula.simulate.trim import Trim, trim_level

__all__ = [
    "Airframe",
    "Pulse",
    "SensorError",
    "Signal",
    "SimulatedFlight",
    "Steps",
    "Sum",
    "Trim",
    "airframe_of",
    "bank_to_bank",
    "doublet",
    "every",
    "flow_angles",
    "fly",
    "initial_state",
    "input_3211",
    "readings",
    "specific_force_at",
    "trim_level",
    "velocity_at",
]
