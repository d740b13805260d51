"""A drag that names the lift coefficient: CD = CD0 + K CL^2."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.model import AeroModel, Reference, aero_model, evaluate_in_core, load_model, save_model

FORMULAS = {"CL": "1 + alpha + qhat + de", "CD": "1 + CL^2 + CL*mach", "Cm": "1 + alpha^2"}
VALUES = {
    "CL_0": 0.25, "CL_alpha": 5.0, "CL_q": 4.0, "CL_de": 0.4,
    "CD_0": 0.035, "CD_CL2": 0.05, "CD_mach_CL": 0.01, "Cm_0": 0.03, "Cm_alpha2": -0.8,
}  # fmt: skip
VARIABLES = {
    "alpha": np.array([-0.1, 0.0, 0.2]),
    "qhat": np.array([0.01, 0.02, -0.01]),
    "de": np.array([0.1, -0.1, 0.0]),
    "mach": np.array([0.1, 0.2, 0.3]),
}


def polar() -> AeroModel:
    return aero_model("polar", FORMULAS, VALUES, Reference(12.0, 9.0, 1.2), axes="stability")


def test_drag_takes_the_lift_of_its_own_model() -> None:
    model = polar()
    lift = 0.25 + 5.0 * VARIABLES["alpha"] + 4.0 * VARIABLES["qhat"] + 0.4 * VARIABLES["de"]
    drag = 0.035 + 0.05 * lift**2 + 0.01 * VARIABLES["mach"] * lift
    for found in (model.evaluate(VARIABLES), evaluate_in_core(model, VARIABLES)):
        np.testing.assert_allclose(found["CL"], lift, rtol=1e-14)  # rounding
        np.testing.assert_allclose(found["CD"], drag, rtol=1e-14)


def test_file_gives_it_back(tmp_path: object) -> None:
    path = f"{tmp_path}/polar.toml"
    save_model(polar(), path)
    assert load_model(path).terms == polar().terms


@pytest.mark.parametrize(
    ("axes", "formulas"),
    [
        ("stability", {"CL": "1 + CL"}),
        ("stability", {"CD": "1", "Cm": "1 + CL"}),
        ("body", {"CX": "1 + CL^2"}),
    ],
)
def test_only_the_drag_may_name_it(axes: str, formulas: dict[str, str]) -> None:
    with pytest.raises(BadInput, match="CD only"):
        aero_model("wrong", formulas, {}, Reference(12.0, 9.0, 1.2), axes=axes)  # type: ignore[arg-type]
