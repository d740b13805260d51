"""An aircraft as strips: geometry, polars and finite-wing corrections for the core's strip theory.

Pusztai 2018, 2.2 and appendix C; docs/methods/strip_theory.md says where it differs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from alula.aircraft import Aircraft
from alula.aircraft.geometry import ControlSurface, Geometry, LiftingSurface
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.predict.downwash import datcom, gradient, horseshoe
from alula.predict.full_circle import full_circle
from alula.predict.lifting_line import correction, lifting_line
from alula.predict.plain_flap import flap_constants
from alula.predict.planform import Planform, planform
from alula.predict.polars import lift_slope, section_polar
from alula.predict.wake import Wake, propeller_wake

CONTROLS = ("de", "da", "dr", "df")
VARIABLES = ("alpha", "beta", "phat", "qhat", "rhat", *CONTROLS, "wash")
COEFFICIENTS = ("CD", "CY", "CL", "Cl", "Cm", "Cn")
_OTHER_WAY = ("da", "dr")  # the left half of a mirrored surface
_LONGEST = 0.035  # of the span, of a strip


@dataclass(frozen=True)
class StripSurfaceData:
    """What strip theory takes of one lifting surface, for reports and tests.

    k: lift over the sections' lift; e: Oswald factor; c_l_alpha of the sections, 1/rad; downwash:
    gradient that it feels; polar: where the sections come from, in words. table: (3, n) c_l c_d c_m
    over table_alpha (n,) rad, see `full_circle`.
    """

    name: str
    plan: Planform
    c_l_alpha: float
    k: float
    e: float
    downwash: float
    polar: str
    table_alpha: Array
    table: Array


@dataclass(frozen=True)
class StripModel:
    """An aircraft of strips. wake: the slipstream's swirl and radius; None without a propeller."""

    name: str
    S: float
    b: float
    c: float
    surfaces: tuple[StripSurfaceData, ...]
    wake: Wake | None
    core: Any

    def evaluate(self, variables: Mapping[str, Array]) -> dict[str, Array]:
        """CD CY CL (stability axes) Cl Cm Cn (body axes) (n,) about the reference point.

        variables: `VARIABLES` by name, rad and hats, each (n,) or a number; what is missing is 0.
        wash: excess of axial speed in the slipstream over V; swirl and radius follow by the wake.
        """
        rows = self.columns(variables)
        out = np.empty((len(rows), 6))
        self.core.evaluate(rows, out, True)
        return dict(zip(COEFFICIENTS, out.T, strict=True))

    def columns(self, variables: Mapping[str, Array]) -> Array:
        """The core's rows (n, 12)."""
        unknown = [name for name in variables if name not in VARIABLES]
        if unknown:
            raise refuse(
                "unknown_variable",
                where=f"strip theory of '{self.name}'",
                expected=", ".join(VARIABLES),
                found=unknown[0],
                do="Leave it out.",
            )
        values = np.broadcast_arrays(*(np.asarray(variables.get(v, 0.0)) for v in VARIABLES))
        rows = np.zeros((values[0].size, 12))
        for j, value in enumerate(values):
            rows[:, j] = value.ravel()
        wash = rows[:, 9]
        if self.wake is not None and np.any(wash != 0.0):
            axial = np.cos(rows[:, 0]) * np.cos(rows[:, 1])
            rows[:, 9], rows[:, 10], rows[:, 11] = self.wake.at(axial, wash)
        else:
            rows[:, 9] = 0.0
        return rows


def strip_model(
    aircraft: Aircraft,
    *,
    CD_body: float | None = None,
    downwash: float | None = None,
    downwash_by: Literal["lift", "angle"] = "lift",
) -> StripModel:
    """The strips of an aircraft.

    CD_body: drag of all that is no lifting surface; None: the file's drag area over S. downwash:
    gradient at the tailplane; None: mean of the Datcom's and the horseshoe vortex's. downwash_by:
    'lift': it goes with the wing's lift, behind stall too; 'angle': with the wing's angle of
    attack, as Pusztai's (2.44a).
    Raises BadInput where the file has no geometry or no wing, or a polar cannot be used.
    """
    shape = aircraft.geometry
    wing = None if shape is None else shape.surface("wing")
    if shape is None or wing is None:
        raise refuse(
            "missing_geometry",
            where=aircraft.path,
            expected="[[geometry.surfaces]] with a wing",
            found="none",
            do="Describe the lifting surfaces in the aircraft file.",
        )
    ordered = sorted(shape.surfaces, key=lambda s: s.role != "wing")
    reference = np.asarray(aircraft.reference_point)
    data: list[StripSurfaceData] = []
    rows: list[list[float]] = []
    strips: list[list[float]] = []
    sections: list[Array] = []
    for surface in ordered:
        one, induced = _surface_data(aircraft, shape, surface)
        if surface.role == "tailplane":
            one = replace(one, downwash=_gradient(data[0], one, downwash))
        mine = _strips(surface, one, reference)
        rows.append(
            [len(strips), len(mine), one.k, induced, one.k * one.c_l_alpha, one.downwash,
             float(surface.role == "wing")]
        )  # fmt: skip
        strips += mine
        data.append(one)
        sections.append(np.ascontiguousarray(one.table))
    center = reference if aircraft.mass is None else np.asarray(aircraft.mass.cg)
    wake, hub = propeller_wake(aircraft)
    incidence = float(np.mean([s.twist for s in wing.sections]))
    made = core.StripAircraft(
        np.array([aircraft.S, aircraft.b, aircraft.c]),
        shape.drag_area / aircraft.S if CD_body is None else CD_body,
        np.array(center - reference),
        np.array(hub - reference),
        incidence,
        downwash_by == "angle",
        np.array(rows, dtype=np.float64),
        np.array(strips, dtype=np.float64),
        sections,
    )
    return StripModel(aircraft.name, aircraft.S, aircraft.b, aircraft.c, tuple(data), wake, made)


