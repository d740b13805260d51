"""Machines of an aircraft file as functions of JSBSim: speed, thrust, moments.

JSBSim's own engine models compute manifold pressure and the like from data that an aircraft file
of Alula does not have; functions carry over exactly what it has. States are summed up by the
rectangle rule at JSBSim's step. Each machine gives `thrust-N`, `along-Nm`, what the airframe feels
along the direction besides, and `momentum-Nms`, angular momentum along the direction.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

import numpy as np
from scipy.interpolate import PchipInterpolator

from alula.aircraft import ElectricMotor, EngineModel, PistonEngine, Propeller, Turbofan
from alula.base.arrays import Array
from alula.base.units import SLUG
from alula.export.jsbsim_functions import grid_element, op, prop, value
from alula.export.jsbsim_property import FT, PROPERTIES
from alula.simulate import Airframe

_SEA_LEVEL = 1.225  # kg/m3
_POWER_LOSS = 1.0 / 7.55  # Gagg and Ferrar, SAE Journal 34, 1934
_SLOW = 5.0  # rad/s: below, friction fades; the core's kFrictionSpeed
_SAMPLES = 400  # of a curve between its ends: the chords err by less than 1e-5 of its range
_FAR = 100.0  # spans


def add_machine(
    system: Element, channel: Element, base: str, engine: EngineModel, airframe: Airframe
) -> None:
    """Append the functions of an engine that has a machine, under properties of `base`."""
    machine = engine.machine
    if isinstance(machine, Turbofan):
        _turbofan(system, channel, base, machine)
    elif machine is not None:
        _propeller(system, channel, base, machine.propeller, engine, airframe)
        if isinstance(machine, PistonEngine):
            p = machine
            turning = p.propeller.inertia + p.crank_inertia * p.reduction**2
            carried = p.propeller.inertia + p.gear_sense * p.crank_inertia * p.reduction
            shaft = _piston_torque(base, p)
        else:
            turning = carried = machine.propeller.inertia
            shaft = _electric_torque(system, channel, base, machine)
        _rotor(channel, base, machine.propeller.sense, turning, carried, shaft)


def add_state(channel: Element, component: str, state: str, rate: str) -> None:
    """Append a component that adds step times rate to a property, never below zero."""
    step = op("product", prop(rate), prop("simulation/dt"))
    part = SubElement(channel, "fcs_function", name=f"{component}-next")
    function = SubElement(part, "function")
    function.append(op("max", op("sum", prop(state), step), value(0.0)))
    SubElement(part, "output").text = state


def _component(channel: Element, name: str, content: Element) -> None:
    """Append a component whose property has this name."""
    part = SubElement(channel, "fcs_function", name=name)
    SubElement(part, "function").append(content)


def _limited(x: Element, low: float, high: float) -> Element:
    return op("max", op("min", x, value(high)), value(low))


def _throttle() -> Element:
    return _limited(prop(PROPERTIES["dt"]), 0.0, 1.0)


def _propeller(
    system: Element,
    channel: Element,
    base: str,
    p: Propeller,
    engine: EngineModel,
    airframe: Airframe,
) -> None:
    """Thrust and torque of the air, N and N m, at the rotor's speed."""
    omega = f"{base}/omega-rad_s"
    SubElement(system, "property", value="0").text = omega
    add_state(channel, f"{base}/omega", omega, f"{base}/omega-rate")
    density = op("product", prop("atmosphere/rho-slugs_ft3"), value(SLUG / FT**3))
    _component(channel, f"{base}/density-kg_m3", density)
    _component(channel, f"{base}/axial-m_s", _axial(engine, airframe))
    n = op("product", prop(omega), value(0.5 / np.pi))
    _component(channel, f"{base}/n", op("max", n, value(1e-3)))
    over = op("product", prop(f"{base}/n"), value(p.diameter))
    _component(channel, f"{base}/J", op("quotient", prop(f"{base}/axial-m_s"), over))
    pressure = [prop(f"{base}/density-kg_m3"), prop(f"{base}/n"), prop(f"{base}/n")]
    for label, y, scale in (
        ("thrust-N", p.CT, p.diameter**4),
        ("propeller-torque-Nm", p.CP, p.diameter**5 / (2.0 * np.pi)),
    ):
        table = curve_element(f"{base}/J", p.J, y)
        _component(channel, f"{base}/{label}", op("product", value(scale), *pressure, table))


def _rotor(
    channel: Element, base: str, sense: float, turning: float, carried: float, shaft: Element
) -> None:
    """Rate of the rotor's speed; the airframe feels -sense (Q + carried domega/dt) along."""
    _component(channel, f"{base}/shaft-torque-Nm", shaft)
    torque = prop(f"{base}/propeller-torque-Nm")
    excess = op("difference", prop(f"{base}/shaft-torque-Nm"), torque)
    _component(channel, f"{base}/omega-rate", op("quotient", excess, value(turning)))
    speeding = op("product", value(carried), prop(f"{base}/omega-rate"))
    _component(
        channel, f"{base}/along-Nm", op("product", value(-sense), op("sum", torque, speeding))
    )
    momentum = op("product", value(sense * carried), prop(f"{base}/omega-rad_s"))
    _component(channel, f"{base}/momentum-Nms", momentum)


