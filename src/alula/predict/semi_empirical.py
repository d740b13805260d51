"""Derivatives of an aircraft from handbook formulas: its parts, and what they do to one another.

USAF Datcom (Hoak et al., AFFDL), Roskam, Raymer and NACA reports, each formula with its source and
range in a file of its own. Dittrich 2016, sec. 3.2.3, names the Datcom as an a-priori source.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from alula.aircraft.aircraft import Aircraft
from alula.aircraft.geometry import Geometry
from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.predict.derivatives import Derivatives
from alula.predict.flow import Flow
from alula.predict.layout import Layout, layout
from alula.predict.profile_drag import DragItem
from alula.predict.semi_controls import controls
from alula.predict.semi_drag import drag
from alula.predict.semi_lateral import sideways
from alula.predict.semi_longitudinal import longitudinal
from alula.predict.sums import Sums

METHOD = "semi-empirical"


def semi_empirical(
    aircraft: Aircraft, flow: Flow | None = None, *, items: Sequence[DragItem] = ()
) -> Derivatives:
    """Derivatives about the aircraft's reference point, in stability axes, per rad and per hat.

    flow: the condition; by default level flight at sea level, 50 m/s. items: parts by their drag
    area that the geometry does not show (landing gear, struts). Raises BadInput where the aircraft
    file has no [geometry] or no wing.
    """
    if aircraft.geometry is None:
        raise refuse(
            "missing_geometry",
            where=aircraft.path,
            expected="[geometry] with at least a wing",
            found="no [geometry]",
            do="Describe the lifting surfaces in the aircraft file.",
        )
    weight = None if aircraft.mass is None else aircraft.mass.mass * 9.80665
    return from_geometry(
        aircraft.geometry, aircraft.S, aircraft.b, aircraft.c, aircraft.reference_point,
        flow or Flow(), weight=weight, items=items, where=aircraft.path,
    )  # fmt: skip


def from_geometry(
    geometry: Geometry,
    S: float,
    b: float,
    c: float,
    point: Array,
    flow: Flow,
    *,
    weight: float | None = None,
    items: Sequence[DragItem] = (),
    where: str = "geometry",
) -> Derivatives:
    """The same from geometry and reference. point: (3,) m. weight: N, for level flight's angle.

    The angle of attack is the flow's, else that of its lift coefficient, else of level flight with
    the weight, else zero.
    """
    plan = layout(geometry, S, b, c, point, flow, where)
    sums = Sums()
    longitudinal(plan, sums)
    alpha, why = _angle(plan, sums, weight)
    sideways(plan, alpha, sums)
    controls(plan, alpha, sums)
    parts = drag(plan, geometry, items, sums)
    lift = sums.total("CL_0").value + sums.total("CL_alpha").value * alpha
    conditions = {
        "alpha_deg": f"{degrees(alpha):.3f}",
        "alpha": why,
        "C_L": f"{lift:.4f}",
        "V": f"{flow.V:.6g} m/s",
        "mach": f"{flow.mach:.4g}",
        "about": ", ".join(f"{x:.4g}" for x in point) + " m",
        "profile drag": ", ".join(f"{name} {x:.4f}" for name, x in parts.items()),
    }
    if plan.tail is not None:
        conditions["downwash gradient"] = (
            f"{plan.downwash.value:.3f} +- {plan.downwash.se:.3f}: {plan.downwash.source}"
        )
    return Derivatives(METHOD, sums.estimates(), conditions, (*plan.notes, *sums.notes()))


def _angle(plan: Layout, sums: Sums, weight: float | None) -> tuple[float, str]:
    flow = plan.flow
    if flow.alpha is not None:
        return flow.alpha, "given"
    lift, why = flow.lift, "of the given lift coefficient"
    if lift is None and weight is not None:
        lift = weight / (0.5 * flow.density * flow.V**2 * plan.S)
        why = "of level flight with the aircraft's mass"
    if lift is None:
        return 0.0, "zero: neither angle, lift nor mass is given"
    alpha = (lift - sums.total("CL_0").value) / sums.total("CL_alpha").value
    if abs(alpha) > 0.35:
        raise refuse(
            "beyond_stall",
            where=f"angle of attack {why}",
            expected="within 0.35 rad: these formulas are of attached flow",
            found=f"C_L = {lift:.3g} needs {alpha:.3g} rad",
            do="Give a higher airspeed, or the angle of attack itself.",
        )
    return alpha, why
