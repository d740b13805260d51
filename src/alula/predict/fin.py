"""The fin: its side force in sideslip, and what that does about all axes, in rolling and yawing.

USAF Datcom, sec. 5.3.1.1 (force), 7.4.2 and 7.4.3 (rates), with the arms of the fin's aerodynamic
center in stability axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

from alula.predict.handbook import Found, Range, exactly, found, scaled, times
from alula.predict.lift_slope import polhamus
from alula.predict.surface_shape import SurfaceShape

# The tailplane and the body close the fin's lower end: 1.55 times its own aspect ratio
# (handbook form, as in Raymer, Aircraft Design, ch. 16). An end plate that seals would double it.
END_PLATE, END_PLATE_SE = 1.55, 0.25


def effective_aspect(fin: SurfaceShape, closed: bool) -> Found:
    """Aspect ratio of the free fin with the same slope. closed: by a body or a tailplane."""
    if not closed:
        return found(fin.aspect, 0.05 * fin.aspect, "free fin")
    return found(
        END_PLATE * fin.aspect,
        END_PLATE_SE * fin.aspect,
        "fin's lower end closed, 1.55 A (Raymer ch. 16); se 0.25 A: 1 A open, 2 A sealed",
        (Range("fin's aspect ratio", fin.aspect, 0.8, 3.0),),
    )


def lift_slope(fin: SurfaceShape, closed: bool, mach: float) -> Found:
    """The fin's own side-force slope on its area, 1/rad, positive."""
    aspect = effective_aspect(fin, closed)
    at = [
        polhamus(a, fin.slope.value, fin.sweep_half, mach)
        for a in (aspect.value, aspect.value + aspect.se)
    ]
    own = Found(at[0].value, at[1].value - at[0].value, aspect.source, aspect.notes)
    return Found(
        own.value, (own.se**2 + at[0].se ** 2) ** 0.5, f"{at[0].source}, {own.source}", own.notes
    )


def sidewash(area_ratio: float, wing_aspect: float, sweep_quarter: float, below: float) -> Found:
    """(1 + d sigma/d beta) q_v/q of wing and body at the fin (Datcom 5.3.1.1).

    0.724 + 3.06 (S_v/S)/(1 + cos) + 0.4 z_w/d + 0.009 A. area_ratio: S_v/S. below: the wing's root
    below the body's center line, over the body's depth (0 without a body).
    """
    value = (
        0.724 + 3.06 * area_ratio / (1.0 + cos(sweep_quarter)) + 0.4 * below + 0.009 * wing_aspect
    )
    return found(
        value,
        0.12,
        "sidewash of Datcom 5.3.1.1; se 0.12, our judgment",
        (
            Range("fin area over wing area", area_ratio, 0.03, 0.25),
            Range("wing's aspect ratio", wing_aspect, 2.0, 12.0),
        ),
    )


@dataclass(frozen=True)
class FinArms:
    """Arms in stability axes, m: aft of and up from the reference; flat: `up` at alpha = 0."""

    aft: float
    up: float
    flat: float


def fin_derivatives(force: Found, arms: FinArms, span: float) -> dict[str, Found]:
    """CY, Cl, Cn over beta, phat, rhat. force: CY_beta of the fin (negative).

    In roll the wing's vortices turn the flow with the fin, so that at alpha = 0 it feels none of
    it: Datcom 7.4.2 takes only the height that alpha adds. Half of what it leaves out is the error.
    """
    x, h, d = arms.aft / span, arms.up / span, (arms.up - arms.flat) / span
    unsure = Found(d, 0.5 * abs(h - d), "wing's sidewash in roll (Datcom 7.4.2)")
    rolled = times(scaled(force, 2.0), unsure)
    yawed = scaled(force, -2.0 * x)
    return {
        "CY_beta": force,
        "Cl_beta": scaled(force, h),
        "Cn_beta": scaled(force, -x),
        "CY_p": rolled,
        "Cl_p": times(rolled, exactly(h, "")),
        "Cn_p": scaled(rolled, -x),
        "CY_r": yawed,
        "Cl_r": scaled(yawed, h),
        "Cn_r": scaled(yawed, -x),
    }
