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
from alula.identify.result import Fit, Identification, Parameter, Series, Tie

__all__ = [
    "CoefficientData",
    "Fit",
    "Identification",
    "Parameter",
    "Perturbed",
    "Reference",
    "Series",
    "Thrust",
    "Tie",
    "coefficients_as_recorded",
    "coefficients_from_motion",
    "identify_equation_error",
]