def _piston_torque(base: str, e: PistonEngine) -> Element:
    """Torque at the propeller, N m: opening (full + friction) - friction, through the gear."""
    omega = f"{base}/omega-rad_s"
    sense = _friction_sense(omega, e.reduction)
    density = op("product", prop(f"{base}/density-kg_m3"), value((1 + _POWER_LOSS) / _SEA_LEVEL))
    factor = op("difference", density, value(_POWER_LOSS))
    torque = curve_element(omega, np.asarray(e.omega) / e.reduction, e.torque)
    full = op("max", op("product", torque, factor), value(0.0))
    opening = op("sum", value(e.idle), op("product", value(1.0 - e.idle), _throttle()))
    brake = op("product", opening, op("sum", full, value(e.friction)))
    friction = op("product", value(e.friction), sense)
    return op("product", value(e.reduction), op("difference", brake, friction))


def _friction_sense(omega: str, ratio: float) -> Element:
    x = op("product", prop(omega), value(ratio / _SLOW))
    return op("quotient", x, op("sqrt", op("sum", op("product", x, x), value(1.0))))


def _electric_torque(system: Element, channel: Element, base: str, e: ElectricMotor) -> Element:
    """k_T (I - I_0), I within the controller's limits; the battery's charge is a state."""
    charge = f"{base}/charge-As"
    SubElement(system, "property", value="0").text = charge
    add_state(channel, charge, charge, f"{base}/battery-A")
    used = op("product", prop(charge), value(1.0 / e.capacity))
    left = _limited(op("difference", value(1.0), used), 0.0, 1.0)
    voltage = op("sum", value(e.U_empty), op("product", value(e.U_full - e.U_empty), left))
    back = op("product", prop(f"{base}/omega-rad_s"), value(1.0 / e.k_V))
    drive = op("difference", op("product", _throttle(), voltage), back)
    resistance = e.R_motor + e.R_esc + e.R_battery
    current = _limited(op("quotient", drive, value(resistance)), -e.I_regen, e.I_max)
    _component(channel, f"{base}/motor-A", current)
    _component(channel, f"{base}/battery-A", op("product", _throttle(), prop(f"{base}/motor-A")))
    lost = op("product", value(e.I_0), _friction_sense(f"{base}/omega-rad_s", 1.0))
    return op("product", value(e.k_T), op("difference", prop(f"{base}/motor-A"), lost))


def _turbofan(system: Element, channel: Element, base: str, e: Turbofan) -> None:
    """Thrust between the tables by power, which lags the throttle."""
    power = f"{base}/power"
    SubElement(system, "property", value="0").text = power
    add_state(channel, power, power, f"{base}/power-rate")
    behind = op("difference", _throttle(), prop(power))
    _component(channel, f"{base}/power-rate", op("quotient", behind, value(e.lag)))
    height = f"{base}/height-m"
    _component(channel, height, op("product", prop("position/h-sl-ft"), value(FT)))
    for name, values in (("idle", e.idle), ("military", e.military), ("maximum", e.maximum)):
        if values is not None:
            table = grid_element([PROPERTIES["mach"], height], [e.mach, e.height], values)
            _component(channel, f"{base}/{name}-N", op("product", table, value(1.0)))
    at = 1.0 if e.maximum is None else e.military_at

    def part(low: float, high: float, under: str, over: str) -> Element:
        """From `low` to `high` of power, what is added between two tables."""
        inside = op("difference", _limited(prop(power), low, high), value(low))
        gap = op("difference", prop(f"{base}/{over}-N"), prop(f"{base}/{under}-N"))
        return op("product", value(1.0 / (high - low)), inside, gap)

    parts = [prop(f"{base}/idle-N"), part(0.0, at, "idle", "military")]
    if e.maximum is not None and at < 1.0:
        parts.append(part(at, 1.0, "military", "maximum"))
    _component(channel, f"{base}/thrust-N", op("sum", *parts))
    change = e.angular_momentum * (1.0 - e.idle_speed)
    _component(
        channel, f"{base}/along-Nm", op("product", value(-change), prop(f"{base}/power-rate"))
    )
    turning = op("product", value(change), prop(power))
    momentum = op("sum", value(e.angular_momentum * e.idle_speed), turning)
    _component(channel, f"{base}/momentum-Nms", momentum)


def _axial(engine: EngineModel, airframe: Airframe) -> Element:
    """Speed of the hub against the air along the direction, m/s: d . v + (r x d) . w."""
    d = np.asarray(engine.direction)
    r = np.asarray(engine.position) - airframe.cg
    parts = [
        op("product", value(float(x) * FT), prop(f"velocities/{n}-aero-fps"))
        for x, n in zip(d, "uvw", strict=True)
    ]
    parts += [
        op("product", value(float(x)), prop(f"velocities/{n}-aero-rad_sec"))
        for x, n in zip(np.cross(r, d), "pqr", strict=True)
    ]
    return op("sum", *parts)


def curve_element(name: str, x: Array, y: Array) -> Element:
    """A table over a property that follows the core's curve: monotone cubic, lines outside."""
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if len(x) > 2:
        smooth = PchipInterpolator(x, y)  # Fritsch and Butland 1984, as the core's curve
        at = np.unique(np.concatenate([x, np.linspace(x[0], x[-1], _SAMPLES)]))
        values, low, high = smooth(at), smooth(x[0], 1), smooth(x[-1], 1)
    else:
        at, values = x, y
        low = high = (y[-1] - y[0]) / (x[-1] - x[0])
    far = _FAR * (x[-1] - x[0])
    at = np.concatenate([[at[0] - far], at, [at[-1] + far]])
    values = np.concatenate([[y[0] - far * low], values, [y[-1] + far * high]])
    return grid_element([name], [at], values)
