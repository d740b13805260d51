"""Writes an aircraft and its aerodynamic model as a JSBSim aircraft file (fdm_config 2.0)."""

from __future__ import annotations

import re
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from alula.aircraft import Actuator, Aircraft
from alula.base.arrays import Array
from alula.export.jsbsim_engine import add_engines
from alula.export.jsbsim_functions import add_coefficients, add_function, op, prop, value
from alula.export.jsbsim_property import (
    COMMANDS,
    DEFAULT_LIMITS,
    FT,
    INCH,
    POUNDS_PER_SLUG,
    PROPERTIES,
    SLUG,
)
from alula.export.jsbsim_stall import add_stall
from alula.model import AXES, AeroModel
from alula.simulate import Airframe


def jsbsim_name(aircraft: Aircraft) -> str:
    """The aircraft's name as JSBSim's folder and file."""
    return re.sub(r"\W+", "_", aircraft.name, flags=re.ASCII).strip("_").lower() or "aircraft"


def limits_of(aircraft: Aircraft) -> dict[str, tuple[float, float]]:
    """Limits of each control, Alula's notation; what the file does not state by default."""
    return {**DEFAULT_LIMITS, **{k: v for k, v in aircraft.control_limits.items() if k in COMMANDS}}


def jsbsim_text(
    aircraft: Aircraft, airframe: Airframe, model: AeroModel, *, author: str, date: str
) -> str:
    """The aircraft at one loading as JSBSim's XML.

    airframe: mass properties, engines and actuators of that loading. Coefficients are functions
    outside the axes, about the reference point AERORP; commands become surface positions in rad;
    engines are functions that make their forces and moments. Raises BadInput where JSBSim cannot
    hold the model.
    """
    model.check_without_lift("JSBSim")
    model.check_without_wash("JSBSim")
    root = Element("fdm_config", name=aircraft.name, version="2.0", release="BETA")
    _header(root, aircraft, model, author, date)
    _metrics(root, model)
    _mass_balance(root, airframe)
    _ground_reactions(root, airframe, model)
    SubElement(root, "propulsion")
    _controls(root, aircraft, airframe)
    forces = add_engines(root, airframe)
    aerodynamics = SubElement(root, "aerodynamics")
    _variables(aerodynamics)
    add_coefficients(aerodynamics, model)
    if model.stall is not None:
        add_stall(root, aerodynamics, model)
    _axes(aerodynamics, model)
    root.append(forces)
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _header(root: Element, aircraft: Aircraft, model: AeroModel, author: str, date: str) -> None:
    header = SubElement(root, "fileheader")
    SubElement(header, "author").text = author
    SubElement(header, "filecreationdate").text = date
    SubElement(header, "version").text = "1"
    words = [f"{aircraft.name}: aerodynamic model '{model.name}', written by Alula."]
    words += [f"{k}: {v}" for k, v in model.provenance.items()]
    if model.assumed:
        words.append(f"Assumed: {', '.join(model.assumed)}.")
    words += [
        f"Values were found with {n} from {a:g} to {b:g}." for n, (a, b) in model.validity.items()
    ]
    SubElement(header, "description").text = "\n".join(words)


def _metrics(root: Element, model: AeroModel) -> None:
    metrics, r = SubElement(root, "metrics"), model.reference
    for name, size, unit in (
        ("wingarea", r.S / FT**2, "FT2"),
        ("wingspan", r.b / FT, "FT"),
        ("chord", r.c / FT, "FT"),
    ):
        SubElement(metrics, name, unit=unit).text = repr(size)
    _location(metrics, "AERORP", model.reference_point)
    _location(metrics, "EYEPOINT", model.reference_point)
    _location(metrics, "VRP", np.zeros(3))


def _mass_balance(root: Element, airframe: Airframe) -> None:
    balance = SubElement(root, "mass_balance")
    J = np.asarray(airframe.inertia) / (SLUG * FT**2)
    # JSBSim's products of inertia are those of the structural axes (x aft, z up): of the tensor's
    # elements only xy and yz change their sign on the way, and ixz stands with that of the tensor.
    products = {"ixy": -J[0, 1], "ixz": J[0, 2], "iyz": -J[1, 2]}
    for name, x in {"ixx": J[0, 0], "iyy": J[1, 1], "izz": J[2, 2], **products}.items():
        SubElement(balance, name, unit="SLUG*FT2").text = repr(float(x))
    weight = airframe.mass / SLUG * POUNDS_PER_SLUG
    SubElement(balance, "emptywt", unit="LBS").text = repr(weight)
    _location(balance, "CG", airframe.cg)


def _location(parent: Element, name: str, position: Array) -> None:
    """A point of the datum frame (body axes, m) in the structural frame: x aft, z up, inches."""
    location = SubElement(parent, "location", name=name, unit="IN")
    x, y, z = (np.asarray(position) / INCH).tolist()
    for axis, number in (("x", -x), ("y", y), ("z", -z)):
        SubElement(location, axis).text = repr(number + 0.0)


def _ground_reactions(root: Element, airframe: Airframe, model: AeroModel) -> None:
    """One contact below the center of gravity: the file describes flight, not the gear."""
    ground = SubElement(root, "ground_reactions")
    contact = SubElement(ground, "contact", type="STRUCTURE", name="BELLY")
    _location(contact, "", airframe.cg + np.array([0.0, 0.0, 0.5 * model.reference.c]))
    del contact[-1].attrib["name"]
    for name, x, unit in (
        ("static_friction", 0.8, None),
        ("dynamic_friction", 0.5, None),
        ("spring_coeff", airframe.mass * 9.80665 / 0.05 / (14.5939), "LBS/FT"),
        ("damping_coeff", airframe.mass * 9.80665 / 0.5 / (14.5939), "LBS/FT/SEC"),
    ):
        element = SubElement(contact, name)
        element.text = repr(float(x))
        if unit:
            element.set("unit", unit)


