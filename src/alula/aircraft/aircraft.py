"""The aircraft as the stages use it: SI, radians, body axes, positions from one datum."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from alula.aircraft.actuators import Actuator
from alula.aircraft.geometry import Geometry
from alula.aircraft.mass import MassModel, MassProperties
from alula.aircraft.propulsion import EngineModel
from alula.base.arrays import Array
from alula.base.messages import Message, refuse

# A sensor box serves several channels; a channel of its own name goes first.
SENSOR_GROUPS: Mapping[str, tuple[str, ...]] = {
    "imu": ("ax", "ay", "az", "p", "q", "r", "pdot", "qdot", "rdot"),
    "airdata": ("alpha", "beta", "beta_flank", "V", "V_cas", "V_ias", "mach", "qbar"),
    "gps": ("h_gps", "lat", "lon", "north", "east", "v_north", "v_east", "v_down"),
}


@dataclass(frozen=True)
class Envelope:
    """Limits of flight (lowest, highest); None where the file states none."""

    V: tuple[float, float] | None = None  # m/s, true airspeed
    alpha: tuple[float, float] | None = None  # rad
    n: tuple[float, float] | None = None  # load factor
    h: tuple[float, float] | None = None  # m


@dataclass(frozen=True)
class Uncertainty:
    """Standard deviations: mass, inertia, the propellers' inertia relative; cg, hub (3,) m."""

    mass: float
    cg: Array
    inertia: float
    hub: Array
    propeller_inertia: float


@dataclass(frozen=True)
class Aircraft:
    """Reference geometry, mass, sensors, engines, control signs and limits of one aircraft.

    S m2, b (full span) m, c m. reference_point: (3,) m, what moment coefficients refer to.
    sensors: positions (3,) m by name. control_signs: factor from the log's sense to Alula's
    notation. control_limits: (lowest, highest) rad, or 1 for throttle, in Alula's notation.
    assumed: keys of the file whose value was not measured. All positions are in body axes from
    the datum. actuators: by control, for those that have one. aero: absolute path of the default
    aerodynamic model's file, None where the aircraft file names none; not opened here.
    uncertainty: of what was estimated, None where the file states none.
    geometry: the shape, None where the file has no [geometry].
    """

    name: str
    S: float
    b: float
    c: float
    reference_point: Array
    mass: MassModel | None
    sensors: Mapping[str, Array]
    engines: tuple[EngineModel, ...]
    control_signs: Mapping[str, float]
    control_limits: Mapping[str, tuple[float, float]]
    envelope: Envelope
    datum: str
    assumed: tuple[str, ...]
    path: str
    sha256: str
    messages: tuple[Message, ...] = field(default=())
    actuators: Mapping[str, Actuator] = field(default_factory=dict)
    aero: str | None = None
    geometry: Geometry | None = None
    uncertainty: Uncertainty | None = None

    def mass_properties(self, fuel_used: Array) -> MassProperties:
        """Mass (n,), CG (n, 3) and inertia (n, 3, 3) after burning `fuel_used` (n,) kg.

        Raises BadInput where the aircraft file has no [mass].
        """
        if self.mass is None:
            raise refuse(
                "missing_mass",
                where=self.path,
                expected="[mass], because coefficients are to be computed from motion",
                found="no [mass]",
                do="State mass, cg and inertia in the aircraft file, or identify from recorded "
                'coefficients (coefficients_from = "recorded").',
            )
        return self.mass.at(fuel_used)

    def sensor_position(self, channel: str) -> Array:
        """Where the sensor of `channel` sits, (3,) m from the datum.

        By the channel's own name ('alpha_2' for a second sensor), else by its group ('imu',
        'airdata', 'gps'), else the center of gravity at zero fuel used (without [mass]: the
        reference point).
        """
        if channel in self.sensors:
            return self.sensors[channel]
        first = re.sub(r"_\d+$", "", channel)
        for group, members in SENSOR_GROUPS.items():
            if first in members and group in self.sensors:
                return self.sensors[group]
        return self.reference_point if self.mass is None else self.mass.cg

    def control_sign(self, name: str) -> float:
        """+1 or -1, the factor from the log's sense to Alula's; +1 where the file says nothing."""
        return self.control_signs.get(name, 1.0)

    def summary(self) -> dict[str, str]:
        """Label and value in words and SI units, for the report."""
        rows = {
            "Aircraft": self.name,
            "Reference area S": f"{self.S:.5g} m²",
            "Span b": f"{self.b:.5g} m",
            "Mean aerodynamic chord c": f"{self.c:.5g} m",
            "Datum": self.datum,
        }
        if self.mass is not None:
            J = self.mass.inertia
            rows["Mass at zero fuel used"] = f"{self.mass.mass:.6g} kg"
            rows["Center of gravity"] = _vector(self.mass.cg)
            rows["Ixx, Iyy, Izz, Ixz"] = (
                f"{J[0, 0]:.6g}, {J[1, 1]:.6g}, {J[2, 2]:.6g}, {-J[0, 2]:.6g} kg m²"
            )
            if self.mass.fuel is not None:
                rows["Fuel on board"] = f"{self.mass.fuel.mass:.5g} kg"
        rows["Moment reference point"] = _vector(self.reference_point)
        for name, position in self.sensors.items():
            rows[f"Sensor {name}"] = _vector(position)
        for engine in self.engines:
            rows[f"Engine {engine.name}"] = f"{_source(engine)}, at {_vector(engine.position)}"
        if self.assumed:
            rows["Assumed, not measured"] = ", ".join(self.assumed)
        return rows


def _source(engine: EngineModel) -> str:
    """Where the engine's thrust comes from, in words."""
    made = "" if engine.machine is None else f"{engine.kind}, "
    if engine.channel is not None:
        return f"{made}thrust by channel '{engine.channel}'"
    if engine.thrust is not None:
        return f"{made}thrust {engine.thrust:.5g} N"
    return f"{engine.kind}, simulated"


def _vector(r: Array) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in r) + ") m"
