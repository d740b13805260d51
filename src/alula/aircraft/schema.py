"""The aircraft file's layout: every table and key, with its unit, as pydantic models."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

HUGE = 1e12  # beyond any aircraft in SI, and far from where squares overflow
Positive = Annotated[float, Field(gt=0.0, le=HUGE, allow_inf_nan=False)]
Number = Annotated[float, Field(ge=-HUGE, le=HUGE, allow_inf_nan=False)]
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]
Range = Annotated[list[Number], Field(min_length=2, max_length=2)]


def _check_order(key: str, limits: list[float] | None) -> None:
    if limits is not None and not limits[0] < limits[1]:
        raise ValueError(f"'{key}' as [lowest, highest]|{limits}")


class Table(BaseModel):
    """A table that knows its keys and takes no other; numbers are numbers, not text."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


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


class Inertia(Table):
    """Inertia about the part's own CG, kg m2; products are positive integrals (Ixz: of x z dm)."""

    Ixx: Number
    Iyy: Number
    Izz: Number
    Ixz: Number = 0.0
    Ixy: Number = 0.0
    Iyz: Number = 0.0


class Part(Table):
    """One component of the mass."""

    name: str
    mass: Positive = Field(description="kg")
    position: Vector = Field(description="its CG, m from the datum")
    inertia: Inertia | None = Field(default=None, description="about its own CG; default a point")


class Fuel(Table):
    """The fuel on board at zero fuel used; the channel 'fuel_used' burns it."""

    mass: Positive = Field(description="kg")
    position: Vector | None = Field(default=None, description="m from the datum; default the CG")
    inertia: Inertia | None = Field(
        default=None, description="about its own CG; burned in proportion"
    )


class Mass(Table):
    """At zero fuel used: totals that include the fuel, or components to which it is added."""

    mass: Positive | None = Field(default=None, description="kg")
    cg: Vector | None = Field(default=None, description="m from the datum")
    Ixx: Positive | None = Field(default=None, description="kg m2, about the CG")
    Iyy: Positive | None = None
    Izz: Positive | None = None
    Ixz: Number | None = Field(default=None, description="integral of x z dm, kg m2")
    Ixy: Number | None = None
    Iyz: Number | None = None
    components: list[Part] = []
    fuel: Fuel | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Mass:
        totals = ("mass", "cg", "Ixx", "Iyy", "Izz", "Ixz")
        given = [k for k in (*totals, "Ixy", "Iyz") if getattr(self, k) is not None]
        if self.components and given:
            raise ValueError("totals or components, not both|components and " + ", ".join(given))
        missing = [k for k in totals if getattr(self, k) is None]
        if not self.components and missing:
            raise ValueError(
                "components, or all of mass, cg, Ixx, Iyy, Izz, Ixz|no " + ", ".join(missing)
            )
        return self


class Sensor(Table):
    """Where a sensor sits."""

    position: Vector = Field(description="m from the datum")


class EngineTable(Table):
    """An engine's line of action and its thrust."""

    name: str
    position: Vector = Field(description="where the thrust acts, m from the datum")
    direction: Vector | None = Field(
        default=None, description="of the thrust; default along the nose"
    )
    tilt_deg: Number | None = Field(
        default=None, description="thrust line's angle up from forward, deg"
    )
    toe_deg: Number | None = Field(
        default=None, description="thrust line's angle to the right, deg"
    )
    channel: str | None = Field(default=None, description="the log's thrust channel, N")
    thrust: Number | None = Field(default=None, description="constant thrust, N")
    thrust_se: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] = Field(
        default=0.0, description="relative standard error of the thrust"
    )

    @model_validator(mode="after")
    def _one_source(self) -> EngineTable:
        if (self.channel is None) == (self.thrust is None):
            raise ValueError("either 'channel' or 'thrust'|both or neither of them")
        if self.direction is not None:
            if self.tilt_deg is not None or self.toe_deg is not None:
                raise ValueError("'direction', or 'tilt_deg' and 'toe_deg'|both")
            if not any(self.direction):
                raise ValueError("a direction|all zeros")
        return self


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
            _check_order(key, getattr(self, key))
        return self


class EnvelopeTable(Table):
    """Limits of flight: lowest and highest of each."""

    V: Range | None = Field(default=None, description="true airspeed, m/s")
    alpha_deg: Range | None = Field(default=None, description="angle of attack, deg")
    n: Range | None = Field(default=None, description="load factor")
    h: Range | None = Field(default=None, description="altitude, m")

    @model_validator(mode="after")
    def _ordered(self) -> EnvelopeTable:
        for key in ("V", "alpha_deg", "n", "h"):
            _check_order(key, getattr(self, key))
        return self


class AircraftFile(Table):
    """An aircraft file, `schema = "alula.aircraft/1"`."""

    schema_: Literal["alula.aircraft/1"] = Field(alias="schema")
    name: str
    assumed: list[str] = Field(default=[], description="dotted keys whose value was not measured")
    datum: Datum = Datum(name="center of gravity", frame="body")
    reference: Reference
    mass: Mass | None = None
    sensors: dict[str, Sensor] = {}
    engines: list[EngineTable] = []
    controls: dict[str, Control] = {}
    envelope: EnvelopeTable = EnvelopeTable()
