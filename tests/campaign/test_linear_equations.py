"""The linear equations of flight from a project's options, against flights by nonlinear ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.campaign.identify_task import IdentifyTask
from alula.campaign.methods import identify_by
from alula.identify import Identification
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from identify.flown_maneuvers import DT, LATERAL, LONGITUDINAL, TRUTH, flown, pitch_3211

# Trimmed at 45 m/s, alpha = theta = 0.05 with 700 N: the flown equations then stand still.
STEADY = {**TRUTH, "CX_0": -0.04418, "CZ_0": -0.19046, "Cm_0": 0.02128}
ALPHA, SLOPE = 0.05, 0.15 + 2 * 2.5 * 0.05  # dCX/dalpha there
CX, CZ = STEADY["CX_0"] + 0.15 * ALPHA + 2.5 * ALPHA**2, STEADY["CZ_0"] - 5.0 * ALPHA
CL_ALPHA = (SLOPE * np.sin(ALPHA) + CX * np.cos(ALPHA)) - (
    -5.0 * np.cos(ALPHA) - CZ * np.sin(ALPHA)
)
IN_STABILITY_AXES = {
    "CL_0": CX * np.sin(ALPHA) - CZ * np.cos(ALPHA) - CL_ALPHA * ALPHA,
    "CL_alpha": CL_ALPHA,
    "CL_q": 6.0 * np.cos(ALPHA),
    "CL_de": 0.4 * np.cos(ALPHA),
}
EXPECTED = {**STEADY, **IN_STABILITY_AXES}
MODELS = {**LATERAL, "CL": "1 + alpha + qhat + de", "Cm": LONGITUDINAL["Cm"]}


def bank_and_yaw(t: np.ndarray) -> dict[str, np.ndarray]:
    """Small enough for linear equations, still at both ends."""
    moving = (t > 1.0) & (t < 9.0)
    dr = 0.02 * ((t > 4) & (t < 5)) - 0.02 * ((t > 5) & (t < 6)) + 0.01 * np.sin(1.7 * t) * moving
    return {"da": 0.012 * np.sign(np.sin(2.1 * t)) * moving, "dr": dr}


def pitch(t: np.ndarray) -> dict[str, np.ndarray]:
    return {"de": 0.4 * (pitch_3211(t)["de"] + 0.01)}


@cache
def maneuvers() -> tuple[MeasuredManeuver, MeasuredManeuver]:
    made = []
    for aspect, controls in (("lateral", bank_and_yaw), ("longitudinal", pitch)):
        m = flown(controls, seconds=12.0, seed=1, id=aspect, truth=STEADY)
        made.append(replace(m, maneuver=replace(m.maneuver, aspect=aspect)))
    return made[0], made[1]


def identify(
    method: str,
    models: Mapping[str, str] = MODELS,
    flights: Sequence[MeasuredManeuver] = (),
    **options: Any,
) -> Identification:
    made = tuple(flights or maneuvers())
    task = IdentifyTask(
        data=(),
        measure=lambda: (made, (), []),
        models=models,
        reference=made[0].reference,
        options={"equations": "linear", **options},
        truth=EXPECTED,
    )
    return identify_by(method, task)


def codes(found: Identification) -> list[str]:
    return [m.code for m in found.messages]


@pytest.mark.parametrize("method", ["oe", "fe", "fd"])
def test_truth_comes_back_under_the_formulas_names(method: str) -> None:
    found = identify(method, **({"band_hz": [0.08, 1.5]} if method == "fd" else {}))
    wanted = {n for n in EXPECTED if n.split("_")[0] in MODELS}
    if method == "fd":
        wanted -= {"CL_0", "Cm_0"}  # constants have no frequency, which is said
        assert "no_constants" in codes(found)
    judged = [p for p in found.parameters if p.truth is not None]
    assert {p.name for p in judged} == wanted
    for p in judged:  # one draw of 21 values
        assert abs(p.value - p.truth) < 4.0 * p.se, p.name
    assert all(p.verdict == "ok" for p in judged if p.name in ("Cm_alpha", "Cl_p", "Cn_beta"))
    assert (found["Cm_q"].coefficient, found["Cm_q"].unit) == ("Cm", "1/rad")
    assert found.formulas == MODELS
    assert "beyond_linear" not in codes(found)


def test_output_error_is_that_of_the_nonlinear_equations() -> None:
    """The same records, the same likelihood: what is left is second order in small angles."""
    models = dict(LATERAL)
    flight = maneuvers()[:1]
    linear = identify("oe", models, flight)
    full = identify("oe", models, flight, equations="flight", outputs=["beta", "p", "r", "phi"])
    for name in EXPECTED.keys() & set(linear.params.index) & set(full.params.index):
        assert abs(linear[name].value - full[name].value) < 0.3 * full[name].se, name


def test_a_delay_is_found() -> None:
    """The aileron acts 0.1 s after it was recorded, 0.7 rad of phase at 1 Hz."""
    m = maneuvers()[0]
    recorded = np.append(m.controls["da"][5:], np.zeros(5))
    late = replace(m, controls={**m.controls, "da": recorded})
    found = identify("fd", LATERAL, [late], band_hz=[0.08, 1.5], delayed=["da"])
    delay = found["delay_da"]
    assert delay.value == pytest.approx(5 * DT, abs=4.0 * delay.se)
    assert delay.se < 0.02
    assert delay.unit == "s"
    ignored = identify("fd", LATERAL, [late], band_hz=[0.08, 1.5])
    off = [abs(f["Cl_p"].value - EXPECTED["Cl_p"]) for f in (found, ignored)]
    assert off[1] > 2.0 * off[0]


def test_fixed_tied_bounded_and_prior() -> None:
    found = identify(
        "oe",
        fixed={"Cn_da": 0.01},
        tied={"Cl_dr": "-0.05*Cl_da"},
        bounds={"Cn_p": [-0.04, 0.0]},  # the truth, -0.05, lies outside
        priors={"CL_q": [EXPECTED["CL_q"], 0.01]},
    )
    assert not {"Cn_da", "Cl_dr"} & set(found.params.index)
    assert found["Cn_p"].value == pytest.approx(-0.04)
    assert found["Cn_p"].verdict == "weak"
    assert "at_bound" in codes(found)
    # without the prior its standard error is several
    assert found["CL_q"].value == pytest.approx(EXPECTED["CL_q"], abs=0.03)


def test_each_maneuver_has_its_own_constants_unless_asked() -> None:
    one = maneuvers()[1]
    two = replace(one, maneuver=replace(one.maneuver, id="again"))
    models = {"CL": MODELS["CL"], "Cm": MODELS["Cm"]}
    own = identify("oe", models, [one, two])
    assert {"Cm_0[longitudinal]", "Cm_0[again]"} <= set(own.params.index)
    common = identify("oe", models, [one, two], common_constant=True)
    assert "Cm_0" in common.params.index


def test_a_large_maneuver_is_said_and_nothing_reads_ok() -> None:
    fast = flown(pitch, seconds=12.0, seed=1, id="climb")  # thrust falls short: slows by 30 %
    found = identify("oe", {"CL": MODELS["CL"], "Cm": MODELS["Cm"]}, [fast])
    assert "beyond_linear" in codes(found)
    assert "ok" not in {p.verdict for p in found.parameters}
    assert "beyond linear equations" in found.status


def test_names_of_the_other_motion_are_left_aside_and_said() -> None:
    found = identify("oe", LATERAL, maneuvers()[:1], fixed={"Cm_q": -12.0, "Cn_da": 0.01})
    (said,) = [m for m in found.messages if m.code == "option_left_aside"]
    assert said.found == "fixed.Cm_q"
    assert "Cn_da" not in found.params.index


@pytest.mark.parametrize("equations", ["linear", "flight"])
def test_a_name_of_no_motion_is_refused(equations: str) -> None:
    """With longitudinal and lateral models too, where it might belong to the other."""
    with pytest.raises(BadInput, match="Cq_m"):
        identify("oe", equations=equations, start={"Cq_m": 1.0})


@pytest.mark.parametrize(
    ("method", "options", "match"),
    [
        ("fd", {"band_hz": [0.1, 1.0], "delayed": ["dx"]}, "delayed"),
        ("fd", {}, "band_hz"),
        ("fd", {"equations": "flight", "delayed": ["da"]}, "delayed"),
        ("oe", {"equations": "quadratic"}, "equations"),
        ("oe", {"states": "six"}, "states"),
        ("fe", {"gain": "high"}, "gain"),
        ("oe", {"models": {"CX": "1 + alpha", "CZ": "1 + alpha"}}, "CD and CL"),
        ("oe", {"models": {"CL": "1 + alpha^2", "Cm": "1 + alpha"}}, "first order"),
        ("oe", {"models": {"CL": "1 + alpha", "Cm": "1 + df"}}, "df"),
    ],
)
def test_what_does_not_fit_is_refused(method: str, options: dict[str, Any], match: str) -> None:
    models = options.pop("models", MODELS)
    with pytest.raises(BadInput) as raised:
        identify(method, models, **options)
    assert match in str(raised.value)
