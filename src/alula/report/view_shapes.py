"""The lines of a three-view drawing, in body axes: surfaces, panels, controls, bodies."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from alula.aircraft.geometry import Airfoil, Body, ControlSurface, LiftingSurface
from alula.base.arrays import Array
from alula.predict.body_shape import BodyShape


def corners(
    surface: LiftingSurface, side: float, airfoils: Mapping[str, Airfoil] | None = None
) -> list[Array]:
    """Each strip between two sections as (4, 3): leading edges, then trailing edges backward.

    side: -1 for the mirror image. airfoils: given, the strip as it is seen from ahead: upper and
    lower side at the section's greatest thickness, by the airfoils' own.
    """
    arc = surface.arc()
    out = []
    for k in range(len(arc) - 1):
        rows = []
        for i in (k, k + 1):
            section = surface.sections[i]
            first, last = _chord(surface, arc[i] / arc[-1])
            if airfoils is not None:
                middle = first + 0.3 * (last - first)
                thick = airfoils[section.airfoil].thickness * section.chord
                up = 0.5 * thick * _normal(surface, k)
                first, last = middle - up, middle + up
            rows.append((first, last))
        (a, d), (b, c) = rows
        out.append(_turned(np.array([a, b, c, d]), side))
    return out


def control_corners(surface: LiftingSurface, control: ControlSurface, side: float) -> Array:
    """Hinge from inner to outer end, then the trailing edge backward, (4, 3)."""
    (a, d), (b, c) = (_chord(surface, f) for f in (control.start, control.end))
    inner, outer = control.hinge
    return _turned(np.array([a + inner * (d - a), b + outer * (c - b), c, d]), side)


def lattice(surface: LiftingSurface, side: float) -> list[Array]:
    """The lines between the default mesh's panels: along the chord, and along the span."""
    chordwise, spanwise = surface.panels
    sections = surface.arc() / surface.arc()[-1]
    stations = np.unique(np.concatenate([np.linspace(0.0, 1.0, spanwise + 1), sections]))
    ends = np.array([_chord(surface, float(f)) for f in stations])  # (n, 2, 3)
    lines = [ends[i] for i in range(1, len(ends) - 1)]
    for x in np.arange(1, chordwise) / chordwise:
        lines.append(ends[:, 0] + x * (ends[:, 1] - ends[:, 0]))
    return [_turned(line, side) for line in lines]


def outline(body: Body, view: str) -> tuple[list[Array], list[Array]]:
    """The skin's silhouettes and the stations' lines: from above, from the left, from ahead."""
    shape = BodyShape(body)
    if view == "from ahead":
        turn = np.linspace(0.0, 2.0 * np.pi, 49)
        rings = [
            s.position
            + np.column_stack(
                [0.0 * turn, 0.5 * s.width * np.cos(turn), 0.5 * s.height * np.sin(turn)]
            )
            for s in body.sections
            if s.width > 0.0
        ]
        return rings, []
    # Closer together at the ends, where the skin is round.
    s = 0.5 * shape.length * (1.0 - np.cos(np.linspace(0.0, np.pi, 81)))
    center = np.column_stack([shape.x_nose - s, shape.center(s)])
    above = view == "from above"
    size = np.sqrt(np.maximum(shape.width2(s) if above else shape.height2(s), 0.0))
    half = 0.5 * np.outer(size, [0.0, 1.0, 0.0] if above else [0.0, 0.0, 1.0])
    stations = [
        np.array([c.position - h, c.position + h])
        for c in body.sections
        for h in [np.array([0.0, 0.5 * c.width, 0.0] if above else [0.0, 0.0, 0.5 * c.height])]
    ]
    return [np.concatenate([center + half, (center - half)[::-1]])], stations


def _chord(surface: LiftingSurface, fraction: float) -> tuple[Array, Array]:
    """Leading and trailing edge (3,) at a fraction of the (half) span, with the twist."""
    lead, chord, twist = surface.at(float(fraction))
    arc = surface.arc()
    k = int(np.clip(np.searchsorted(arc, fraction * arc[-1]) - 1, 0, len(arc) - 2))
    # On a fin the nose turns right, and the trailing edge with it left.
    across = _normal(surface, k) * (1.0 if surface.role == "fin" else -1.0)
    return lead, lead - chord * np.array([np.cos(twist), 0.0, 0.0]) + chord * np.sin(twist) * across


def _normal(surface: LiftingSurface, strip: int) -> Array:
    """Upward (on a fin: to the left) unit normal of a strip, across the flow."""
    a, b = surface.sections[strip].position, surface.sections[strip + 1].position
    dy, dz = float(b[1] - a[1]), float(b[2] - a[2])
    return np.asarray(np.array([0.0, dz, -dy]) / np.hypot(dy, dz))


def _turned(points: Array, side: float) -> Array:
    return np.asarray(points * np.array([1.0, side, 1.0]))
