"""Shapes for tests of the vortex lattice, and its reference cases as geometry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from alula.aircraft.geometry import (
    Airfoil,
    ControlSurface,
    Geometry,
    LiftingSurface,
    Role,
    Section,
)
from alula.base.arrays import Array
from alula.model import Reference

FLAT = {"flat": Airfoil("flat", 0.0)}
# Alula's control and the sign of the reference's deflection in it.
_CONTROL = {"elevator": "de", "aileron": "da", "rudder": "dr"}


def section(x: float, y: float, z: float, chord: float, twist: float = 0.0) -> Section:
    """A section of which x points aft and z up, as in drawings of lattices."""
    return Section(np.array([-x, y, -z], dtype=float), chord, twist, "flat")


def surface(
    name: str,
    sections: tuple[Section, ...],
    mirror: bool = True,
    role: Role = "wing",
    controls: tuple[ControlSurface, ...] = (),
    panels: tuple[int, int] = (4, 8),
) -> LiftingSurface:
    return LiftingSurface(name, role, sections, mirror, controls, panels)


def geometry(*surfaces: LiftingSurface, airfoils: Mapping[str, Airfoil] = FLAT) -> Geometry:
    return Geometry(surfaces, airfoils=airfoils)


def rectangle(aspect: float = 8.0, panels: tuple[int, int] = (4, 16), **changes: Any) -> Geometry:
    """A flat wing of chord 1 without sweep; its reference is `unit(aspect)`."""
    ends = section(0, 0, 0, 1.0), section(0, 0.5 * aspect, 0, 1.0)
    return geometry(surface("wing", ends, panels=panels, **changes))


def unit(aspect: float = 8.0) -> tuple[Reference, Array]:
    return Reference(S=aspect, b=aspect, c=1.0), np.array([-0.25, 0.0, 0.0])


def reference_case(case: Mapping[str, Any]) -> tuple[Geometry, Reference, Array]:
    """A case of vortex_lattice.json."""
    surfaces = []
    for s in case["surfaces"]:
        control = s.get("control")
        moved = ()
        if control:
            moved = (
                ControlSurface(
                    control["name"], 0.0, 1.0, (control["hinge"],) * 2,
                    {_CONTROL[control["name"]]: 1.0},
                ),
            )  # fmt: skip
        role: Role = {"htail": "tailplane", "vtail": "fin"}.get(s["name"], "wing")  # type: ignore[assignment]
        surfaces.append(
            surface(s["name"], tuple(section(*x) for x in s["sections"]), s["mirror"], role, moved)
        )
    point = np.array([-float(case["x_ref"]), 0.0, 0.0])
    return geometry(*surfaces), Reference(case["S"], case["b"], case["c"]), point


def light_airplane(**changes: Any) -> tuple[Geometry, Reference, Array]:
    """Wing with twist, dihedral and ailerons, tailplane and fin, all controls; 174 panels."""
    aileron = ControlSurface("aileron", 0.6, 0.95, (0.75, 0.7), {"da": 1.0})
    flap = ControlSurface("flap", 0.1, 0.55, (0.7, 0.7), {"df": 1.0})
    elevator = ControlSurface("elevator", 0.0, 1.0, (0.6, 0.6), {"de": 1.0})
    rudder = ControlSurface("rudder", 0.0, 1.0, (0.6, 0.7), {"dr": 1.0})
    wing = surface(
        "wing",
        (section(0.0, 0, 0, 1.5, 0.03), section(0.1, 2.0, 0.1, 1.3, 0.02),
         section(0.3, 4.3, 0.3, 0.9, -0.01)),
        controls=(aileron, flap), panels=changes.get("wing", (7, 9)),
    )  # fmt: skip
    tail = surface(
        "tailplane", (section(3.7, 0, 0.4, 0.8, -0.02), section(3.8, 1.25, 0.4, 0.7, -0.02)),
        role="tailplane", controls=(elevator,), panels=changes.get("tail", (3, 4)),
    )  # fmt: skip
    fin = surface(
        "fin", (section(3.5, 0, 0.4, 1.1), section(3.95, 0, 1.6, 0.65)), mirror=False,
        role="fin", controls=(rudder,), panels=changes.get("fin", (4, 6)),
    )  # fmt: skip
    return geometry(wing, tail, fin), Reference(10.6, 8.6, 1.25), np.array([-0.4, 0.0, 0.05])
