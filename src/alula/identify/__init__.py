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
from alula.identify.flown.extended_filter_error import identify_extended_filter_error
from alula.identify.flown.filter_error import identify_flight_filter_error
from alula.identify.flown.measured_maneuver import MeasuredManeuver, measured_maneuver
from alula.identify.flown.output_error import identify_output_error
from alula.identify.flown.python_model import FunctionManeuver, identify_output_error_function
from alula.identify.flown.stall import identify_stall
from alula.identify.frequency.output_error import identify_frequency_output_error
from alula.identify.frequency.recursive_fourier import recursive_frequency_regression
from alula.identify.frequency.regression import identify_frequency_regression
from alula.identify.frequency.response import (
    FrequencyResponse,
    frequency_responses,
    multisine_responses,
)
from alula.identify.likelihood.parameters import Prior
from alula.identify.linear.filter_error import identify_filter_error
from alula.identify.linear.flight import SteadyFlight, linear_flight_model
from alula.identify.linear.model import LinearModel, linear_model
from alula.identify.linear.output_error import identify_linear_output_error
from alula.identify.linear.record import LinearRecord, linear_record
from alula.identify.model import identified_model
from alula.identify.result import Fit, History, Identification, Parameter, Series, Tie

__all__ = [
    "CoefficientData",
    "Fit",
    "Forgetting",
    "FrequencyResponse",
    "FunctionManeuver",
    "History",
    "Identification",
    "LinearModel",
    "LinearRecord",
    "MeasuredManeuver",
    "Parameter",
    "Perturbed",
    "Prior",
    "Reference",
    "RegressionChoice",
    "Series",
    "StateSpace",
    "SteadyFlight",
    "Thrust",
    "Tie",
    "coefficients_as_recorded",
    "coefficients_from_motion",
    "frequency_responses",
    "identified_model",
    "identify_equation_error",
    "identify_extended_filter_error",
    "identify_filter_error",
    "identify_flight_filter_error",
    "identify_frequency_output_error",
    "identify_frequency_regression",
    "identify_linear_output_error",
    "identify_output_error",
    "identify_output_error_function",
    "identify_recursive",
    "identify_stall",
    "identify_state_space",
    "linear_flight_model",
    "linear_model",
    "linear_record",
    "measured_maneuver",
    "multisine_responses",
    "recursive_frequency_regression",
    "recursive_least_squares",
    "state_derivatives",
]
