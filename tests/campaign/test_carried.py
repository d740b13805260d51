"""The reconstruction's uncertainty in output error: the step against an estimate made anew."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.campaign.check import check_project
from alula.campaign.identify_task import IdentifyTask
from alula.campaign.measured import measured_maneuvers
from alula.campaign.methods import identify_by
from alula.identify import Identification
from alula.identify.flown.carried import Shifts, carried
from alula.identify.flown.fit import Covariance
from alula.identify.flown.output_error import identify_output_error
from alula.identify.flown.problem import STATE_SETS, Setting
from alula.reconstruct import reconstruct
from cli.command import demo_files, small_project

__all__ = ["demo_files"]


@pytest.mark.parametrize("covariance", ["diagonal", "full"])
def test_the_step_is_what_other_readings_give(
    demo_files: Path, tmp_path: Path, covariance: Covariance
) -> None:
    project = small_project(demo_files, tmp_path / "project")
    checked = check_project(str(project.path))
    path = reconstruct(
        checked.flights, checked.maneuvers, checked.aircraft, checked.project.reconstruct
    )
    (maneuver,), _, shifts = measured_maneuvers(checked, path)
    models = checked.project.identify.models
    setting = Setting(STATE_SETS["longitudinal"], ("V", "alpha", "theta", "q", "ax", "az"))

    def identified(m):
        return identify_output_error(
            [m],
            models,
            states=setting.states,
            outputs=list(setting.outputs),
            covariance=covariance,
        )

    found = identified(maneuver)
    id = maneuver.maneuver.id
    strongest = max(shifts, key=lambda s: np.abs(s[id].get("alpha", np.zeros(1))).max())
    moved = {n: x + strongest[id].get(n, 0.0) for n, x in maneuver.outputs.items()}
    again = identified(replace(maneuver, outputs=moved))
    wider = carried(found, [maneuver], models, [strongest], setting, covariance=covariance)
    assert wider.uncertainty.endswith("reconstruction")
    told = 0
    for p, q, w in zip(found.parameters, again.parameters, wider.parameters, strict=True):
        step = np.sqrt(max(w.se**2 - p.se**2, 0.0))
        # linear to a percent of a standard error; the search ends within 1e-4 of one
        assert abs(step - abs(q.value - p.value)) < 0.02 * p.se
        assert w.ci95[1] - w.ci95[0] >= p.ci95[1] - p.ci95[0]
        told += step > 0.1 * p.se
    assert told > 0  # the direction matters to some parameter


def test_filter_error_carries_it_too(demo_files: Path, tmp_path: Path) -> None:
    """As the command goes, with a tie: one direction against an estimate made anew, either way."""
    checked = check_project(str(small_project(demo_files, tmp_path / "project").path))
    path = reconstruct(
        checked.flights, checked.maneuvers, checked.aircraft, checked.project.reconstruct
    )
    (maneuver,), _, shifts = measured_maneuvers(checked, path)
    models = checked.project.identify.models
    id = maneuver.maneuver.id
    strongest = max(shifts, key=lambda s: np.abs(s[id].get("alpha", np.zeros(1))).max())

    def identified(sign: float, carry: list[Shifts]) -> Identification:
        outputs = {n: x + sign * strongest[id].get(n, 0.0) for n, x in maneuver.outputs.items()}
        measured = ((replace(maneuver, outputs=outputs),), (), carry)
        options = {"tied": {"CL_q": "0.5*Cm_q"}}
        task = IdentifyTask((), lambda: measured, models, maneuver.reference, options)
        return identify_by("fe", task)

    found, wider = identified(0.0, []), identified(0.0, [strongest])
    up, down = identified(1.0, []), identified(-1.0, [])
    assert found.tied == wider.tied == {"CL_q": ("Cm_q", 0.5)}
    assert wider.uncertainty.endswith("reconstruction")
    assert not found.uncertainty.endswith("reconstruction")
    told = 0
    for p, w in zip(found.parameters, wider.parameters, strict=True):
        step = np.sqrt(max(w.se**2 - p.se**2, 0.0))
        anew = 0.5 * abs(up[p.name].value - down[p.name].value)
        if not p.name.startswith(("F_", "sigma_")):  # which no constant moves but by chance
            assert abs(step - anew) < 0.02 * p.se  # as output error's
        told += step > 0.1 * p.se
        assert w.unit
    assert told > 0  # the direction matters to some parameter


def test_nothing_to_carry_changes_nothing(demo_files: Path, tmp_path: Path) -> None:
    project = small_project(demo_files, tmp_path / "project")
    project.edit('filter = "ekf"', 'filter = "none"')
    checked = check_project(str(project.path))
    path = reconstruct(
        checked.flights, checked.maneuvers, checked.aircraft, checked.project.reconstruct
    )
    assert measured_maneuvers(checked, path)[2] == []


def test_a_second_sensor_s_own_bias_is_carried(demo_files: Path, tmp_path: Path) -> None:
    """Where another channel of the quantity is read, its constants count and no others'."""
    checked = check_project(str(small_project(demo_files, tmp_path / "project").path))
    path = reconstruct(
        checked.flights, checked.maneuvers, checked.aircraft, checked.project.reconstruct
    )
    first = measured_maneuvers(checked, path)[2]

    def renamed(name: str) -> str:
        return {"b_alpha": "b_alpha_2", "k_alpha": "k_alpha_2"}.get(name, name)

    segments = tuple(
        replace(
            s,
            sensors=tuple(
                replace(x, name="alpha_2") if x.name == "alpha" else x for x in s.sensors
            ),
        )
        for s in path.segments
    )
    constants = tuple(replace(c, name=renamed(c.name)) for c in path.constants)
    assert constants != path.constants  # the demo's vane has constants to be unsure of
    second = measured_maneuvers(checked, replace(path, segments=segments, constants=constants))[2]
    assert len(first) == len(second)
    for one, two in zip(first, second, strict=True):
        assert one.keys() == two.keys()
        for id in one:
            assert one[id].keys() == two[id].keys()
            for name in one[id]:
                np.testing.assert_array_equal(one[id][name], two[id][name])
