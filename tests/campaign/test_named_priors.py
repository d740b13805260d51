"""A project that names a prediction as what was known before the flight."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput
from alula.campaign.predict import Asked, run_prediction
from alula.campaign.prior_model import with_named_priors
from alula.model import AeroModel, Reference, save_model
from alula.model.aero_model import aero_model
from alula.predict.to_model import priors

AIRCRAFT = Path(__file__).parents[2] / "aircraft" / "sportstar.toml"
MODELS = {"CL": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de", "CZ": "1 + alpha"}


@pytest.fixture(scope="module")
def predicted() -> AeroModel:
    model = run_prediction(str(AIRCRAFT), Asked()).model
    assert model is not None
    return model


def test_prediction_becomes_pairs(predicted: AeroModel, tmp_path: Path) -> None:
    save_model(predicted, tmp_path / "p.toml")
    plane = load_aircraft(AIRCRAFT)
    given = {"priors": "p.toml", "algorithm": "gauss_newton"}
    options, said = with_named_priors(given, tmp_path, plane, MODELS)
    assert options["algorithm"] == "gauss_newton"
    assert set(options["priors"]) == {
        "CL_alpha", "CL_q", "CL_de", "Cm_alpha", "Cm_q", "Cm_de",
    }  # no constants, nothing of CZ  # fmt: skip
    for name, (value, se) in options["priors"].items():
        assert (value, se) == pytest.approx(priors(predicted)[name])
    assert [m.code for m in said] == ["priors_of_model"]
    assert "CZ_alpha" in said[0].found


def test_other_options_stay(tmp_path: Path) -> None:
    plane = load_aircraft(AIRCRAFT)
    pairs = {"priors": {"Cm_q": [-20.0, 2.0]}}
    assert with_named_priors(pairs, tmp_path, plane, MODELS) == (pairs, [])
    assert with_named_priors({}, tmp_path, plane, MODELS) == ({}, [])


def test_prior_about_another_point_is_transferred(predicted: AeroModel, tmp_path: Path) -> None:
    """A point 0.1 m ahead: Cm_alpha of the same aircraft is CL_alpha 0.1/c less stable there."""
    plane = load_aircraft(AIRCRAFT)
    p = predicted.params
    ahead = aero_model(
        "ahead", predicted.formulas,
        {**p, "Cm_alpha": p["Cm_alpha"] - p["CL_alpha"] * 0.1 / plane.c},
        Reference(plane.S, plane.b, plane.c), axes="stability",
        covariance=predicted.covariance, reference_point=np.array([0.1, 0.0, 0.0]),
    )  # fmt: skip
    save_model(ahead, tmp_path / "p.toml")
    options, _ = with_named_priors({"priors": "p.toml"}, tmp_path, plane, MODELS)
    # About the aircraft's point; the drag's share at alpha = 0 is CD_0 0.1/c, 0.0013.
    assert options["priors"]["Cm_alpha"][0] == pytest.approx(p["Cm_alpha"], abs=0.002)


def test_model_without_errors_is_refused(predicted: AeroModel, tmp_path: Path) -> None:
    bare = aero_model(
        "bare", predicted.formulas, predicted.params, predicted.reference, axes="stability"
    )
    save_model(bare, tmp_path / "p.toml")
    with pytest.raises(BadInput, match="without covariance"):
        with_named_priors({"priors": "p.toml"}, tmp_path, load_aircraft(AIRCRAFT), MODELS)


def test_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"none\.toml"):
        with_named_priors({"priors": "none.toml"}, tmp_path, load_aircraft(AIRCRAFT), MODELS)
