"""One side of a lifting surface cut into panels: edges, vortices, normals and how these turn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

import numpy as np

from alula.aircraft.geometry import Airfoil, ControlSurface, LiftingSurface
from alula.base.arrays import Array

Spacing = Literal["uniform", "cosine"]
OTHER_WAY = frozenset(("da", "dr"))  # move the left half of a mirrored surface the other way
_SAME = 1e-9  # of the span: breaks nearer than this are one


class Half(NamedTuple):
    """One side of a surface: m rows of s panels; the control's normal rates by control."""

    vertices: Array  # (m, s + 1, 3)
    control: Array  # (m, s, 3)
    bound: Array  # (m, s, 3), on the bound vortices
    normal: Array  # (m, s, 3)
    lines: Array  # (m + 1, s + 1, 3), corners of the panels
    rates: Mapping[str, Array]  # (m, s, 3)
    quarter: Array  # (s, 3)
    wash: Array  # (s, 3), on the trailing edge
    chord: Array  # (s,)


def span_edges(
    surface: LiftingSurface, arc: Array, count: int, spacing: Spacing
) -> tuple[Array, Array]:
    """Fractions of the span at the strips' edges, from 0 to 1, and between where flow is looked at.

    arc: fractions of the sections. Sections and ends of controls are edges; the strips between
    them keep the spacing's widths as nearly as their whole number allows, and are more than asked
    for where there are more pieces. Cosine: finer to the tip of a mirrored surface, to both ends of
    another. Between edges that lie by a cosine the flow is looked at in the middle of its angle, as
    in Multhopp's method; in the middle of the strip the loads of the tip would converge slowly.
    """
    ends = [x for c in surface.controls for x in (c.start, c.end)]
    breaks = [0.0]
    for place in sorted([*arc.tolist(), *ends, 1.0]):
        if place - breaks[-1] > _SAME:
            breaks.append(place)
    pieces = len(breaks) - 1
    count = max(count, pieces)
    ideal = np.arange(2 * count + 1) / (2 * count)
    if spacing == "cosine" and surface.mirror:
        ideal = np.sin(0.5 * np.pi * ideal)
    elif spacing == "cosine":
        ideal = 0.5 - 0.5 * np.cos(np.pi * ideal)
    ideal, between = ideal[::2], ideal[1::2]
    index = np.zeros(pieces + 1, dtype=int)
    index[-1] = count
    for i in range(1, pieces):
        nearest = int(np.argmin(np.abs(ideal - breaks[i])))
        index[i] = min(max(nearest, index[i - 1] + 1), count - (pieces - i))
    return np.interp(ideal, ideal[index], breaks), np.interp(between, ideal[index], breaks)


def half_panels(
    surface: LiftingSurface,
    airfoils: Mapping[str, Airfoil],
    mesh: tuple[int, int],
    spacing: Spacing,
    deflections: Mapping[str, float],
    side: float,
) -> Half:
    """The surface as described; side -1: with the deflections of its image, not yet mirrored."""
    m = mesh[0]
    arc = surface.arc()
    arc = arc / arc[-1]
    t, middle = span_edges(surface, arc, mesh[1], spacing)
    share = ((middle - t[:-1]) / (t[1:] - t[:-1]))[:, None]
    edges = _between(np.array([[*s.position, s.chord] for s in surface.sections]), arc, t)
    front, chord = edges[:, :3], edges[:, 3]
    xi = np.arange(m + 1) / m
    if spacing == "cosine":
        xi = 0.5 - 0.5 * np.cos(np.pi * xi)

    # Lines along the span at fractions of the chord: edges of panels, bound vortices, control
    # points, and the quarter chord; then the points of the strips on them.
    width = xi[1:] - xi[:-1]
    fractions = np.concatenate([xi, xi[:-1] + 0.25 * width, xi[:-1] + 0.75 * width, [0.25]])
    along = np.empty((len(fractions), *front.shape))
    along[:] = front
    along[:, :, 0] -= fractions[:, None] * chord
    inside = along[:, :-1] * (1.0 - share) + along[:, 1:] * share
    behind = along[2 * m + 1 : -1]

    # Chord direction turned about the span's direction across the flow, then the normal to it.
    line = front[1:] - front[:-1]
    up = np.zeros_like(line)
    up[:, 1], up[:, 2] = line[:, 2], -line[:, 1]
    up = _unit(up)
    incidence = _incidence(surface, airfoils, arc, middle, fractions[2 * m + 1 : -1])
    aft = -np.sin(incidence)[..., None] * up
    aft[..., 0] = -np.cos(incidence)
    normal = _unit(cross(aft, behind[:, 1:] - behind[:, :-1]))

    rates: dict[str, Array] = {}
    toward = _deflected(surface)
    for control_surface in surface.controls:
        axis, weight = _hinge(control_surface, front, chord, t, middle, xi, toward)
        turn = sum(
            gain * deflections.get(name, 0.0) * (side if name in OTHER_WAY else 1.0)
            for name, gain in control_surface.gains.items()
        )
        if turn:
            normal = _rotated(normal, axis, turn * weight)
        rate = weight[..., None] * cross(axis, normal)
        for name, gain in control_surface.gains.items():
            rates[name] = gain * rate + rates.get(name, 0.0)
    return Half(
        vertices=along[m + 1 : 2 * m + 1],
        control=inside[2 * m + 1 : -1],
        bound=inside[m + 1 : 2 * m + 1],
        normal=normal,
        lines=along[: m + 1],
        rates=rates,
        quarter=inside[-1],
        wash=inside[m],
        chord=0.5 * (chord[1:] + chord[:-1]),
    )


