"""Flight path reconstruction: what the aircraft really did, with the sensors' errors estimated."""

from alula.reconstruct.differentiate import Derivative, differentiate
from alula.reconstruct.linear_filter import LinearEstimate, LinearSystem, linear_filter
from alula.reconstruct.reconstruct import METHODS, reconstruct
from alula.reconstruct.result import Constant, Reconstruction, Segment, SensorFit

__all__ = [
    "METHODS",
    "Constant",
    "Derivative",
    "LinearEstimate",
    "LinearSystem",
    "Reconstruction",
    "Segment",
    "SensorFit",
    "differentiate",
    "linear_filter",
    "reconstruct",
]
