"""A project's maneuvers flown through a model: the one it identifies, or one from a file."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from alula.base.messages import Message, note, refuse
from alula.campaign.check import Checked, Progress, check_project
from alula.campaign.hold_out import with_held_out
from alula.campaign.job import (
    NOTHING_ASKED,
    Job,
    coefficient_data,
    identify_project,
    report_of,
    served_models,
    task_of,
)
from alula.campaign.learned import LEARNED, learned_from
from alula.campaign.measured import measured_maneuvers
from alula.campaign.methods import identify_by, takes_readings
from alula.campaign.named import named
from alula.campaign.validation_case import case_of, unequal_thrust
from alula.flight import Maneuver
from alula.identify import CoefficientData, Identification, identified_model
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.model import AeroModel, Reference, load_model
from alula.reconstruct import Reconstruction, reconstruct
from alula.report import ReportInput
from alula.validate import Reidentified, Validation, reidentify, validate
from alula.validate.validate import DRAWS, Trim


@dataclass(frozen=True)
class ValidationJob:
    """A finished validation. job: what led to it; its identification is empty for a model file."""

    job: Job
    model: AeroModel
    model_sha256: str
    validation: Validation
    reidentified: tuple[Reidentified, ...] = ()

    def all_messages(self) -> tuple[Message, ...]:
        """The messages of every stage, each once."""
        return tuple(dict.fromkeys([*self.job.all_messages(), *self.validation.messages]))


def run_validation(
    path: str,
    *,
    model: Path | None = None,
    only: Sequence[str] = (),
    filter: str | None = None,
    trim: Trim = "none",
    horizon: float | None = None,
    draws: int = DRAWS,
    reidentified: int = 0,
    seed: int | None = None,
    progress: Progress = lambda _: None,
) -> ValidationJob:
    """Validate by flying. model: a file; None identifies the project's own.

    only: maneuvers to fly; where the model is identified here they are held out of the estimate.
    Without it those held out are flown, and where none is, all, labeled as seen. reidentified: how
    often flights of the model identified here are identified again; 0: not. Raises
    BadInput for what cannot be used.
    """
    given = None if model is None else load_model(model)
    if reidentified and given is not None:
        raise refuse(
            "usage",
            where="--reidentify",
            expected="a model that is identified here",
            found=f"--model {model}",
            do="Leave --model out: a file does not say how it was identified.",
        )
    stamps = [time.perf_counter()]
    checked = check_project(path, (), progress)
    if only:
        asked = {m.id for m in named(checked.project, checked.maneuvers, only)}
        marked = (replace(m, held_out=True) if m.id in asked else m for m in checked.maneuvers)
        checked = replace(checked, maneuvers=tuple(marked))
    elif given is None:  # a file's model is flown on all: each window says whether it saw it
        checked = with_held_out(checked, seed or 0)
    chosen = named(checked.project, checked.maneuvers, only)
    if not only:
        chosen = tuple(m for m in chosen if m.held_out) or chosen
    stamps.append(time.perf_counter())
    project = checked.project
    spec = project.reconstruct
    if filter is not None:
        spec = spec.model_copy(update={"filter": filter})
    if given is not None:  # what is not flown serves nothing
        checked = replace(checked, maneuvers=chosen)
    progress("reconstructing the flight path")
    reconstruction = reconstruct(
        checked.flights, checked.maneuvers, checked.aircraft, spec, progress, checked.loaded
    )
    stamps.append(time.perf_counter())
    data = coefficient_data(checked, reconstruction, shared=spec.share == "all")
    identification, messages = NOTHING_ASKED, tuple(_shared(spec.share, spec.filter, chosen))
    if given is None:
        progress("identifying")
        models, said = served_models(project, checked.maneuvers)
        messages += said
        identification = identify_project(
            checked, reconstruction, data, models, project.identify.method, seed=seed or 0
        )
        learned = [d for d in data if not d.maneuver.held_out]
        given = identified_model(
            identification,
            project.name,
            Reference(checked.aircraft.S, checked.aircraft.b, checked.aircraft.c),
            data=learned,
            reference_point=checked.aircraft.reference_point,
            provenance={LEARNED: learned_from(learned, checked.flights)},
        )
        source = "identified here from " + ", ".join(d.maneuver.id for d in learned)
        sha256 = ""
    else:
        assert model is not None
        source, sha256 = str(model), hashlib.sha256(model.read_bytes()).hexdigest()
        messages += tuple(_reference(given, checked, str(model)))
    stamps.append(time.perf_counter())
    ids = {m.id for m in chosen}
    cases = [
        case_of(checked, segment, item, given)
        for segment, item in zip(reconstruction.segments, data, strict=True)
        if segment.maneuver.id in ids
    ]
    messages += tuple(
        m
        for s in reconstruction.segments
        if s.maneuver.id in ids
        for m in unequal_thrust(checked, s)
    )
    result = validate(
        given,
        cases,
        gravity=spec.gravity,
        trim=trim,
        horizon=horizon,
        draws=draws,
        seed=0 if seed is None else seed,
        source=source,
        progress=progress,
    )
    repeated: tuple[Reidentified, ...] = ()
    if reidentified:
        repeated, said = _repeated(
            checked, reconstruction, data, identification, given, reidentified, seed or 0, progress
        )
        messages += said
    stamps.append(time.perf_counter())
    stages = ("read", "reconstruct", "identify", "fly")
    seconds = dict(zip(stages, np.diff(stamps).tolist(), strict=True))
    job = Job(checked, reconstruction, data, identification, seconds, messages)
    return ValidationJob(job, given, sha256, result, repeated)


def report_of_validation(done: ValidationJob, date: str, seed: int | None) -> ReportInput:
    """What the report shows of a validation."""
    base = report_of(done.job, date, seed)
    return replace(
        base,
        identification=base.identification if done.job.identification.parameters else None,
        validation=done.validation,
        reidentified=done.reidentified,
        provenance={
            **base.provenance,
            "model": done.validation.source,
            **({"model_sha256": done.model_sha256} if done.model_sha256 else {}),
            "model_origin": done.model.provenance,
        },
    )


def _repeated(
    checked: Checked,
    reconstruction: Reconstruction,
    data: tuple[CoefficientData, ...],
    result: Identification,
    model: AeroModel,
    draws: int,
    seed: int,
    progress: Progress,
) -> tuple[tuple[Reidentified, ...], tuple[Message, ...]]:
    """Flights of the model, identified again by the project's own method."""
    method = checked.project.identify.method
    learned = [(s, d) for s, d in zip(reconstruction.segments, data, strict=True)
               if not d.maneuver.held_out]  # fmt: skip
    ids = {d.maneuver.id for _, d in learned}
    readings: tuple[MeasuredManeuver, ...] = ()
    if takes_readings(method, checked.project.identify.options):
        every, _, _ = measured_maneuvers(checked, reconstruction)
        readings = tuple(m for m in every if m.maneuver.id in ids)

    def identify(
        other: Sequence[CoefficientData], read: Sequence[MeasuredManeuver]
    ) -> Identification:
        models = result.formulas or {c: fit.formula for c, fit in result.fits.items()}
        task = task_of(checked, tuple(other), lambda: (tuple(read), (), []), models, seed=seed)
        return identify_by(method, task)

    return reidentify(
        model,
        result,
        [case_of(checked, s, d, model) for s, d in learned],
        [d for _, d in learned],
        readings,
        identify,
        gravity=checked.project.reconstruct.gravity,
        draws=draws,
        seed=seed,
        progress=progress,
    )


