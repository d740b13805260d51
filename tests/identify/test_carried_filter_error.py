"""The reconstruction's uncertainty in filter error: the step against an estimate made anew."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from alula.identify.flown.carried import with_steps
from alula.identify.flown.carried_filter_error import carried_by_filter
from alula.identify.flown.filter_error import STATES_OF, identify_flight_filter_error
from identify.gusty_maneuver import FORMULAS, TRUE, short_period

SETTING: dict[str, Any] = {
    "states": STATES_OF["longitudinal"],
    "outputs": ("alpha", "q", "az"),
    "start": {k: 0.7 * v for k, v in TRUE.items()},
}
TIED: dict[str, Any] = {
    **SETTING,
    "tied": {"Cm_de": ("Cm_q", 0.06)},
    "fixed": {"CZ_0": -0.45, "sigma_q": 0.004},
    "common_constant": False,
}


@cache
def gusty():
    return tuple(
        replace(m, maneuver=replace(m.maneuver, id=id))
        for m, id in ((short_period(3), "one"), (short_period(4), "two"))
    )


@pytest.mark.parametrize("name", ["alpha", "q", "az"])
@pytest.mark.parametrize("case", ["plain", "two maneuvers, tied"])
def test_a_constant_shift_is_an_estimate_made_anew(name, case):
    """Readings off by half their noise, in one maneuver the other way round."""
    flown = gusty()[:1] if case == "plain" else gusty()
    setting = SETTING if case == "plain" else TIED
    size = {"alpha": 0.001, "q": 0.002, "az": 0.1}[name]
    shift = {
        m.maneuver.id: {name: np.full(len(m.t), sign * size)}
        for m, sign in zip(flown, (1.0, -1.0), strict=False)
    }
    off = [
        replace(m, outputs={**m.outputs, name: m.outputs[name] + shift[m.maneuver.id][name]})
        for m in flown
    ]
    found = identify_flight_filter_error(flown, FORMULAS, **setting)
    again = identify_flight_filter_error(off, FORMULAS, **setting)
    wider = carried_by_filter(found, flown, FORMULAS, [shift], **setting)
    for p, q, w in zip(found.parameters, again.parameters, wider.parameters, strict=True):
        step = np.sqrt(max(w.se**2 - p.se**2, 0.0))
        print(case, name, p.name, (q.value - p.value) / p.se, step / p.se)