def _incidence(
    surface: LiftingSurface, airfoils: Mapping[str, Airfoil], arc: Array, middle: Array, at: Array
) -> Array:
    """Angle (rad, nose up) of the mean line at fractions `at` of the chord, (len(at), strips).

    An airfoil of which only the angle of zero lift is known is turned by it.
    """
    by_section = np.empty((len(surface.sections), len(at)))
    for k, section in enumerate(surface.sections):
        airfoil = airfoils[section.airfoil]
        by_section[k] = section.twist
        if airfoil.camber is not None:
            x, z = airfoil.camber.T
            by_section[k] -= np.arctan(np.interp(at, x, _slope(x, z)))
        elif airfoil.alpha_0 is not None:
            by_section[k] -= airfoil.alpha_0
    return _between(by_section, arc, middle).T


def _slope(x: Array, z: Array) -> Array:
    return np.asarray(np.gradient(z, x, edge_order=2 if len(x) > 2 else 1))


def _deflected(surface: LiftingSurface) -> Array:
    """Where a positive deflection moves the trailing edge: down; on a fin to the left."""
    step = surface.sections[-1].position - surface.sections[0].position
    upright = abs(step[1]) <= _SAME * abs(step[2])
    if upright or (surface.role == "fin" and step[2] != 0.0):
        return np.array([0.0, -1.0, 0.0])
    return np.array([0.0, 0.0, 1.0])


def _hinge(
    control: ControlSurface,
    front: Array,
    chord: Array,
    t: Array,
    middle: Array,
    xi: Array,
    toward: Array,
) -> tuple[Array, Array]:
    """Unit vectors along the hinge (strips, 3), and the share of each panel's turning (m, strips).

    Right-handed rotation about them moves the trailing edge toward the given direction.
    """
    hinge, at = (
        control.hinge[0]
        if control.hinge[0] == control.hinge[1]
        else np.interp(x, [control.start, control.end], control.hinge)
        for x in (t, middle)
    )
    line = front.copy()
    line[:, 0] -= hinge * chord
    axis = _unit(line[1:] - line[:-1])
    # Axis x aft is where the trailing edge goes.
    axis[toward[2] * axis[:, 1] < toward[1] * axis[:, 2]] *= -1.0
    inside = (middle > control.start) & (middle < control.end)
    behind = (xi[1:, None] - at) / (xi[1:] - xi[:-1])[:, None]
    return axis, np.minimum(np.maximum(behind, 0.0), 1.0) * inside


def _between(rows: Array, arc: Array, t: Array) -> Array:
    """Rows (sections, k) interpolated to places (len(t), k) along the span."""
    i = np.minimum(np.searchsorted(arc, t, side="right"), len(arc) - 1)
    w = ((t - arc[i - 1]) / (arc[i] - arc[i - 1]))[:, None]
    out: Array = rows[i - 1] * (1.0 - w) + rows[i] * w
    return out


def _unit(vectors: Array) -> Array:
    length = np.sqrt(np.einsum("...i,...i", vectors, vectors))
    out: Array = vectors / length[..., None]
    return out


def cross(a: Array, b: Array) -> Array:
    """Cross product over the last axis; NumPy's own takes several times as long on few vectors."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.subtract(a[..., j] * b[..., k], a[..., k] * b[..., j], out=out[..., i])
    return out


def _rotated(vectors: Array, axis: Array, angle: Array) -> Array:
    """Vectors (m, s, 3) turned about the unit vectors (s, 3) by angles (m, s): Rodrigues."""
    c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
    along = np.sum(axis * vectors, axis=2, keepdims=True)
    out: Array = vectors * c + cross(axis, vectors) * s + axis * along * (1.0 - c)
    return out


def image(half: Half) -> Half:
    """The other side, its rows from tip to root so that bound vortices run to the right, too."""
    flip = np.array([1.0, -1.0, 1.0])

    def over(x: Array) -> Array:
        out: Array = x[:, ::-1] * flip
        return out

    rates = {
        name: over(rate) * (-1.0 if name in OTHER_WAY else 1.0) for name, rate in half.rates.items()
    }
    return Half(
        over(half.vertices),
        over(half.control),
        over(half.bound),
        over(half.normal),
        over(half.lines),
        rates,
        half.quarter[::-1] * flip,
        half.wash[::-1] * flip,
        half.chord[::-1],
    )
