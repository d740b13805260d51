"""Several predictions to one, in one set of axes, and as a model that flies and serves as prior."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput
from alula.identify.likelihood.parameters import Prior
from alula.model import Reference, load_model, save_model
from alula.predict.axes import along, turn
from alula.predict.combine import FLOOR, added, as_flown, combine
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.flow import Flow
from alula.predict.lattice_and_bodies import lattice_and_bodies
from alula.predict.semi_empirical import semi_empirical
from alula.predict.slender_body import slender_bodies
from alula.predict.to_model import priors, to_model
from alula.simulate import airframe_of, linearize, modes_of, trim_level
from alula.simulate.airframe import core_model

SPORTSTAR = Path(__file__).parents[2] / "aircraft" / "sportstar.toml"


def given(method: str, alpha_deg: float = 0.0, **values: tuple[float, float]) -> Derivatives:
    estimates = {n: Estimate(v, se, method) for n, (v, se) in values.items()}
    return Derivatives(method, estimates, {"alpha_deg": str(alpha_deg)})


def test_two_that_agree_are_no_better_than_one() -> None:
    a, b = given("a", CL_alpha=(5.0, 0.5)), given("b", CL_alpha=(5.0, 0.5))
    found = combine([a, b]).values["CL_alpha"]
    assert (found.value, found.se) == pytest.approx((5.0, 0.5))


def test_disagreement_widens_the_error() -> None:
    """Weights 1/0.3^2 and 1/0.6^2, 4 to 1: mean 4.8, spread 0.4, own sqrt((4*.09+.36)/5)."""
    a, b = given("a", CL_alpha=(5.0, 0.3)), given("b", CL_alpha=(4.0, 0.6))
    found = combine([a, b]).values["CL_alpha"]
    assert found.value == pytest.approx(4.8)
    assert found.se == pytest.approx(np.sqrt(0.144 + 0.16))
    assert "a 5 +- 0.3" in found.source


def test_preferred_value_keeps_the_spread() -> None:
    a, b = given("a", CL_alpha=(5.0, 0.5)), given("b", CL_alpha=(4.0, 0.5))
    found = combine([a, b], prefer={"CL_alpha": "a"}).values["CL_alpha"]
    assert found.value == 5.0
    assert found.se == pytest.approx(np.sqrt(0.25 + 0.5))
    # A preferred method that does not give this derivative leaves the mean.
    c = given("c", Cm_q=(-9.0, 1.0))
    assert combine([a, c], prefer={"Cm_q": "a"}).values["Cm_q"].value == -9.0


def test_no_method_is_better_than_the_floor() -> None:
    found = combine([given("a", CL_alpha=(5.0, 1e-6))]).values["CL_alpha"]
    assert found.se == pytest.approx(FLOOR * 5.0)


def test_zero_by_symmetry_stays_zero() -> None:
    found = combine([given("a", CD_alpha=(0.0, 0.0)), given("b", CD_alpha=(0.0, 0.1))])
    assert found.values["CD_alpha"].value == 0.0


@pytest.mark.parametrize(
    ("sources", "prefer"),
    [([], {}), ([given("a"), given("a")], {}), ([given("a")], {"Cm_q": "b"})],
)
def test_combination_refused(sources: list[Derivatives], prefer: dict[str, str]) -> None:
    with pytest.raises(BadInput, match="combining predictions"):
        combine(sources, prefer=prefer)


def test_different_angles_are_said() -> None:
    found = combine([given("a", 0.0, Cl_p=(-0.5, 0.1)), given("b", 4.0, Cl_p=(-0.5, 0.1))])
    assert any("different angles of attack" in note for note in found.notes)


def test_parts_add_up() -> None:
    whole = added("whole", [given("wings", Cm_alpha=(-1.0, 0.3)),
                            given("body", Cm_alpha=(0.5, 0.4), CL_alpha=(0.1, 0.0))])  # fmt: skip
    assert whole.values["Cm_alpha"].value == pytest.approx(-0.5)
    assert whole.values["Cm_alpha"].se == pytest.approx(0.5)
    assert whole.values["CL_alpha"].value == 0.1


def test_like_with_like() -> None:
    d = given("a", Cm_q=(-11.0, 1.0), Cm_alphadot=(-4.0, 0.5), Cn_r=(-0.1, 0.01),
              Cn_betadot=(0.02, 0.01), CL_q=(8.0, 1.0))  # fmt: skip
    flown = as_flown(d)
    assert flown["Cm_q + Cm_alphadot"].value == pytest.approx(-15.0)
    assert flown["Cm_q + Cm_alphadot"].se == pytest.approx(1.5)
    assert flown["Cn_r - Cn_betadot"].value == pytest.approx(-0.12)
    assert flown["CL_q"].value == 8.0  # alone: named as what it is
    assert "Cm_alphadot" not in flown


def test_turn_of_axes_by_vectors() -> None:
    """The moment of any rolling, yawing and sideslipping motion is the same vector in both axes."""
    names = [
        "CY_beta",
        "CY_p",
        "CY_r",
        "Cl_beta",
        "Cl_p",
        "Cl_r",
        "Cn_beta",
        "Cn_p",
        "Cn_r",
        "Cl_da",
    ]
    rng = np.random.default_rng(3)
    stability = dict(zip(names, rng.normal(size=len(names)), strict=True))
    alpha = 0.3
    to, matrix = turn(names, alpha)
    body = dict(zip(to, matrix @ np.array(list(stability.values())), strict=True))
    c, s = np.cos(alpha), np.sin(alpha)
    beta, p, r, da = rng.normal(size=4)  # p, r along body axes
    p_s, r_s = c * p + s * r, c * r - s * p

    def total(v: dict[str, float], coefficient: str, p: float, r: float) -> float:
        parts = {"beta": beta, "p": p, "r": r, "da": da}
        return sum(v.get(f"{coefficient}_{n}", 0.0) * x for n, x in parts.items())

    l_s, n_s = total(stability, "Cl", p_s, r_s), total(stability, "Cn", p_s, r_s)
    assert total(body, "Cl", p, r) == pytest.approx(c * l_s - s * n_s)
    assert total(body, "Cn", p, r) == pytest.approx(s * l_s + c * n_s)
    assert total(body, "CY", p, r) == pytest.approx(total(stability, "CY", p_s, r_s))


def test_axes_there_and_back() -> None:
    d = given("a", 8.0, Cl_p=(-0.5, 0.0), Cl_r=(0.2, 0.0), Cn_p=(-0.05, 0.0), Cn_r=(-0.1, 0.0),
              CL_alpha=(5.0, 0.2))  # fmt: skip
    body = along(d, "model")
    assert body.axes == "model"
    assert body.values["CL_alpha"] == d.values["CL_alpha"]
    back = along(body, "stability")
    for name, e in d.values.items():
        assert back.values[name].value == pytest.approx(e.value)


def sportstar_model():
    aircraft = load_aircraft(SPORTSTAR)
    prediction = combine([semi_empirical(aircraft, Flow(V=45.0))])
    reference = Reference(aircraft.S, aircraft.b, aircraft.c)
    return aircraft, prediction, to_model(
        prediction, reference, aircraft.reference_point, name="predicted"
    )  # fmt: skip


def test_prediction_flies(tmp_path: Path) -> None:
    """Trimmed and linearized: oscillations that die out, as the real airplane's do."""
    aircraft, _, model = sportstar_model()
    airframe = airframe_of(aircraft)
    level = trim_level(airframe, model, 45.0, 900.0)
    assert level.residual < 1e-9
    # Where the handbook's own lift says: C_L of 560 kg at this air's density.
    assert 0.04 < level.alpha < 0.14
    modes = modes_of(
        linearize(core_model(airframe, model), level.state, level.inputs).longitudinal()
    )
    short = max(modes, key=lambda m: abs(m.eigenvalue))
    assert short.eigenvalue.real < 0.0
    assert abs(short.eigenvalue.imag) > 0.0
    save_model(model, tmp_path / "predicted.toml")
    again = load_model(tmp_path / "predicted.toml")
    assert again.params == pytest.approx(model.params)
    assert np.allclose(again.covariance, model.covariance)
    assert "semi-empirical" in again.provenance["method"]


