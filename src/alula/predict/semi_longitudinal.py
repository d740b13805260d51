"""Lift and pitching moment of the whole aircraft from its parts."""

from __future__ import annotations

import numpy as np

from alula.predict.alpha_dot import tail_rates
from alula.predict.body_carry_over import body_at_wing
from alula.predict.handbook import Found, Range, exactly, found, plus, scaled, times
from alula.predict.layout import Layout, incidence, lift_at_zero
from alula.predict.pitch_rate import tail, wing
from alula.predict.sums import Sums


def longitudinal(plan: Layout, sums: Sums) -> None:
    """Adds CL and Cm over alpha, qhat and alphadot, and their values at alpha = 0."""
    shape, line = plan.wing.shape, plan.wing
    wing_zero, tail_zero = lift_at_zero(plan)
    sums.add("CL_0", wing_zero)
    sums.add("CL_alpha", plan.wing_lift)
    sums.add("Cm_alpha", plan.wing_lift, -plan.behind)
    sums.add("Cm_0", wing_zero, -plan.behind)
    sums.add("Cm_0", _section_moment(plan))
    sums.add("Cm_0", _twist_moment(plan))
    rates = wing(plan.wing_lift, shape.slope.value, shape.aspect, shape.sweep_quarter, plan.behind)
    sums.add_all(rates)
    if plan.body is not None:
        sums.add("Cm_alpha", _body(plan))
        sums.add("Cm_0", Found(0.0, 0.02, "body at alpha = 0 left out; se 0.02, our judgment"))
    if plan.tail is None or plan.tail_lift is None:
        return
    sums.add("CL_0", tail_zero)
    sums.add("Cm_0", tail_zero, -plan.arm / plan.c)
    through = plus(exactly(1.0, ""), scaled(plan.downwash, -1.0))
    lift = times(plan.tail_lift, through)
    sums.add("CL_alpha", lift)
    sums.add("Cm_alpha", lift, -plan.arm / plan.c)
    sums.add_all(tail(plan.tail_lift, plan.arm, plan.c))
    behind_wing = float(line.shape.quarter[0] - plan.tail.shape.quarter[0])
    if behind_wing > 0.0:
        sums.add_all(tail_rates(plan.tail_lift, plan.arm, plan.c, plan.downwash))


def _section_moment(plan: Layout) -> Found:
    """The sections' own moment about their quarter chords, strip by strip."""
    shape = plan.wing.shape
    step = 0.5 * shape.span / shape.eta.size
    total = 2.0 * float((shape.local_moment * shape.local_chord**2).sum()) * step
    value = total / (plan.S * plan.c)
    return Found(value, 0.1 * abs(value) + 0.005, "sections' moment by strips; se 10 % and 0.005")


def _twist_moment(plan: Layout) -> Found:
    """Cm_0 of the lift that twist moves along a swept wing, whose sum is zero."""
    wing, line = plan.wing, plan.wing.line
    twisted, plain = line.load(incidence(wing, 0.0)), line.load(np.ones_like(line.eta))
    share = line.lift(twisted) / line.lift(plain)
    x = wing.over_span(wing.shape.local_quarter - wing.shape.quarter[0])
    basic = line.carried(twisted, x) - share * line.carried(plain, x)
    value = wing.even * basic * plan.share / plan.c
    return Found(value, 0.25 * abs(value), "twist by the lifting line; se 25 %, unswept loads")


def _body(plan: Layout) -> Found:
    """Cm_alpha of the body in the wing's flow."""
    assert plan.body is not None
    assert plan.outline is not None
    w = plan.wing.shape
    leading = float(w.root[0])
    trailing = leading - w.root_chord
    tail = None
    if plan.tail is not None and float(plan.tail.shape.quarter[0]) < trailing:
        tail = (float(plan.tail.shape.quarter[0]), plan.downwash.value)
    value, _ = body_at_wing(
        plan.outline, w.plan, (leading, trailing), plan.wing.slope.value, plan.S, plan.c, tail
    )
    return found(
        value,
        0.25 * value,
        "Multhopp, NACA TM 1036; se 25 %, our judgment for bodies that are not slender",
        (Range("fineness of the body", plan.body.length / plan.body.diameter, 4.0, 20.0),),
    )