def _controls(root: Element, aircraft: Aircraft, airframe: Airframe) -> None:
    """Commands to positions in rad: limits, and lag and rate where the airframe has actuators."""
    control = SubElement(root, "flight_control", name="FCS")
    limits = limits_of(aircraft)
    # JSBSim makes this one for engines of its own only.
    SubElement(control, "property", value="0").text = COMMANDS["dt"][0]
    for name, (command, factor) in COMMANDS.items():
        channel = SubElement(control, "channel", name=name)
        low, high = limits[name]
        actuator = airframe.actuators.get(name)
        position = PROPERTIES[name]
        scaled = position if actuator is None else f"alula/{name}-commanded"
        part = SubElement(channel, "aerosurface_scale", name=f"alula/{name}-scale")
        text = f"-{command}" if factor < 0.0 else command
        SubElement(part, "input").text = text
        if name in ("df", "dt"):
            domain = SubElement(part, "domain")
            SubElement(domain, "min").text, SubElement(domain, "max").text = "0", "1"
        span = SubElement(part, "range")
        SubElement(span, "min").text, SubElement(span, "max").text = repr(low), repr(high)
        SubElement(part, "output").text = scaled
        if actuator is not None:
            _actuator(control, channel, actuator, scaled, position)


def _actuator(control: Element, channel: Element, a: Actuator, command: str, state: str) -> None:
    """The position as a state: its rate is the error over tau, limited, none in the dead band.

    JSBSim's own actuator lags and limits one behind the other, and means another dead band.
    """
    SubElement(control, "property", value="0").text = state
    inside = op("max", op("min", prop(command), value(_finite(a.high))), value(_finite(a.low)))
    error = op("difference", inside, prop(state))
    if a.dead_band > 0.0:
        half = 0.5 * a.dead_band
        error = op("difference", error, op("max", op("min", error, value(half)), value(-half)))
    rate = op("quotient", error, value(a.tau))
    if np.isfinite(a.rate_limit) and a.rate_limit > 0.0:
        rate = op("max", op("min", rate, value(a.rate_limit)), value(-a.rate_limit))
    part = SubElement(channel, "fcs_function", name=f"alula/{state.rpartition('/')[2]}-next")
    step = op("product", rate, prop("simulation/dt"))
    SubElement(part, "function").append(op("sum", prop(state), step))
    SubElement(part, "output").text = state


def _finite(x: float) -> float:
    return float(np.clip(x, -1e6, 1e6))


def _variables(parent: Element) -> None:
    speed = add_function(parent, PROPERTIES["V"], "True airspeed, m/s")
    speed.append(op("product", prop("velocities/vt-fps"), value(FT)))
    for hat, rate, over in (
        ("phat", "p", "aero/bi2vel"), ("qhat", "q", "aero/ci2vel"), ("rhat", "r", "aero/bi2vel")
    ):  # fmt: skip
        function = add_function(parent, PROPERTIES[hat], f"{hat} of Alula's notation")
        function.append(op("product", prop(f"velocities/{rate}-aero-rad_sec"), prop(over)))


def _axes(parent: Element, model: AeroModel) -> None:
    """Forces in body axes and moments about AERORP, in pounds and feet."""
    attached: dict[str, str] = {c: f"aero/coefficient/{c}" for c in model.coefficients}
    lost = {} if model.stall is None else {c: f"alula/stall/{c}" for c in ("CD", "CL", "Cm")}
    if model.stall is not None and model.stall.split:
        lost |= {c: f"alula/stall/{c}" for c in ("Cl", "Cn")}
    names: dict[str, list[str]] = {
        c: [d[c] for d in (attached, lost) if c in d] for c in (*AXES["body"], "CD", "CL")
    }
    if names["CD"] or names["CL"]:
        for c, drag, lift in (("CX", "cos", "sin"), ("CZ", "sin", "cos")):
            function = add_function(parent, f"aero/body/{c}", f"{c} of CD and CL")
            parts = [
                op("product", value(sign), prop(n), op(angle, prop("aero/alpha-rad")))
                for label, angle, sign in (
                    ("CD", drag, -1.0), ("CL", lift, 1.0 if c == "CX" else -1.0)
                )
                for n in names[label]
            ]  # fmt: skip
            function.append(op("sum", *parts, value(0.0)))
            names[c].append(f"aero/body/{c}")
    lengths = {"Cl": "metrics/bw-ft", "Cm": "metrics/cbarw-ft", "Cn": "metrics/bw-ft"}
    for axis, c in zip(
        ("X", "Y", "Z", "ROLL", "PITCH", "YAW"), ("CX", "CY", "CZ", "Cl", "Cm", "Cn"), strict=True
    ):
        element = SubElement(parent, "axis", name=axis)
        if not names[c]:
            continue
        function = add_function(element, f"aero/load/{c}", f"qbar S {c}")
        length = [prop(lengths[c])] if c in lengths else []
        pressure = [prop("aero/qbar-psf"), prop("metrics/Sw-sqft")]
        function.append(op("product", *pressure, *length, _sum(names[c])))


def _sum(names: list[str]) -> Element:
    return op("sum", *map(prop, names), value(0.0))
