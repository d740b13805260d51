"""AeroModel: two evaluations that must agree, its file, its refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from alula.base.messages import BadInput
from alula.model import (
    VARIABLES,
    AeroModel,
    Reference,
    aero_model,
    evaluate_in_core,
    load_model,
    model_text,
    save_model,
    to_table,
)
from model.formulas import models

REFERENCE = Reference(10.0, 8.0, 1.25)


def random_variables(seed: int, n: int = 7) -> dict[str, np.ndarray]:
    random = np.random.default_rng(seed)
    out = {name: random.uniform(-1.0, 1.0, n) for name in VARIABLES}
    return {**out, "V": random.uniform(5.0, 60.0, n)}


@given(models(), st.integers(0, 2**31))
def test_core_evaluates_as_numpy_does(model: AeroModel, seed: int) -> None:
    variables = random_variables(seed)
    here, core = model.evaluate(variables), evaluate_in_core(model, variables)
    for name in here:
        # Rounding of up to three terms as large as 30 * 60^6, and fused products in the core
        np.testing.assert_allclose(core[name], here[name], rtol=1e-12, atol=1e-15 * 30 * 60.0**6)


@given(models())
@settings(max_examples=30)
def test_file_gives_the_model_back(
    tmp_path_factory: pytest.TempPathFactory, model: AeroModel
) -> None:
    path = tmp_path_factory.mktemp("model") / "model.toml"
    save_model(model, path)
    back = load_model(path)
    assert back.terms == model.terms
    assert back.values.tobytes() == model.values.tobytes()
    assert model_text(back) == model_text(model)


def full_model() -> AeroModel:
    return aero_model(
        'with "quotes"\nand a line',
        {"CL": "1 + alpha", "Cm": "1 + alpha + (alpha - 0.2)+^2"},
        {"Cm_alpha": -0.4, "CL_0": 0.5, "CL_alpha": 5.0, "Cm_0": -0.1, "Cm_(alpha-0.2)+2": -1.0},
        REFERENCE,
        axes="stability",
        covariance=np.diag([1.0, 2.0, 3.0, 4.0, 5.0]) * 1e-4,
        reference_point=np.array([0.1, 0.0, -0.05]),
        validity={"alpha": (-0.1, 0.3)},
        assumed=("CL_0",),
        provenance={"log": "0123abcd", "who": 'me "and" you'},
    )


def test_everything_survives_the_file(tmp_path: Path) -> None:
    model = full_model()
    save_model(model, tmp_path / "m.toml")
    back = load_model(tmp_path / "m.toml")
    assert back.covariance is not None
    np.testing.assert_array_equal(back.covariance, model.covariance)
    np.testing.assert_array_equal(back.reference_point, model.reference_point)
    for name in ("name", "axes", "terms", "reference", "validity", "assumed", "provenance"):
        assert getattr(back, name) == getattr(model, name), name


def test_values_and_covariance_follow_their_names() -> None:
    # Given in another order than the terms: CL_0 was second with variance 2e-4.
    model = full_model()
    assert model.names == ("CL_0", "CL_alpha", "Cm_0", "Cm_alpha", "Cm_(alpha-0.2)+2")
    assert model.params["Cm_alpha"] == -0.4
    assert model.covariance is not None
    np.testing.assert_allclose(np.diag(model.covariance), [2e-4, 3e-4, 4e-4, 1e-4, 5e-4])


def test_values_cannot_be_changed() -> None:
    with pytest.raises(ValueError, match="read-only"):
        full_model().values[0] = 1.0


@pytest.mark.parametrize(
    ("formulas", "values", "word"),
    [
        ({"CD": "1"}, {"CD_0": 0.1}, "body axes"),
        ({"Cm": "1 + alpha"}, {"Cm_0": 0.1}, "Cm_alpha"),
        ({"Cm": "1"}, {"Cm_0": 0.1, "Cm_q": 1.0}, "Cm_q"),
        ({"Cm": "1"}, {"Cm_0": float("nan")}, "Cm_0"),
    ],
)
def test_what_does_not_fit_is_refused(
    formulas: dict[str, str], values: dict[str, float], word: str
) -> None:
    with pytest.raises(BadInput, match=word):
        aero_model("m", formulas, values, REFERENCE)


def test_covariance_must_be_one() -> None:
    with pytest.raises(BadInput, match="model_covariance"):
        aero_model("m", {"Cm": "1"}, {"Cm_0": 1.0}, REFERENCE, covariance=np.array([[-1.0]]))


def test_too_many_terms_for_the_table() -> None:
    powers = [f"{v}^{k}" for v in VARIABLES for k in range(1, 7)]
    model = aero_model(
        "large",
        {"Cm": " + ".join(powers)},
        {f"Cm_{_short(v)}{k if k > 1 else ''}": 1.0 for v in VARIABLES for k in range(1, 7)},
        REFERENCE,
    )
    with pytest.raises(BadInput, match="model_too_large"):
        to_table(model)


def _short(variable: str) -> str:
    return {"phat": "p", "qhat": "q", "rhat": "r"}.get(variable, variable)


@pytest.mark.parametrize(
    ("text", "where"),
    [
        ("schema = 'alula.model/2'", "schema"),
        ("name = 3", "name"),
        ("colour = 'red'", "colour"),
        ("values = {Cm_0 = 'x'}", "values"),
        ("not toml", "m.toml"),
    ],
)
def test_file_errors_name_the_key(tmp_path: Path, text: str, where: str) -> None:
    (tmp_path / "m.toml").write_text(text)
    with pytest.raises(BadInput) as caught:
        load_model(tmp_path / "m.toml")
    assert any(where in message.where for message in caught.value.messages)


def test_ready_models_load() -> None:
    folder = Path(__file__).parents[2] / "aircraft"
    model = load_model(folder / "sportstar_aero.toml")
    assert model.params["CL_alpha"] == 5.0702
    assert {n for n in model.assumed if not n.startswith("stall.")} < set(model.names)


def test_the_documented_example_is_a_model(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "model_file.md").read_text()
    (tmp_path / "m.toml").write_text(page.split("```toml\n")[1].split("```")[0])
    model = load_model(tmp_path / "m.toml")
    assert model.formulas["Cm"] == "1 + alpha + qhat + de + (alpha - 0.2)+^2"
    assert model.assumed == ("CL_q",)
