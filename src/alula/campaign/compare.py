"""`alula compare`: sources of derivatives side by side, judged on a project's maneuvers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn
from alula.campaign.check import Progress, check_project
from alula.campaign.hold_out import with_held_out
from alula.campaign.job import coefficient_data
from alula.campaign.predict import Asked
from alula.campaign.results import SOURCES, Source, named, read_sources
from alula.campaign.sources.alike import alike
from alula.campaign.sources.convert import convert
from alula.flight import Maneuver, SourceFile
from alula.identify import CoefficientData, Series
from alula.identify.compare import Row, compare
from alula.identify.equation_error.quality import r_squared
from alula.identify.equation_error.task import LONGITUDINAL, MOMENTS
from alula.reconstruct import reconstruct


@dataclass(frozen=True)
class Judged:
    """How one column predicts one coefficient on the maneuvers judged by."""

    r2: float
    rrmse: float


@dataclass(frozen=True)
class Comparison:
    """rows: by parameter. judged: by coefficient, one per column, None where it has no model.

    maneuvers: judged on; seen: by id, one word per column. files: what was read.
    """

    sources: tuple[Source, ...]
    rows: tuple[Row, ...]
    judged: Mapping[str, tuple[Judged | None, ...]]
    samples: Mapping[str, int]
    maneuvers: tuple[Maneuver, ...]
    seen: Mapping[str, tuple[str, ...]]
    files: tuple[SourceFile, ...]
    messages: tuple[Message, ...]


def run_comparison(
    paths: Sequence[Path],
    *,
    project: str | None = None,
    methods: Sequence[str] = (),
    asked: Asked | None = None,
    alpha: float | None = None,
    origin: Array | None = None,
    seed: int | None = None,
    progress: Progress = lambda _: None,
) -> Comparison:
    """Compare sources with the first. project: judges each on its held-out maneuvers.

    methods, asked: how aircraft files are predicted. alpha: rad, where Datcom's table is read and
    for sources that state no angle. origin: (3,) m, of AVL's and Datcom's axes from the datum.
    Raises BadInput for fewer than two sources and for files that are none.
    """
    sources = named([s for path in paths for s in read_sources(path, methods, asked, alpha)])
    if len(sources) < 2:
        raise refuse(
            "too_few_results",
            where="alula compare",
            expected="two sources or more",
            found=str(len(sources)),
            do=f"Name {SOURCES}.",
        )
    columns, converted = convert(
        [s.column for s in sources], [s.frame for s in sources], [s.stated for s in sources],
        alpha=alpha, origin=origin,
    )  # fmt: skip
    columns, unlike = alike(columns)
    sources = tuple(replace(s, column=c) for s, c in zip(sources, columns, strict=True))
    rows = compare(columns)
    files = list(dict.fromkeys(s.file for s in sources))
    at_first = [*converted, *unlike]
    if project is None:
        return Comparison(sources, rows, {}, {}, (), {}, tuple(files), tuple(at_first))
    checked = with_held_out(check_project(project, (), progress), seed or 0)
    progress("reconstructing the flight path")
    spec = checked.project.reconstruct
    path = reconstruct(
        checked.flights, checked.maneuvers, checked.aircraft, spec, progress, checked.loaded
    )
    data = coefficient_data(checked, path, shared=spec.share == "all")
    chosen = [d for d in data if d.maneuver.held_out]
    said = [*at_first, *checked.all_messages(), *path.messages]
    if not chosen:
        chosen = list(data)
        said.append(
            warn(
                "no_held_out_maneuver",
                where=project,
                expected="maneuvers that are held out",
                found="none; all maneuvers are judged by",
                do="Mark some with held_out = true: on maneuvers that a result learned from it "
                "shows its fit, not what it predicts.",
            )
        )
    wanted = list(checked.project.identify.models) or sorted(
        {c for s in sources for c in s.column.formulas}
    )
    judged, samples = judge(sources, chosen, wanted)
    seen = {
        d.maneuver.id: tuple(s.saw(d.maneuver, checked.flights[d.maneuver.log]) for s in sources)
        for d in chosen
    }
    learned = [
        f"{s.column.name} ({', '.join(id for id, words in seen.items() if words[i] == 'yes')})"
        for i, s in enumerate(sources)
        if any(words[i] == "yes" for words in seen.values())
    ]
    if learned:
        said.append(
            warn(
                "seen_by_estimate",
                where=project,
                expected="maneuvers that no result learned from",
                found="learned from: " + ", ".join(learned),
                do="Its R2 there tells how it fits, not how it predicts.",
            )
        )
    files += checked.files
    return Comparison(
        sources, rows, judged, samples, tuple(d.maneuver for d in chosen), seen, tuple(files),
        tuple(dict.fromkeys(said)),
    )  # fmt: skip


def judge(
    sources: Sequence[Source], data: Sequence[CoefficientData], coefficients: Sequence[str]
) -> tuple[dict[str, tuple[Judged | None, ...]], dict[str, int]]:
    """R2 and RRMSE of every source by coefficient, and the samples; van den Hoek 2017, Table 8.

    Each maneuver's constant is taken from itself for every source alike: it belongs to the trim.
    A model in the other set of axes is turned by the measured angle of attack.
    """
    predicted = {d.maneuver.id: [_both_axes(s.predict(d), d) for s in sources] for d in data}
    out: dict[str, tuple[Judged | None, ...]] = {}
    samples = {}
    for c in coefficients:
        aspect = "longitudinal" if c in LONGITUDINAL else "lateral"
        serving = [d for d in data if d.maneuver.aspect in (aspect, "both") and c in d.coefficients]
        if not serving:
            continue
        found: list[Judged | None] = []
        for i in range(len(sources)):
            if all(c in predicted[d.maneuver.id][i] for d in serving):
                found.append(_judged([_series(c, d, predicted[d.maneuver.id][i]) for d in serving]))
            else:
                found.append(None)
        out[c] = tuple(found)
        samples[c] = sum(len(d.t) for d in serving)
    return out, samples


def _series(coefficient: str, d: CoefficientData, predicted: Mapping[str, Array]) -> Series:
    measured, model = d.coefficients[coefficient], predicted[coefficient]
    if d.cubic is not None and coefficient in MOMENTS:  # as the measured side was smoothed
        model = d.cubic.matched(model[:, None])[:, 0]
    model = model + np.mean(measured - model)
    return Series(coefficient, d.maneuver.id, d.t, measured, model, d.maneuver.held_out)


def _judged(shown: Sequence[Series]) -> Judged:
    squares = sum(float(np.sum((s.measured - s.model) ** 2)) for s in shown)
    count = sum(len(s.t) for s in shown)
    spread = float(np.ptp(np.concatenate([s.measured for s in shown])))
    return Judged(r_squared(shown), math.sqrt(squares / count) / spread if spread else math.nan)


def _both_axes(found: dict[str, Array], d: CoefficientData) -> dict[str, Array]:
    alpha = d.variables.get("alpha")
    if alpha is None:
        return found
    sin, cos = np.sin(alpha), np.cos(alpha)
    if {"CX", "CZ"} <= found.keys() and "CL" not in found:
        X, Z = found["CX"], found["CZ"]
        return {**found, "CD": -X * cos - Z * sin, "CL": X * sin - Z * cos}
    if {"CD", "CL"} <= found.keys() and "CX" not in found:
        D, L = found["CD"], found["CL"]
        return {**found, "CX": L * sin - D * cos, "CZ": -D * sin - L * cos}
    return found
