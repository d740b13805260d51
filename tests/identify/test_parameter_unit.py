"""Units of derivatives, states, biases and noises, worked out by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from alula.campaign.by_outputs import by_outputs
from alula.flight import Maneuver
from alula.identify.parameter_unit import parameter_unit
from alula.identify.result import Identification, Parameter


@pytest.mark.parametrize(
    ("belongs", "name", "unit"),
    [
        ("Cm", "Cm_alpha", "1/rad"),
        ("Cm", "Cm_0[elevator]", "1"),
        # a white-noise drive of x' has (unit of x)/s per root of a hertz: unit of x per root second
        ("alpha", "F_alpha", "rad/s^0.5"),
        ("q", "F_q", "rad/s^1.5"),
        ("V", "F_V", "m/s^1.5"),
        ("az", "sigma_az", "m/s2"),
        ("q", "sigma_q", "rad/s"),
        ("q", "q(0)[elevator]", "rad/s"),
        ("alpha", "alpha(0)[elevator]", "rad"),
        ("az", "b_az[elevator]", "m/s2"),
        ("own", "F_own", ""),
        ("own", "sigma_own", ""),
    ],
)
def test_unit(belongs: str, name: str, unit: str) -> None:
    assert parameter_unit(belongs, name) == unit


def test_the_command_states_them() -> None:
    """Filter error's parameters as the method leaves them come out of the campaign with units."""
    parameters = tuple(
        Parameter(n, c, 1.0, 0.1, 0.1, (0.8, 1.2), "ok", (), "", 1.0)
        for n, c in (("Cm_alpha", "Cm"), ("F_q", "q"), ("sigma_q", "q"))
    )
    found = Identification("filter error", parameters, {}, (), np.eye(3), "converged")
    maneuver: Any = SimpleNamespace(
        maneuver=Maneuver("m", "log", "", 0.0, 8.0), outputs={"alpha": [], "q": []}
    )
    task: Any = SimpleNamespace(
        options={}, models={"Cm": "1 + alpha"}, truth=None, measure=lambda: ([maneuver], (), [])
    )
    result = by_outputs(task, lambda *_, **__: found, {"longitudinal": ("alpha", "q")})
    assert [p.unit for p in result.parameters] == ["1/rad", "rad/s^1.5", "rad/s"]
    row = next(line for line in result.summary().splitlines() if line.startswith("F_q"))
    assert " rad/s^1.5 " in row
