"""What flight path reconstruction returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from alula.base.arrays import Array
from alula.base.messages import Message
from alula.flight import Maneuver, Motion


@dataclass(frozen=True)
class Constant:
    """An unknown that the reconstruction estimated: a bias, a scale factor, a wind component.

    For one that walks, `value` and `se` are of its mean over the maneuvers. `observable` is False
    where the data leave it as uncertain as before; it is then reported, not used.
    """

    name: str  # 'b_ax', 'k_alpha', 'wind_n'
    value: float
    se: float
    unit: str
    observable: bool


@dataclass(frozen=True)
class SensorFit:
    """One measured channel beside what the reconstructed motion says it should read.

    t, measured, fitted: (k,) at the sensor's own samples, SI. innovation: (k,) measured minus
    predicted before the sample was used, NaN for methods without one. innovation_se: (k,) its
    predicted standard deviation.
    """

    name: str
    unit: str
    t: Array
    measured: Array
    fitted: Array
    innovation: Array
    innovation_se: Array
    sigma: float  # measurement standard deviation used
    whiteness: float  # lag-1 autocorrelation of the normalized innovations (or residuals)


@dataclass(frozen=True)
class Segment:
    """The reconstruction of one maneuver.

    motion: at the center of gravity. state_names, states (n, k), states_se (n, k): as the filter
    holds them, at the inertial sensor. mismatch: rms of measurement minus the kinematics
    integrated open loop with the estimated constants and initial state, by sensor: SI.
    perturbed: for each independent direction of the reconstruction's uncertainty (one standard
    deviation long), the motion it would have given; identification carries it into error bars.
    """

    maneuver: Maneuver
    motion: Motion
    state_names: tuple[str, ...]
    states: Array
    states_se: Array
    sensors: tuple[SensorFit, ...]
    mismatch: Mapping[str, float]
    perturbed: tuple[Motion, ...] = ()


@dataclass(frozen=True)
class Reconstruction:
    """States with covariance, constants, innovations and their tests.

    nis: mean normalized innovation squared per measurement with its 95 % interval under the
    filter's own assumptions; NaN for methods without innovations.
    """

    method: str  # a FilterName
    segments: tuple[Segment, ...]
    constants: tuple[Constant, ...]
    constants_cov: Array  # (len(constants), len(constants))
    nis_mean: float
    nis_interval: tuple[float, float]
    status: str  # in words; where it did not go well, what to try next
    converged: bool
    messages: tuple[Message, ...] = field(default=())
