"""The aircraft as the handbook sees it: wing, tailplane, fin and body with their arms and flow."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin, sqrt

import numpy as np

from alula.aircraft.geometry import Body, Geometry
from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.predict.body_shape import BodyShape
from alula.predict.downwash import datcom, gradient, horseshoe, pressure_ratio
from alula.predict.fin import FinArms
from alula.predict.flow import Flow
from alula.predict.handbook import Found, exactly, plus, scaled, times
from alula.predict.lift_slope import body_factor, polhamus
from alula.predict.surface_shape import SurfaceShape, surface_shape
from alula.predict.wing_line import WingLine, wing_line

WAKE_DRAG = 0.010  # profile drag of the wing's root that the tail's wake is reckoned with


@dataclass(frozen=True)
class Layout:
    """The parts and what one does to another. S, b, c, point: the reference.

    behind: chords c from the reference point back to the wing's quarter chord. wing_lift: C_L_alpha
    of wing with body, on S. tail_lift: eta a_t S_t/S of the tailplane, None without one; arm:
    m, its quarter chord behind the reference. outline: the largest body
    as the file has it. notes: what was left out.
    """

    S: float
    b: float
    c: float
    point: Array
    flow: Flow
    wing: WingLine
    wing_lift: Found
    behind: float
    tail: WingLine | None
    tail_lift: Found | None
    arm: float
    downwash: Found
    fin: SurfaceShape | None
    body: BodyShape | None
    outline: Body | None
    notes: tuple[str, ...]

    @property
    def share(self) -> float:
        """Wing's area over the reference area."""
        return self.wing.shape.area / self.S

    @property
    def wing_height(self) -> float:
        """Wing's root above the body's center line, m; 0 without a body."""
        if self.body is None:
            return 0.0
        root = self.wing.shape.root
        return float(self._center(root[0] - 0.25 * self.wing.shape.root_chord) - root[2])

    @property
    def depth(self) -> float:
        """Height of the body at the wing's root, m; 0 without a body."""
        if self.body is None:
            return 0.0
        x = self.wing.shape.root[0] - 0.25 * self.wing.shape.root_chord
        s = np.clip(self.body.x_nose - x, 0.0, self.body.length)
        return sqrt(float(self.body.height2(np.array([s]))[0]))

    def fin_arms(self, alpha: float) -> FinArms:
        """The fin's arms in stability axes at an angle of attack."""
        assert self.fin is not None
        x, _, z = self.fin.quarter - self.point
        return FinArms(
            aft=float(-x * cos(alpha) - z * sin(alpha)),
            up=float(x * sin(alpha) - z * cos(alpha)),
            flat=float(-z),
        )

    @property
    def fin_closed(self) -> bool:
        """Whether a body or a tailplane closes the fin's lower end."""
        if self.fin is None:
            return False
        if self.body is not None:
            return True
        if self.tail is None:
            return False
        gap = abs(float(self.tail.shape.root[2] - self.fin.root[2]))
        return gap < 0.2 * self.fin.span

    def _center(self, x: float) -> float:
        assert self.body is not None
        s = np.clip(self.body.x_nose - x, 0.0, self.body.length)
        return float(self.body.center(np.array([s]))[0, 1])


def layout(
    geometry: Geometry, S: float, b: float, c: float, point: Array, flow: Flow, where: str
) -> Layout:
    """The layout; raises BadInput without a wing, or with one that is not mirrored."""
    surface = geometry.surface("wing")
    if surface is None or not surface.mirror:
        raise refuse(
            "missing_wing",
            where=where,
            expected="a mirrored lifting surface with role = 'wing'",
            found=", ".join(f"{s.name} ({s.role})" for s in geometry.surfaces) or "no surface",
            do="State the wing in [geometry] of the aircraft file.",
        )
    wing = wing_line(surface_shape(surface, geometry), flow.mach)
    shape = wing.shape
    outline = max(geometry.bodies, key=lambda x: BodyShape(x).volume, default=None)
    body = None if outline is None else BodyShape(outline)
    factor = exactly(1.0, "") if body is None else body_factor(body.diameter, shape.span)
    named = {"wing": surface, "tailplane": geometry.surface("tailplane"),
             "fin": geometry.surface("fin")}  # fmt: skip
    notes = [
        f"'{s.name}' ({s.role}) is not counted by the handbook formulas"
        for s in geometry.surfaces
        if s not in named.values()
    ]
    if len(geometry.bodies) > 1:
        notes.append("only the largest body is counted")
    tailplane, fin = named["tailplane"], named["fin"]
    tail, tail_lift, arm, downwash = None, None, 0.0, exactly(0.0, "")
    if tailplane is not None and tailplane.mirror:
        tail = wing_line(surface_shape(tailplane, geometry), flow.mach)
        arm = float(point[0] - tail.shape.quarter[0])
        tail_lift, downwash = _tail(wing, tail, S, flow)
    return Layout(
        S, b, c, point, flow, wing,
        scaled(times(wing.slope, factor), shape.area / S),
        float(point[0] - shape.quarter[0]) / c,
        tail, tail_lift, arm, downwash,
        None if fin is None else surface_shape(fin, geometry),
        body, outline, tuple(notes),
    )  # fmt: skip


def _tail(wing: WingLine, tail: WingLine, S: float, flow: Flow) -> tuple[Found, Found]:
    """eta a_t S_t/S and d epsilon/d alpha of a tailplane behind the wing (or before it: upwash)."""
    w, t = wing.shape, tail.shape
    length = float(w.quarter[0] - t.quarter[0])
    height = float(w.root[2] - t.root[2])
    vortex = horseshoe(wing.slope.value, w.aspect, w.span, length, height)
    if length <= 0.0:  # a canard
        return scaled(tail.slope, t.area / S), vortex
    low = polhamus(w.aspect, w.slope.value, w.sweep_half).value
    chart = datcom(
        w.aspect, w.taper, w.sweep_quarter, w.span, length, height, wing.slope.value / low
    )
    chords = length / w.mean_chord - 0.75
    pressure = pressure_ratio(WAKE_DRAG, max(chords, 0.05), height / w.mean_chord)
    return scaled(times(tail.slope, pressure), t.area / S), gradient((chart, vortex))


def incidence(wing: WingLine, alpha: float) -> Array:
    """Angle of attack from zero lift at the line's stations, (k,) rad, with incidence and twist."""
    shape = wing.shape
    return alpha + wing.over_span(shape.local_twist) - wing.over_span(shape.local_zero_lift)


def lift_at_zero(plan: Layout) -> tuple[Found, Found]:
    """C_L of the wing with body, and of the tailplane, at alpha = 0, on the reference area."""
    wing = plan.wing
    at_zero = wing.line.lift(wing.line.load(incidence(wing, 0.0))) * wing.even / wing.slope.value
    se = 0.005  # rad, of a zero-lift angle by theory or from a polar
    angle = Found(at_zero, se, "incidence, twist and zero-lift angle; se 0.005 rad")
    lift = times(plan.wing_lift, angle)
    if plan.tail is None or plan.tail_lift is None:
        return lift, exactly(0.0, "")
    tail = plan.tail
    own = tail.line.lift(tail.line.load(incidence(tail, 0.0))) * tail.even / tail.slope.value
    flow = plus(Found(own, se, ""), scaled(times(plan.downwash, angle), -1.0))
    return lift, times(plan.tail_lift, flow)
