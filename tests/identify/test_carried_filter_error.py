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
from alula.identify.result import Identification, Parameter
from identify.gusty_maneuver import FORMULAS, TRUE, short_period

SETTING: dict[str, Any] = {
    "states": STATES_OF["longitudinal"],
    "outputs": ("alpha", "q", "az"),
    "start": {k: 0.7 * v for k, v in TRUE.items()},
}
TIED: dict[str, Any] = {
    **SETTING,
    "tied": {"Cm_de": ("Cm_q", 0.06)},
    "fixed": {"Cm_alpha": -1.2, "sigma_q": 0.004},
    "common_constant": False,
}


@cache
def gusty():
    return tuple(
        replace(m, maneuver=replace(m.maneuver, id=id))
        for m, id in ((short_period(3), "one"), (short_period(4), "two"))
    )


def off(m, shift, sign=1.0):
    """The maneuver with its readings shifted."""
    moved = shift[m.maneuver.id]
    return replace(m, outputs={n: x + sign * moved.get(n, 0.0) for n, x in m.outputs.items()})


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
    found = identify_flight_filter_error(flown, FORMULAS, **setting)
    wider = carried_by_filter(found, flown, FORMULAS, [shift], **setting)
    up, down = (
        identify_flight_filter_error([off(m, shift, sign) for m in flown], FORMULAS, **setting)
        for sign in (1.0, -1.0)
    )
    assert wider.uncertainty == f"{found.uncertainty} + reconstruction"
    told = np.array([0.5 * (up[p.name].value - down[p.name].value) for p in found.parameters])
    se = np.array([p.se for p in found.parameters])
    step = [max(w.se**2 - s**2, 0.0) ** 0.5 for w, s in zip(wider.parameters, se, strict=True)]
    largest = np.abs(told / se).max()
    assert largest > 0.3  # the shift matters
    far = np.abs(step - np.abs(told)) / se / largest
    noise = np.array([p.name.startswith(("F_", "sigma_")) for p in found.parameters])
    # the information leaves out what has no mean: of 200 samples 7 % of one term, times what each
    # parameter has of it; of noises, which no constant moves, that is all of their step
    assert far[~noise].max() < 0.03
    assert far[noise].max() < 0.3
    for p, w in zip(found.parameters, wider.parameters, strict=True):
        assert w.value == p.value
        assert np.diff(w.ci95) >= np.diff(p.ci95) * (1.0 - 1e-9)


def test_nothing_to_carry_changes_nothing():
    flown = gusty()[:1]
    found = identify_flight_filter_error(flown, FORMULAS, **SETTING)
    assert carried_by_filter(found, flown, FORMULAS, [], **SETTING) is found
    elsewhere = {"another": {"alpha": np.full(len(flown[0].t), 0.1)}}
    same = carried_by_filter(found, flown, FORMULAS, [elsewhere], **SETTING)
    assert same["Cm_q"].se == found["Cm_q"].se
    np.testing.assert_array_equal(same.covariance, found.covariance)


def test_directions_add_as_squares():
    flown = gusty()[:1]
    n = len(flown[0].t)
    found = identify_flight_filter_error(flown, FORMULAS, **SETTING)
    shifts = [{"one": {name: np.full(n, 0.001)}} for name in ("alpha", "q")]
    both = carried_by_filter(found, flown, FORMULAS, shifts, **SETTING)
    added = [
        carried_by_filter(found, flown, FORMULAS, [s], **SETTING).covariance - found.covariance
        for s in shifts
    ]
    np.testing.assert_allclose(both.covariance - found.covariance, sum(added), rtol=1e-6, atol=1e-9)


def one(name, value, se, verdict="ok"):
    ci95 = (value - 2.0 * se, value + 2.0 * se)
    return Parameter(name, name.split("_")[0], value, se, se, ci95, verdict, (), "", 1.0)


def test_a_noise_keeps_the_interval_of_its_logarithm():
    noise = replace(one("F_q", 0.1, 0.03), ci95=(0.05, 0.2))
    found = Identification("filter error", (noise,), {}, (), np.eye(1), "converged")
    # 0.3 of the logarithm added to half a width of ln 2
    wider = with_steps(found, np.array([[0.3]]), {}, ["F_q"])["F_q"]
    assert wider.se == pytest.approx(0.1 * np.hypot(0.3, 0.3))
    assert wider.ci95 == pytest.approx(
        (0.1 * np.exp(-np.hypot(np.log(2.0), 0.588)), 0.1 * np.exp(np.hypot(np.log(2.0), 0.588)))
    )
    assert wider.verdict == "ok"
    lost = with_steps(found, np.array([[0.5]]), {}, ["F_q"])["F_q"]
    assert lost.verdict == "weak"  # its logarithm is not known to 0.5


def test_a_verdict_only_gets_worse():
    """What is weak for another reason than its error bar stays so, and the status keeps it."""
    parameters = (one("Cm_de", 1.1, 0.1, "weak"), one("Cm_q", -10.0, 2.0), one("Cm_0", 0.1, 0.01))
    status = "converged; weak: Cm_de; sign contradicted: de"
    found = Identification("filter error", parameters, {}, (), np.eye(3), status)
    wider = with_steps(found, np.array([[0.0], [6.0], [0.0]]), {})
    assert [p.verdict for p in wider.parameters] == ["weak", "weak", "ok"]
    assert wider.status == "converged; weak: Cm_de, Cm_q; sign contradicted: de"
    enough = with_steps(found, np.array([[0.0], [6.0], [0.0]]), {"Cm_q": 7.0})
    assert enough["Cm_q"].verdict == "ok"