def test_model_lumps_what_flight_does_not_tell_apart() -> None:
    _, prediction, model = sportstar_model()
    v = prediction.values
    assert model.params["Cm_q"] == pytest.approx(v["Cm_q"].value + v["Cm_alphadot"].value)
    assert "Cm_alphadot" not in model.params
    assert np.all(np.linalg.eigvalsh(model.covariance) > -1e-12)


def test_priors_are_what_estimators_take() -> None:
    _, prediction, model = sportstar_model()
    found = {n: Prior(*pair) for n, pair in priors(model).items()}
    assert found["CL_alpha"].mean == prediction.values["CL_alpha"].value
    assert found["CL_alpha"].se == pytest.approx(prediction.values["CL_alpha"].se)
    assert all(p.se > 0.0 for p in found.values())
    assert priors(replace(model, covariance=None)) == {}


def test_model_without_lift_is_refused() -> None:
    with pytest.raises(BadInput, match="CL_alpha"):
        to_model(given("a", Cm_q=(-9.0, 1.0)), Reference(1.0, 1.0, 1.0), np.zeros(3), name="x")


def test_a_value_near_zero_is_not_known_exactly() -> None:
    """A tenth of almost nothing is no error bar: the derivative's ordinary size counts."""
    low = given("a", Cl_beta=(-0.001, 1e-4))
    assert combine([low]).values["Cl_beta"].se == pytest.approx(FLOOR * 0.1)


def test_lattice_with_bodies_leaves_out_what_it_does_not_know() -> None:
    aircraft = load_aircraft(SPORTSTAR)
    known = {"CL_alpha": (5.0, 0.5), "Cm_alpha": (-1.0, 0.1), "Cl_p": (-0.5, 0.05)}
    lattice = given("vortex_lattice", CD_alpha=(0.1, 0.1), Cl_r=(0.01, 0.0), **known)
    whole = lattice_and_bodies(aircraft, lattice).values
    assert not {"CD_alpha", "Cl_r", "Cm_alphadot", "Cn_betadot"} & whole.keys()
    assert whole["Cl_p"].value == -0.5
    # A closed body's pitch damping and its lag cancel: nothing is left to be mistaken for damping.
    assert whole["Cm_q"].value == pytest.approx(0.0, abs=1e-6)
    # The body overturns: Multhopp's moment, between none and that of slender bodies in free air.
    alone = slender_bodies(aircraft).values["Cm_alpha"].value
    assert 0.0 < whole["Cm_alpha"].value + 1.0 < 2.0 * alone
    loaded = replace(lattice, conditions={"alpha_deg": "4"})
    assert "Cl_r" in lattice_and_bodies(aircraft, loaded).values
