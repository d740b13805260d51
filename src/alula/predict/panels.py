"""Lifting surfaces cut into the panels of a vortex lattice: where the vortices lie and what turns.

Panels lie in the plane of their sections' chords as if these had no twist; twist, the camber's
slope at the control point and deflections turn the normals, as in linear theory. A panel that a
hinge cuts turns by the fraction of its chord behind the hinge.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.aircraft.geometry import Airfoil, Geometry
from alula.base.arrays import Array
from alula.predict.half_panels import OTHER_WAY, Half, Spacing, half_panels, image

CONTROLS = ("de", "da", "dr", "df")
_ON_PLANE = 1e-9  # of the span: as near to the plane of symmetry as rounding leaves a fin


@dataclass(frozen=True)
class Panels:
    """A lattice as the core takes it, body axes, m; n panels in rows, k strips, c controls.

    vertices: (n + rows, 3), of the bound vortices, row by row; row_start: (rows + 1,);
    row_surface: (rows,). trailing: (edges, 3), where legs leave the trailing edge; row_trailing:
    (rows,), that of the row's first vertex. control, middle (on the bound vortices), normal:
    (n, 3). normal_rate: (c, n, 3), 1/rad of each of `controls`; parity: (c,), 1 or -1 by symmetry.
    The first `right` panels have their images `mirror` at the end, the next `center` lie in the
    plane of symmetry; right = 0: symmetry is not used. strip: (n,); strip_first, strip_last:
    (k, 3), ends of the trailing edge; strip_wash: (k, 3), on it between them; strip_middle: (k, 3),
    at the quarter chord; strip_chord, strip_width: (k,), m, across the flow; strip_control: (k, 3),
    mean control point; strip_surface: (k,). surfaces: names; mesh: (chordwise, spanwise of the
    half) panels as made, by surface. lines: (m + 1, s + 1, 3) by half of a surface, corners of its
    m rows of s panels.
    """

    surfaces: tuple[str, ...]
    mesh: Mapping[str, tuple[int, int]]
    controls: tuple[str, ...]
    vertices: Array
    row_start: NDArray[np.int32]
    row_surface: NDArray[np.int32]
    trailing: Array
    row_trailing: NDArray[np.int32]
    control: Array
    middle: Array
    normal: Array
    lines: tuple[Array, ...]
    normal_rate: Array
    parity: Array
    mirror: NDArray[np.int32]
    right: int
    center: int
    strip: NDArray[np.int32]
    strip_first: Array
    strip_last: Array
    strip_wash: Array
    strip_middle: Array
    strip_chord: Array
    strip_width: Array
    strip_control: Array
    strip_surface: NDArray[np.int32]

    @property
    def count(self) -> int:
        """Number of panels, both halves."""
        return len(self.control)

    @property
    def corners(self) -> Array:
        """(n, 4, 3): around each panel, from the leading edge's first end."""
        return np.concatenate(
            [
                np.stack([x[:-1, :-1], x[:-1, 1:], x[1:, 1:], x[1:, :-1]], axis=2).reshape(-1, 4, 3)
                for x in self.lines
            ]
        )


def make_panels(
    geometry: Geometry,
    mesh: Mapping[str, tuple[int, int]],
    spacing: Spacing,
    deflections: Mapping[str, float],
    *,
    symmetric: bool,
) -> Panels:
    """The lattice of all lifting surfaces.

    mesh: (chordwise, spanwise of the half) panels by surface; at least one for each piece of the
    span between sections and ends of controls. deflections: rad, by control, steady ones.
    symmetric: the condition allows one half to be solved; used where the shape allows it, too.
    """
    controls = tuple(
        c for c in CONTROLS if any(c in k.gains for s in geometry.surfaces for k in s.controls)
    )
    use = symmetric and _symmetric(geometry, deflections)
    groups: tuple[list[tuple[int, Half]], ...] = ([], [], [])  # right, center, left
    made = {}
    for index, surface in enumerate(geometry.surfaces):
        one = half_panels(surface, geometry.airfoils, mesh[surface.name], spacing, deflections, 1.0)
        made[surface.name] = (one.control.shape[0], one.control.shape[1])
        groups[0 if use and surface.mirror else 1].append((index, one))
        if surface.mirror:
            other = one
            if any(deflections.get(c, 0.0) for c in OTHER_WAY):
                other = half_panels(
                    surface, geometry.airfoils, mesh[surface.name], spacing, deflections, -1.0
                )
            groups[2 if use else 1].append((index, image(other)))
    return _joined(geometry, groups, controls, made)


