"""An aircraft's engines as functions of JSBSim: their speed, thrust and moments.

JSBSim's own engine models compute manifold pressure and the like from data that an aircraft file
of Alula does not have; functions carry over exactly what it has. Speeds of rotors are summed up by
the rectangle rule at JSBSim's step.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

import numpy as np
from scipy.interpolate import PchipInterpolator

from alula.aircraft import Aircraft, EngineModel, PistonEngine
from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.base.units import LBF, SLUG
from alula.export.jsbsim_functions import add_function, grid_element, op, prop, value
from alula.export.jsbsim_property import FT, INCH, PROPERTIES
from alula.simulate import Airframe

THRUST = "alula/thrust-N"  # of all engines whose thrust is given, set by the user
_SEA_LEVEL = 1.225  # kg/m3
_POWER_LOSS = 1.0 / 7.55  # Gagg and Ferrar, SAE Journal 34, 1934
_SLOW = 5.0  # rad/s: below, friction fades; the core's kFrictionSpeed
_SAMPLES = 400  # of a curve between its ends: the chords err by less than 1e-5 of its range
_FAR = 100.0


def add_engines(root: Element, aircraft: Aircraft, airframe: Airframe) -> Element:
    """Append what the engines need and return their `external_reactions`, to stand last.

    Raises BadInput for an engine of a kind that is not exported.
    """
    system = SubElement(root, "system", name="engines")
    given = sum(e.thrust or 0.0 for e in aircraft.engines)
    SubElement(system, "property", value=repr(float(given))).text = THRUST
    channel = SubElement(system, "channel", name="engines")
    forces = Element("external_reactions")
    for i, engine in enumerate(aircraft.engines):
        base = f"alula/engine[{i}]"
        name = f"engine-{i}"
        if engine.kind == "given":
            thrust = op("product", value(engine.share), prop(THRUST))
            _forces(forces, name, engine, airframe, thrust)
        elif isinstance(engine.machine, PistonEngine):
            SubElement(system, "property", value="0").text = f"{base}/omega-rad_s"
            add_state(channel, f"{base}/omega", f"{base}/omega-rad_s", f"{base}/omega-rate")
            _piston(channel, base, engine, engine.machine, airframe)
            _forces(forces, name, engine, airframe, prop(f"{base}/thrust-N"))
            _rotor_moments(forces, name, base, engine, engine.machine)
        else:
            raise refuse(
                "jsbsim_engine",
                where=f"{aircraft.path}, engines, '{engine.name}'",
                expected="engines of kind 'given' or 'piston'",
                found=f"'{engine.kind}'",
                do="Give the thrust (kind = 'given') for the export.",
            )
    if not aircraft.engines:
        _forces(forces, "thrust", None, airframe, prop(THRUST))
    return forces


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


def _piston(
    channel: Element, base: str, engine: EngineModel, e: PistonEngine, airframe: Airframe
) -> None:
    p, omega = e.propeller, f"{base}/omega-rad_s"
    _component(
        channel,
        f"{base}/density-kg_m3",
        op("product", prop("atmosphere/rho-slugs_ft3"), value(SLUG / FT**3)),
    )
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
    _component(channel, f"{base}/shaft-torque-Nm", _shaft(base, omega, e))
    excess = op("difference", prop(f"{base}/shaft-torque-Nm"), prop(f"{base}/propeller-torque-Nm"))
    turning = p.inertia + e.crank_inertia * e.reduction**2
    _component(channel, f"{base}/omega-rate", op("quotient", excess, value(turning)))


def _shaft(base: str, omega: str, e: PistonEngine) -> Element:
    """Torque at the propeller, N m: opening (full + friction) - friction, through the gear."""
    x = op("product", prop(omega), value(e.reduction / _SLOW))
    root = op("sqrt", op("sum", op("product", x, x), value(1.0)))
    sense = op("quotient", x, root)
    density = op("product", prop(f"{base}/density-kg_m3"), value((1 + _POWER_LOSS) / _SEA_LEVEL))
    factor = op("difference", density, value(_POWER_LOSS))
    torque = curve_element(omega, np.asarray(e.omega) / e.reduction, e.torque)
    full = op("max", op("product", torque, factor), value(0.0))
    throttle = op("max", op("min", prop(PROPERTIES["dt"]), value(1.0)), value(0.0))
    opening = op("sum", value(e.idle), op("product", value(1.0 - e.idle), throttle))
    brake = op("product", opening, op("sum", full, value(e.friction)))
    friction = op("product", value(e.friction), sense)
    return op("product", value(e.reduction), op("difference", brake, friction))


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


def _forces(
    forces: Element, name: str, engine: EngineModel | None, airframe: Airframe, thrust: Element
) -> None:
    point = airframe.cg if engine is None else np.asarray(engine.position)
    direction = np.array([1.0, 0.0, 0.0]) if engine is None else engine.direction
    force = SubElement(forces, "force", name=name, frame="BODY")
    function = add_function(force, f"alula/force/{name}-lbs", "Thrust, lbf")
    function.append(op("product", thrust, value(1.0 / LBF)))
    location = SubElement(force, "location", unit="IN")
    x, y, z = (np.asarray(point) / INCH).tolist()
    for axis, number in (("x", -x), ("y", y), ("z", -z)):
        SubElement(location, axis).text = repr(number + 0.0)
    _direction(force, np.asarray(direction))


def _rotor_moments(
    forces: Element, name: str, base: str, engine: EngineModel, e: PistonEngine
) -> None:
    """Reaction of the air's torque, and what changing and turning the angular momentum needs.

    The airframe feels -sense (Q + carried domega/dt) along the direction and
    -sense carried omega (w x direction).
    """
    p = e.propeller
    carried = p.inertia + e.gear_sense * e.crank_inertia * e.reduction
    d = np.asarray(engine.direction)
    speeding = op("product", value(carried), prop(f"{base}/omega-rate"))
    along = op("sum", prop(f"{base}/propeller-torque-Nm"), speeding)
    scale = -p.sense / (LBF * FT)
    _moment(forces, f"{name}-along", d, op("product", value(scale), along))
    for i, axis in enumerate("xyz"):
        j, k = (i + 1) % 3, (i + 2) % 3  # (w x d)_i = w_j d_k - w_k d_j
        turning = op(
            "difference",
            op("product", value(float(d[k])), prop(f"velocities/{'pqr'[j]}i-rad_sec")),
            op("product", value(float(d[j])), prop(f"velocities/{'pqr'[k]}i-rad_sec")),
        )
        content = op("product", value(scale * carried), prop(f"{base}/omega-rad_s"), turning)
        _moment(forces, f"{name}-gyro-{axis}", np.eye(3)[i], content)


def _moment(forces: Element, name: str, direction: Array, content: Element) -> None:
    moment = SubElement(forces, "moment", name=name, frame="BODY")
    add_function(moment, f"alula/moment/{name}-lbsft", "Moment, lbf ft").append(content)
    _direction(moment, direction)


def _direction(parent: Element, direction: Array) -> None:
    element = SubElement(parent, "direction")
    for axis, number in zip("xyz", direction.tolist(), strict=True):
        SubElement(element, axis).text = repr(float(number))


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
