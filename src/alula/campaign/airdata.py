"""A project's air data: calibrated by each log; every source of the flow angles side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from alula.aircraft import Aircraft, load_aircraft
from alula.airdata.inflight import calibrate_in_flight
from alula.airdata.inflight_record import record_of
from alula.airdata.inflight_result import InFlightCalibration
from alula.base.messages import BadInput, Message, refuse, warn
from alula.base.project import LogSpec, Project, load_project
from alula.campaign.angle_board import arm_of
from alula.campaign.angles import Angles, angles_of
from alula.campaign.check import Progress, taken_names
from alula.flight import Flight, SourceFile
from alula.logs.own_channels import own_channels
from alula.logs.reader import read
from alula.model import load_model

_ARMS = {"V": "V", "alpha": "alpha", "beta": "beta", "gps": "v_north", "imu": "ax"}


@dataclass(frozen=True)
class AirDataJob:
    """What was found, by log. calibrated: of logs that have what it takes; refused: why a log has
    not. angles: where asked.
    """

    project: Project
    logs: tuple[str, ...]
    calibrated: Mapping[str, InFlightCalibration]
    refused: Mapping[str, Message]
    angles: Mapping[str, Angles]
    files: tuple[SourceFile, ...]
    messages: tuple[Message, ...]

    @property
    def determined(self) -> bool:
        """Whether every sought parameter of every calibration is."""
        return all(one.determined for one in self.calibrated.values())

    @property
    def failed(self) -> bool:
        """Whether a source of an angle was voted out."""
        return any(one.failed for one in self.angles.values())

    def as_dict(self) -> dict[str, Any]:
        """As the envelope carries it."""
        logs = []
        for id in self.logs:
            one: dict[str, Any] = {"id": id, "parameters": []}
            if id in self.calibrated:
                one |= self.calibrated[id].as_dict()
            if id in self.angles:
                one["angles"] = self.angles[id].as_dict()
            logs.append(one)
        return {"logs": logs}

    def summary(self) -> str:
        """As text."""
        lines: list[str] = []
        for id in self.logs:
            lines += [""] if lines else []
            if id in self.calibrated:
                one = self.calibrated[id]
                lines.append(f"Log {id}: reading = (1 + k) truth + b\n{one.summary()}")
                if not one.rich:
                    lines.append("Not rich enough: airspeed error and wind are not told apart.")
            if id in self.angles:
                lines.append(f"Log {id}: angles at the center of gravity, deg")
                lines += [c.summary() for c in self.angles[id].compared.values()]
        return "\n".join(lines)


def run_air_data(
    path: str,
    *,
    logs: Sequence[str] = (),
    start: float | None = None,
    end: float | None = None,
    angles: bool = False,
    model: Path | None = None,
    progress: Progress = lambda _: None,
) -> AirDataJob:
    """Calibrate by each log of a project, or those named, and compare the angles if asked for.

    model: an aerodynamic model's file, whose lift is a source of the angle of attack. Raises
    BadInput for what cannot be used; with `angles` a log that cannot be calibrated is only warned
    of.
    """
    project = load_project(path)
    known = [one.id for one in project.logs]
    unknown = [id for id in logs if id not in known]
    if unknown:
        raise refuse(
            "unknown_log",
            where="alula airdata --log",
            expected=f"one of {', '.join(known)}",
            found=", ".join(unknown),
            do="Name a log of this project.",
        )
    aero = None if model is None else load_model(model)
    calibrated, refused, compared = {}, {}, {}
    files: list[SourceFile] = []
    flown: dict[str, Aircraft] = {}
    said: list[Message] = []
    chosen = [spec for spec in project.logs if not logs or spec.id in logs]
    for spec in chosen:
        progress(f"reading {spec.id}")
        flight = read(spec, project.channels_of(spec))
        files += flight.files
        said += flight.messages
        aircraft = _aircraft(project, spec)
        if aircraft is not None:
            flown[spec.id] = aircraft
        progress(f"calibrating by {spec.id}")
        try:
            calibrated[spec.id] = _calibrated(flight, aircraft, start, end)
            said += calibrated[spec.id].messages
        except BadInput as error:
            if not angles:
                raise
            first = error.messages[0]
            refused[spec.id] = warn(
                "not_calibrated", where=first.where, expected=first.expected, found=first.found,
                do=f"The angles are shown uncalibrated. {first.do}",
            )  # fmt: skip
            said.append(refused[spec.id])
        if angles:
            progress(f"comparing angles of {spec.id}")
            compared[spec.id] = angles_of(
                project, aircraft, flight, calibrated.get(spec.id), aero, start, end
            )
            said += compared[spec.id].messages
    own = own_channels(project, taken_names(project, list(flown.values())))
    return AirDataJob(
        project, tuple(spec.id for spec in chosen), calibrated, refused, compared, tuple(files),
        tuple(dict.fromkeys([*own, *said])),
    )  # fmt: skip


def vane_arms(aircraft: Aircraft | None) -> dict[str, tuple[float, float, float]]:
    """Where the sensors sit from the center of gravity, m, as `record_of` takes it."""
    arms = {}
    for name, channel in _ARMS.items():
        x, y, z = (float(k) for k in arm_of(aircraft, channel))
        if x or y or z:
            arms[name] = (x, y, z)
    return arms


def _calibrated(
    flight: Flight, aircraft: Aircraft | None, start: float | None, end: float | None
) -> InFlightCalibration:
    return calibrate_in_flight(record_of(flight, start, end, arms=vane_arms(aircraft)))


def _aircraft(project: Project, log: LogSpec) -> Aircraft | None:
    path = log.aircraft or project.aircraft
    return None if path is None else load_aircraft(path)
