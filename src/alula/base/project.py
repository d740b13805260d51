"""The project file: logs, channels, maneuvers and what to do with them.

`load_project` reads TOML; `Project.model_json_schema()` is the schema for editors. The layout is
explained in docs/project_file.md.
"""

from __future__ import annotations

from datetime import date
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from alula.base.file_schema import Identifier, Quantity, ReadFile, Strict
from alula.base.filters import FilterName
from alula.base.messages import BadInput
from alula.base.project_messages import check_units, expand_paths, read_toml, validated
from alula.base.project_references import references
from alula.base.units import to_si

Repair = Literal["drop_duplicate_times", "drop_backward_times", "drop_ragged_rows"]
Format = Literal["auto", "csv", "ascii", "npz", "mat", "hdf5", "parquet"]
Source = Annotated[int, Field(ge=1)] | Annotated[str, Field(min_length=1)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
State = Literal["h", "u", "v", "w", "phi", "theta", "psi"]
Option = (
    float
    | str
    | bool
    | list[float]
    | list[str]
    | dict[str, float]
    | dict[str, str]
    | dict[str, list[float]]
)


class TimeSpec(Strict):
    """Time stamps of one channel that has its own, from the file itself."""

    source: Source = Field(alias="from")
    column: int | None = Field(default=None, ge=1)
    unit: str = "s"
    scale: float = 1.0
    offset: float = 0.0


class ChannelSpec(Strict):
    """Where a channel comes from: value_SI = unit(sign * (scale * x + offset))."""

    source: Source | list[Source] | None = Field(
        default=None, alias="from", description="a column name, a 1-based column, or several"
    )
    column: int | None = Field(
        default=None, ge=1, description="1-based column of the matrix that 'from' names"
    )
    weights: list[float] | None = Field(default=None, description="one for each of 'from'")
    constant: float | None = Field(default=None, description="a value instead of a recording")
    unit: str | None = Field(default=None, description="default: the unit the file itself states")
    scale: float = Field(default=1.0, description="in the source's unit")
    offset: float = Field(default=0.0, description="in the source's unit")
    sign: Literal[1, -1] = 1
    table: list[Pair] | None = Field(
        default=None, description="calibration: [source, unit] pairs, linear between"
    )
    delay_s: float = Field(
        default=0.0, description="the sample was true this long before its stamp"
    )
    time: str | TimeSpec | None = Field(default=None, description="default: the channel 't'")
    fill_values: list[float] | None = Field(default=None, description="values that mean 'no data'")
    repeats: Literal["keep", "drop"] = Field(
        default="keep", description="drop: a value equal to the one before is held, no sample"
    )
    confirmed: bool = Field(
        default=False, description="the unit is right although the values look as if it were not"
    )

    @model_validator(mode="after")
    def _one_source(self) -> ChannelSpec:
        if (self.source is None) == (self.constant is None):
            raise ValueError("either 'from' or 'constant'|both or neither of them")
        if self.weights is not None and len(self.weights) != len(self.sources):
            raise ValueError(
                f"one weight for each of the {len(self.sources)} sources|{len(self.weights)}"
            )
        if self.column is not None and not isinstance(self.source, str):
            raise ValueError("'from' naming a matrix when 'column' is given|no matrix name")
        if self.table is not None:
            x = [pair[0] for pair in self.table]
            if len(x) < 2 or any(b <= a for a, b in pairwise(x)):
                raise ValueError(
                    "a table of two or more rows with increasing source values|" + str(x)
                )
        return self

    @property
    def sources(self) -> tuple[int | str, ...]:
        """The sources as a tuple; empty for a constant."""
        if self.source is None:
            return ()
        return tuple(self.source) if isinstance(self.source, list) else (self.source,)


class LogSpec(Strict):
    """One log file and how to read it."""

    id: Identifier
    path: Path = Field(strict=False)
    aircraft: Path | None = Field(
        default=None,
        strict=False,
        description="for this log only: the same aircraft, otherwise loaded",
    )
    format: Format = "auto"
    variable: str | None = Field(
        default=None, description="matrix, structure, dataset or group inside the file"
    )
    separator: str | None = Field(default=None, min_length=1, max_length=1)
    decimal: Literal[".", ","] | None = None
    encoding: str | None = None
    header_row: int | None = Field(default=None, ge=0, description="line number; 0: no header")
    unit_row: int | None = Field(default=None, ge=0, description="line number; 0: no unit row")
    skip_rows: int = Field(default=0, ge=0, description="lines to pass over at the top")
    columns: list[str] | None = Field(default=None, description="names when there is no header")
    fill_values: list[float] | None = Field(default=None, description="values that mean 'no data'")
    repair: list[Repair] = Field(default=[], description="what may be dropped, and is counted")
    channels: dict[str, ChannelSpec] = Field(default={}, description="for this log only")


class ManeuverSpec(Strict):
    """A window of a log."""

    id: Identifier
    log: str
    kind: str = ""
    start: float
    end: float
    aspect: Literal["longitudinal", "lateral", "both"] = "both"
    configuration: dict[str, str] = Field(default={})
    held_out: bool = False
    on_gap: Literal["refuse", "split"] = "refuse"

    @model_validator(mode="after")
    def _order(self) -> ManeuverSpec:
        if self.end <= self.start:
            raise ValueError(f"'end' after 'start'|{self.start:g} to {self.end:g} s")
        return self


class NoiseSpec(Quantity):
    """Standard deviation of an inertial sensor's white noise per sample."""

    sigma: float = Field(ge=0)

    @property
    def sigma_si(self) -> float:
        """The standard deviation, SI."""
        return self.in_si(self.sigma)


class UnknownSpec(Quantity):
    """One unknown of the reconstruction. prior: standard deviation; walk: per square root of s."""

    state: Literal["constant", "walk", "off"] = "constant"
    value: float = 0.0
    prior: float | None = Field(default=None, gt=0)
    walk: float | None = Field(default=None, ge=0)


class SensorSpec(Quantity):
    """One measured channel of the reconstruction."""

    sigma: float | None = Field(default=None, gt=0)
    use: bool = True
    form: str | None = None
    reference: Literal["zero", "first"] = "zero"

    @property
    def sigma_si(self) -> float | None:
        """The standard deviation, SI; None where the method's default applies."""
        return None if self.sigma is None else self.in_si(self.sigma)


class InitialSpec(Quantity):
    """One motion state at the first sample of a maneuver."""

    value: float

    @property
    def value_si(self) -> float:
        """The value, SI."""
        return self.in_si(self.value)


class ReconstructSpec(Strict):
    """How the flight path is reconstructed."""

    filter: FilterName = "ekf"
    gravity: float = Field(default=9.80665, gt=0)
    share: Literal["all", "log", "maneuver"] = "all"
    initial_state: Literal["estimate", "measured"] = "estimate"
    given: list[State] = Field(
        default=[], description="motion states taken as measured, not integrated (filter 'ml')"
    )
    initial: dict[str, dict[State, InitialSpec]] = Field(
        default={}, description="by maneuver: motion states at its first sample, where known better"
    )
    smoothing_window_s: float = Field(default=0.0, ge=0, description="0: the method chooses")
    vibration_filter_hz: float = Field(
        default=0.0, ge=0, description="low-pass of inertial channels and controls; 0: none"
    )
    imu: dict[Literal["ax", "ay", "az", "p", "q", "r"], NoiseSpec] = Field(default={})
    unknowns: dict[str, UnknownSpec] = Field(default={})
    sensors: dict[str, SensorSpec] = Field(default={})


class NavigateSpec(Strict):
    """How `alula navigate` filters a log."""

    filter: Literal["joint", "pair"] = "joint"
    field: (
        Annotated[list[float], Field(min_length=3, max_length=3)]
        | Literal["world_magnetic_model"]
        | None
    ) = Field(
        default=None,
        description="Earth's magnetic field there: north, east, down; or that of the World "
        "Magnetic Model at the log's first position; none: no magnetometer",
    )
    field_unit: str = "uT"
    day: date | None = Field(default=None, description="of the flight, for that model")
    gust: float = Field(default=1.0, ge=0, description="turbulence, standard deviation, m/s")
    gust_length: float = Field(default=200.0, gt=0, description="its scale length, m")
    sensors: dict[str, SensorSpec] = Field(
        default={}, description="by channel, before [reconstruct.sensors]"
    )

    @property
    def field_si(self) -> tuple[float, float, float] | None:
        """The field where it is stated, T."""
        if self.field is None or isinstance(self.field, str):
            return None
        scale = to_si(self.field_unit, where="navigate.field_unit").scale
        return scale * self.field[0], scale * self.field[1], scale * self.field[2]


class IdentifySpec(Strict):
    """What is identified, and how."""

    method: str = "ee"
    coefficients_from: Literal["motion", "recorded"] = "motion"
    models: dict[str, str] = Field(default={})
    options: dict[str, Option] = Field(default={})
    hold_out: float = Field(
        default=0.2,
        ge=0.0,
        le=0.5,
        description="share of the maneuvers held out where none is marked and there are five or "
        "more of an aspect; 0: none",
    )


class Project(ReadFile):
    """A project file as it was read; paths are absolute."""

    schema_: Literal["alula.project/1"] = Field(alias="schema")
    name: str
    aircraft: Path | None = Field(default=None, strict=False)
    logs: list[LogSpec] = Field(min_length=1)
    channels: dict[str, ChannelSpec] = Field(default={})
    maneuvers: list[ManeuverSpec] = Field(default=[])
    reconstruct: ReconstructSpec = ReconstructSpec()
    navigate: NavigateSpec = NavigateSpec()
    identify: IdentifySpec = IdentifySpec()

    def log(self, id: str) -> LogSpec:
        """The log of that id (the maneuvers' references are checked on loading)."""
        return next(log for log in self.logs if log.id == id)

    def channels_of(self, log: LogSpec) -> dict[str, ChannelSpec]:
        """The channels of one log: the project's, replaced by the log's own where it has them."""
        return {**self.channels, **log.channels}


def load_project(path: Path | str) -> Project:
    """Read and check a project file; paths in it become absolute, from its folder.

    Raises BadInput with one message for everything that is wrong: file, key, expected, found.
    """
    path = Path(path)
    text, tree, sha256 = read_toml(path)
    expand_paths(tree, path, ("aircraft",), "logs", ("path", "aircraft"))
    project = validated(Project, tree, path, text)
    problems = references(project, path) + check_units(project, path)
    if problems:
        raise BadInput(*problems)
    project._path, project._sha256 = path.resolve(), sha256
    return project
