"""Does the model fly like the aircraft? Recorded controls through the model, judged."""

from alula.validate.case import Case
from alula.validate.oscillation import Oscillation, fit_oscillation
from alula.validate.part60 import REGULATION, judge, tolerances
from alula.validate.quality import Quality, quality
from alula.validate.reidentify import Reidentified, reidentify
from alula.validate.result import ChannelMatch, Criterion, Evidence, Flown, Validation
from alula.validate.validate import validate

__all__ = [
    "REGULATION",
    "Case",
    "ChannelMatch",
    "Criterion",
    "Evidence",
    "Flown",
    "Oscillation",
    "Quality",
    "Reidentified",
    "Validation",
    "fit_oscillation",
    "judge",
    "quality",
    "reidentify",
    "tolerances",
    "validate",
]
