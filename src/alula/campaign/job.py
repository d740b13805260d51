"""The main job: from a project file to identified derivatives, stage by stage."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from alula.aircraft import Aircraft, control_sign_check, load_aircraft
from alula.base.messages import Message, note, refuse
from alula.base.project import Project, load_project
from alula.base.provenance import provenance
from alula.flight import Flight, Maneuver, Motion
from alula.identify import (
    CoefficientData,
    Identification,
    Reference,
    Thrust,
    coefficients_as_recorded,
    coefficients_from_motion,
    identify_equation_error,
)
from alula.logs.card import LogCard, log_card
from alula.logs.maneuvers import maneuvers
from alula.logs.reader import read_all
from alula.reconstruct import Reconstruction, Segment, reconstruct
from alula.reconstruct.recorded import recorded_motion
from alula.reconstruct.transfer import engines_on
from alula.report import ReportInput

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Checked:
    """A project's logs, read and looked through."""

    project: Project
    aircraft: Aircraft
    flights: Mapping[str, Flight]
    maneuvers: tuple[Maneuver, ...]
    cards: tuple[LogCard, ...]
    messages: tuple[Message, ...]  # beyond those of the cards

    def all_messages(self) -> tuple[Message, ...]:
        """Those of the logs and those of the project, each once."""
        return tuple(
            dict.fromkeys([m for card in self.cards for m in card.messages] + list(self.messages))
        )


@dataclass(frozen=True)
class Job:
    """A finished main job. seconds: by stage."""

    checked: Checked
    reconstruction: Reconstruction
    data: tuple[CoefficientData, ...]
    identification: Identification
    seconds: Mapping[str, float]

    def all_messages(self) -> tuple[Message, ...]:
        """The messages of every stage, each once, in the order in which they arose."""
        found = [
            *self.checked.all_messages(),
            *self.reconstruction.messages,
            *self.identification.messages,
        ]
        return tuple(dict.fromkeys(found))


def check_project(
    path: str, only: Sequence[str] = (), progress: Progress = lambda _: None
) -> Checked:
    """Read everything a project names and look through it. only: maneuver ids, all if empty.

    Raises BadInput, with every message there is, for what cannot be used.
    """
    project = load_project(path)
    _known(project, only)
    if project.aircraft is None:
        raise refuse(
            "missing_aircraft",
            where=f"{path}: aircraft",
            expected="the path of an aircraft file",
            found="none",
            do='Add aircraft = "my_aircraft.toml".',
        )
    aircraft = load_aircraft(project.aircraft)
    progress("reading logs")
    flights = read_all(project)
    found, said = maneuvers(project, flights)
    chosen = tuple(m for m in found if not only or m.id.split(".")[0] in only or m.id in only)
    messages = [*aircraft.messages, *said, *_signs(flights, chosen, aircraft)]
    cards = tuple(log_card(flight, found) for flight in flights.values())
    return Checked(project, aircraft, flights, chosen, cards, tuple(messages))


def run_project(
    path: str,
    *,
    filter: str | None = None,
    method: str | None = None,
    only: Sequence[str] = (),
    truth: Mapping[str, float] | None = None,
    progress: Progress = lambda _: None,
) -> Job:
    """The main job. filter, method: instead of the project's. truth: shown beside the estimates.

    Raises BadInput for what cannot be used.
    """
    clock = {"start": time.perf_counter()}
    checked = check_project(path, only, progress)
    project = checked.project
    clock["read"] = time.perf_counter()
    if not checked.maneuvers:
        raise refuse(
            "no_maneuver",
            where=f"{path}: maneuvers",
            expected="at least one maneuver",
            found="none",
            do="Add [[maneuvers]] with id, log, start and end; `alula check` shows the log.",
        )
    spec = project.reconstruct
    if filter is not None:
        spec = spec.model_copy(update={"filter": filter})
    progress("reconstructing the flight path")
    reconstruction = reconstruct(
        checked.flights, checked.maneuvers, checked.aircraft, spec, progress
    )
    clock["reconstruct"] = time.perf_counter()
    progress("identifying")
    identifier = IDENTIFIERS[_method(method or project.identify.method)]
    models = _models(project, checked.maneuvers)
    data: tuple[CoefficientData, ...] = ()
    identification = NOTHING_ASKED
    if models:
        data = coefficient_data(checked, reconstruction, shared=spec.share == "all")
        identification = identifier(data, models, project.identify.options, truth)
    clock["identify"] = time.perf_counter()
    stamps = list(clock.values())
    seconds = {name: b - a for name, a, b in zip(list(clock)[1:], stamps, stamps[1:], strict=False)}
    return Job(checked, reconstruction, data, identification, seconds)


