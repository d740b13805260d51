"""The calibration project, `alula.calibration/1`: which columns of which files are what."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from alula.base.file_schema import ReadFile, Strict
from alula.base.messages import BadInput
from alula.base.project import LogSpec, Source
from alula.base.project_messages import check_units, expand_paths, read_toml, validated
from alula.base.project_references import duplicate_ids, unknown_log

Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
Three = Annotated[list[Source], Field(min_length=3, max_length=3)]
Window = Annotated[list[float], Field(min_length=2, max_length=2)]
SensorName = Literal["accelerometer", "gyro", "magnetometer"]


class VectorsSpec(Strict):
    """Three columns, or a matrix of three columns (or rows) by its name."""

    log: str
    source: Source | Three = Field(alias="from")
    unit: str | None = Field(default=None, description="default: the unit the file itself states")
    signs: Vector = Field(default=[1.0, 1.0, 1.0], description="1 or -1 for each axis")
    limit: float | None = Field(default=None, gt=0.0, description="end of the range, in the unit")

    @model_validator(mode="after")
    def _signs(self) -> VectorsSpec:
        if any(abs(s) != 1.0 for s in self.signs):
            raise ValueError(f"signs that are 1 or -1|{self.signs}")
        return self


class RecordingSpec(VectorsSpec):
    """Three columns over time."""

    time: Source = "t"
    time_unit: str | None = None
    start: float | None = None
    end: float | None = None


class PositionsSpec(RecordingSpec):
    """A recording in which the sensor rests in many positions."""

    windows: list[Window] | None = Field(
        default=None, description="s, one at rest for each position; default: found"
    )
    least_s: float = Field(default=2.0, gt=0.0, description="shortest rest to be taken")


class AccelerometerSpec(Strict):
    """Static positions."""

    gravity: float | None = Field(default=None, gt=9.5, lt=10.0, description="local, m/s2")
    positions: VectorsSpec | None = Field(default=None, description="mean readings, a row each")
    recording: PositionsSpec | None = None
    directions: Literal["faces", "faces_and_edges", "none"] | list[Vector] = Field(
        default="none", description="of the specific force in body axes; level: [0, 0, -1]"
    )

    @model_validator(mode="after")
    def _one(self) -> AccelerometerSpec:
        if (self.positions is None) == (self.recording is None):
            raise ValueError("either 'positions' or 'recording'|both or neither of them")
        return self


class TurnSpec(Strict):
    """A turn by a known angle, or a rest (angle 0)."""

    start: float
    end: float
    angle_deg: float = Field(default=0.0, ge=0.0)
    axis: Vector | None = None

    @model_validator(mode="after")
    def _right(self) -> TurnSpec:
        if self.end <= self.start:
            raise ValueError(f"'end' after 'start'|{self.start:g} to {self.end:g} s")
        if self.axis is not None and not any(self.axis):
            raise ValueError("an axis that is not zero|[0, 0, 0]")
        return self


class GyroSpec(Strict):
    """Turns."""

    recording: RecordingSpec
    force: VectorsSpec | None = Field(default=None, description="raw accelerometer, same log")
    g_sensitivity: Literal["none", "diagonal", "full"] = "diagonal"
    turns: list[TurnSpec] = Field(min_length=1)


class LevelSpec(VectorsSpec):
    """Readings of the level aircraft at a true heading; several are averaged."""

    heading_deg: float
    amperes: float = Field(default=0.0, description="motor current")


class MagnetometerSpec(Strict):
    """Turned through all directions, then level, then with current."""

    readings: VectorsSpec
    field: float | Vector = Field(description="the Earth's: north, east, down, or its length")
    field_unit: str = "T"
    level: list[LevelSpec] = Field(default_factory=list)


class StillSpec(RecordingSpec):
    """A recording at rest."""

    sensor: SensorName


class CalibrationProject(ReadFile):
    """A calibration project as it was read; paths are absolute."""

    schema_: Literal["alula.calibration/1"] = Field(alias="schema")
    name: str
    logs: list[LogSpec] = Field(min_length=1)
    accelerometer: AccelerometerSpec | None = None
    gyro: GyroSpec | None = None
    magnetometer: MagnetometerSpec | None = None
    still: list[StillSpec] = Field(default_factory=list)

    @model_validator(mode="after")
    def _something(self) -> CalibrationProject:
        if not (self.accelerometer or self.gyro or self.magnetometer or self.still):
            raise ValueError("[accelerometer], [gyro], [magnetometer] or [[still]]|none of them")
        return self


def load_calibration_project(path: Path | str) -> CalibrationProject:
    """Read and check a calibration project; raises BadInput with all that is wrong."""
    path = Path(path)
    text, tree, digest = read_toml(path)
    expand_paths(tree, path, (), "logs", ("path",))
    project = validated(CalibrationProject, tree, path, text)
    known = [log.id for log in project.logs]
    problems = check_units(project, path)
    for where, spec in _vectors(project):
        problems += unknown_log(path, f"{where}.log", spec.log, known)
    problems += duplicate_ids(path, "logs", known)
    if problems:
        raise BadInput(*problems)
    project._path, project._sha256 = path.resolve(), digest
    return project


def _vectors(p: CalibrationProject) -> list[tuple[str, VectorsSpec]]:
    """Every entry that names columns, with its key."""
    found: list[tuple[str, VectorsSpec | None]] = []
    if p.accelerometer:
        found.append(("accelerometer.positions", p.accelerometer.positions))
        found.append(("accelerometer.recording", p.accelerometer.recording))
    if p.gyro:
        found += [("gyro.recording", p.gyro.recording), ("gyro.force", p.gyro.force)]
    if p.magnetometer:
        found.append(("magnetometer.readings", p.magnetometer.readings))
        for k, level in enumerate(p.magnetometer.level):
            found.append((f"magnetometer.level[{k + 1}]", level))
    found += [(f"still[{k + 1}]", s) for k, s in enumerate(p.still)]
    return [(where, spec) for where, spec in found if spec is not None]
