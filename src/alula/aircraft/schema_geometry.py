"""The aircraft file's [geometry]: lifting surfaces, controls, bodies, airfoils."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from alula.aircraft.schema_table import NotNegative, Number, Positive, Table, Vector

Angle = Annotated[float, Field(ge=-90.0, le=90.0, allow_inf_nan=False)]
Count = Annotated[int, Field(ge=1, le=400)]
Numbers = Annotated[list[Number], Field(min_length=3, max_length=2000)]
Pair = Annotated[list[Number], Field(min_length=2, max_length=2)]
Station = Annotated[list[Number], Field(min_length=5, max_length=5)]


class PolarTable(Table):
    """Section coefficients over the angle of attack: inline, or a CSV file beside this file."""

    file: str | None = Field(
        default=None, description="CSV with a header alpha_deg,c_l,c_d,c_m, from this file's folder"
    )
    alpha_deg: Numbers | None = Field(default=None, description="increasing, deg")
    c_l: Numbers | None = None
    c_d: Numbers | None = None
    c_m: Numbers | None = Field(default=None, description="about the quarter chord; default 0")
    reynolds: Positive | None = Field(default=None, description="that it holds for")
    source: str = Field(description="where the numbers come from")

    @model_validator(mode="after")
    def _one_way(self) -> PolarTable:
        inline = [k for k in ("alpha_deg", "c_l", "c_d", "c_m") if getattr(self, k) is not None]
        if self.file is not None and inline:
            raise ValueError(f"'file' or the numbers|file and {', '.join(inline)}")
        missing = [k for k in ("alpha_deg", "c_l", "c_d") if k not in inline]
        if self.file is None and missing:
            raise ValueError(f"'file', or all of alpha_deg, c_l, c_d|no {', '.join(missing)}")
        lengths = {k: len(getattr(self, k)) for k in inline}
        if len(set(lengths.values())) > 1:
            found = ", ".join(f"{n} of {k}" for k, n in lengths.items())
            raise ValueError(f"as many values of each|{found}")
        return self


class AirfoilTable(Table):
    """A section's shape and its aerodynamics where they are known."""

    naca: str | None = Field(
        default=None, description="four digits, e.g. '2412': camber, thickness"
    )
    thickness: Positive | None = Field(default=None, le=0.6, description="over the chord")
    camber: Annotated[list[Pair], Field(min_length=3, max_length=500)] | None = Field(
        default=None, description="mean line as [x/c, z/c] from [0, 0] to [1, 0], up positive"
    )
    c_l_alpha: Positive | None = Field(default=None, le=12.0, description="lift slope, 1/rad")
    alpha_0_deg: Angle | None = Field(default=None, description="of zero lift, deg")
    polar: PolarTable | None = None


class SectionTable(Table):
    """A chord of a lifting surface."""

    position: Vector = Field(description="of the leading edge, m from the datum")
    chord: Positive = Field(description="m")
    twist_deg: Angle = Field(default=0.0, description="nose up (on a fin: nose right), deg")
    airfoil: str = Field(description="'NACA 2412', or a name of [geometry.airfoils]")


class ControlSurfaceTable(Table):
    """A hinged part of a lifting surface."""

    name: str
    span: Pair = Field(
        default=[0.0, 1.0], description="from, to: fractions of the span from first to last section"
    )
    hinge: Number | Pair = Field(description="fraction of the chord, or [inner, outer]")
    gains: dict[str, Number] = Field(
        min_length=1, description="own deflection over the control's, by control: {da = 1.0}"
    )
    c_l_delta: Positive | None = Field(
        default=None, description="section lift per rad of deflection; default by its hinge"
    )
    c_m_delta: Number | None = Field(
        default=None, description="section moment about the quarter chord, the same"
    )


class SurfaceTable(Table):
    """A wing, tailplane or fin, from the root to the right or upper tip."""

    name: str
    role: Literal["wing", "tailplane", "fin", "other"]
    mirror: bool = Field(description="whether there is a left half as well")
    sections: Annotated[list[SectionTable], Field(min_length=2, max_length=100)]
    controls: list[ControlSurfaceTable] = Field(default_factory=list)
    panels: Annotated[list[Count], Field(min_length=2, max_length=2)] = Field(
        default=[6, 12], description="of the lattice: along the chord, along the (half) span"
    )


class BodyTable(Table):
    """A fuselage or nacelle by elliptic cross-sections, from nose to tail."""

    name: str
    stations: Annotated[list[Station], Field(min_length=3, max_length=500)] = Field(
        description="x, y, z of the center, width, height, m"
    )


class GeometryTable(Table):
    """The shape, from which derivatives are predicted."""

    surfaces: Annotated[list[SurfaceTable], Field(min_length=1, max_length=40)]
    bodies: Annotated[list[BodyTable], Field(max_length=40)] = Field(default_factory=list)
    drag_area: NotNegative = Field(
        default=0.0, description="c_d times area of all that is no lifting surface, m2"
    )
    airfoils: dict[str, AirfoilTable] = Field(default_factory=dict)
    blades: dict[str, dict[str, Any]] = Field(
        default_factory=dict, description="propeller blades, by the engine's name"
    )

    @model_validator(mode="after")
    def _named_apart(self) -> GeometryTable:
        controls = [c for s in self.surfaces for c in s.controls]
        for kind, things in (("surface", self.surfaces), ("body", self.bodies),
                             ("control surface", controls)):  # fmt: skip
            names = [thing.name for thing in things]
            twice = next((n for n in names if names.count(n) > 1), None)
            if twice is not None:
                raise ValueError(f"a name of its own for each {kind}|'{twice}' more than once")
        return self