def _surface_data(
    aircraft: Aircraft, shape: Geometry, surface: LiftingSurface
) -> tuple[StripSurfaceData, float]:
    """Corrections of one surface, with 1/(pi e A). One polar serves it: the
    first section's; thickness and camber between root and tip are not followed.
    """
    plan = planform(surface)
    airfoil = shape.airfoils[surface.sections[0].airfoil]
    polar = section_polar(airfoil, f"{aircraft.path}, geometry.airfoils.{airfoil.name}.polar")
    slope = lift_slope(polar)
    area = plan.span**2 / plan.aspect
    line = lifting_line(
        lambda eta: np.array([surface.at(float(x))[1] for x in eta]), plan.span, area, slope
    )
    finite = correction(line, slope)
    k, e = finite.slope / slope, 1.0 / (1.0 + finite.delta)
    induced = 1.0 / (np.pi * e * plan.aspect)
    table = full_circle(polar, k, induced, plan.aspect)
    alpha = np.linspace(-np.pi, np.pi, table.shape[1])
    data = StripSurfaceData(
        surface.name, plan, slope, k, e, 0.0, polar.source, frozen(alpha), table
    )
    return data, induced


def _gradient(wing: StripSurfaceData, tail: StripSurfaceData, given: float | None) -> float:
    arm = float(wing.plan.quarter_chord[0] - tail.plan.quarter_chord[0])
    if arm <= 0.0:  # a canard: its own wake is left out
        return 0.0
    if given is not None:
        return given
    height = float(wing.plan.quarter_chord[2] - tail.plan.quarter_chord[2])
    w = wing.plan
    chart = datcom(w.aspect * wing.e, w.taper, w.sweep_quarter, w.span, arm, height)
    vortex = horseshoe(wing.k * wing.c_l_alpha, w.aspect, w.span, arm, height)
    return gradient((chart, vortex)).value


def _strips(surface: LiftingSurface, data: StripSurfaceData, reference: Array) -> list[list[float]]:
    """Rows of the core's strips, the right half and its mirror image. Edges are where sections and
    controls begin and end.
    """
    arc = surface.arc()
    joints = [float(x) / float(arc[-1]) for x in arc]
    joints += [x for c in surface.controls for x in (c.start, c.end)]
    edges = np.unique(np.round(np.clip(joints, 0.0, 1.0), 9))
    longest = _LONGEST * (1.0 if surface.mirror else 2.0)
    out = []
    for a, b in pairwise(edges):
        n = max(1, int(np.ceil((b - a) / (2.0 * longest))))
        for i in range(n):
            fractions = (a + (b - a) * i / n, a + (b - a) * (i + 1) / n)
            row, control = _strip(surface, data, fractions, float(arc[-1]), reference)
            out.append(row + _gains(control, 1.0))
            if surface.mirror:
                left = list(row)
                for j in (1, 4, 7):  # y of point, chord axis, normal
                    left[j] = -left[j]
                out.append(left + _gains(control, -1.0))
    return out


def _strip(
    surface: LiftingSurface,
    data: StripSurfaceData,
    fractions: tuple[float, float],
    length: float,
    reference: Array,
) -> tuple[list[float], ControlSurface | None]:
    inner, outer = (_quarter(surface, f) for f in fractions)
    middle = 0.5 * (fractions[0] + fractions[1])
    _, chord, twist = surface.at(middle)
    line = outer - inner
    along = line / np.linalg.norm(line)
    forward = np.array([1.0, 0.0, 0.0])
    up = np.cross(along, forward)
    if surface.role == "fin":  # its upper side is the right one
        up = -up
    up /= np.linalg.norm(up)
    axis = np.cos(twist) * forward + np.sin(twist) * up
    axis -= (axis @ along) * along
    cosine = float(np.linalg.norm(axis))
    axis /= cosine
    normal = np.cross(np.cross(axis, up), axis)
    normal -= (normal @ along) * along
    normal /= np.linalg.norm(normal)
    area = chord * length * (fractions[1] - fractions[0])
    control = next((c for c in surface.controls if c.start <= middle <= c.end), None)
    c_l_delta = c_m_delta = 0.0
    if control is not None:
        part = (middle - control.start) / (control.end - control.start)
        hinge = control.hinge[0] + part * (control.hinge[1] - control.hinge[0])
        c_l_delta, c_m_delta = flap_constants(control, hinge, data.c_l_alpha)
    point = 0.5 * (inner + outer) - reference
    return [
        *point, *axis, *normal, chord * cosine, area, 0.5 * float(np.linalg.norm(line)),
        c_l_delta, c_m_delta, data.c_l_alpha,
    ], control  # fmt: skip


def _quarter(surface: LiftingSurface, fraction: float) -> Array:
    lead, chord, _ = surface.at(fraction)
    return np.asarray(lead - np.array([0.25 * chord, 0.0, 0.0]))


def _gains(control: ControlSurface | None, side: float) -> list[float]:
    gains = {} if control is None else control.gains
    return [gains.get(c, 0.0) * (side if c in _OTHER_WAY else 1.0) for c in CONTROLS]
