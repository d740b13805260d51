"""The aircraft file's tables of mass: totals or components, persons, fuel and tanks."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from alula.aircraft.schema_table import Number, Positive, Table, Vector

Height = Annotated[float, Field(ge=0.5, le=2.6, allow_inf_nan=False)]
Density = Annotated[float, Field(ge=50.0, le=2000.0, allow_inf_nan=False)]


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


class Person(Table):
    """Somebody on board; inertia follows from height and weight."""

    name: str
    mass: Positive = Field(description="kg, clothed and with what is worn")
    height: Height = Field(description="m, standing")
    position: Vector = Field(description="CG as seated, m from the datum")
    posture: Literal["sitting", "standing"] = "sitting"


class Fuel(Table):
    """The fuel on board at zero fuel used; the channel 'fuel_used' burns it."""

    mass: Positive = Field(description="kg")
    position: Vector | None = Field(default=None, description="m from the datum; default the CG")
    inertia: Inertia | None = Field(
        default=None, description="about its own CG; burned in proportion"
    )


class Section(Table):
    """A rectangular section of a wing tank, across the span."""

    position: Vector = Field(description="the rectangle's center, m from the datum")
    length: Positive = Field(description="m, fore and aft")
    depth: Positive = Field(description="m, up and down")


class Tank(Table):
    """A tank of given shape; its fuel lies on its floor and burns from the top."""

    name: str
    shape: Literal["box", "cylinder", "wing"]
    fuel: Positive = Field(description="kg at zero fuel used")
    density: Density = Field(description="of the fuel, kg/m3")
    burn: int = Field(default=1, ge=1, le=99, description="order; equal numbers burn together")
    liquid: Literal["solid", "reduced"] = Field(
        default="solid", description="whether the fuel's own inertia is that of a solid"
    )
    center: Vector | None = Field(default=None, description="of a box or cylinder, m")
    size: Vector | None = Field(default=None, description="of a box: length, width, depth, m")
    diameter: Positive | None = Field(default=None, description="of a cylinder, m")
    length: Positive | None = Field(default=None, description="of a cylinder, m")
    axis: Literal["x", "y", "z"] | None = Field(default=None, description="of a cylinder")
    root: Section | None = Field(default=None, description="of a wing tank: one end")
    tip: Section | None = Field(default=None, description="of a wing tank: the other end")

    @model_validator(mode="after")
    def _shaped(self) -> Tank:
        wanted = {
            "box": ("center", "size"),
            "cylinder": ("center", "diameter", "length", "axis"),
            "wing": ("root", "tip"),
        }[self.shape]
        keys = ("center", "size", "diameter", "length", "axis", "root", "tip")
        given = tuple(k for k in keys if getattr(self, k) is not None)
        if given != wanted:
            raise ValueError(f"{', '.join(wanted)} for a {self.shape}|{', '.join(given) or 'none'}")
        if self.size is not None and min(self.size) <= 0.0:
            raise ValueError(f"a size of positive length, width and depth|{self.size}")
        if self.root and self.tip and self.root.position[1] == self.tip.position[1]:
            raise ValueError("root and tip at different stations y|the same")
        return self


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
    components: list[Part] = Field(default_factory=list)
    persons: list[Person] = Field(default_factory=list)
    fuel: Fuel | None = None
    tanks: list[Tank] = Field(default_factory=list)

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
        if self.persons and not self.components:
            raise ValueError("persons beside components|totals, which include them")
        if self.fuel and self.tanks:
            raise ValueError("'fuel' or 'tanks'|both")
        for kind in ("components", "persons", "tanks"):
            names = [part.name for part in getattr(self, kind)]
            twice = next((n for n in names if names.count(n) > 1), None)
            if twice is not None:
                raise ValueError(f"a name of its own for each of {kind}|'{twice}' more than once")
        return self
