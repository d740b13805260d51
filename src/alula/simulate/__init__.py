"""Virtual flights: the equations of motion, trim, control inputs, sensors."""

from alula.simulate.airframe import Airframe, airframe_of
from alula.simulate.condition import Condition
from alula.simulate.fly import SimulatedFlight, fly, initial_state
from alula.simulate.fly_many import fly_many
from alula.simulate.handling import judge
from alula.simulate.inputs import Pulse, Signal, Steps, Sum, bank_to_bank, doublet, input_3211
from alula.simulate.linearize import Linearization, LinearModel, linearize
from alula.simulate.modes import Mode, modes_of
from alula.simulate.requirement import Judgment
from alula.simulate.sensors import (
    SensorError,
    every,
    flow_angles,
    readings,
    specific_force_at,
    velocity_at,
)
from alula.simulate.trim import Trim, trim, trim_level

__all__ = [
    "Airframe",
    "Condition",
    "Judgment",
    "LinearModel",
    "Linearization",
    "Mode",
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
    "fly_many",
    "initial_state",
    "input_3211",
    "judge",
    "linearize",
    "modes_of",
    "readings",
    "specific_force_at",
    "trim",
    "trim_level",
    "velocity_at",
]
