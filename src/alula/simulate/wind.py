"""Air that moves: wind over height, discrete gusts, turbulence. North, east, down; m/s."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from alula.base.arrays import Array, frozen
from alula.core import core

NORMALS = 8  # standard normal numbers of turbulence for each step, motion/dryden.hpp


@dataclass(frozen=True)
class Wind:
    """Wind that does not change with time, the way it blows to.

    steady: (3,) m/s at the reference height. shear: (3,) 1/s, change per meter of height above it.
    logarithmic: `steady` grows with ln(z/roughness), z the height above ground between 3 and 1000
    ft (MIL-F-8785C, 3.7.3.2). Heights in m.
    """

    steady: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    shear: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    reference_height: float = 0.0
    logarithmic: bool = False
    roughness: float = 0.0457
    ground: float = 0.0


def as_wind(wind: Array | Wind | None) -> Wind:
    """A `Wind` of what may be given for one: (3,) NED m/s, the way it blows to; None: calm."""
    if wind is None:
        return Wind()
    return wind if isinstance(wind, Wind) else Wind(np.asarray(wind, dtype=np.float64))


@dataclass(frozen=True)
class CosineGust:
    """A discrete gust of one minus cosine (MIL-F-8785C, 3.7.1.3), body axes.

    amplitude: (3,) m/s, velocity of the air. start: s. length: m from zero to the full amplitude.
    speed: m/s, airspeed at entry. returns: there and back over twice the length (CS 25.341 (a)(2)),
    else the amplitude stays.
    """

    amplitude: Array
    start: float
    length: float
    speed: float
    returns: bool = False

    def value(self, t: Array) -> Array:
        """Gust inputs (n, 6) at times t (n,), s: ug vg wg (m/s), rates zero."""
        out = np.zeros((len(t), 6))
        core.cosine_gust(
            np.ascontiguousarray(t, dtype=np.float64),
            np.array(self.amplitude, dtype=np.float64),
            self.start,
            self.length,
            self.speed,
            self.returns,
            out,
        )
        return out


@dataclass(frozen=True)
class Turbulence:
    """Dryden turbulence of MIL-F-8785C, section 3.7.

    W20: wind 20 ft above the ground, m/s, which sets it below 1000 ft. sigma: m/s above 2000 ft.
    seed: of the standard normal numbers; the same seed gives the same flight.
    """

    W20: float = 0.0
    sigma: float = 0.0
    seed: int = 0

    def normals(self, steps: int) -> Array:
        """(steps, 8) standard normal numbers."""
        return np.random.default_rng(self.seed).standard_normal((steps, NORMALS))

    def arguments(self, span: float, steps: int) -> dict[str, Array]:
        """What the core's `fly` takes of it, for a span (m) and a number of integration steps."""
        return {
            "turbulence": np.array([span, self.W20, self.sigma]),
            "normals": self.normals(steps),
        }
