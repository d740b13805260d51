"""A lifting surface in the handbook's numbers: area, aspect ratio, mean chord, sweep, dihedral."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, tan

import numpy as np
from numpy.typing import NDArray

from alula.aircraft.geometry import Airfoil, ControlSurface, Geometry, LiftingSurface
from alula.base.arrays import Array
from alula.predict.handbook import Found
from alula.predict.lift_slope import SECTION, SECTION_SE
from alula.predict.planform import Planform, planform

STEPS = 400  # stations over the half span of the tables that the lifting line reads


@dataclass(frozen=True)
class SurfaceShape:
    """What the formulas take of a surface; positions in body axes from the datum.

    area: m2, both halves of a mirrored one. span: tip to tip, or a fin's height. aspect: of the one
    connected surface (a fin's own, not the mirrored wing's). station: distance of the mean chord
    from the root along the span, m. quarter: (3,), its quarter point, on the right or upper half.
    root: (3,) of the first section's leading edge. sweep_*: rad. slope: c_l_alpha, incompressible.
    eta: (k,) over the (half) span, 0 to 1; local_*: (k,) there; local_quarter: x of the quarter
    chord, m.
    """

    name: str
    mirror: bool
    area: float
    span: float
    aspect: float
    taper: float
    mean_chord: float
    station: float
    quarter: Array
    root: Array
    root_chord: float
    sweep_leading: float
    sweep_quarter: float
    sweep_half: float
    thickness: float
    slope: Found
    eta: Array
    local_chord: Array
    local_twist: Array
    local_dihedral: Array
    local_zero_lift: Array
    local_moment: Array
    local_quarter: Array
    controls: tuple[ControlSurface, ...]
    plan: Planform

    def chord(self, eta: Array) -> Array:
        """Chord, m, at |2 y/b| (k,) of a mirrored surface."""
        return np.interp(eta, self.eta, self.local_chord)

    def within(self, control: ControlSurface) -> tuple[NDArray[np.bool_], Array]:
        """Where the control reaches over `eta` (k,) bool, and its hinge there, of the chord (k,).

        A surface that begins off the plane of symmetry counts its span from its first section.
        """
        gap = self._gap
        at = (self.eta - gap) / (1.0 - gap)
        inside = (at >= control.start) & (at <= control.end)
        return inside, np.interp(at, [control.start, control.end], control.hinge)

    @property
    def _gap(self) -> float:
        free = self.mirror and 0.0 < self.root[1] < 0.5 * self.span
        return float(2.0 * self.root[1] / self.span) if free else 0.0


def surface_shape(surface: LiftingSurface, geometry: Geometry) -> SurfaceShape:
    """The numbers of one surface."""
    plan = planform(surface)
    fin = surface.role == "fin"
    eta = (np.arange(STEPS) + 0.5) / STEPS
    arc = surface.arc()
    length = 0.5 * plan.span
    where = eta * length
    arc = arc + (length - arc[-1])  # what lies inside the fuselage goes on with the first section
    foils = [geometry.airfoils.get(x.airfoil) for x in surface.sections]
    lead = np.array([x.position for x in surface.sections])
    d = np.diff(lead, axis=0)
    segment = np.clip(np.searchsorted(arc, where) - 1, 0, len(d) - 1)
    dihedral = np.where(where < arc[0], 0.0, np.arctan2(-d[:, 2], np.abs(d[:, 1]))[segment])
    slope, se = _slope(foils)
    return SurfaceShape(
        name=surface.name,
        mirror=surface.mirror,
        area=plan.area,
        span=length if fin else plan.span,
        aspect=0.5 * plan.aspect if fin else plan.aspect,
        taper=plan.taper,
        mean_chord=plan.chord,
        station=plan.y_mean,
        quarter=plan.quarter_chord,
        root=lead[0],
        root_chord=surface.sections[0].chord,
        sweep_leading=plan.sweep_leading,
        sweep_quarter=plan.sweep_quarter,
        sweep_half=atan(2.0 * tan(plan.sweep_quarter) - tan(plan.sweep_leading)),
        thickness=float(np.mean([0.12 if a is None else a.thickness for a in foils])),
        slope=Found(slope, se * slope, ""),
        eta=eta,
        local_chord=np.interp(where, arc, [x.chord for x in surface.sections]),
        local_twist=np.interp(where, arc, [x.twist for x in surface.sections]),
        local_dihedral=dihedral,
        local_zero_lift=np.interp(where, arc, [_zero_lift(a) for a in foils]),
        local_moment=np.interp(where, arc, [_moment(a) for a in foils]),
        local_quarter=np.interp(
            where, arc, [x.position[0] - 0.25 * x.chord for x in surface.sections]
        ),
        controls=surface.controls,
        plan=plan,
    )


def _slope(foils: list[Airfoil | None]) -> tuple[float, float]:
    known = [a.c_l_alpha for a in foils if a is not None and a.c_l_alpha is not None]
    if not known:
        return SECTION, SECTION_SE
    return float(np.mean(known)), 0.02


def _thin(camber: Array) -> tuple[float, float]:
    """Angle of zero lift and quarter-chord moment of a mean line, by thin-airfoil theory."""
    x = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 2001)))
    mid = 0.5 * (x[1:] + x[:-1])
    theta = np.arccos(1.0 - 2.0 * mid)
    slope = np.diff(np.interp(x, camber[:, 0], camber[:, 1])) / np.diff(x)
    d = np.pi / 2000
    a = [2.0 / np.pi * float((slope * np.cos(n * theta)).sum() * d) for n in (1, 2)]
    mean = float(slope.sum() * d) / np.pi
    return mean - 0.5 * a[0], -0.25 * np.pi * (a[0] - a[1])


def _zero_lift(foil: Airfoil | None) -> float:
    if foil is None:
        return 0.0
    if foil.alpha_0 is not None:
        return foil.alpha_0
    if foil.polar is not None and foil.polar.alpha[0] < 0.0 < foil.polar.alpha[-1]:
        inner = np.abs(foil.polar.alpha) < 0.1
        if int(inner.sum()) > 1:
            slope, at = np.polyfit(foil.polar.alpha[inner], foil.polar.c_l[inner], 1)
            return float(-at / slope)
    return 0.0 if foil.camber is None else _thin(foil.camber)[0]


def _moment(foil: Airfoil | None) -> float:
    if foil is None:
        return 0.0
    if foil.polar is not None and np.any(foil.polar.c_m):
        return float(np.interp(_zero_lift(foil), foil.polar.alpha, foil.polar.c_m))
    return 0.0 if foil.camber is None else _thin(foil.camber)[1]
