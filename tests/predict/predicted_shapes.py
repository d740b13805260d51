"""A light airplane's shape for the tests of whole-aircraft predictions."""

from __future__ import annotations

from alula.aircraft.geometry import (
    Airfoil,
    Body,
    ControlSurface,
    CrossSection,
    Geometry,
    LiftingSurface,
    Section,
)
from alula.base.arrays import frozen

FOIL = "foil"
S, B, C = 10.6, 8.65, 1.25


def section(x: float, y: float, z: float, chord: float, scale: float) -> Section:
    """x, y, z m of the leading edge, body axes."""
    return Section(frozen([scale * x, scale * y, scale * z]), scale * chord, 0.0, FOIL)


def light_airplane(scale: float = 1.0, body: bool = True, x: float = 0.0) -> Geometry:
    """SportStar-like: 'light airplane of SportStar size', nose at x + 1.7 m, all times scale."""
    k = scale
    wing = LiftingSurface(
        "wing", "wing",
        (section(x + 0.44, 0, 0, 1.5259, k), section(x + 0.29, 4.325, 0, 0.925, k)),
        True, (ControlSurface("aileron", 0.55, 0.95, (0.75, 0.75), {"da": 1.0}),
               ControlSurface("flap", 0.1, 0.5, (0.75, 0.75), {"df": 1.0})),
    )  # fmt: skip
    tailplane = LiftingSurface(
        "tailplane", "tailplane",
        (section(x - 3.325, 0, -0.1, 0.8, k), section(x - 3.325, 1.25, -0.1, 0.8, k)),
        True, (ControlSurface("elevator", 0.0, 1.0, (0.6, 0.6), {"de": 1.0}),),
    )  # fmt: skip
    fin = LiftingSurface(
        "fin", "fin",
        (section(x - 3.125, 0, -0.1, 1.1, k), section(x - 3.575, 0, -1.3, 0.65, k)),
        False, (ControlSurface("rudder", 0.0, 1.0, (0.6, 0.6), {"dr": 1.0}),),
    )  # fmt: skip
    hull = Body("fuselage", tuple(
        CrossSection(frozen([k * (x + s), 0.0, -0.1 * k]), k * w, k * w)
        for s, w in ((1.75, 0.0), (1.2, 0.9), (-0.3, 1.15), (-1.6, 0.75), (-4.2, 0.0))
    ))  # fmt: skip
    bodies = (hull,) if body else ()
    return Geometry((wing, tailplane, fin), bodies, {FOIL: Airfoil(FOIL, 0.12)})
