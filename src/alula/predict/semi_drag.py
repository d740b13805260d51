"""Drag of the whole aircraft: profile drag of its parts and the parabola of induced drag."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi

from alula.aircraft.geometry import Geometry
from alula.predict.handbook import Found, Range, found, scaled, squared, times
from alula.predict.layout import Layout
from alula.predict.oswald import aircraft_factor, nita_scholz, raymer
from alula.predict.planform import wetted_area
from alula.predict.profile_drag import (
    DragItem,
    WettedPart,
    body_form,
    profile_drag,
    surface_form,
)
from alula.predict.sums import Sums

# Interference of the joints (Raymer ch. 12): wing, tails, body.
JOINT = {"wing": 1.05, "tailplane": 1.05, "fin": 1.05, "other": 1.05}


def drag(
    plan: Layout, geometry: Geometry, items: Sequence[DragItem], sums: Sums
) -> dict[str, float]:
    """Adds CD_0, CD_alpha, CD_alpha2 of CD = CD_min + C_L2/(pi A e); returns the parts by name.

    CD_0 is the drag at alpha = 0. The lift of least drag is taken to be zero.
    """
    stated = stated_area(geometry)
    if stated > 0.0:
        items = (*items, DragItem("parts by the file's drag area", 1.0, stated))
    minimum, parts = profile_drag(
        wetted_parts(plan, geometry),
        plan.S,
        plan.flow.V,
        plan.flow.viscosity,
        plan.flow.mach,
        items,
    )
    induced = induced_factor(plan)
    zero, slope = sums.total("CL_0"), sums.total("CL_alpha")
    sums.add("CD_0", minimum)
    sums.add("CD_0", times(induced, squared(zero)))
    sums.add("CD_alpha", scaled(times(induced, zero, slope), 2.0))
    sums.add("CD_alpha2", times(induced, squared(slope)))
    return parts


def wetted_parts(plan: Layout, geometry: Geometry) -> list[WettedPart]:
    """Surfaces and bodies by their skin, outside one another.

    Bodies are left out where the file states the drag area of all that is no lifting surface.
    """
    out = []
    for surface in geometry.surfaces:
        shapes = [
            x for x in (plan.wing.shape, plan.tail.shape if plan.tail else None, plan.fin)
            if x is not None and x.name == surface.name
        ]  # fmt: skip
        if not shapes:
            continue
        shape = shapes[0]
        lift_factor = cos(shape.sweep_quarter) ** 0.28  # Raymer ch. 12
        out.append(
            WettedPart(
                surface.name, wetted_area(surface, geometry), shape.mean_chord,
                surface_form(shape.thickness) * lift_factor, JOINT[surface.role],
            )
        )  # fmt: skip
    if plan.body is not None and stated_area(geometry) == 0.0:
        body = plan.body
        form = body_form(body.length, body.diameter)
        out.append(WettedPart(body.name, body.wetted_area, body.length, form, 1.0, laminar=0.0))
    return out


def stated_area(geometry: Geometry) -> float:
    """Drag area, m2, of all that is no lifting surface, as the file states it, else 0."""
    return float(getattr(geometry, "drag_area", 0.0))


def induced_factor(plan: Layout) -> Found:
    """1/(pi A e) on the reference area, the mean of published forms for whole aircraft."""
    shape = plan.wing.shape
    width = 0.0 if plan.body is None else float(plan.body.width.max()) / shape.span
    e = aircraft_factor(
        (
            raymer(shape.aspect, shape.sweep_leading),
            nita_scholz(shape.aspect, shape.taper, shape.sweep_quarter, width),
        )
    )
    # On the reference area: C_Di = C_L2 S/(pi b2 e), whatever the wing's own area is.
    value = plan.S / (pi * shape.span**2 * e.value)
    return found(
        value,
        value * e.se / e.value,
        f"Oswald factor {e.value:.3f}: {e.source}",
        (Range("aspect ratio", shape.aspect, 3.0, 15.0),),
    )
