"""Forces and moments of control deflections, from flap theory and the lifting line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.aircraft.geometry import ControlSurface
from alula.base.arrays import Array
from alula.predict.flap import friction_loss, low_aspect, moment, turning
from alula.predict.handbook import Found, exactly, scaled, times
from alula.predict.layout import Layout, incidence
from alula.predict.semi_lateral import fin_force
from alula.predict.sums import Sums
from alula.predict.surface_shape import SurfaceShape
from alula.predict.wing_line import WingLine

ANTISYMMETRIC = ("da", "dr")  # move the left half of a mirrored surface the other way


@dataclass(frozen=True)
class _Flap:
    """A control over a surface: alpha_delta (k,) and c_m_delta (k,) over `eta`, and their loss."""

    turn: Array
    moment: Array
    loss: Found


def controls(plan: Layout, alpha: float, sums: Sums) -> None:
    """Adds the derivatives to every control of wing, tailplane and fin."""
    for part in (plan.wing, plan.tail):
        if part is None:
            continue
        for control in part.shape.controls:
            flap = _flap(part.shape, control)
            for name, gain in control.gains.items():
                if name in ANTISYMMETRIC:
                    _rolling(plan, part, flap, name, gain, alpha, sums)
                elif part is plan.wing:
                    _on_wing(plan, flap, name, gain, sums)
                else:
                    _on_tail(plan, flap, name, gain, sums)
    if plan.fin is not None:
        for control in plan.fin.controls:
            flap = _flap(plan.fin, control)
            for name, gain in control.gains.items():
                _on_fin(plan, plan.fin, flap, name, gain, alpha, sums)


def _flap(shape: SurfaceShape, control: ControlSurface) -> _Flap:
    inside, hinge = shape.within(control)
    aspect = shape.aspect
    known: float | None = getattr(control, "c_l_delta", None)
    couple: float | None = getattr(control, "c_m_delta", None)
    turn, turned = np.zeros_like(shape.eta), np.zeros_like(shape.eta)
    for i in np.flatnonzero(inside):
        theory = turning(float(hinge[i])) if known is None else known / shape.slope.value
        turn[i] = theory * low_aspect(theory, aspect)
        turned[i] = moment(float(hinge[i])) if couple is None else couple
    if known is not None:
        return _Flap(turn, turned, Found(1.0, 0.05, "c_l_delta as the file states it; se 5 %"))
    ratio = shape.slope.value / (2.0 * np.pi)
    loss = friction_loss(shape.slope.value)
    # The surface's slope holds the section's own loss already.
    return _Flap(turn, turned, scaled(loss, 1.0 / ratio))


def _lift(part: WingLine, flap: _Flap) -> Found:
    """C_L_delta of both halves deflected alike, on the surface's own area."""
    angle = part.line.lift(part.line.load(part.over_span(flap.turn))) * part.even / part.slope.value
    return times(part.slope, exactly(angle, ""), flap.loss)


def _couple(plan: Layout, shape: SurfaceShape, flap: _Flap) -> Found:
    """Cm_delta of the sections about their quarter chords, on the reference S c."""
    step = 0.5 * shape.span / shape.eta.size
    total = 2.0 * float((flap.moment * shape.local_chord**2).sum()) * step
    value = total / (plan.S * plan.c)
    return Found(value, 0.15 * abs(value), "sections' moment by Glauert's flap theory; se 15 %")


def _on_wing(plan: Layout, flap: _Flap, name: str, gain: float, sums: Sums) -> None:
    lift = scaled(_lift(plan.wing, flap), gain * plan.share)
    sums.add(f"CL_{name}", lift)
    sums.add(f"Cm_{name}", lift, -plan.behind)
    sums.add(f"Cm_{name}", _couple(plan, plan.wing.shape, flap), gain)
    if plan.tail is None or plan.tail_lift is None or plan.arm <= 0.0:
        return
    # The tail feels the downwash of the flap's lift as of any other.
    washed = times(plan.tail_lift, plan.downwash, scaled(lift, 1.0 / plan.wing_lift.value))
    sums.add(f"CL_{name}", washed, -1.0)
    sums.add(f"Cm_{name}", washed, plan.arm / plan.c)


def _on_tail(plan: Layout, flap: _Flap, name: str, gain: float, sums: Sums) -> None:
    assert plan.tail is not None
    assert plan.tail_lift is not None
    own = _lift(plan.tail, flap)
    lift = times(plan.tail_lift, scaled(own, gain / plan.tail.slope.value))
    sums.add(f"CL_{name}", lift)
    sums.add(f"Cm_{name}", lift, -plan.arm / plan.c)
    sums.add(f"Cm_{name}", _couple(plan, plan.tail.shape, flap), gain)


def _rolling(
    plan: Layout, part: WingLine, flap: _Flap, name: str, gain: float, alpha: float, sums: Sums
) -> None:
    """Trailing edge down on the right, up on the left: rolls to the left."""
    line = part.line
    load = line.load(np.sign(line.eta) * part.over_span(flap.turn))
    size = gain * part.shape.area * part.shape.span / (plan.S * plan.b)
    rolls = times(part.odd_found(line.roll(load), "aileron"), flap.loss)
    sums.add(f"Cl_{name}", rolls, size)
    base = line.load(incidence(part, alpha)) if part is plan.wing else line.load(0.0 * line.eta)
    yaw = line.yaw(base, load) * flap.loss.value
    sums.add(
        f"Cn_{name}",
        Found(yaw, 0.3 * abs(yaw) + 0.003, "induced yaw by the lifting line; se 30 % and 0.003"),
        size,
    )


def _on_fin(
    plan: Layout, fin: SurfaceShape, flap: _Flap, name: str, gain: float, alpha: float, sums: Sums
) -> None:
    """Trailing edge left: a force to the right behind the reference point."""
    weights = fin.local_chord / fin.local_chord.sum()
    mean = exactly(float((weights * flap.turn).sum()), "")
    # The flap itself is not turned by the sidewash, which lies near one; it stays in the se.
    force = scaled(times(fin_force(plan), mean, flap.loss), -gain)
    arms = plan.fin_arms(alpha)
    sums.add(f"CY_{name}", force)
    sums.add(f"Cl_{name}", force, arms.up / plan.b)
    sums.add(f"Cn_{name}", force, -arms.aft / plan.b)
