"""An aircraft's engines in JSBSim: external forces and moments by functions."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

import numpy as np

from alula.aircraft import EngineModel
from alula.base.arrays import Array
from alula.base.units import LBF
from alula.export.jsbsim_functions import add_function, op, prop, value
from alula.export.jsbsim_machines import add_machine
from alula.export.jsbsim_property import FT, INCH
from alula.simulate import Airframe

THRUST = "alula/thrust-N"  # of all engines whose thrust is given, set by the user


def add_engines(root: Element, airframe: Airframe) -> Element:
    """Append what the engines need and return their `external_reactions`, to stand last."""
    system = SubElement(root, "system", name="engines")
    given = sum(e.thrust or 0.0 for e in airframe.engines if e.kind == "given")
    SubElement(system, "property", value=repr(float(given))).text = THRUST
    channel = SubElement(system, "channel", name="engines")
    forces = Element("external_reactions")
    for i, engine in enumerate(airframe.engines):
        base = f"alula/engine[{i}]"
        name = f"engine-{i}"
        if engine.kind == "given":
            thrust = op("product", value(engine.share), prop(THRUST))
            _forces(forces, name, engine, airframe, thrust)
        else:
            add_machine(system, channel, base, engine, airframe)
            _forces(forces, name, engine, airframe, prop(f"{base}/thrust-N"))
            _rotor_moments(forces, name, base, engine)
    if not airframe.engines:
        _forces(forces, "thrust", None, airframe, prop(THRUST))
    return forces


def _forces(
    forces: Element, name: str, engine: EngineModel | None, airframe: Airframe, thrust: Element
) -> None:
    if engine is None:
        point = airframe.cg if airframe.thrust_point is None else airframe.thrust_point
        direction = airframe.thrust_direction
    else:
        point, direction = engine.position, engine.direction
    force = SubElement(forces, "force", name=name, frame="BODY")
    function = add_function(force, f"alula/force/{name}-lbs", "Thrust, lbf")
    function.append(op("product", thrust, value(1.0 / LBF)))
    location = SubElement(force, "location", unit="IN")
    x, y, z = (np.asarray(point) / INCH).tolist()
    for axis, number in (("x", -x), ("y", y), ("z", -z)):
        SubElement(location, axis).text = repr(number + 0.0)
    _direction(force, np.asarray(direction))


def _rotor_moments(forces: Element, name: str, base: str, engine: EngineModel) -> None:
    """What the airframe feels of a rotor: `along` the direction, and -h (w x direction)."""
    d = np.asarray(engine.direction)
    scale = 1.0 / (LBF * FT)
    _moment(forces, f"{name}-along", d, op("product", value(scale), prop(f"{base}/along-Nm")))
    for i, axis in enumerate("xyz"):
        j, k = (i + 1) % 3, (i + 2) % 3  # (w x d)_i = w_j d_k - w_k d_j
        turning = op(
            "difference",
            op("product", value(float(d[k])), prop(f"velocities/{'pqr'[j]}i-rad_sec")),
            op("product", value(float(d[j])), prop(f"velocities/{'pqr'[k]}i-rad_sec")),
        )
        content = op("product", value(-scale), prop(f"{base}/momentum-Nms"), turning)
        _moment(forces, f"{name}-gyro-{axis}", np.eye(3)[i], content)


def _moment(forces: Element, name: str, direction: Array, content: Element) -> None:
    moment = SubElement(forces, "moment", name=name, frame="BODY")
    add_function(moment, f"alula/moment/{name}-lbsft", "Moment, lbf ft").append(content)
    _direction(moment, direction)


def _direction(parent: Element, direction: Array) -> None:
    element = SubElement(parent, "direction")
    for axis, number in zip("xyz", direction.tolist(), strict=True):
        SubElement(element, axis).text = repr(float(number))
