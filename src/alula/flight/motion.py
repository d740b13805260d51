"""What the aircraft did during one maneuver: the value that reconstruction makes and
identification, simulation and validation take.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from alula.base.arrays import Array
from alula.flight.maneuver import Maneuver


@dataclass(frozen=True)
class Motion:
    """Time histories of one maneuver on one time base, at the center of gravity.

    All arrays are (n,), SI and radians, body axes x forward, y right, z down. `V alpha beta` are
    relative to the air; `ax ay az` is specific force (level flight: az = -9.81); `p q r` and their
    derivatives are rates of the body against the Earth.
    """

    maneuver: Maneuver
    t: Array  # s, the log's time
    V: Array  # m/s, true airspeed
    alpha: Array  # rad
    beta: Array  # rad, asin(v/V)
    p: Array  # rad/s
    q: Array
    r: Array
    pdot: Array  # rad/s2
    qdot: Array
    rdot: Array
    ax: Array  # m/s2, specific force at the center of gravity
    ay: Array
    az: Array
    phi: Array  # rad
    theta: Array
    psi: Array
    h: Array  # m, positive up
    rho: Array  # kg/m3
    controls: Mapping[str, Array] = field(default_factory=dict)  # de da dr df dt, rad (dt: 0 to 1)
    thrust: Array | None = None  # N, all engines
    fuel_used: Array | None = None  # kg
    window_s: float = 0.0  # of the local cubics that gave pdot qdot rdot; 0 where recorded
    recorded: Mapping[str, Array] = field(default_factory=dict)  # coefficients as recorded: 'CZ'

    @property
    def dt(self) -> float:
        """Sample interval, s (mean over the maneuver)."""
        return float((self.t[-1] - self.t[0]) / (len(self.t) - 1))
