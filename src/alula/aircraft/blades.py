"""The blades of a propeller as its models take them: SI, radians."""

from __future__ import annotations

from dataclasses import dataclass

from alula.base.arrays import Array


@dataclass(frozen=True)
class Blades:
    """A propeller by blade stations.

    count: of blades. radius: m, of the tip. hub_radius: m. r: (k,) m, increasing; chord: (k,) m;
    pitch: (k,) rad, of the section's zero-lift line or chord (see `pitch_of`) against the disk.
    airfoil: section data per station or one for all, see `alula.predict`.
    source: where the numbers come from.
    """

    name: str
    count: int
    radius: float
    hub_radius: float
    r: Array
    chord: Array
    pitch: Array
    pitch_of: str
    source: str
