"""The aircraft file's layout: every table and key, with its unit, as pydantic models."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from alula.aircraft.schema_engines import EngineTable
from alula.aircraft.schema_geometry import GeometryTable
from alula.aircraft.schema_mass import Mass
from alula.aircraft.schema_table import (
    NotNegative,
    Positive,
    Range,
    Table,
    Vector,
    check_order,
)

Surface = Literal["de", "da", "dr", "df", "dt"]


class Datum(Table):
    """From where, and in which axes, positions are measured."""

    name: str = Field(description="the point positions are measured from, in words")
    frame: Literal["body", "design"] = Field(
        default="body", description="body: x forward, y right, z down; design: x aft, y right, z up"
    )


class Reference(Table):
    """Reference geometry."""

    S: Positive = Field(description="wing area, m2")
    b: Positive = Field(description="full span, m")
    c: Positive = Field(description="mean aerodynamic chord, m")
    point: Vector | None = Field(default=None, description="moment reference, m; default the CG")


class Sensor(Table):
    """Where a sensor sits."""

    position: Vector = Field(description="m from the datum")


class Control(Table):
    """What the log's positive means for one control, and how far it goes, in the same sense."""

    sign: str = Field(description="'+TED', '+TEL', '+RTED', '+ANU', ...")
    limits_deg: Range | None = Field(default=None, description="lowest, highest, deg")
    limits: Range | None = Field(default=None, description="lowest, highest, of a throttle: 0 to 1")

    @model_validator(mode="after")
    def _ordered(self) -> Control:
        if self.limits_deg is not None and self.limits is not None:
            raise ValueError("'limits_deg' or 'limits'|both")
        for key in ("limits_deg", "limits"):
            check_order(key, getattr(self, key))
        return self


class ActuatorTable(Table):
    """What stands between the command and a control's position."""

    tau: Positive = Field(description="time constant of the lag, s")
    rate_limit_deg_s: Positive | None = Field(default=None, description="deg/s; default none")
    rate_limit: Positive | None = Field(default=None, description="of a throttle, 1/s")
    dead_band_deg: NotNegative | None = Field(default=None, description="full width, deg")
    dead_band: NotNegative | None = Field(default=None, description="of a throttle, full width")


class EnvelopeTable(Table):
    """Limits of flight: lowest and highest of each."""

    V: Range | None = Field(default=None, description="true airspeed, m/s")
    alpha_deg: Range | None = Field(default=None, description="angle of attack, deg")
    n: Range | None = Field(default=None, description="load factor")
    h: Range | None = Field(default=None, description="altitude, m")

    @model_validator(mode="after")
    def _ordered(self) -> EnvelopeTable:
        for key in ("V", "alpha_deg", "n", "h"):
            check_order(key, getattr(self, key))
        return self


class UncertaintyTable(Table):
    """Standard deviations of what was estimated: a sample of the aircraft is drawn from them."""

    mass: NotNegative = Field(default=0.0, le=0.5, description="of itself")
    cg: Vector = Field(default=[0.0, 0.0, 0.0], description="m, along the datum's axes")
    inertia: NotNegative = Field(default=0.0, le=0.5, description="of itself")
    hub: Vector = Field(default=[0.0, 0.0, 0.0], description="of each engine's position, m")
    propeller_inertia: NotNegative = Field(default=0.0, le=0.5, description="of itself")


class AircraftFile(Table):
    """An aircraft file, `schema = "alula.aircraft/1"`."""

    schema_: Literal["alula.aircraft/1"] = Field(alias="schema")
    name: str
    aero: str | None = Field(
        default=None, description="file of the aerodynamic model, from this file's folder"
    )
    assumed: list[str] = Field(default=[], description="dotted keys whose value was not measured")
    datum: Datum = Datum(name="center of gravity", frame="body")
    reference: Reference
    mass: Mass | None = None
    uncertainty: UncertaintyTable | None = None
    sensors: dict[str, Sensor] = Field(default_factory=dict)
    engines: list[EngineTable] = Field(default_factory=list)
    controls: dict[str, Control] = Field(default_factory=dict)
    actuators: dict[Surface, ActuatorTable] = Field(default_factory=dict)
    envelope: EnvelopeTable = EnvelopeTable()
    geometry: GeometryTable | None = None