def coefficient_data(
    checked: Checked, reconstruction: Reconstruction, shared: bool
) -> tuple[CoefficientData, ...]:
    """The coefficients of every reconstructed maneuver, by the project's choice of source."""
    aircraft = checked.aircraft
    reference = Reference(aircraft.S, aircraft.b, aircraft.c, aircraft.reference_point)
    recorded = checked.project.identify.coefficients_from == "recorded"
    return tuple(
        coefficients_as_recorded(segment.motion, reference)
        if recorded
        else _from_motion(
            segment, checked.flights[segment.maneuver.log], aircraft, reference, shared
        )
        for segment in reconstruction.segments
    )


def _from_motion(
    segment: Segment, flight: Flight, aircraft: Aircraft, reference: Reference, shared: bool
) -> CoefficientData:
    motion = segment.motion
    fuel = np.zeros(len(motion.t)) if motion.fuel_used is None else motion.fuel_used
    mass = aircraft.mass_properties(fuel)
    forces = engines_on(flight, aircraft, motion.t)
    return coefficients_from_motion(
        motion,
        reference,
        mass=mass.mass,
        cg=mass.cg,
        inertia=mass.inertia,
        thrust=[
            Thrust(e.position, e.direction, forces[e.name], e.thrust_se)
            for e in aircraft.engines
            if e.name in forces
        ],
        perturbed=segment.perturbed,
        shared=shared,
    )


def report_of(job: Job, date: str, seed: int | None) -> ReportInput:
    """What the report shows of a job."""
    checked = job.checked
    return ReportInput(
        name=checked.project.name,
        path=str(checked.project.path),
        date=date,
        aircraft=checked.aircraft.summary(),
        cards=checked.cards,
        maneuvers=checked.maneuvers,
        reconstruction=job.reconstruction,
        identification=job.identification,
        messages=checked.messages,
        provenance={
            **provenance(seed),
            "project": checked.project.sha256,
            "aircraft": checked.aircraft.sha256,
        },
    )


def _equation_error(
    data: Sequence[CoefficientData],
    models: Mapping[str, str],
    options: Mapping[str, Any],
    truth: Mapping[str, float] | None,
) -> Identification:
    known = {"weighting", "common_constant", "scales"}
    if options.keys() - known:
        raise refuse(
            "unknown_option",
            where="[identify.options]",
            expected="only " + ", ".join(sorted(known)),
            found=", ".join(sorted(options.keys() - known)),
            do="Take the entry out.",
        )
    return identify_equation_error(data, models, **options, truth=truth)


# One method: one file in identify/ and one entry here.
IDENTIFIERS: Mapping[
    str,
    Callable[
        [
            Sequence[CoefficientData],
            Mapping[str, str],
            Mapping[str, Any],
            Mapping[str, float] | None,
        ],
        Identification,
    ],
] = {"ee": _equation_error}


# A project without models wants the flight path only.
NOTHING_ASKED = Identification(
    method="none",
    parameters=(),
    fits={},
    series=(),
    covariance=np.zeros((0, 0)),
    status="no [identify.models] in the project: the flight path was reconstructed, no more",
)


def _method(name: str) -> str:
    if name in IDENTIFIERS:
        return name
    raise refuse(
        "unknown_method",
        where="identify.method",
        expected="one of " + ", ".join(IDENTIFIERS),
        found=f"'{name}'",
        do="Choose one of these.",
    )


def _models(project: Project, chosen: Sequence[Maneuver]) -> dict[str, str]:
    """The project's models, less those that none of the chosen maneuvers serves."""
    aspects = {m.aspect for m in chosen if not m.held_out}
    longitudinal = bool(aspects & {"longitudinal", "both"})
    lateral = bool(aspects & {"lateral", "both"})
    served = {
        name: formula
        for name, formula in project.identify.models.items()
        if (lateral if name in ("CY", "Cl", "Cn") else longitudinal)
    }
    return served or dict(project.identify.models)


def _known(project: Project, only: Sequence[str]) -> None:
    known = [m.id for m in project.maneuvers]
    for id in only:
        if id.split(".")[0] not in known and id not in known:
            raise refuse(
                "unknown_maneuver",
                where="--maneuver",
                expected="one of " + ", ".join(known),
                found=f"'{id}'",
                do="Name a maneuver of the project file.",
            )


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
