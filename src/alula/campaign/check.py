"""A project's logs, read and looked through before anything is estimated."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft import Aircraft, control_sign_check, load_aircraft
from alula.base.messages import BadInput, Message, note, refuse
from alula.base.project import Project, load_project
from alula.campaign.envelope import outside_envelope
from alula.campaign.named import named
from alula.flight import Flight, Maneuver, Motion, SourceFile
from alula.logs.card import LogCard, log_card
from alula.logs.maneuvers import maneuvers
from alula.logs.own_channels import own_channels
from alula.logs.reader import read_all
from alula.model.formula_problems import formula_problems
from alula.reconstruct.recorded import recorded_motion

Progress = Callable[[str], None]

# Codes of warnings after which a result would be wrong, not only less certain.
CONTRADICTIONS = ("control_sign", "sign_contradiction")
_WORD = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class Checked:
    """A project's logs, read and looked through."""

    project: Project
    aircraft: Aircraft
    flights: Mapping[str, Flight]
    maneuvers: tuple[Maneuver, ...]
    cards: tuple[LogCard, ...]
    messages: tuple[Message, ...]  # beyond those of the cards
    loaded: Mapping[str, Aircraft] = field(default_factory=dict)  # logs that state their own

    def aircraft_of(self, log: str) -> Aircraft:
        """The aircraft as it was loaded in the log of that id."""
        return self.loaded.get(log, self.aircraft)

    @property
    def files(self) -> tuple[SourceFile, ...]:
        """What was read, log by log."""
        return tuple(f for card in self.cards for f in card.files)

    @property
    def failed(self) -> bool:
        """Whether the recordings contradict each other or the aircraft file."""
        return any(m.code in CONTRADICTIONS for m in self.all_messages())

    def all_messages(self) -> tuple[Message, ...]:
        """Those of the logs and those of the project, each once."""
        return tuple(
            dict.fromkeys([m for card in self.cards for m in card.messages] + list(self.messages))
        )


def check_project(
    path: str,
    only: Sequence[str] = (),
    progress: Progress = lambda _: None,
    logs: Sequence[str] = (),
) -> Checked:
    """Read everything a project names and look through it. only: maneuver ids, all if empty.

    logs: ids; the others are not read, and their maneuvers are none of the result's; all if empty.
    Raises BadInput, with every message there is, for what cannot be used.
    """
    project = load_project(path)
    if project.aircraft is None:
        raise refuse(
            "missing_aircraft",
            where=f"{path}: aircraft",
            expected="the path of an aircraft file",
            found="none",
            do='Add aircraft = "my_aircraft.toml".',
        )
    aircraft = _aircraft(project.aircraft, f"{path}: aircraft")
    loaded = _loaded(project, aircraft)
    wrong = formula_problems(project.identify.models, f"{project.path}: identify.models")
    if wrong:
        raise BadInput(*wrong)
    if logs:
        project = _narrowed(project, logs)
    progress("reading logs")
    flights = read_all(project)
    found, said = maneuvers(project, flights)
    chosen = named(project, found, only)
    messages = own_channels(project, taken_names(project, [aircraft, *loaded.values()]))
    messages += [*aircraft.messages, *said, *_signs(flights, chosen, aircraft)]
    messages += [m for other in loaded.values() for m in other.messages]
    for log in project.logs:
        flown = [m for m in chosen if m.log == log.id]
        plane = loaded.get(log.id, aircraft)
        messages += outside_envelope(flights[log.id], flown, plane, project.channels_of(log))
    cards = tuple(log_card(flight, found) for flight in flights.values())
    return Checked(project, aircraft, flights, chosen, cards, tuple(messages), loaded)


def taken_names(project: Project, aircraft: Sequence[Aircraft]) -> set[str]:
    """Names that engines, sensors, controls, formulas and options of the methods take."""
    found = {word for text in project.identify.models.values() for word in _WORD.findall(text)}
    found |= set(_WORD.findall(repr(project.identify.options)))
    found |= {*project.reconstruct.sensors, *project.navigate.sensors}
    for one in aircraft:
        found |= {e.channel for e in one.engines if e.channel} | {*one.sensors, *one.control_signs}
    return found


def _narrowed(project: Project, logs: Sequence[str]) -> Project:
    """The project with these logs alone."""
    known = [log.id for log in project.logs]
    for name in logs:
        if name not in known:
            raise refuse(
                "unknown_log",
                where="--log",
                expected="one of " + ", ".join(known),
                found=f"'{name}'",
                do="Name a log of the project file.",
            )
    kept = {
        "logs": [log for log in project.logs if log.id in logs],
        "maneuvers": [m for m in project.maneuvers if m.log in logs],
    }
    return project.model_copy(update=kept)


def _aircraft(file: Path, where: str) -> Aircraft:
    if not file.exists():
        raise refuse(
            "missing_aircraft",
            where=where,
            expected="the path of an aircraft file, from the project's folder",
            found=f"no file {file}",
            do="Name a ready one or write one; docs/aircraft_file.md shows how.",
        )
    return load_aircraft(file)


def _loaded(project: Project, aircraft: Aircraft) -> dict[str, Aircraft]:
    """The aircraft of the logs that name their own; it may differ in mass and thrust alone."""
    files: dict[Path, Aircraft] = {}
    out = {}
    for i, log in enumerate(project.logs):
        if log.aircraft is None:
            continue
        where = f"{project.path}: logs[{i + 1}].aircraft"
        if log.aircraft not in files:
            files[log.aircraft] = _aircraft(log.aircraft, where)
        other = out[log.id] = files[log.aircraft]
        differs = [
            key
            for key, same in (
                ("reference", (other.S, other.b, other.c) == (aircraft.S, aircraft.b, aircraft.c)),
                ("reference.point", np.allclose(other.reference_point, aircraft.reference_point)),
                ("sensors", _positions(other) == _positions(aircraft)),
                ("controls", other.control_signs == aircraft.control_signs),
            )
            if not same
        ]
        if differs:
            raise refuse(
                "another_aircraft",
                where=where,
                expected="the project's aircraft, differing in mass only",
                found=f"other values of {', '.join(differs)}",
                do="Derivatives are shared by one aircraft: make another project, or state "
                "reference.point where the center of gravity differs.",
            )
    return out


def _positions(aircraft: Aircraft) -> dict[str, list[float]]:
    return {name: position.tolist() for name, position in aircraft.sensors.items()}


def _signs(
    flights: Mapping[str, Flight], chosen: Sequence[Maneuver], aircraft: Aircraft
) -> list[Message]:
    """Control senses: what was turned round, and what contradicts the motion."""
    out = [
        note(
            "control_turned",
            where=f"channel {name}",
            expected="Alula's sense: a positive deflection gives a negative moment",
            found="the opposite one, by the aircraft file's sign",
            do="Nothing: the channel is multiplied by -1.",
        )
        for name, sign in aircraft.control_signs.items()
        if sign < 0 and any(name in f for f in flights.values())
    ]
    for maneuver in chosen:
        flight = flights[maneuver.log]
        if "V" not in flight or "alpha" not in flight:
            continue
        motion, _ = recorded_motion(flight, maneuver, aircraft, 0.0)
        if len(motion.t) < 20:
            continue
        for message in control_sign_check(_plain(motion), motion.dt):
            out.append(replace(message, where=f"maneuver {maneuver.id}, {message.where}"))
    return out


def _plain(motion: Motion) -> dict[str, Any]:
    names = ("alpha", "beta", "p", "q", "r", "pdot", "qdot", "rdot")
    return {**{n: getattr(motion, n) for n in names}, **motion.controls}
