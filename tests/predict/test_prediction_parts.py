"""What `alula predict` puts together: strips' slopes, the turned lattice, units."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import Aircraft, load_aircraft
from alula.base.messages import BadInput
from alula.campaign.predict import METHODS, Asked, at_angle, run_prediction
from alula.model import Reference
from alula.predict.axes import along
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.prediction import per_deg
from alula.predict.strip_derivatives import strip_derivatives
from alula.predict.strip_model import strip_model
from alula.predict.vortex_lattice import vortex_lattice

AIRCRAFT = Path(__file__).parents[2] / "aircraft"


@pytest.fixture(scope="module")
def arm_hawk() -> Aircraft:
    return load_aircraft(AIRCRAFT / "armhawk.toml")


def test_strip_slopes_are_the_strips(arm_hawk: Aircraft) -> None:
    """A small motion in everything at once, by the slopes and by the strips themselves."""
    strips = strip_model(arm_hawk)
    found = strip_derivatives(arm_hawk, 0.05, 25.0, strips)
    step = {"alpha": 0.008, "beta": 0.01, "phat": 0.01, "qhat": 0.003, "rhat": 0.01,
            "de": 0.02, "da": 0.02, "dr": 0.02}  # fmt: skip
    at = {n: np.array(v) for n, v in step.items()}
    at["alpha"] = np.array(0.05 + step["alpha"])
    moved, here = strips.evaluate(at), strips.evaluate({"alpha": np.array(0.05)})
    label = {"phat": "p", "qhat": "q", "rhat": "r"}
    for c in ("CL", "Cm", "CY", "Cl", "Cn"):
        slope = sum(
            found.values[f"{c}_{label.get(n, n)}"].value * v
            for n, v in step.items()
            if f"{c}_{label.get(n, n)}" in found.values
        )
        change = float(moved[c][0] - here[c][0])
        # Products of two motions are of second order: 2 % of the largest change and 10 % of it.
        assert slope == pytest.approx(change, rel=0.1, abs=0.0006), c


def test_strips_bend_goes_into_the_error(arm_hawk: Aircraft) -> None:
    """On the way to the stall the slopes to either side differ: the error says so."""
    strips = strip_model(arm_hawk)
    slopes = [
        strip_derivatives(arm_hawk, float(a), 25.0, strips).values["CL_alpha"]
        for a in np.radians([2.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0])
    ]
    assert slopes[-1].value < 0.7 * slopes[0].value
    assert slopes[0].se / slopes[0].value == pytest.approx(0.1, abs=0.003)  # straight: 10 % only
    assert max(e.se / e.value for e in slopes[1:]) > 0.115


def test_unloaded_lattice_turned_is_the_lattice_at_the_angle() -> None:
    """A fin alone is unloaded at any angle: its derivatives turn with the body.

    At 6 deg the stream meets it at another sweep, which the turn leaves out: 3 % of each.
    """
    plane = load_aircraft(AIRCRAFT / "sportstar.toml")
    assert plane.geometry is not None
    fin = plane.geometry.surface("fin")
    assert fin is not None
    shape = replace(plane.geometry, surfaces=(fin,), bodies=())
    reference, alpha = Reference(plane.S, plane.b, plane.c), np.radians(6.0)
    zero, there = (
        vortex_lattice(shape, reference, np.zeros(3), alpha=a, symmetry=False) for a in (0.0, alpha)
    )
    turned = at_angle(zero.as_derivatives(), float(alpha), 0.0).values
    truth = there.derivatives("stability")
    for name in ("CY_beta", "CY_dr", "Cn_beta", "Cn_dr", "CY_r", "Cn_r"):
        assert turned[name].value == pytest.approx(truth[name], rel=0.03), name
    # The small ones against the large ones that turn into them.
    assert turned["Cl_dr"].value == pytest.approx(truth["Cl_dr"], abs=0.03 * abs(truth["Cn_dr"]))
    assert turned["Cl_beta"].value == pytest.approx(
        truth["Cl_beta"], abs=0.03 * abs(truth["Cn_beta"])
    )
    assert "Cl_r" not in turned  # proportional to lift on an aircraft: from the formulas


def test_what_lift_adds_to_dihedral_is_in_the_error() -> None:
    one = {"Cl_beta": Estimate(-0.02, 0.002, ""), "Cn_beta": Estimate(0.1, 0.01, "")}
    unloaded = Derivatives("lattice", one, {"alpha_deg": "0"}, axes="model")
    se = [at_angle(unloaded, 0.0, lift).values["Cl_beta"].se for lift in (0.0, 0.4)]
    assert se == pytest.approx([0.002, np.hypot(0.002, 0.02)])


def test_per_degree() -> None:
    names = {"CL_0": 1.0, "CL_alpha": 5.0, "CD_alpha2": 2.0, "Cm_q": -9.0, "Cl_da": -0.3}
    values = {n: Estimate(v, 0.1 * abs(v), "") for n, v in names.items()}
    found = per_deg(Derivatives("m", values)).values
    assert found["CL_0"].value == 1.0
    assert found["Cm_q"].value == -9.0
    assert found["CL_alpha_per_deg"].value == pytest.approx(np.radians(5.0))
    assert found["CL_alpha_per_deg"].se == pytest.approx(np.radians(0.5))
    assert found["CD_alpha2_per_deg2"].value == pytest.approx(np.radians(1.0) ** 2 * 2.0)


@pytest.mark.parametrize("method", METHODS)
def test_prediction_of_the_arm_hawk(arm_hawk: Aircraft, method: str) -> None:
    found = run_prediction(arm_hawk, Asked(method, V=25.0))
    assert found.derivatives.axes == "stability"
    assert all(np.isfinite([e.value, e.se]).all() for e in found.derivatives.values.values())
    if method == "bodies":
        assert found.model is None
        return
    assert found.model is not None
    # The model is what was predicted, along body axes, lags with the rates.
    body = along(found.derivatives, "model").values
    lag = body.get("Cm_alphadot", Estimate(0.0, 0.0, "")).value
    assert found.model.params["Cm_q"] == pytest.approx(body["Cm_q"].value + lag)
    assert found.model.params["Cn_beta"] == pytest.approx(body["Cn_beta"].value)
    assert found.neutral_point is not None
    assert found.neutral_point[0] < arm_hawk.reference_point[0]  # stable


def test_unsettled_mesh_is_warned_of(arm_hawk: Aircraft) -> None:
    """The tail lies in the wing's plane, their strips apart: flaps' downwash does not settle."""
    found = run_prediction(arm_hawk, Asked("lattice", V=25.0))
    (said,) = [m for m in found.messages if m.code == "mesh_not_converged"]
    assert "CL_df" in said.found


def test_unknown_method_is_refused(arm_hawk: Aircraft) -> None:
    with pytest.raises(BadInput, match="tornado"):
        run_prediction(arm_hawk, Asked("tornado"))
