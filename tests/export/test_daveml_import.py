"""DAVE-ML models as aerodynamic models: against the evaluator of the files themselves."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.export.daveml_import import import_daveml
from alula.export.daveml_read import parse_daveml, read_daveml
from alula.model import AeroModel, Reference
from data import data
from export.daveml_texts import REFERENCE, file, given, math, output, table

FT, DEG = 0.3048, np.pi / 180.0
ALPHA = given("angleOfAttack", "a", "deg")
BETA = given("angleOfSideslip", "be", "rad")
Q = given("bodyAngularRate_Pitch", "q", "rad_s")
V = given("trueAirspeed", "v", "ft_s")
CM = "aeroBodyMomentCoefficient_Pitch"
T = '<variableDef name="t" varID="t" units="nd"/>'


def f16() -> tuple:
    dave = read_daveml(data("nesc_6dof", "models", "F16_aero.dml"))
    return dave, import_daveml(dave).model


def test_f16_is_the_file_at_random_points() -> None:
    dave, model = f16()
    random, n = np.random.default_rng(0), 5000
    # beyond the tables too: alpha -10 to 45 deg, beta 30, elevator 24
    at = {name: random.uniform(-1.0, 1.0, n) for name in ("alpha", "beta", "de", "da", "dr")}
    p, q, r = random.uniform(-2.0, 2.0, (3, n))
    speed = random.uniform(30.0, 300.0, n)
    theirs = dave.evaluate(
        {"vt": speed / FT, "alpha": at["alpha"] / DEG, "beta": at["beta"] / DEG, "p": p, "q": q,
         "r": r, "el": at["de"] / DEG, "ail": at["da"] / DEG, "rdr": at["dr"] / DEG}
    )  # fmt: skip
    b, c = model.reference.b, model.reference.c
    hats = {"phat": p * b / 2 / speed, "qhat": q * c / 2 / speed, "rhat": r * b / 2 / speed}
    ours = model.evaluate({"V": speed, **at, **hats})
    for name, id in zip(
        ("CX", "CY", "CZ", "Cl", "Cm", "Cn"), ("cx", "cy", "cz", "cl", "cm", "cn"), strict=True
    ):
        # the same sums in another order; coefficients reach 6
        np.testing.assert_allclose(ours[name], theirs[id], rtol=0, atol=1e-12, err_msg=name)


def test_f16_reads_as_a_person_would_write_it() -> None:
    _, model = f16()
    assert model.formulas["CX"] == "cxt(de, alpha) + qhat*cxq(alpha)"
    assert model.formulas["Cm"] == "cmt(de, alpha) + qhat*cmq(alpha)"
    assert model.params["Cm_q_cmq"] == 1.0
    np.testing.assert_allclose(
        [model.reference.S, model.reference.b, model.reference.c],
        [300 * FT**2, 30 * FT, 11.32 * FT],
        rtol=1e-15,
    )
    np.testing.assert_allclose(model.validity["alpha"], [-10 * DEG, 45 * DEG], rtol=1e-15)
    # +TED, left roll, +TEL are Alula's signs: a positive deflection gives a negative moment
    still = {n: np.zeros(1) for n in ("alpha", "beta", "phat", "qhat", "rhat")}
    for control, moment in (("de", "Cm"), ("da", "Cl"), ("dr", "Cn")):
        at = {"de": np.zeros(1), "da": np.zeros(1), "dr": np.zeros(1)}
        neutral = model.evaluate({**still, **at})[moment][0]
        assert model.evaluate({**still, **at, control: np.array([0.1])})[moment][0] < neutral


def test_f16_has_its_slope_over_sideslip_at_zero() -> None:
    # The file takes a table over |beta| with the sign of beta; as an odd table it has a slope at 0.
    _, model = f16()
    assert "sign" not in "".join(model.formulas.values())
    e = 1e-7
    at = {n: np.zeros(3) for n in ("alpha", "phat", "qhat", "rhat", "de", "da", "dr")}
    Cn = model.evaluate({**at, "beta": np.array([-e, 0.0, e])})["Cn"]
    # from the file: Cn0 at alpha 0, beta 5 deg is 0.018; odd and linear between
    np.testing.assert_allclose(Cn / (e / DEG), [-0.018 / 5, 0.0, 0.018 / 5], rtol=1e-6)


def test_brick_is_three_dampings() -> None:
    model = import_daveml(read_daveml(data("nesc_6dof", "models", "brick_aero.dml"))).model
    assert model.params == {"CD_0": 0.01, "Cl_p": -1.0, "Cm_q": -1.0, "Cn_r": -1.0}


def test_geometry_is_asked_for() -> None:
    dave = read_daveml(data("nesc_6dof", "models", "cannonball_aero.dml"))
    with pytest.raises(BadInput, match="no b and no c"):
        import_daveml(dave)
    model = import_daveml(dave, reference=Reference(0.0182, 0.15, 0.15)).model
    assert model.params == {"CD_0": 0.1}


def small(content: str, *parts: str, more: str = 'sign="ANU"', **options) -> AeroModel:
    text = file(*(parts or (ALPHA, BETA, Q, V)), REFERENCE, output(CM, content, more))
    return import_daveml(parse_daveml(text), **options).model


def apply(op: str, *args: str) -> str:
    return f"<apply><{op}/>{''.join(args)}</apply>"


A, B = "<ci>a</ci>", "<ci>be</ci>"
ABOVE = apply("gt", A, "<cn>0</cn>")


@pytest.mark.parametrize(
    ("content", "params"),
    [
        (apply("divide", apply("times", "<ci>q</ci>", "<ci>c</ci>"), "<ci>v</ci>"), {"Cm_q": 2.0}),
        (apply("power", apply("plus", B, "<cn>3</cn>"), "<cn>2</cn>"),
         {"Cm_beta2": 1.0, "Cm_beta": 6.0, "Cm_0": 9.0}),
        (apply("abs", apply("times", "<cn>-2</cn>", B)), {"Cm_absbeta": 2.0}),
        (apply("max", apply("minus", B, "<cn>0.2</cn>"), "<cn>0</cn>"), {"Cm_(beta-0.2)+": 1.0}),
        (apply("max", apply("minus", "<cn>0.25</cn>", B), "<cn>0</cn>"),
         {"Cm_0": 0.25, "Cm_beta": -1.0, "Cm_(beta-0.25)+": 1.0}),
        (apply("min", B, "<cn>0.5</cn>"), {"Cm_beta": 1.0, "Cm_(beta-0.5)+": -1.0}),
        (f"<piecewise><piece>{B}{ABOVE}</piece><otherwise><cn>0</cn></otherwise></piecewise>",
         {"Cm_beta": 0.5, "Cm_signalpha_beta": 0.5}),
        (f"<piecewise><piece>{A}{ABOVE}</piece><otherwise>{apply('minus', A)}</otherwise>"
         "</piecewise>", {"Cm_absalpha": 1.0 / DEG}),
        (apply("minus", B, B), {}),
        (apply("plus", A, apply("sin", "<cn>0</cn>")), {"Cm_alpha": 1.0 / DEG}),
    ],
)  # fmt: skip
def test_expansions(content: str, params: dict[str, float]) -> None:
    found = small(content).params
    assert found.keys() == params.keys()
    for name, value in params.items():
        assert found[name] == pytest.approx(value, rel=1e-14)  # rounding


@pytest.mark.parametrize(
    ("content", "more", "word"),
    [
        (apply("sin", A), 'sign="ANU"', "'sin' of a variable"),
        (apply("divide", "<cn>1</cn>", apply("plus", A, B)), 'sign="ANU"', "division by a sum"),
        (apply("divide", B, A), 'sign="ANU"', "power -1"),
        (apply("power", A, "<cn>0.5</cn>"), 'sign="ANU"', "power 0.5"),
        (apply("abs", apply("plus", A, B)), 'sign="ANU"', "absolute value"),
        (f"<piecewise><piece>{A}{apply('gt', A, '<cn>1</cn>')}</piece><otherwise>{B}</otherwise>"
         "</piecewise>", 'sign="ANU"', "condition"),
        ("<ci>q</ci>", 'sign="ANU"', "rates"),
        (A, 'sign="ANU" maxValue="3"', "maxValue 3"),
        (A, 'sign="sideways"', "'sideways'"),
    ],
)  # fmt: skip
def test_what_is_no_sum_of_products_is_refused_by_name(content: str, more: str, word: str) -> None:
    with pytest.raises(BadInput) as caught:
        small(content, more=more)
    assert word in str(caught.value)
    assert "'out'" in str(caught.value)


@pytest.mark.parametrize(
    ("name", "sign", "factor"),
    [
        ("elevatorDeflection", "+TEU", -1.0),
        ("elevatorDeflection", "trailing edge down", 1.0),
        ("aileronDeflection", "+RWD", -1.0),
        ("rudderDeflection", "TER", -1.0),
        ("angleOfSideslip", "ANR", -1.0),
    ],
)
def test_signs_come_into_alulas_notation(name: str, sign: str, factor: float) -> None:
    one = given(name, "x", "deg", f'sign="{sign}"')
    (value,) = small("<ci>x</ci>", one).params.values()
    assert value == pytest.approx(factor / DEG, rel=1e-15)
    (value,) = small("<ci>x</ci>", one, more='sign="AND"').params.values()
    assert value == pytest.approx(-factor / DEG, rel=1e-15)


def test_a_table_against_the_axis_is_turned() -> None:
    # the argument is -2 alpha: breakpoints 0 10 20 are alpha 0, -5, -10 deg
    twice = math(apply("times", "<cn>-2</cn>", A))
    turned = f'<variableDef name="x" varID="x" units="deg">{twice}</variableDef>'
    text = file(ALPHA, turned, T, REFERENCE, output(CM, "<ci>t</ci>"), table("x"))
    model = import_daveml(parse_daveml(text)).model
    at = np.array([-12.0, -10.0, -2.5, 0.0, 3.0]) * DEG
    np.testing.assert_allclose(model.evaluate({"alpha": at})["Cm"], [2, 2, 2, 1, 1], rtol=1e-14)


@pytest.mark.parametrize(
    ("values", "formula"),
    [("0, 3, 2", "t(beta)"), ("1, 3, 2", "sign(beta)*t(beta)")],
)
def test_tables_over_an_absolute_value(values: str, formula: str) -> None:
    size = f'<variableDef name="x" varID="x" units="rad">{math(apply("abs", B))}</variableDef>'
    absolute = T.replace('"t"', '"abst"')
    below = apply("lt", B, "<cn>0</cn>")
    signed = (
        f"<piecewise><piece>{apply('minus', '<ci>abst</ci>')}{below}</piece>"
        "<otherwise><ci>abst</ci></otherwise></piecewise>"
    )
    text = file(BETA, size, absolute, REFERENCE, output(CM, signed),
                table("x", values=values, output="abst"))  # fmt: skip
    dave = parse_daveml(text)
    model = import_daveml(dave).model
    assert model.formulas["Cm"].replace("abst", "t") == formula
    at = np.array([-25.0, -15.0, -4.0, 4.0, 15.0])
    np.testing.assert_allclose(
        model.evaluate({"beta": at})["Cm"], dave.evaluate({"be": at})["out"], rtol=1e-15
    )


def test_uncertainty_goes_through_the_products() -> None:
    def k(id: str, value: float, sigma: float, more: str = "") -> str:
        return (
            f'<variableDef name="{id}" varID="{id}" units="nd" initialValue="{value}"><uncertainty '
            f'effect="additive"><normalPDF numSigmas="1"><bounds>{sigma}</bounds>{more}'
            "</normalPDF></uncertainty></variableDef>"
        )

    parts = (BETA, k("k", 2.0, 0.1), k("m", 5.0, 0.3, '<correlation varID="k" corrCoef="0.5"/>'))
    content = apply("plus", apply("times", "<ci>k</ci>", "<ci>m</ci>", B), "<ci>k</ci>")
    model = small(content, *parts)
    assert model.names == ("Cm_beta", "Cm_0")
    assert model.covariance is not None
    # d(km) = 5 dk + 2 dm with var 0.01, 0.09 and cov 0.015; cov(km, k) = 5 0.01 + 2 0.015
    np.testing.assert_allclose(model.covariance, [[0.91, 0.08], [0.08, 0.01]], rtol=1e-14)


def test_signals_without_standard_names_are_named_by_the_user() -> None:
    one = given("myAngle", "x", "rad")
    with pytest.raises(BadInput, match="'myAngle'"):
        small("<ci>x</ci>", one)
    assert small("<ci>x</ci>", one, names={"x": "da"}).params == {"Cm_da": 1.0}
