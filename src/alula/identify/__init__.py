"""From motion to derivatives: coefficients, regression, error bars, verdicts."""

from alula.identify.coefficients import (
    CoefficientData,
    Perturbed,
    Reference,
    Thrust,
    coefficients_as_recorded,
    coefficients_from_motion,
)
from alula.identify.equation_error import identify_equation_error
from alula.identify.model import identified_model
from alula.identify.result import Fit, Identification, Parameter, Series, Tie
from alula.identify.state_space import StateSpace, identify_state_space, state_derivatives

__all__ = [
    "CoefficientData",
    "Fit",
    "Identification",
    "Parameter",
    "Perturbed",
    "Reference",
    "Series",
    "StateSpace",
    "Thrust",
    "Tie",
    "coefficients_as_recorded",
    "coefficients_from_motion",
    "identified_model",
    "identify_equation_error",
    "identify_state_space",
    "state_derivatives",
]
