"""A virtual flight test of an aircraft that is not quite what its file says: a Monte Carlo draw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from alula.aircraft.sampled import sampled
from alula.base.messages import Message, note, refuse
from alula.simulate.virtual_loading import Loading


def drawn(
    loadings: Mapping[str, Loading], seed: int, number: int
) -> tuple[dict[str, Loading], dict[str, Any], Message]:
    """The loadings of the aircraft of that number, what was drawn (SI) by loading, and a note.

    The files that the campaign writes keep the nominal values: who identifies does not know better.
    Every loading is of one aircraft: the same numbers are drawn for each. Raises BadInput where a
    file states no [uncertainty], and for a number below 1.
    """
    lacking = [x.aircraft.path for x in loadings.values() if x.aircraft.uncertainty is None]
    if lacking or number < 1:
        raise refuse(
            "nothing_to_sample" if lacking else "usage",
            where=lacking[0] if lacking else "--sample",
            expected="[uncertainty] in the aircraft file" if lacking else "a number from 1 on",
            found="none" if lacking else str(number),
            do="Add it (docs/aircraft_file.md, Uncertainty), or fly without --sample."
            if lacking
            else "Number the draws 1, 2, 3, ...",
        )
    out, truth = {}, {}
    for id, loading in loadings.items():
        one = sampled(loading.aircraft, np.random.default_rng([seed, number]))
        out[id] = replace(loading, aircraft=one)
        truth[id or "nominal loading"] = {
            "mass": None if one.mass is None else one.mass.mass,
            "cg": None if one.mass is None else one.mass.cg.tolist(),
            "inertia": None if one.mass is None else one.mass.inertia.tolist(),
            "engines": {e.name: e.position.tolist() for e in one.engines},
        }
    said = note(
        "sampled_aircraft",
        where="--sample",
        expected="the aircraft as its file says",
        found=f"number {number} of seed {seed}, drawn from its [uncertainty]",
        do="truth.json has what was flown; the campaign's aircraft file keeps the nominal values.",
    )
    return out, {"number": number, "loadings": truth}, said
