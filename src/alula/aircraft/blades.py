"""The blades of a propeller as its models take them: SI, radians."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from alula.base.arrays import Array

PitchOf = Literal["chord", "zero_lift"]


@dataclass(frozen=True)
class BladePolar:
    """Lift and drag of a blade's section, in the form of QPROP (Drela 2007) or as a table.

    c_l = (c_l_0 + c_l_alpha alpha)/sqrt(1 - Mach^2) within c_l_min and c_l_max; c_d = (c_d_0 +
    c_d_2 (c_l - c_l_cd0)^2) (Reynolds/reynolds)^reynolds_power with c_d_2_upper above c_l_cd0 and
    c_d_2_lower below, and c_d_stalled sin^2 of the angle from there where the lift is held.
    table: alpha (rad, increasing), c_l, c_d instead of these, held outside; the corrections for
    Mach number (where mach_corrected) and Reynolds number apply to it too. source: where from.
    """

    c_l_0: float = 0.0
    c_l_alpha: float = 0.0
    c_l_min: float = -10.0
    c_l_max: float = 10.0
    c_d_0: float = 0.0
    c_d_2_upper: float = 0.0
    c_d_2_lower: float = 0.0
    c_l_cd0: float = 0.0
    c_d_stalled: float = 2.0
    reynolds: float = 1.0
    reynolds_power: float = 0.0
    mach_corrected: bool = True
    table: tuple[Array, Array, Array] | None = None
    source: str = ""


@dataclass(frozen=True)
class MomentumParameters:
    """What Pusztai's propeller (2018, 2.1) needs beside its shape.

    c_l_alpha: 1/rad. alpha_max: rad, beyond which the lift is held. c_d_alpha: 1/rad^2.
    pitch: m, the effective geometric pitch: that of the line of no lift.
    """

    c_l_alpha: float
    alpha_max: float
    c_d_alpha: float
    pitch: float


@dataclass(frozen=True)
class Blades:
    """A propeller by blade stations.

    count: of blades. radius: m, of the tip. hub_radius: m. r: (k,) m, increasing; chord: (k,) m;
    pitch: (k,) rad, of the section's chord or zero-lift line (see `pitch_of`) against the disk.
    polars: none, one for all stations or one per station. sense: +1 right-hand (clockwise seen
    from behind), -1 left-hand. helix: m, the geometric pitch where it is one number.
    momentum: parameters of the momentum model, None where they are to be fitted.
    source: where the numbers come from.
    """

    name: str
    count: int
    radius: float
    hub_radius: float
    r: Array
    chord: Array
    pitch: Array
    pitch_of: PitchOf
    source: str
    polars: tuple[BladePolar, ...] = ()
    sense: float = 1.0
    helix: float | None = None
    momentum: MomentumParameters | None = None

    @property
    def diameter(self) -> float:
        """m."""
        return 2.0 * self.radius
