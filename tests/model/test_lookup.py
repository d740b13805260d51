"""Lookup tables: against SciPy, against polynomials, in formulas and in the file."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from alula.base.messages import BadInput
from alula.model import (
    LookupTable,
    Reference,
    Stall,
    aero_model,
    evaluate_in_core,
    load_model,
    lookup_table,
    model_text,
    parse,
    save_model,
)

AXES = {"alpha": [-0.2, 0.0, 0.1, 0.5], "de": [-0.4, 0.0, 0.3], "mach": [0.1, 0.5, 0.6, 0.7, 0.9]}


def table(count: int, interpolation: str = "linear", outside: str = "hold") -> LookupTable:
    axes = dict(list(AXES.items())[:count])
    values = np.random.default_rng(count).normal(size=[len(b) for b in axes.values()])
    return lookup_table(axes, values, interpolation, outside)  # type: ignore[arg-type]


def points(count: int, wide: float) -> list[np.ndarray]:
    random = np.random.default_rng(9)
    ends = [(b[0] - wide, b[-1] + wide) for b in AXES.values()]
    return [random.uniform(*ends[i], 200) for i in range(count)]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_linear_is_scipys(count: int) -> None:
    made, at = table(count), points(count, 0.0)
    theirs = RegularGridInterpolator(made.breakpoints, made.values)(np.array(at).T)
    np.testing.assert_allclose(made.evaluate(*at), theirs, rtol=0, atol=1e-14)  # rounding


@pytest.mark.parametrize("count", [1, 2, 3])
def test_line_goes_on_as_scipy_extrapolates(count: int) -> None:
    made, at = table(count, outside="line"), points(count, 0.3)
    theirs = RegularGridInterpolator(
        made.breakpoints, made.values, bounds_error=False, fill_value=None
    )(np.array(at).T)
    np.testing.assert_allclose(made.evaluate(*at), theirs, rtol=0, atol=1e-12)  # far outside


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_hold_is_the_value_at_the_edge(interpolation: str) -> None:
    made, at = table(2, interpolation), points(2, 0.5)
    inside = [np.clip(x, b[0], b[-1]) for x, b in zip(at, made.breakpoints, strict=True)]
    np.testing.assert_array_equal(made.evaluate(*at), made.evaluate(*inside))


def test_cubic_gives_parabolas_back() -> None:
    # Slopes of parabolas through three neighbors are exact for a parabola, on any spacing.
    alpha, mach = (np.array(AXES[n]) for n in ("alpha", "mach"))

    def f(a: np.ndarray, m: np.ndarray) -> np.ndarray:
        return 1.0 - 3.0 * a + 7.0 * a * a + 2.0 * m * a - m * m + 4.0 * a * a * m * m

    made = lookup_table(
        {"alpha": alpha, "mach": mach}, f(alpha[:, None], mach[None, :]), "cubic", "line"
    )
    random = np.random.default_rng(1)
    a, m = random.uniform(-0.2, 0.5, 100), random.uniform(0.1, 0.9, 100)
    np.testing.assert_allclose(made.evaluate(a, m), f(a, m), rtol=0, atol=1e-14)  # rounding


def test_cubic_goes_through_its_values_and_is_smooth() -> None:
    made = table(1, "cubic", "line")
    (b,) = made.breakpoints
    np.testing.assert_allclose(made.evaluate(b), made.values, rtol=0, atol=1e-15)
    e = 1e-6
    left = (made.evaluate(b) - made.evaluate(b - e)) / e
    right = (made.evaluate(b + e) - made.evaluate(b)) / e
    # one-sided differences err by half the curvature (below 1000 here) times the step
    np.testing.assert_allclose(left, right, rtol=0, atol=2e-3)


@pytest.mark.parametrize(
    ("axes", "values", "word"),
    [
        ({"alpha": [0.0, 1.0]}, [0.0, float("nan")], "nan at [1]"),
        ({"alpha": [0.0, 1.0]}, [0.0, float("inf")], "inf"),
        ({"alpha": [0.0, float("nan")]}, [0.0, 1.0], "not finite"),
        ({"alpha": [0.0, 0.0]}, [0.0, 1.0], "increasing"),
        ({"alpha": [1.0, 0.0]}, [0.0, 1.0], "1.0 before 0.0"),
        ({"alpha": [0.0]}, [0.0], "2 to 1000"),
        ({"alpha": [0.0, 1.0]}, [0.0, 1.0, 2.0], "shape (3,)"),
        ({"alpha": [0.0, 1.0], "de": [0.0, 1.0]}, [[0.0, 1.0], [2.0]], "different length"),
        ({"gamma": [0.0, 1.0]}, [0.0, 1.0], "'gamma'"),
        ({}, [], "one to 3"),
        ({n: [0.0, 1.0] for n in ("V", "alpha", "beta", "de")}, np.zeros((2, 2, 2, 2)), "found 4"),
    ],
)
def test_wrong_tables_are_refused(axes: dict, values: list, word: str) -> None:
    with pytest.raises(BadInput) as caught:
        lookup_table(axes, values, where="m.toml, tables.cxt")
    assert word in str(caught.value)
    assert caught.value.messages[0].where == "m.toml, tables.cxt"


def model_with_tables():
    return aero_model(
        "tables",
        {"CX": "cxt(alpha, de) + qhat*cxq(alpha) + sign(beta)*alpha", "Cm": "1 + cxq(alpha)^2*de"},
        {"CX_cxt": 1.0, "CX_q_cxq": 2.0, "CX_alpha_signbeta": 3.0, "Cm_0": 0.1, "Cm_de_cxq2": -1.0},
        Reference(10.0, 8.0, 1.25),
        tables={"cxt": table(2), "cxq": table(1, "cubic", "line")},
        stall=Stall(15.0, 0.25, 0.2, 0.05, 5.0, -0.1, 0.2, -0.1, 2.0, 0.01),
        assumed=("CX_cxt", "stall.a1"),
    )


def test_tables_and_signs_in_formulas() -> None:
    model = model_with_tables()
    random = np.random.default_rng(3)
    v = {n: random.uniform(-0.3, 0.3, 50) for n in ("alpha", "beta", "de", "qhat")}
    cxt, cxq = (
        table(2).evaluate(v["alpha"], v["de"]),
        table(1, "cubic", "line").evaluate(v["alpha"]),
    )
    found = model.evaluate(v)
    expected = cxt + 2.0 * v["qhat"] * cxq + 3.0 * v["alpha"] * np.where(v["beta"] < 0, -1.0, 1.0)
    np.testing.assert_allclose(found["CX"], expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(found["Cm"], 0.1 - v["de"] * cxq * cxq, rtol=0, atol=1e-14)


def test_file_gives_tables_and_stall_back(tmp_path: Path) -> None:
    model = model_with_tables()
    save_model(model, tmp_path / "m.toml")
    back = load_model(tmp_path / "m.toml")
    assert back.tables == model.tables
    assert back.stall == model.stall
    assert back.terms == model.terms
    assert back.assumed == model.assumed
    assert model_text(back) == model_text(model)


@pytest.mark.parametrize("hole", ["nan", "inf", "'x'", "[1.0]"])
def test_a_hole_in_a_files_table_is_named(tmp_path: Path, hole: str) -> None:
    save_model(model_with_tables(), tmp_path / "m.toml")
    text = (tmp_path / "m.toml").read_text()
    first = re.search(r"\[tables.\"cxq\"\](.*?)values = \[([^,]*),", text, re.S)
    assert first is not None
    damaged = text[: first.start(2)] + hole + text[first.end(2) :]
    (tmp_path / "m.toml").write_text(damaged)
    with pytest.raises(BadInput) as caught:
        load_model(tmp_path / "m.toml")
    assert caught.value.messages[0].where.endswith("m.toml, tables.cxq")


def test_tables_that_differ_are_not_equal() -> None:
    assert table(1) == table(1)
    assert table(1) != table(1, "cubic")
    assert table(1) != table(2)


@pytest.mark.parametrize(
    ("formula", "position", "word"),
    [
        ("cxt(de, alpha)", 5, "cxt(alpha, de)"),
        ("cxt(alpha)", 10, "','"),
        ("cxt", 4, "'('"),
        ("1 + cxtt(alpha, de)", 5, "'cxt'"),
        ("sign(alpha*beta)", 11, "')'"),
    ],
)
def test_mistakes_in_calls_are_named(formula: str, position: int, word: str) -> None:
    with pytest.raises(BadInput) as caught:
        parse(formula, {"cxt": table(2)})
    assert f"character {position}" in caught.value.messages[0].where
    assert word in str(caught.value)


@pytest.mark.parametrize("name", ["alpha", "p", "abs", "2x", "a b", ""])
def test_names_that_no_formula_can_call_are_refused(name: str) -> None:
    with pytest.raises(BadInput, match="lookup_table"):
        aero_model("m", {}, {}, Reference(1.0, 1.0, 1.0), tables={name: table(1)})


def test_a_table_must_not_read_like_a_product() -> None:
    with pytest.raises(BadInput, match="CX_alpha_de"):
        aero_model(
            "m",
            {"CX": "alpha*de + alpha_de(alpha)"},
            {"CX_alpha_de": 1.0},
            Reference(1.0, 1.0, 1.0),
            tables={"alpha_de": table(1)},
        )


@pytest.mark.parametrize(
    "changes",
    [{"a1": 0.0}, {"tau1": -1.0}, {"CD_X": float("nan")}, {"y_station": 0.0}],
)
def test_impossible_stalls_are_refused(changes: dict) -> None:
    good = {
        "a1": 15.0,
        "alpha_star": 0.25,
        "tau1": 0.2,
        "tau2": 0.05,
        "CL_alpha": 5.0,
        "alpha_0": -0.1,
    }
    split = {"y_station": 2.0, "alpha_star_difference": 0.01}
    with pytest.raises(BadInput) as caught:
        aero_model("m", {}, {}, Reference(1, 1, 1), stall=Stall(**{**good, **split, **changes}))
    named = "alpha_star_difference" if "y_station" in changes else next(iter(changes))
    assert named in caught.value.messages[0].found


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
@pytest.mark.parametrize("outside", ["hold", "line"])
def test_core_looks_up_as_numpy_does(interpolation: str, outside: str) -> None:
    tables = {f"t{k}": table(k, interpolation, outside) for k in (1, 2, 3)}
    model = aero_model(
        "tables",
        {"CX": "t3(alpha, de, mach) + t1(alpha)^2*sign(beta)", "Cm": "t2(alpha, de)*t1(alpha)"},
        {"CX_t3": 1.0, "CX_signbeta_t12": 2.0, "Cm_t1_t2": -3.0},
        Reference(10.0, 8.0, 1.25),
        tables=tables,
    )
    alpha, de, mach = points(3, 0.3)
    beta = np.where(np.arange(len(alpha)) % 3 == 0, 0.0, alpha)
    variables = {"alpha": alpha, "de": de, "mach": mach, "beta": beta}
    here, core = model.evaluate(variables), evaluate_in_core(model, variables)
    for name in here:
        # rounding of 64 products; cubics that go on as lines reach 1000
        np.testing.assert_allclose(core[name], here[name], rtol=1e-11, atol=1e-11)
