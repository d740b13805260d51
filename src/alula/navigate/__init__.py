"""Navigation from what is on board: attitude, velocity, position, wind, power train."""

from alula.navigate.attitude import VectorAttitude, attitude_from_vectors, gravity_seen
from alula.navigate.joint import JointSettings, navigate_joint
from alula.navigate.pair import PairSettings, navigate_pair
from alula.navigate.power_train import PowerTrainState, power_train
from alula.navigate.result import Navigation, Taking, quaternion, rotations
from alula.navigate.samples import Inertial, Readings, assumed_sideslip
from alula.navigate.start import Start, first_state
from alula.navigate.wind import AirEstimate, WindEstimate, air_from_wind, wind_from

__all__ = [
    "AirEstimate",
    "Inertial",
    "JointSettings",
    "Navigation",
    "PairSettings",
    "PowerTrainState",
    "Readings",
    "Start",
    "Taking",
    "VectorAttitude",
    "WindEstimate",
    "air_from_wind",
    "assumed_sideslip",
    "attitude_from_vectors",
    "first_state",
    "gravity_seen",
    "navigate_joint",
    "navigate_pair",
    "power_train",
    "quaternion",
    "rotations",
    "wind_from",
]
