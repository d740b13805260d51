"""Gaussian priors from a model file: what a prediction or an earlier flight knew before this one.

`priors = "prediction.toml"` in [identify.options] stands for its values and standard errors
(Dittrich 2016, Eq. (3.11)). Constants are left out: they belong to the trim of a maneuver.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft import Aircraft
from alula.base.files import sha256
from alula.base.messages import Message, note, refuse
from alula.campaign.sources.conventions import to_point, to_reference
from alula.identify.compare import Entry
from alula.model import AeroModel, Reference, load_model
from alula.model.grammar import parse
from alula.predict.to_model import priors


def with_named_priors(
    options: Mapping[str, Any], folder: Path, plane: Aircraft, models: Mapping[str, str]
) -> tuple[dict[str, Any], list[Message]]:
    """The options with [mean, standard error] by parameter where they name a model's file.

    folder: of the project; models: formula by coefficient, whose parameters get a prior. Raises
    BadInput for a file that is no model, or none with standard errors of these parameters.
    """
    given = options.get("priors")
    if not isinstance(given, str):
        return dict(options), []
    path = folder / given
    model = load_model(path)
    known, lost = _about(plane, model, priors(model))
    wanted = [term.name(c) for c, formula in models.items() for term in parse(formula)]
    taken = {n: list(known[n]) for n in wanted if n in known and not n.endswith("_0")}
    if not taken:
        raise refuse(
            "no_prior",
            where=f"identify.options.priors, {path}",
            expected=f"standard errors of {', '.join(wanted[:8])}",
            found=", ".join(list(known)[:8]) or "a model without covariance",
            do="Write it by `alula predict --model` or `alula identify --model`; forces must be in "
            "the same axes, CD and CL or CX and CZ, as [identify.models].",
        )
    without = [n for n in wanted if n not in taken and not n.endswith("_0")]
    said = note(
        "priors_of_model",
        where=f"identify.options.priors, {path}",
        expected="a prior for each parameter",
        found=f"{len(taken)} of '{model.name}' (SHA-256 {sha256(path)[:12]}); none for "
        + (", ".join(without) or "constants"),
        do="What has no prior is told by the flight alone."
        + (f" Not transferred to the reference point: {', '.join(lost)}." if lost else ""),
    )
    return {**options, "priors": taken}, [said]


def _about(
    plane: Aircraft, model: AeroModel, known: Mapping[str, tuple[float, float]]
) -> tuple[dict[str, tuple[float, float]], list[str]]:
    """On the aircraft's reference, about its point."""
    entries = {n: Entry(v, known[n][1] if n in known else 0.0) for n, v in model.params.items()}
    own = Reference(plane.S, plane.b, plane.c)
    moved = to_reference(entries, model.reference, own)
    step = np.asarray(model.reference_point) - plane.reference_point
    lost: list[str] = []
    if float(np.max(np.abs(step))) > 1e-6 * plane.c:
        if model.axes != "stability" or abs(step[1]) > 1e-6 * plane.b:
            raise refuse(
                "prior_reference_point",
                where=f"aerodynamic model '{model.name}'",
                expected="moments about the aircraft file's reference point, or CD and CL to "
                "transfer them within the plane of symmetry",
                found=f"about {model.reference_point.tolist()} m",
                do="Predict or identify it with this aircraft file.",
            )
        moved, lost = to_point(moved, step, own, 0.0)
    return {n: (e.value, e.se) for n, e in moved.items() if e.se > 0.0}, lost
