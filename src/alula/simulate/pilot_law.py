"""What a pilot does before and after the input: holds the entry condition, keeps an axis, lets go.

Gains follow from the aircraft's own control effectiveness at the trim: attitude is held as by a
second-order system of BANDWIDTH and DAMPING beside the aircraft's own stiffness. McRuer and
Krendel, Mathematical Models of Human Pilot Behavior, AGARD AG-188, 1974, find crossovers of 1 to
3 rad/s in attitude; outer loops are some times slower. Lag and reaction time are not modeled.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.simulate.pilot import Pilot
from alula.simulate.plant import plant_matrices
from alula.simulate.trim import Trim

BANDWIDTH, DAMPING = 1.5, 0.7  # rad/s, of attitude
HEIGHT, HEADING = 0.2, 0.1  # rad/s, of the outer loops
YAW = 1.0  # 1/s, of damping added by the rudder
THROTTLE = 0.03  # per m/s of airspeed
G = 9.80665
AXES: Mapping[str, tuple[str, ...]] = {"pitch": ("de", "dt"), "roll": ("da",), "yaw": ("dr",)}
# What a floating surface answers to: a flow angle and a rate.
_FLOATS = {"de": ("alpha", "q"), "da": ("beta", "p"), "dr": ("beta", "r")}


@dataclass(frozen=True)
class Law:
    """Gains by (control, sight), and what the pilot wants to see; see `Pilot`."""

    gains: Mapping[tuple[str, str], float]
    references: Mapping[str, float]

    def pilot(self, limits: Mapping[str, tuple[float, float]]) -> Pilot:
        """The law as `fly` takes it, within the control limits (rad, throttle 0 to 1)."""
        return Pilot(self.gains, self.references, limits)

    def of(self, axes: Iterable[str]) -> Law:
        """The law of some axes: 'pitch', 'roll', 'yaw'."""
        controls = {c for axis in axes for c in AXES[axis]}
        return Law({k: g for k, g in self.gains.items() if k[0] in controls}, self.references)


def holding(plant: Any, trim: Trim, V: float) -> Law:
    """The law that holds a trimmed flight: attitude, height, heading, and airspeed by throttle.

    plant: the core's AircraftModel. V: true airspeed of the trim, m/s.
    """
    u = np.zeros(plant.input_count)
    for i, name in enumerate(("de", "da", "dr", "df", "dt")):
        u[i] = trim.controls[name]
    u[5] = trim.thrust
    B = plant_matrices(plant, _settled(plant, trim.state, u), u).B
    pitch, roll, yaw = float(B[11, 0]), float(B[10, 1]), float(B[12, 2])
    gains: dict[tuple[str, str], float] = {}
    if pitch:
        attitude = BANDWIDTH**2 / pitch
        gains |= {
            ("de", "theta"): attitude,
            ("de", "q"): 2.0 * DAMPING * BANDWIDTH / pitch,
            ("de", "h"): attitude * HEIGHT / V,
        }
    if roll:
        attitude = BANDWIDTH**2 / roll
        gains |= {
            ("da", "phi"): attitude,
            ("da", "p"): 2.0 * DAMPING * BANDWIDTH / roll,
            ("da", "psi"): attitude * HEADING * V / G,
        }
    if yaw:
        gains["dr", "r"] = YAW / yaw
    if trim.controls["dt"] > 0.0:
        gains["dt", "V"] = THROTTLE
    return Law(gains, seen(plant, trim, V, u))


def floating(plant: Any, trim: Trim, V: float, ratios: Mapping[str, tuple[float, float]]) -> Law:
    """Free surfaces: each goes at once where its hinge moments vanish, in proportion to a flow
    angle and a rate, from where it was trimmed.

    ratios: by control, deflection per flow angle (de: alpha; da, dr: beta) and per rate (s).
    """
    u = np.zeros(plant.input_count)
    gains = {}
    for control, (angle, rate) in ratios.items():
        flow, turning = _FLOATS[control]
        gains[control, flow], gains[control, turning] = -angle, -rate
    return Law(gains, seen(plant, trim, V, u))


def seen(plant: Any, trim: Trim, V: float, u: Array) -> dict[str, float]:
    """What a pilot sees in the trimmed flight."""
    from alula.simulate.fly import attitudes

    phi, theta, psi = attitudes(np.asarray(trim.state)[None, :13])[0][0]
    return {
        "V": V, "alpha": trim.alpha, "beta": trim.beta,
        "p": trim.p, "q": trim.q, "r": trim.r,
        "phi": float(phi), "theta": float(theta), "psi": float(psi),
        "h": -float(trim.state[2]),
    }  # fmt: skip


def _settled(plant: Any, state: Array, u: Array) -> Array:
    if len(state) == plant.state_count:
        return np.array(state)
    out = np.zeros(plant.state_count)
    plant.settle(np.array(state), u, out)
    return out
