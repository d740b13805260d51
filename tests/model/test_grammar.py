"""Formulas as text: what they mean, and how mistakes are told."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from alula.base.messages import BadInput
from alula.model import VARIABLES, parse, reference_scales, regressors


@pytest.mark.parametrize(
    ("formula", "names"),
    [
        ("1 + alpha + qhat + de", ["Cm_0", "Cm_alpha", "Cm_q", "Cm_de"]),
        ("alpha^2 + alpha*alpha*alpha", ["Cm_alpha2", "Cm_alpha3"]),
        ("de*alpha + alpha*mach", ["Cm_alpha_de", "Cm_alpha_mach"]),
        ("beta*dr + phat + rhat", ["Cm_beta_dr", "Cm_p", "Cm_r"]),
        ("abs(beta) + abs(beta)**2", ["Cm_absbeta", "Cm_absbeta2"]),
        ("(alpha - 0.2)+^2 + (alpha-.2)+", ["Cm_(alpha-0.2)+2", "Cm_(alpha-0.2)+"]),
        ("(beta + 1e-1)+*de", ["Cm_(beta+0.1)+_de"]),
        ("1*alpha", ["Cm_alpha"]),
        ("  alpha\n + 1 ", ["Cm_alpha", "Cm_0"]),
    ],
)
def test_names(formula: str, names: list[str]) -> None:
    assert [term.name("Cm") for term in parse(formula)] == names


def test_regressors_are_the_products() -> None:
    alpha, de, beta = np.array([0.1, 0.3]), np.array([-0.2, 0.1]), np.array([-0.1, 0.2])
    names, X = regressors(
        "CY",
        "1 + alpha + alpha^2*de + abs(beta) + (alpha - 0.2)+^2",
        {"alpha": alpha, "de": de, "beta": beta},
    )
    assert names == ("CY_0", "CY_alpha", "CY_alpha2_de", "CY_absbeta", "CY_(alpha-0.2)+2")
    expected = [[1, 1], [0.1, 0.3], [-0.002, 0.009], [0.1, 0.2], [0, 0.01]]
    np.testing.assert_allclose(X.T, expected, rtol=1e-12)  # rounding only


@pytest.mark.parametrize(
    ("formula", "code", "position", "word"),
    [
        ("1 + q", "unknown_term", 5, "qhat"),
        ("1 + alpah", "unknown_term", 5, "'alpha'"),
        ("1 + gamma", "unknown_term", 5, "alpha, beta"),
        ("1 + alpha + alpha", "duplicate_term", 13, "once"),
        ("alpha*de + de*alpha", "duplicate_term", 12, "once"),
        ("1 - alpha", "formula_syntax", 3, "'+'"),
        ("2*alpha", "formula_syntax", 1, "constant 1"),
        ("alpha +", "formula_syntax", 8, "the end"),
        ("(alpha - 0.2)^2", "formula_syntax", 14, "'+'"),
        ("abs(alpha", "formula_syntax", 10, "')'"),
        ("abs(alpha*beta)", "formula_syntax", 10, "')'"),
        ("alpha^0", "formula_syntax", 7, "power"),
        ("alpha^2.5", "formula_syntax", 7, "power"),
        ("(alpha - 1e999)+", "formula_syntax", 10, "knot"),
        ("alpha de", "formula_syntax", 7, "'+'"),
        ("__import__('os')", "unknown_term", 1, "__import__"),
    ],
)
def test_mistakes_name_formula_and_position(
    formula: str, code: str, position: int, word: str
) -> None:
    with pytest.raises(BadInput) as caught:
        parse(formula)
    message = caught.value.messages[0]
    assert message.code == code
    assert f"'{formula}', character {position}" in message.where
    assert word in str(message)


@pytest.mark.parametrize("formula", ["", "   ", "alpha + " * 1000])
def test_empty_and_endless_formulas_are_refused(formula: str) -> None:
    with pytest.raises(BadInput):
        parse(formula)


def test_missing_variable_is_named() -> None:
    with pytest.raises(BadInput, match="'de'"):
        regressors("Cm", "1 + de", {"alpha": np.zeros(3)})


def test_reference_scale() -> None:
    assert reference_scales("Cn", "1~0.001 + beta + da~2e-3") == {"Cn_0": 0.001, "Cn_da": 0.002}


@given(st.text(alphabet="1 +*^().-~absalphbetq02e\n", max_size=40) | st.text(max_size=30))
def test_any_text_is_a_formula_or_refused(text: str) -> None:
    try:
        terms = parse(text)
    except BadInput:
        return
    # What was read can be written and read again.
    assert parse(" + ".join(term.formula for term in terms)) == terms
    assert all(f.variable in VARIABLES for term in terms for f in term.factors)
