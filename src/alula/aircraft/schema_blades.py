"""Tables of a propeller: blades, polars, tests; in aircraft files and propeller files."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from alula.aircraft.schema_table import NotNegative, Number, Positive, Table

STATIONS = 64  # the core's capacity
Stations = Annotated[list[Number], Field(min_length=2, max_length=STATIONS)]
Column = Annotated[list[Number], Field(min_length=1, max_length=10000)]


def check_increasing(key: str, values: list[float]) -> None:
    """Raises ValueError at the first value that does not exceed the one before."""
    for k, (a, b) in enumerate(pairwise(values), 2):
        if not a < b:
            raise ValueError(f"'{key}' increasing|{b:g} after {a:g} (value {k})")


def check_alike(**columns: list[float] | None) -> None:
    """Raises ValueError unless all columns that are given have one length."""
    lengths = {key: len(values) for key, values in columns.items() if values is not None}
    if len(set(lengths.values())) > 1:
        found = ", ".join(f"{n} of {key}" for key, n in lengths.items())
        raise ValueError(f"as many values of each of {', '.join(lengths)}|{found}")


class PolarParameters(Table):
    """A section's lift and drag: QPROP's parameters, or a table over alpha."""

    c_l_0: Number = 0.0
    c_l_alpha: NotNegative = Field(default=0.0, description="1/rad")
    c_l_min: Number = -10.0
    c_l_max: Number = 10.0
    c_d_0: NotNegative = 0.0
    c_d_2_upper: NotNegative = Field(default=0.0, description="of (c_l - c_l_cd0)^2 above it")
    c_d_2_lower: NotNegative = Field(default=0.0, description="the same below")
    c_l_cd0: Number = Field(default=0.0, description="lift coefficient of least drag")
    c_d_stalled: NotNegative = Field(default=2.0, description="of sin^2 alpha where stalled")
    reynolds: Positive = Field(default=1.0, description="at which the drag is stated")
    reynolds_power: Number = Field(default=0.0, description="of drag over Reynolds number")
    mach_corrected: bool = True
    alpha_deg: Column | None = Field(default=None, description="of the table, deg")
    c_l: Column | None = None
    c_d: Column | None = None
    source: str = ""

    @model_validator(mode="after")
    def _one_form(self) -> PolarParameters:
        if not self.c_l_min < self.c_l_max:
            raise ValueError(f"c_l_min below c_l_max|{self.c_l_min:g} and {self.c_l_max:g}")
        table = (self.alpha_deg, self.c_l, self.c_d)
        if any(t is not None for t in table):
            if any(t is None for t in table):
                raise ValueError("all of alpha_deg, c_l, c_d|one of them alone")
            if self.c_l_alpha or self.c_l_0 or self.c_d_0:
                raise ValueError("a table, or parameters such as c_l_alpha|both")
            check_alike(alpha_deg=self.alpha_deg, c_l=self.c_l, c_d=self.c_d)
            check_increasing("alpha_deg", self.alpha_deg or [])
        elif not self.c_l_alpha > 0.0:
            raise ValueError("'c_l_alpha', or a table of alpha_deg, c_l, c_d|neither")
        return self


class MomentumTable(Table):
    """Parameters of the momentum model (Pusztai 2018, 2.1)."""

    c_l_alpha: Positive = Field(description="1/rad")
    alpha_max_deg: Annotated[float, Field(gt=0.0, le=90.0)] = Field(description="stall, deg")
    c_d_alpha: NotNegative = Field(description="1/rad^2")
    pitch: Positive = Field(description="effective geometric pitch, m")


class BladesTable(Table):
    """Blades by stations from root to tip."""

    name: str = ""
    count: Annotated[int, Field(ge=1, le=20)] = Field(description="of blades")
    diameter: Positive = Field(description="m")
    hub_radius: NotNegative | None = Field(
        default=None, description="where the blades begin, m; default the first station"
    )
    sense: Literal["right", "left"] = Field(
        default="right", description="seen from behind: right is clockwise"
    )
    r: Stations = Field(description="m from the axis, increasing")
    chord: Stations = Field(description="m")
    beta_deg: Stations | None = Field(default=None, description="angle against the disk, deg")
    pitch: Positive | None = Field(default=None, description="geometric pitch, m, for beta_deg")
    pitch_of: Literal["chord", "zero_lift"] = Field(
        default="chord", description="what beta_deg or pitch is the angle of"
    )
    polar: PolarParameters | None = Field(default=None, description="of all stations")
    polars: list[PolarParameters] | None = Field(default=None, description="one per station")
    momentum: MomentumTable | None = None
    source: str = ""

    @model_validator(mode="after")
    def _possible(self) -> BladesTable:
        check_increasing("r", self.r)
        check_alike(r=self.r, chord=self.chord, beta_deg=self.beta_deg)
        if (self.beta_deg is None) == (self.pitch is None):
            raise ValueError("'beta_deg' or 'pitch'|" + ("both" if self.pitch else "neither"))
        radius = 0.5 * self.diameter
        if not self.r[0] > 0.0 or self.r[-1] > radius * (1.0 + 1e-9):
            raise ValueError(
                f"'r' between 0 and the tip at {radius:g} m|{self.r[0]:g} to {self.r[-1]:g} m"
            )
        hub = self.r[0] if self.hub_radius is None else self.hub_radius
        if not hub < radius:
            raise ValueError(f"a hub inside the tip at {radius:g} m|hub_radius {hub:g} m")
        for k, chord in enumerate(self.chord, 1):
            if not 0.0 < chord <= self.diameter:
                raise ValueError(f"chords above 0 and below the diameter|{chord:g} m, station {k}")
        for k, beta in enumerate(self.beta_deg or [], 1):
            if not -90.0 < beta < 90.0:
                raise ValueError(f"'beta_deg' between -90 and 90 deg|{beta:g} at station {k}")
        if self.polar is not None and self.polars is not None:
            raise ValueError("'polar' or 'polars'|both")
        if self.polars is not None and len(self.polars) != len(self.r):
            raise ValueError(f"{len(self.r)} polars, one per station|{len(self.polars)}")
        return self


class TestTable(Table):
    """A propeller's measured coefficients."""

    __test__ = False  # no test of pytest's

    J: Column = Field(description="advance ratio V/(n D)")
    CT: Column = Field(description="T/(rho n^2 D^4)")
    CP: Column = Field(description="P/(rho n^3 D^5)")
    run: list[str] | None = Field(default=None, description="names, where there were several runs")
    se_CT: Positive | None = Field(default=None, description="standard error of CT")
    se_CP: Positive | None = Field(default=None, description="of CP")
    rpm: Positive | None = Field(default=None, description="for Reynolds numbers")
    source: str = ""

    @model_validator(mode="after")
    def _columns(self) -> TestTable:
        check_alike(J=self.J, CT=self.CT, CP=self.CP)
        if self.run is not None and len(self.run) != len(self.J):
            raise ValueError(f"a name per value of J|{len(self.run)} names, {len(self.J)} values")
        return self


