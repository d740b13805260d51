"""The aircraft file's tables of engines and propellers."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from alula.aircraft.schema_table import NotNegative, Number, Positive, Table, Vector

KNOTS = 24  # the core's capacity for a curve
Knots = Annotated[list[Number], Field(min_length=2, max_length=KNOTS)]
Axis = Annotated[list[Number], Field(min_length=2, max_length=64)]
Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Grid = Annotated[list[Axis], Field(min_length=2, max_length=64)]


def _increasing(key: str, values: list[float]) -> None:
    if any(not a < b for a, b in pairwise(values)):
        raise ValueError(f"'{key}' increasing|{values}")


def _alike(tables: dict[str, list[float]]) -> None:
    lengths = {key: len(values) for key, values in tables.items()}
    if len(set(lengths.values())) > 1:
        found = ", ".join(f"{n} of {key}" for key, n in lengths.items())
        raise ValueError(f"as many values of each of {', '.join(tables)}|{found}")


class PropellerTable(Table):
    """A fixed-pitch propeller by its coefficients over the advance ratio."""

    diameter: Positive = Field(description="m")
    inertia: Positive = Field(description="about its axis, kg m2")
    sense: Literal["right", "left"] = Field(
        default="right", description="seen from behind: right is clockwise"
    )
    J: Knots = Field(description="advance ratio V/(n D), n in revolutions per second")
    CT: Knots = Field(description="thrust coefficient T/(rho n^2 D^4)")
    CP: Knots = Field(description="power coefficient P/(rho n^3 D^5)")

    @model_validator(mode="after")
    def _tables(self) -> PropellerTable:
        _increasing("J", self.J)
        _alike({"J": self.J, "CT": self.CT, "CP": self.CP})
        return self


class PistonTable(Table):
    """A piston engine."""

    reduction: Positive = Field(default=1.0, description="crankshaft speed over propeller speed")
    gear: Literal["same", "opposite"] = Field(
        default="same", description="whether the crankshaft turns with the propeller"
    )
    crank_inertia: NotNegative = Field(default=0.0, description="at crankshaft speed, kg m2")
    speed_rpm: Knots = Field(description="crankshaft speed, revolutions per minute")
    torque: Knots = Field(description="at full throttle at sea level, N m")
    friction: NotNegative = Field(
        default=0.0, description="drag of the crankshaft, throttle closed, ignition off, N m"
    )
    idle: Share = Field(default=0.0, description="opening that the closed throttle leaves")
    consumption_g_kWh: NotNegative = Field(
        default=0.0, description="fuel over shaft energy, g/(kW h); 0: fuel is not modeled"
    )

    @model_validator(mode="after")
    def _tables(self) -> PistonTable:
        _increasing("speed_rpm", self.speed_rpm)
        _alike({"speed_rpm": self.speed_rpm, "torque": self.torque})
        return self


class ElectricTable(Table):
    """A motor, its speed controller and its battery."""

    k_V_rpm: Positive = Field(description="speed constant, rpm/V")
    k_T: Positive | None = Field(default=None, description="N m/A; default 1/k_V in SI")
    I_0: NotNegative = Field(description="current without load, A")
    R_motor: NotNegative = Field(description="ohm")
    R_esc: NotNegative = Field(default=0.0, description="of the speed controller, ohm")
    R_battery: NotNegative = Field(default=0.0, description="ohm")
    U_full: Positive = Field(description="battery's voltage without load, full, V")
    U_empty: Positive = Field(description="the same, empty, V")
    capacity_Ah: Positive = Field(description="charge between the two, A h")
    I_max: Positive = Field(description="the speed controller's limit, A")
    I_regen: NotNegative = Field(default=0.0, description="current it lets flow back, A")

    @model_validator(mode="after")
    def _possible(self) -> ElectricTable:
        if not self.R_motor + self.R_esc + self.R_battery > 0.0:
            raise ValueError("a resistance above zero|all zero")
        if self.U_empty > self.U_full:
            raise ValueError(f"U_empty at most U_full|{self.U_empty} V and {self.U_full} V")
        return self


class TurbofanTable(Table):
    """A turbofan by its net thrust over Mach number (rows) and height (columns)."""

    mach: Axis
    height: Axis = Field(description="m")
    idle: Grid = Field(description="N, one row per Mach number")
    military: Grid = Field(description="N")
    maximum: Grid | None = Field(default=None, description="N, with afterburner; default none")
    military_at: Share = Field(default=1.0, description="throttle of military thrust")
    lag: Positive = Field(description="of the first order, s")
    angular_momentum: Number = Field(
        default=0.0, description="of the rotors at full power, kg m2/s, along the thrust"
    )
    idle_speed: Share = Field(default=1.0, description="share of the rotors' speed at idle")
    consumption_kg_N_h: NotNegative = Field(
        default=0.0, description="fuel over thrust, kg/(N h); 0: fuel is not modeled"
    )

    @model_validator(mode="after")
    def _tables(self) -> TurbofanTable:
        if (self.maximum is None) != (self.military_at == 1.0) or self.military_at == 0.0:
            found = f"military_at {self.military_at:g}"
            found += ", no 'maximum'" if self.maximum is None else " and 'maximum'"
            raise ValueError(f"military_at between 0 and 1 with 'maximum', else 1|{found}")
        _increasing("mach", self.mach)
        _increasing("height", self.height)
        for key in ("idle", "military", "maximum"):
            grid = getattr(self, key)
            if grid is None:
                continue
            if len(grid) != len(self.mach) or {len(row) for row in grid} != {len(self.height)}:
                rows = f"{len(grid)} rows of {', '.join(str(len(row)) for row in grid)}"
                expected = f"{len(self.mach)} rows of {len(self.height)}"
                raise ValueError(f"'{key}' of {expected}: Mach number by height|{rows}")
        return self


class EngineTable(Table):
    """An engine's line of action and its thrust."""

    name: str
    kind: Literal["given", "piston", "electric", "turbofan"] = Field(
        default="given", description="what makes the thrust where it is simulated"
    )
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
    propeller: PropellerTable | None = None
    piston: PistonTable | None = None
    electric: ElectricTable | None = None
    turbofan: TurbofanTable | None = None

    @model_validator(mode="after")
    def _one_source(self) -> EngineTable:
        both = self.channel is not None and self.thrust is not None
        if both or (self.kind == "given" and self.channel is None and self.thrust is None):
            raise ValueError("either 'channel' or 'thrust'|both or neither of them")
        if self.direction is not None:
            if self.tilt_deg is not None or self.toe_deg is not None:
                raise ValueError("'direction', or 'tilt_deg' and 'toe_deg'|both")
            if not any(self.direction):
                raise ValueError("a direction|all zeros")
        return self

    @model_validator(mode="after")
    def _machine(self) -> EngineTable:
        wanted = {
            "given": (),
            "piston": ("propeller", "piston"),
            "electric": ("propeller", "electric"),
            "turbofan": ("turbofan",),
        }[self.kind]
        keys = ("propeller", "piston", "electric", "turbofan")
        given = tuple(k for k in keys if getattr(self, k) is not None)
        if given != wanted:
            tables = " and ".join(f"[engines.{k}]" for k in wanted) or "no machine's table"
            raise ValueError(f"{tables} for kind '{self.kind}'|{', '.join(given) or 'none'}")
        return self
