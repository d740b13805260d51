"""Virtual flights: the equations of motion, trim, control inputs, sensors."""

from alula.simulate.airframe import Airframe, airframe_of
from alula.simulate.condition import Condition
from alula.simulate.fly import SimulatedFlight, fly, initial_state
from alula.simulate.fly_many import fly_many
from alula.simulate.handling import judge
from alula.simulate.inputs import (
    Delay,
    Pulse,
    Signal,
    Steps,
    Sum,
    Sweep,
    bank_to_bank,
    doublet,
    input_3211,
)
from alula.simulate.linearize import Linearization, LinearModel, linearize
from alula.simulate.modes import Mode, modes_of
from alula.simulate.multisine import Multisine, multisines
from alula.simulate.pilot import Pilot
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
from alula.simulate.virtual_campaign import Campaign, fly_plan
from alula.simulate.virtual_plan import Plan, load_plan
from alula.simulate.wind import CosineGust, Turbulence, Wind

__all__ = [
    "Airframe",
    "Campaign",
    "Condition",
    "CosineGust",
    "Delay",
    "Judgment",
    "LinearModel",
    "Linearization",
    "Mode",
    "Multisine",
    "Pilot",
    "Plan",
    "Pulse",
    "SensorError",
    "Signal",
    "SimulatedFlight",
    "Steps",
    "Sum",
    "Sweep",
    "Trim",
    "Turbulence",
    "Wind",
    "airframe_of",
    "bank_to_bank",
    "doublet",
    "every",
    "flow_angles",
    "fly",
    "fly_many",
    "fly_plan",
    "initial_state",
    "input_3211",
    "judge",
    "linearize",
    "load_plan",
    "modes_of",
    "multisines",
    "readings",
    "specific_force_at",
    "trim",
    "trim_level",
    "velocity_at",
]