class StaticTestTable(Table):
    """A static thrust test: torque from the motor's electric power (Pusztai 2018, B.2)."""

    rpm: Column
    thrust: Column = Field(description="N")
    voltage: Column = Field(description="at the motor, V")
    current: Column = Field(description="A")
    motor_efficiency: Annotated[float, Field(gt=0.0, le=1.0)]
    motor_efficiency_se: NotNegative = Field(default=0.0, description="its standard error")
    density: Positive = Field(default=1.225, description="kg/m3")

    @model_validator(mode="after")
    def _columns(self) -> StaticTestTable:
        check_alike(
            rpm=self.rpm, thrust=self.thrust, voltage=self.voltage, current=self.current
        )  # fmt: skip
        for key in ("rpm", "voltage", "current"):
            for k, x in enumerate(getattr(self, key), 1):
                if not x > 0.0:
                    raise ValueError(f"'{key}' above zero|{x:g} (value {k})")
        return self


class FitTable(Table):
    """What a fit holds: parameters that are given, not sought."""

    alpha_max_deg: Annotated[float, Field(gt=0.0, le=90.0)] | None = None
    pitch: Positive | None = Field(default=None, description="effective geometric pitch, m")
    c_l_alpha: Positive | None = None
    c_d_alpha: NotNegative | None = None
    J_max: Positive | None = Field(default=None, description="values above are not fitted")


class PropellerFile(Table):
    """A propeller file, `schema = "alula.propeller/1"`."""

    schema_: Literal["alula.propeller/1"] = Field(alias="schema")
    name: str
    blades: BladesTable
    rpm: Positive | None = Field(default=None, description="at which its curves are computed")
    density: Positive = Field(default=1.225, description="kg/m3")
    test: TestTable | None = None
    static_test: StaticTestTable | None = None
    fit: FitTable = FitTable()
