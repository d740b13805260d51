"""Planning of flight tests: inputs from the a-priori model, and what they will tell."""

from alula.plan.amplitude import Limits, largest_amplitude, limits_of, outside
from alula.plan.design import Design, design, planned
from alula.plan.expected import expected
from alula.plan.information import Prediction, predict
from alula.plan.output_error_information import predict_output_error
from alula.plan.widths import Timing, timing

__all__ = [
    "Design",
    "Limits",
    "Prediction",
    "Timing",
    "design",
    "expected",
    "largest_amplitude",
    "limits_of",
    "outside",
    "planned",
    "predict",
    "predict_output_error",
    "timing",
]