def _symmetric(geometry: Geometry, deflections: Mapping[str, float]) -> bool:
    """Whether all is its own mirror image: mirrored, or flat in the plane of symmetry."""
    if any(deflections.get(c, 0.0) for c in OTHER_WAY):
        return False
    for s in geometry.surfaces:
        if s.mirror:
            continue
        span = s.arc()[-1]
        if any(abs(x.position[1]) > _ON_PLANE * span or x.twist for x in s.sections):
            return False
        if any(_bent(geometry.airfoils[x.airfoil]) for x in s.sections):
            return False
        if any(c not in OTHER_WAY for k in s.controls for c in k.gains):
            return False
    return True


def _bent(airfoil: Airfoil) -> bool:
    if airfoil.camber is not None:
        return bool(np.any(airfoil.camber[:, 1]))
    return bool(airfoil.alpha_0)


def _joined(
    geometry: Geometry,
    groups: tuple[list[tuple[int, Half]], ...],
    controls: tuple[str, ...],
    mesh: Mapping[str, tuple[int, int]],
) -> Panels:
    halves = [pair for group in groups for pair in group]
    sizes = [sum(h.control.shape[0] * h.control.shape[1] for _, h in g) for g in groups]
    count = sum(sizes)
    rate = np.zeros((len(controls), count, 3))
    rows, row_surface, row_trailing, strip, mirror = [], [], [], [], []
    panel = strips = edges = 0
    images = sizes[0] + sizes[1]
    for index, half in halves:
        m, s = half.control.shape[:2]
        for name, values in half.rates.items():
            rate[controls.index(name), panel : panel + m * s] = values.reshape(-1, 3)
        rows += [s + 1] * m
        row_surface += [index] * m
        row_trailing += [edges] * m
        strip.append(np.tile(np.arange(strips, strips + s), m))
        if panel < sizes[0]:
            mirror.append(images + panel + np.arange(m * s).reshape(m, s)[:, ::-1].ravel())
        panel, strips, edges = panel + m * s, strips + s, edges + s + 1

    def flat(arrays: list[Array]) -> Array:
        return np.ascontiguousarray(np.concatenate([a.reshape(-1, *a.shape[2:]) for a in arrays]))

    first = np.concatenate([h.lines[-1, :-1] for _, h in halves])
    last = np.concatenate([h.lines[-1, 1:] for _, h in halves])
    across = last - first
    return Panels(
        surfaces=tuple(s.name for s in geometry.surfaces),
        mesh=dict(mesh),
        controls=controls,
        vertices=flat([h.vertices for _, h in halves]),
        row_start=np.concatenate([[0], np.cumsum(rows)]).astype(np.int32),
        row_surface=np.array(row_surface, dtype=np.int32),
        trailing=np.concatenate([h.lines[-1] for _, h in halves]),
        row_trailing=np.array(row_trailing, dtype=np.int32),
        control=flat([h.control for _, h in halves]),
        middle=flat([h.bound for _, h in halves]),
        normal=flat([h.normal for _, h in halves]),
        lines=tuple(h.lines for _, h in halves),
        normal_rate=rate,
        parity=np.array([-1.0 if c in OTHER_WAY else 1.0 for c in controls]),
        mirror=np.concatenate([*mirror, []]).astype(np.int32),
        right=sizes[0],
        center=sizes[1],
        strip=np.concatenate(strip).astype(np.int32),
        strip_first=first,
        strip_last=last,
        strip_wash=np.concatenate([h.wash for _, h in halves]),
        strip_middle=np.concatenate([h.quarter for _, h in halves]),
        strip_chord=np.concatenate([h.chord for _, h in halves]),
        strip_width=np.hypot(across[:, 1], across[:, 2]),
        strip_control=np.concatenate([h.control.mean(axis=0) for _, h in halves]),
        strip_surface=np.repeat(
            [i for i, _ in halves], [h.control.shape[1] for _, h in halves]
        ).astype(np.int32),
    )
