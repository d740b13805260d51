"""The main job: from a project file to identified derivatives, stage by stage."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft import Aircraft
from alula.base.messages import Message, note, refuse
from alula.base.project import Project
from alula.base.provenance import provenance
from alula.campaign.check import Checked, Progress, check_project
from alula.campaign.hold_out import with_held_out
from alula.campaign.identify_task import IdentifyTask, Measured
from alula.campaign.measured import engines_of, measured_maneuvers
from alula.campaign.methods import IDENTIFIERS, identify_by, method_name
from alula.campaign.prior_model import with_named_priors
from alula.flight import Flight, Maneuver
from alula.identify import (
    CoefficientData,
    Identification,
    Reference,
    coefficients_as_recorded,
    coefficients_from_motion,
)
from alula.identify.equation_error.task import LONGITUDINAL
from alula.reconstruct import Reconstruction, Segment, reconstruct
from alula.report import ReportInput

__all__ = ["IDENTIFIERS", "Job", "identify_project", "report_of", "run_project"]


@dataclass(frozen=True)
class Job:
    """A finished main job. seconds: by stage."""

    checked: Checked
    reconstruction: Reconstruction
    data: tuple[CoefficientData, ...]
    identification: Identification
    seconds: Mapping[str, float]
    messages: tuple[Message, ...] = ()  # beyond those of the stages

    def all_messages(self) -> tuple[Message, ...]:
        """The messages of every stage, each once, in the order in which they arose."""
        found = [
            *self.checked.all_messages(),
            *self.reconstruction.messages,
            *self.identification.messages,
            *self.messages,
        ]
        return tuple(dict.fromkeys(found))


def run_project(
    path: str,
    *,
    filter: str | None = None,
    method: str | None = None,
    only: Sequence[str] = (),
    truth: Mapping[str, float] | None = None,
    seed: int | None = None,
    progress: Progress = lambda _: None,
) -> Job:
    """The main job. filter, method: instead of the project's. truth: shown beside the estimates.
    seed: of what is random: the maneuvers held out, the draws of a bootstrap.

    Raises BadInput for what cannot be used.
    """
    stamps = [time.perf_counter()]
    checked = with_held_out(check_project(path, only, progress), seed or 0)
    project = checked.project
    chosen = method_name(method or project.identify.method)
    stamps.append(time.perf_counter())
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
        checked.flights, checked.maneuvers, checked.aircraft, spec, progress, checked.loaded
    )
    stamps.append(time.perf_counter())
    progress("identifying")
    models, messages = served_models(project, checked.maneuvers)
    data: tuple[CoefficientData, ...] = ()
    identification = NOTHING_ASKED
    if models:
        data = coefficient_data(checked, reconstruction, shared=spec.share == "all")
        identification = identify_project(
            checked, reconstruction, data, models, chosen, truth, seed or 0
        )
    stamps.append(time.perf_counter())
    stages = ("read", "reconstruct", "identify")
    seconds = {name: b - a for name, (a, b) in zip(stages, pairwise(stamps), strict=True)}
    return Job(checked, reconstruction, data, identification, seconds, messages)


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
            segment,
            checked.flights[segment.maneuver.log],
            checked.aircraft_of(segment.maneuver.log),
            reference,
            shared,
        )
        for segment in reconstruction.segments
    )


def _from_motion(
    segment: Segment, flight: Flight, aircraft: Aircraft, reference: Reference, shared: bool
) -> CoefficientData:
    motion = segment.motion
    fuel = np.zeros(len(motion.t)) if motion.fuel_used is None else motion.fuel_used
    mass = aircraft.mass_properties(fuel)
    return coefficients_from_motion(
        motion,
        reference,
        mass=mass.mass,
        cg=mass.cg,
        inertia=mass.inertia,
        thrust=engines_of(flight, aircraft, motion),
        perturbed=segment.perturbed,
        shared=shared,
    )


def identify_project(
    checked: Checked,
    reconstruction: Reconstruction,
    data: tuple[CoefficientData, ...],
    models: Mapping[str, str],
    method: str,
    truth: Mapping[str, float] | None = None,
    seed: int = 0,
) -> Identification:
    """The models identified from reconstructed maneuvers by the method of that name."""
    measure = partial(measured_maneuvers, checked, reconstruction)
    found = identify_by(method, task_of(checked, data, measure, models, truth, seed))
    return replace(found, messages=(*_options(checked, models)[1], *found.messages))


def _options(checked: Checked, models: Mapping[str, str]) -> tuple[dict[str, Any], list[Message]]:
    """[identify.options], with the priors of a model's file where one is named."""
    project = checked.project
    return with_named_priors(
        project.identify.options, Path(project.path).parent, checked.aircraft, models
    )


def task_of(
    checked: Checked,
    data: tuple[CoefficientData, ...],
    measure: Callable[[], Measured],
    models: Mapping[str, str],
    truth: Mapping[str, float] | None = None,
    seed: int = 0,
) -> IdentifyTask:
    """What a method of identification may ask of a project."""
    base = checked.aircraft
    return IdentifyTask(
        data=data,
        measure=measure,
        models=models,
        reference=Reference(base.S, base.b, base.c, base.reference_point),
        options=_options(checked, models)[0],
        truth=truth,
        seed=seed,
    )


def report_of(job: Job, date: str, seed: int | None) -> ReportInput:
    """What the report shows of a job."""
    checked = job.checked
    return ReportInput(
        name=checked.project.name,
        path=str(checked.project.path),
        date=date,
        aircraft=checked.aircraft.summary(),
        shape=checked.aircraft,
        cards=checked.cards,
        maneuvers=checked.maneuvers,
        reconstruction=job.reconstruction,
        identification=job.identification,
        messages=(*checked.messages, *job.messages),
        provenance={
            **provenance(seed),
            "project": checked.project.sha256,
            "aircraft": checked.aircraft.sha256,
        },
    )


# A project without models wants the flight path only.
NOTHING_ASKED = Identification(
    method="none",
    parameters=(),
    fits={},
    series=(),
    covariance=np.zeros((0, 0)),
    status="no [identify.models] in the project: the flight path was reconstructed, no more",
)


def served_models(
    project: Project, chosen: Sequence[Maneuver]
) -> tuple[dict[str, str], tuple[Message, ...]]:
    """The project's models, less those that none of the chosen maneuvers serves; these are said."""
    aspects = {m.aspect for m in chosen if not m.held_out}
    asked = project.identify.models
    served = {
        name: formula
        for name, formula in asked.items()
        if aspects & {"both", "longitudinal" if name in LONGITUDINAL else "lateral"}
    }
    if not served or len(served) == len(asked):  # with none, the identification refuses
        return dict(asked), ()
    left = [name for name in asked if name not in served]
    said = note(
        "model_not_served",
        where="[identify.models]",
        expected="a maneuver to learn from for every model",
        found=f"none for {', '.join(left)} among {', '.join(m.id for m in chosen)}",
        do="Nothing: these are left out. Add a maneuver of their aspect to identify them.",
    )
    return served, (said,)
