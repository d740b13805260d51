"""From motion to derivatives: coefficients, regression, error bars, verdicts."""

from alula.identify.coefficients import (
    CoefficientData,
    Perturbed,
    Reference,
    Thrust,
    coefficients_as_recorded,
    coefficients_from_motion,
)
from alula.identify.equation_error.choice import RegressionChoice
from alula.identify.equation_error.identify import identify_equation_error
from alula.identify.equation_error.recursive import identify_recursive
from alula.identify.equation_error.recursive_least_squares import (
    Forgetting,
    recursive_least_squares,
)
from alula.identify.equation_error.state_space import (
    StateSpace,
    identify_state_space,
    state_derivatives,
)
from alula.identify.frequency.recursive_fourier import recursive_frequency_regression
from alula.identify.model import identified_model
from alula.identify.result import Fit, History, Identification, Parameter, Series, Tie

__all__ = [
    "CoefficientData",
    "Fit",
    "Forgetting",
    "History",
    "Identification",
    "Parameter",
    "Perturbed",
    "Reference",
    "RegressionChoice",
    "Series",
    "StateSpace",
    "Thrust",
    "Tie",
    "coefficients_as_recorded",
    "coefficients_from_motion",
    "identified_model",
    "identify_equation_error",
    "identify_recursive",
    "identify_state_space",
    "recursive_frequency_regression",
    "recursive_least_squares",
    "state_derivatives",
]
