"""Side force, rolling and yawing moment of the whole aircraft from its parts, stability axes."""

from __future__ import annotations

from alula.predict import lateral, roll_rate, yaw_rate
from alula.predict.fin import fin_derivatives, lift_slope, sidewash
from alula.predict.fuselage import side_force, yawing
from alula.predict.handbook import Found, scaled, times
from alula.predict.layout import Layout, incidence
from alula.predict.sums import Sums

PROFILE = 0.010  # the wing's profile drag where it is not known better


def sideways(plan: Layout, alpha: float, sums: Sums) -> None:
    """Adds CY, Cl, Cn over beta, phat, rhat at an angle of attack."""
    wing, line = plan.wing, plan.wing.line
    at = incidence(wing, alpha)
    base = line.load(at)
    lift = line.lift(base)
    share, wide = plan.share, wing.shape.span / plan.b
    # The wing's coefficients are on its own area and span; a rate's hat brings the span once more.
    moment, rate = share * wide, share * wide**2
    height = plan.wing_height if plan.body is not None else None
    diameter = plan.body.diameter if plan.body is not None else 0.0
    sums.add("Cl_beta", lateral.wing_roll(wing, lift, height, diameter), moment)
    sums.add("CY_beta", lateral.wing_side(wing), share)
    sums.add("Cn_beta", lateral.wing_yaw(wing, lift, plan.behind), moment)
    sums.add("Cl_p", roll_rate.damping(wing), rate)
    sums.add("Cn_p", roll_rate.yaw(wing, base, lift, plan.behind), rate)
    sums.add("CY_p", roll_rate.side(wing, lift), share * wide)
    sums.add("Cl_r", yaw_rate.roll(wing, base, at), rate)
    sums.add("Cn_r", yaw_rate.yaw(wing, base, at, PROFILE), rate)
    if plan.tail is not None:
        _tailplane(plan, sums)
    if plan.body is not None:
        sums.add("CY_beta", side_force(plan.body, plan.wing_height, plan.depth, plan.S))
        sums.add("Cn_beta", yawing(plan.body, plan.S, plan.b))
    if plan.fin is not None:
        sums.add_all(fin_derivatives(fin_force(plan), plan.fin_arms(alpha), plan.b))


def _tailplane(plan: Layout, sums: Sums) -> None:
    """Roll damping and dihedral of the tailplane; the wing's rolling wake takes half of the first.

    Half: handbook form (Roskam, Airplane Design VI, sec. 10.2), the whole of it as the error.
    """
    assert plan.tail is not None
    shape = plan.tail.shape
    size = shape.area * shape.span / (plan.S * plan.b)
    own = roll_rate.damping(plan.tail)
    half = Found(0.5 * own.value, 0.5 * abs(own.value), "tailplane in the rolling wing's wake")
    sums.add("Cl_p", half, size * shape.span / plan.b)
    sums.add("Cl_beta", lateral.dihedral_roll(plan.tail), size)


def fin_force(plan: Layout) -> Found:
    """CY_beta of the fin (fins) on the reference area, negative."""
    assert plan.fin is not None
    below = -plan.wing_height / plan.depth if plan.depth > 0.0 else 0.0
    w = plan.wing.shape
    wash = sidewash(plan.fin.area / plan.S, w.aspect, w.sweep_quarter, below)
    slope = lift_slope(plan.fin, plan.fin_closed, plan.flow.mach)
    return scaled(times(slope, wash), -plan.fin.area / plan.S)
