"""A model's stall as functions of JSBSim: separation points, and what they take."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

from alula.export.jsbsim_functions import add_function, op, prop, value
from alula.export.jsbsim_machines import add_state
from alula.export.jsbsim_property import FT
from alula.model import AeroModel, Stall


def add_stall(root: Element, aerodynamics: Element, model: AeroModel) -> None:
    """Append states and functions; the increments are `alula/stall/NAME`, also of body axes."""
    stall = model.stall
    assert stall is not None
    sides = (-1, 1) if stall.split else (0,)
    system = SubElement(root, "system", name="stall")
    channel = SubElement(system, "channel", name="stall")
    for side in sides:
        base = _base(side)
        SubElement(system, "property", value="1").text = f"{base}/X"
        add_state(channel, f"{base}/X", f"{base}/X", f"{base}/X-rate")
        _side(aerodynamics, stall, side)
    share = value(1.0 / len(sides))

    def mean(what: str) -> Element:
        return op(
            "product", share, op("sum", *(prop(f"{_base(s)}/{what}") for s in sides), _zero())
        )

    def half_difference(what: str) -> Element:
        parts = [prop(f"{_base(s)}/{what}") for s in (1, -1)]
        return op("product", value(0.5), op("difference", *parts))

    increments = {"CL": mean("CL"), "CD": mean("CD"), "Cm": mean("Cm")}
    if stall.split:
        arm = stall.y_station / model.reference.b
        sine, cosine = op("sin", prop("aero/alpha-rad")), op("cos", prop("aero/alpha-rad"))
        lift, drag = half_difference("CL"), half_difference("CD")
        increments["Cl"] = op(
            "product",
            value(-arm),
            op("sum", op("product", lift, cosine), op("product", drag, sine)),
        )
        increments["Cn"] = op(
            "product",
            value(arm),
            op("difference", op("product", drag, cosine), op("product", lift, sine)),
        )
    for name, content in increments.items():
        add_function(aerodynamics, f"alula/stall/{name}", f"{name} by separation").append(content)


def _base(side: int) -> str:
    return {-1: "alula/stall-left", 0: "alula/stall", 1: "alula/stall-right"}[side]


def _zero() -> Element:
    return value(0.0)


def _side(parent: Element, s: Stall, side: int) -> None:
    """Local angle of attack, rate of X and increments of one half, or of the whole wing."""
    base, y = _base(side), side * s.y_station
    alpha = prop("aero/alpha-rad")
    if side:
        down = op(
            "sum",
            op("product", value(FT), prop("velocities/w-aero-fps")),
            op("product", value(y), prop("velocities/p-aero-rad_sec")),
        )
        forward = op(
            "difference",
            op("product", value(FT), prop("velocities/u-aero-fps")),
            op("product", value(y), prop("velocities/r-aero-rad_sec")),
        )
        alpha = op("atan2", down, forward)
    add_function(parent, f"{base}/alpha-rad", "Local angle of attack").append(alpha)
    star = s.alpha_star + 0.5 * side * s.alpha_star_difference
    delayed = op(
        "difference",
        prop(f"{base}/alpha-rad"),
        op("product", value(s.tau2), prop("aero/alphadot-rad_sec")),
    )
    z = op("product", value(2.0 * s.a1), op("difference", delayed, value(star)))
    steady = op("quotient", value(1.0), op("sum", value(1.0), op("exp", z)))
    rate = op("quotient", op("difference", steady, prop(f"{base}/X")), value(s.tau1))
    add_function(parent, f"{base}/X-rate", "Rate of the separation point, 1/s").append(rate)

    def inside() -> Element:
        return op("max", op("min", prop(f"{base}/X"), value(1.0)), value(0.0))

    half = op("product", value(0.5), op("sum", value(1.0), op("sqrt", inside())))
    lost = op("difference", op("pow", half, value(2.0)), value(1.0))
    lift = op("difference", prop(f"{base}/alpha-rad"), value(s.alpha_0))
    add_function(parent, f"{base}/CL", "Lift lost").append(
        op("product", value(s.CL_alpha), lost, lift)
    )
    for name, full in (("CD", s.CD_X), ("Cm", s.Cm_X)):
        add_function(parent, f"{base}/{name}", f"{name} by separation").append(
            op("product", value(full), op("difference", value(1.0), inside()))
        )
