"""What wing and body do to each other: lift carried over, and the wing's flow along the body.

The lattice knows only surfaces and `slender_body` only a body alone; this is what is added where
they are joined.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ellipe

from alula.aircraft import Aircraft
from alula.aircraft.geometry import Body
from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.predict.body_shape import BodyShape
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.planform import Planform, planform

# Multhopp's method beside wind tunnels, Alula's reading of the spread in NACA TM 1036 and TR 711.
_SHARE = 0.20


@dataclass(frozen=True)
class CarryOver:
    """Lift of wing and body over the lift of the exposed wing alone (both halves joined).

    on_wing: on the exposed wing beside the body. on_body: carried over to the body.
    """

    on_wing: float
    on_body: float

    @property
    def total(self) -> float:
        """(1 + d/b)^2."""
        return self.on_wing + self.on_body


def wing_body_lift(diameter: float, span: float) -> CarryOver:
    """Lift carried over between a wing at angle of attack and a round body, both at one angle.

    Pitts, Nielsen, Kaattari 1957, NACA Report 1307, from the slender-body
    solution of Spreiter 1950, NACA Report 962; used there for wings of any aspect ratio. diameter:
    m, at the wing; span: m, tip to tip, above it.
    """
    if not 0.0 <= diameter < span:
        raise refuse(
            "bad_value",
            where="lift carried over between wing and body",
            expected="a body narrower than the wing's span",
            found=f"diameter {diameter:g} m, span {span:g} m",
            do="Check the body's stations and the wing's sections.",
        )
    t = diameter / span
    if t < 1e-9:
        return CarryOver(1.0, 0.0)
    u = 1.0 / t
    on_wing = (2.0 / np.pi) / (1.0 - t) ** 2 * (
        (1.0 + t**4) * (0.5 * np.arctan(0.5 * (u - t)) + 0.25 * np.pi)
        - t**2 * ((u - t) + 2.0 * np.arctan(t))
    )  # fmt: skip
    return CarryOver(float(on_wing), float((1.0 + t) ** 2 - on_wing))


def upwash(x: Array, span: float) -> Array:
    """Upwash in the plane of symmetry, over CL/(pi A), x > 0 m ahead of an elliptic lifting line.

    2/pi sqrt(1 + xi^2)/xi E(1/(1 + xi^2)) - 1 with xi = 2 x/b: Biot and Savart for bound and
    trailing vortices. As far behind it the downwash is this plus 2.
    """
    xi = 2.0 * np.asarray(x) / span
    root = np.sqrt(1.0 + xi * xi)
    return np.asarray(2.0 / np.pi * root / xi * ellipe(1.0 / (1.0 + xi * xi)) - 1.0)


def body_at_wing(
    body: Body,
    wing: Planform,
    root: tuple[float, float],
    CL_alpha: float,
    S: float,
    c: float,
    tail: tuple[float, float] | None = None,
) -> tuple[float, float]:
    """Cm_alpha of a body in its wing's flow, and of the same body alone, 1/rad.

    Multhopp 1942, NACA TM 1036: Cm_alpha = pi/(2 S c) integral of width^2 d(flow angle)/d(alpha).
    Ahead of the wing's root chord the flow angle grows faster than alpha, along the root chord it
    does not change, behind it grows linearly to 1 - d(epsilon)/d(alpha) at the tail. In place of
    his chart the upwash is that of an elliptic wing (`upwash`), its lifting line at close range
    spread over the root chord as on a flat plate: sqrt(1 + c/d) - 1 at d m ahead, where the line
    has c/(2 d + c/2). root: x of leading and trailing edge, m body axes. CL_alpha: of the wing,
    1/rad on its own area. tail: x of the tailplane's quarter chord, m, and d(epsilon)/d(alpha);
    None: the lifting line's own downwash at each point.
    """
    shape = BodyShape(body)
    front, back = shape.x_nose - root[0], shape.x_nose - root[1]  # aft of the nose
    chord = back - front
    per = CL_alpha / (np.pi * wing.aspect)

    def ahead(s: Array) -> Array:
        d = np.maximum(front - s, 1e-9 * chord)
        line = per * upwash(d + 0.25 * chord, wing.span)
        plate = (np.sqrt(1.0 + chord / d) - 1.0) * (2.0 * d + 0.5 * chord) / chord
        return 1.0 + line * plate

    def behind(s: Array) -> Array:
        if tail is not None:
            at_tail = shape.x_nose - tail[0]
            # Behind the tail the flow stays as it is there.
            return np.asarray((1.0 - tail[1]) * np.minimum((s - back) / (at_tail - back), 1.0))
        x = s - front - 0.25 * chord
        return np.asarray(1.0 - np.minimum(per * (upwash(x, wing.span) + 2.0), 1.0))

    # d = v^2 takes the plate's root out of the integral just ahead of the leading edge.
    near = np.sqrt(max(min(front, shape.length), 0.0))
    v, w = np.polynomial.legendre.leggauss(200)
    v, w = 0.5 * near * (v + 1.0), 0.5 * near * w
    s = front - v * v
    first = float(np.sum(w * 2.0 * v * np.where(s <= shape.length, shape.width2(
        np.clip(s, 0.0, shape.length)), 0.0) * ahead(s)))  # fmt: skip
    last = shape.integral(lambda s: shape.width2(s) * behind(s), low=max(back, 0.0))
    alone = shape.integral(shape.width2)
    factor = 0.5 * np.pi / (S * c)
    return factor * (first + last), factor * alone


def bodies_at_wing(
    aircraft: Aircraft, CL_alpha: float, downwash: float | None = None
) -> Derivatives:
    """What is to be added to lattice and `slender_bodies` where the bodies meet the wing.

    CL_alpha: of the wing, 1/rad on the reference area. downwash: d(epsilon)/d(alpha) at the
    tailplane; None: by the lifting line. Returned are increments: Cm_alpha by Multhopp less that
    of the bodies alone; CL_alpha by the lift carried over, against the lattice's wing that goes
    through the body, for the widest body. Raises BadInput without wing or body.
    """
    shape = aircraft.geometry
    wing = None if shape is None else shape.surface("wing")
    if shape is None or wing is None or not shape.bodies:
        raise refuse(
            "missing_bodies",
            where=aircraft.path,
            expected='a surface with role = "wing" and [[geometry.bodies]]',
            found="no wing" if wing is None else "no body",
            do="Add them to the aircraft file, or leave the carry-over out.",
        )
    plan = planform(wing)
    first = wing.sections[0]
    x = float(first.position[0])
    root = (x, x - first.chord)
    tailplane = shape.surface("tailplane")
    tail = None
    if tailplane is not None and downwash is not None:
        tail = (float(planform(tailplane).quarter_chord[0]), downwash)
    own = CL_alpha * aircraft.S / plan.area
    pairs = [body_at_wing(b, plan, root, own, aircraft.S, aircraft.c, tail) for b in shape.bodies]
    moment = sum(joined - alone for joined, alone in pairs)
    width = max(_width(b, root) for b in shape.bodies)
    carried = wing_body_lift(width, plan.span)
    # The exposed wing's slope is taken as the whole one's; its area is smaller by the root strip.
    exposed = 1.0 - width * first.chord / plan.area
    gain = carried.total * exposed - 1.0
    values = {
        "Cm_alpha": Estimate(
            moment,
            _SHARE * abs(sum(joined for joined, _ in pairs)),
            "Multhopp 1942 (NACA TM 1036) less the body alone; se: 20 % of Multhopp's value "
            "(Alula's estimate)",
        ),
        "CL_alpha": Estimate(
            CL_alpha * gain,
            abs(CL_alpha * gain),
            "Pitts, Nielsen, Kaattari 1957 (NACA Report 1307) on the exposed wing; se: all of it, "
            "the lattice's wing goes through the body already",
        ),
    }
    conditions = {
        "wing": wing.name,
        "body's width at the wing over span": f"{width / plan.span:.3f}",
        "lift on wing, on body": f"{carried.on_wing:.4f}, {carried.on_body:.4f} of the exposed "
        "wing's",
        "downwash": "by the lifting line" if tail is None else f"{downwash:.3g} at the tailplane",
    }
    return Derivatives("wing-body carry-over", values, conditions)


def _width(body: Body, root: tuple[float, float]) -> float:
    """Largest width beside the wing's root chord, m; 0 where the body is elsewhere."""
    shape = BodyShape(body)
    s = np.linspace(shape.x_nose - root[0], shape.x_nose - root[1], 21)
    s = s[(s >= 0.0) & (s <= shape.length)]
    if len(s) == 0:
        return 0.0
    off = np.abs(shape.center(s)[:, 0])
    width = np.sqrt(shape.width2(s))
    return float(np.max(np.where(off < 0.5 * width, width, 0.0)))  # a nacelle carries its own
