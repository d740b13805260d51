"""All sources of angle of attack and sideslip of one log beside one another, and their vote."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from alula.aircraft import Aircraft
from alula.airdata.angles import AngleSource, Compared, Kind, compare_angles
from alula.airdata.inflight_result import InFlightCalibration
from alula.base.arrays import frozen
from alula.base.messages import BadInput, Message, note, refuse, warn
from alula.base.project import Project
from alula.campaign.angle_board import board_of
from alula.campaign.angle_sources import (
    asse,
    asse_sources,
    joint_sources,
    lift_source,
    recorded,
    zero_order_sources,
)
from alula.flight import Flight
from alula.model import AeroModel

KINDS: tuple[Kind, ...] = ("alpha", "beta")
RECORDED, ASSE, PRINTED, JOINT, LIFT = (
    "recorded", "ASSE", "ASSE, zero order", "joint filter", "lift model",
)  # fmt: skip


@dataclass(frozen=True)
class Angles:
    """compared: by angle. messages: what was noticed, absent sources and failures among it."""

    compared: Mapping[Kind, Compared]
    messages: tuple[Message, ...]

    @property
    def failed(self) -> bool:
        """Whether a source was voted out."""
        return any(c.named for c in self.compared.values())

    def as_dict(self) -> dict[str, Any]:
        """As the envelope carries it."""
        return {kind: c.as_dict() for kind, c in self.compared.items()}


def angles_of(
    project: Project,
    aircraft: Aircraft | None,
    flight: Flight,
    calibration: InFlightCalibration | None = None,
    model: AeroModel | None = None,
    start: float | None = None,
    end: float | None = None,
) -> Angles:
    """Every source that the log has what it takes for; why the others are not there.

    calibration: of the recorded channels; model: with a lift. Raises BadInput where the log has
    neither flow angles nor inertial sensors.
    """
    flight, said = _speed(flight, calibration)
    board = board_of(project, aircraft, flight, start, end)
    sources: dict[Kind, dict[str, AngleSource]] = {"alpha": {}, "beta": {}}
    absent: dict[Kind, dict[str, str]] = {"alpha": {}, "beta": {}}

    def missing(name: str, error: BadInput, kinds: tuple[Kind, ...] = KINDS) -> None:
        first = error.messages[0]
        for kind in kinds:
            absent[kind][name] = first.found
        severe = warn if name == LIFT else note
        said.append(
            severe("source_absent", where=first.where, expected=first.expected,
                   found=first.found, do=first.do)
        )  # fmt: skip

    for kind in KINDS:
        names = board.sensors(kind, "beta_flank") if kind == "beta" else board.sensors(kind)
        for k, channel in enumerate(names):
            name = RECORDED if k == 0 else f"{RECORDED} {channel}"
            sources[kind][name] = recorded(board, kind, channel, calibration)
        if not names:
            absent[kind][RECORDED] = f"no {kind}"
    try:
        made = asse(board)
    except BadInput as error:
        missing(ASSE, error)
    else:
        said += made.result.messages
        for kind, one in asse_sources(board, made).items():
            sources[kind][ASSE] = one
        try:
            for kind, one in zero_order_sources(board, made).items():
                sources[kind][PRINTED] = one
        except BadInput as error:
            missing(PRINTED, error)
    try:
        joint, noticed = joint_sources(board)
        said += noticed
        for kind, one in joint.items():
            sources[kind][JOINT] = one
    except BadInput as error:
        missing(JOINT, error)
    if model is None:
        absent["alpha"][LIFT] = "no model given (--model)"
    else:
        try:
            sources["alpha"][LIFT], noticed = lift_source(board, model)
            said += noticed
        except BadInput as error:
            missing(LIFT, error, ("alpha",))
    if not any(sources.values()):
        raise refuse(
            "no_angles",
            where=f"log {flight.id}",
            expected="a recorded angle, or what ASSE, joint filter or lift model take",
            found="; ".join(f"{name}: {why}" for name, why in absent["alpha"].items()),
            do="Map alpha or beta in [channels], or inertial sensors, attitude and V.",
        )
    compared = {k: compare_angles(k, board.t, sources[k], absent[k]) for k in KINDS}
    for kind, result in compared.items():
        said += [
            warn(
                f"source_{n.reason}",
                where=f"log {flight.id}, {kind}, {n.source}",
                expected="a source that agrees with the others",
                found=f"{n.reason} at {n.t:.6g} s",
                do="It has no vote until it agrees again; look at its sensors there.",
            )
            for n in result.named
        ]
    return Angles(compared, tuple(dict.fromkeys(said)))


def _speed(flight: Flight, calibration: InFlightCalibration | None) -> tuple[Flight, list[Message]]:
    """The flight with its airspeed corrected where the calibration determined its scale."""
    if calibration is None or "V" not in flight or not calibration.rich:
        return flight, []
    channel, scale = flight["V"], calibration["k_V"].value
    values = frozen(calibration.corrected({"V": channel.values})["V"])
    source = f"{channel.source}; calibrated in flight"
    channels = {**flight.channels, "V": replace(channel, values=values, source=source)}
    said = note(
        "speed_calibrated",
        where=f"log {flight.id}, V",
        expected="airspeed as recorded",
        found=f"a scale error of {100.0 * scale:.2f} %, by this flight",
        do="ASSE, joint filter and lift model take the corrected one.",
    )
    return replace(flight, channels=channels), [said]
