"""What follows from a lifting surface's sections: area, spans, chords, sweep, tail volume.

Between sections chord and leading edge are straight, so every integral is closed. Lengths along
the span are measured in the surface's own plane: with dihedral, area and span are not projected.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.aircraft.geometry import Body, Geometry, LiftingSurface, Section
from alula.base.arrays import Array, frozen
from alula.predict.body_shape import BodyShape


@dataclass(frozen=True)
class Planform:
    """A wing, tailplane or fin as handbook formulas take it; m, m2, rad, body axes.

    area: of what is there: both halves of a mirrored surface, the one fin. span: tip to tip; of a
    fin it is that of the mirrored wing, twice the height, and `aspect` is that wing's too (so
    aspect = span^2 / 2 area for one fin), as lift-slope formulas want it. chord: mean aerodynamic.
    leading_edge: (3,) of the mean aerodynamic chord, on the right or upper half. quarter_chord:
    (3,) its quarter point. y_mean: m along the span from the plane of symmetry (fin: its root).
    sweep_quarter, sweep_leading: rad, aft positive; dihedral: rad, tips up; averages by area.
    A wing or tailplane whose first section lies off the plane of symmetry is taken to pass
    through the fuselage with that section's chord.
    """

    name: str
    area: float
    span: float
    aspect: float
    taper: float
    chord: float
    leading_edge: Array
    quarter_chord: Array
    y_mean: float
    sweep_quarter: float
    sweep_leading: float
    dihedral: float


def planform(surface: LiftingSurface) -> Planform:
    """The planform of a surface. Area, mean chord: Pusztai 2018, appendix C, strip by strip."""
    sections, arc = _gross(surface)
    step = np.diff(arc)
    c = np.array([s.chord for s in sections])
    position = np.array([s.position for s in sections])
    a, b = c[:-1], c[1:]
    areas = 0.5 * step * (a + b)
    half = float(areas.sum())
    mean = float(np.sum(step * (a * a + a * b + b * b)) / 3.0 / half)
    lead = _by_area(position, step, a, b) / half
    along = _by_area(arc[:, None], step, a, b)[0] / half
    twice = surface.mirror or surface.role == "fin"
    span = (2.0 if twice else 1.0) * float(arc[-1])
    rise = np.diff(position, axis=0)
    quarter = -np.diff(position[:, 0] - 0.25 * c)
    return Planform(
        surface.name,
        area=half * (2.0 if surface.mirror else 1.0),
        span=span,
        aspect=span**2 / (half * (2.0 if twice else 1.0)),
        taper=float(c[-1] / c[0]),
        chord=mean,
        leading_edge=frozen(lead),
        quarter_chord=frozen(lead - [0.25 * mean, 0.0, 0.0]),
        y_mean=float(along),
        sweep_quarter=float(np.arctan(_mean(quarter / step, areas))),
        sweep_leading=float(np.arctan(_mean(-rise[:, 0] / step, areas))),
        dihedral=_mean(np.arctan2(-rise[:, 2], rise[:, 1]), areas),
    )


def exposed_area(surface: LiftingSurface, bodies: Sequence[Body]) -> float:
    """The part of a surface's area outside the bodies, m2, both halves of a mirrored one.

    By 400 stations along the span and 64 along each chord, good to about 0.3 % of the area.
    """
    arc = surface.arc()
    inside_of = [BodyShape(body) for body in bodies]
    edges = np.linspace(0.0, 1.0, 401)
    along = (np.arange(64) + 0.5) / 64
    stations = [surface.at(float(eta)) for eta in 0.5 * (edges[1:] + edges[:-1])]
    chords = np.array([chord for _, chord, _ in stations])
    points = np.repeat([lead for lead, _, _ in stations], len(along), axis=0)
    points[:, 0] -= np.outer(chords, along).ravel()
    inside = np.zeros(len(points), dtype=bool)
    for shape in inside_of:
        inside |= shape.contains(points)
    outside = 1.0 - inside.reshape(len(chords), len(along)).mean(axis=1)
    total = float(np.sum(chords * outside)) * float(arc[-1]) / len(chords)
    return total * (2.0 if surface.mirror else 1.0)


def wetted_area(surface: LiftingSurface, geometry: Geometry) -> float:
    """Both sides of the exposed area, with the contour's excess over the chord, m2.

    Raymer, Aircraft Design, on wetted areas: 1.977 + 0.52 t/c from t/c = 0.05 up, 2.003 below.
    """
    exposed = exposed_area(surface, geometry.bodies)
    t = float(np.mean([geometry.airfoils[s.airfoil].thickness for s in surface.sections]))
    return exposed * (1.977 + 0.52 * t if t >= 0.05 else 2.003)


def tail_volume(tail: Planform, point: Array, S: float, length: float) -> float:
    """Tail area times its arm over S times `length` (c for a tailplane, b for a fin).

    The arm goes from `point` (3,) m, the moment reference, back to the quarter point of the
    tail's mean aerodynamic chord. Dihedral and the fin's tilt are not taken off.
    """
    return tail.area * float(point[0] - tail.quarter_chord[0]) / (S * length)


def _gross(surface: LiftingSurface) -> tuple[tuple[Section, ...], Array]:
    """Sections and their distance along the span, carried through to the plane of symmetry."""
    first = surface.sections[0]
    gap = float(first.position[1])
    if not surface.mirror or surface.role not in ("wing", "tailplane") or gap <= 0.0:
        return surface.sections, surface.arc()
    middle = Section(frozen(first.position * [1.0, 0.0, 1.0]), first.chord, 0.0, first.airfoil)
    return (middle, *surface.sections), np.concatenate([[0.0], gap + surface.arc()])


def _by_area(values: Array, step: Array, a: Array, b: Array) -> Array:
    """Integral of values (n, k), linear between sections, times the chord from a to b."""
    v, w = values[:-1], values[1:]
    weight = step[:, None] / 6.0
    a, b = a[:, None], b[:, None]
    return np.asarray(np.sum(weight * (v * (2.0 * a + b) + w * (a + 2.0 * b)), axis=0))


def _mean(values: Array, areas: Array) -> float:
    return float(np.sum(values * areas) / np.sum(areas))
