"""The aircraft's shape as the predictors and the three-view drawing take it: SI, radians.

Positions are in body axes (x forward, y right, z down) from the aircraft file's datum.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from alula.aircraft.blades import Blades
from alula.base.arrays import Array

Role = Literal["wing", "tailplane", "fin", "other"]


@dataclass(frozen=True)
class Polar:
    """Section coefficients over the angle of attack, measured or computed at one Reynolds number.

    alpha: (k,) rad, increasing; c_l, c_d, c_m (about the quarter chord): (k,). source: where from.
    """

    alpha: Array
    c_l: Array
    c_d: Array
    c_m: Array
    reynolds: float | None
    source: str


@dataclass(frozen=True)
class Airfoil:
    """A section's shape and what is known of its aerodynamics; None where it is not stated.

    thickness: over the chord. camber: (k, 2), the mean line's x/c from the leading edge and z/c,
    up positive; None for a symmetric section. c_l_alpha: 1/rad. alpha_0: rad, of zero lift.
    """

    name: str
    thickness: float
    camber: Array | None = None
    c_l_alpha: float | None = None
    alpha_0: float | None = None
    polar: Polar | None = None


@dataclass(frozen=True)
class Section:
    """A chord of a lifting surface. position: (3,) m, of the leading edge; twist: rad, nose up."""

    position: Array
    chord: float
    twist: float
    airfoil: str


@dataclass(frozen=True)
class ControlSurface:
    """A hinged part of a lifting surface.

    start, end: fractions of the surface's span from its first to its last section. hinge: fraction
    of the chord at both ends. gains: deflection, rad trailing edge down (on a fin: left), over each
    control in Alula's notation. On a mirrored surface `da` and `dr` move the left half the other
    way, `de` and `df` the same way. c_l_delta, c_m_delta: section lift and moment (quarter chord)
    per rad of deflection where they are known.
    """

    name: str
    start: float
    end: float
    hinge: tuple[float, float]
    gains: Mapping[str, float]
    c_l_delta: float | None = None
    c_m_delta: float | None = None


@dataclass(frozen=True)
class LiftingSurface:
    """A wing, tailplane or fin by its sections, from the root to the (right or upper) tip.

    mirror: the left half is added. panels: (chordwise, spanwise of this half), the default mesh.
    """

    name: str
    role: Role
    sections: tuple[Section, ...]
    mirror: bool
    controls: tuple[ControlSurface, ...] = ()
    panels: tuple[int, int] = (6, 12)

    def arc(self) -> Array:
        """Distance of each section from the first along the (half) span, seen from ahead, m."""
        yz = np.array([s.position[1:] for s in self.sections])
        steps = np.hypot(*np.diff(yz, axis=0).T)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def at(self, fraction: float) -> tuple[Array, float, float]:
        """Leading edge (3,), chord and twist at a fraction of the (half) span, interpolated."""
        arc = self.arc()
        where = fraction * arc[-1]
        x, y, z = (np.interp(where, arc, [s.position[k] for s in self.sections]) for k in range(3))
        chord = np.interp(where, arc, [s.chord for s in self.sections])
        twist = np.interp(where, arc, [s.twist for s in self.sections])
        return np.array([x, y, z]), float(chord), float(twist)


@dataclass(frozen=True)
class CrossSection:
    """An elliptic cut through a body. position: (3,) m, of its center; width, height: m."""

    position: Array
    width: float
    height: float


@dataclass(frozen=True)
class Body:
    """A fuselage or nacelle by its cross-sections from nose to tail (at least three)."""

    name: str
    sections: tuple[CrossSection, ...]


@dataclass(frozen=True)
class Geometry:
    """Everything that `alula predict` knows of the shape. blades: by name of the engine.

    drag_area: m2, c_d times area of all that is no lifting surface, as the file states it.
    """

    surfaces: tuple[LiftingSurface, ...]
    bodies: tuple[Body, ...] = ()
    airfoils: Mapping[str, Airfoil] = field(default_factory=dict)
    blades: Mapping[str, Blades] = field(default_factory=dict)
    drag_area: float = 0.0

    def surface(self, role: Role) -> LiftingSurface | None:
        """The first surface with this role, None where there is none."""
        return next((s for s in self.surfaces if s.role == role), None)