def _shared(share: str, filter: str, chosen: Sequence[Maneuver]) -> list[Message]:
    """Sensor constants are estimated from validation maneuvers too; that is said."""
    if share == "maneuver" or filter == "none":
        return []
    return [
        note(
            "sensor_constants_shared",
            where="maneuvers " + ", ".join(m.id for m in chosen),
            expected="nothing of the validation in the estimate",
            found=f"reconstruct.share = '{share}': sensor biases and wind come from these "
            "maneuvers too",
            do="The aerodynamic model saw none of the maneuvers held out; to part the sensors' "
            "constants as well, write share = 'maneuver'.",
        )
    ]


def _reference(model: AeroModel, checked: Checked, path: str) -> list[Message]:
    """Refuses a model of another reference geometry than the aircraft's: another aircraft."""
    a, r = checked.aircraft, model.reference
    if not np.allclose([r.S, r.b, r.c], [a.S, a.b, a.c], rtol=1e-3):
        raise refuse(
            "other_reference",
            where=path,
            expected=f"the aircraft's S {a.S:g} m2, b {a.b:g} m, c {a.c:g} m",
            found=f"S {r.S:g} m2, b {r.b:g} m, c {r.c:g} m",
            do="Take the model of this aircraft, or correct the reference geometry.",
        )
    return []
