"""Pools of candidate terms from a line of text."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from alula.base.messages import BadInput
from alula.identify.regression.candidates import candidates


@pytest.mark.parametrize(
    ("pool", "terms"),
    [
        ("alpha + qhat*de", "alpha, qhat*de"),
        ("(1, alpha, de)^2", "1, alpha, de, alpha^2, alpha*de, de^2"),
        ("(alpha, de)^2", "alpha^2, alpha*de, de^2"),  # without 1: of that order only
        ("(alpha - [0.1, 0.2])+^2", "(alpha - 0.1)+^2, (alpha - 0.2)+^2"),
        ("(alpha + [0.1])+ + de", "(alpha + 0.1)+, de"),
        ("(alpha - 0.2)++de", "(alpha - 0.2)+, de"),
        ("(1, mach)*(alpha, abs(beta))", "alpha, abs(beta), alpha*mach, abs(beta)*mach"),
        ("(1, (alpha - [0.1, 0.2])+)*qhat", "qhat, (alpha - 0.1)+*qhat, (alpha - 0.2)+*qhat"),
        ("alpha + alpha*1 + (1, alpha)", "alpha, 1"),  # each once
        ("beta**2 + (1,beta)**3", "beta^2, 1, beta, beta^3"),
    ],
)
def test_pool(pool, terms):
    assert ", ".join(t.formula for t in candidates(pool)) == terms


@pytest.mark.parametrize(
    ("pool", "code"),
    [
        (" ", "candidates_syntax"),
        ("(alpha", "candidates_syntax"),
        ("alpha)(", "candidates_syntax"),
        ("alpha + ", "candidates_syntax"),
        ("()", "candidates_syntax"),
        ("(1, alpha)^x", "candidates_syntax"),
        ("(alpha + beta, de)^2", "candidates_syntax"),
        ("(alpha^5)^2", "candidates_syntax"),  # a power over 9
        ("(" * 1000 + ")" * 1000, "candidates_syntax"),
        ("alpha - 2", "formula_syntax"),
        ("(alpha - [])+", "formula_syntax"),
        ("alfa", "unknown_term"),
        ("(1, alpha, beta, phat, qhat, rhat)^9", "too_many_candidates"),
    ],
)
def test_what_cannot_be_read_is_refused(pool, code):
    with pytest.raises(BadInput, match=code):
        candidates(pool)


@given(st.text(alphabet="(1,alphde )^2*+-[].0", max_size=40))
def test_any_text_gives_terms_or_a_refusal(pool):
    try:
        terms = candidates(pool)
    except BadInput:
        return
    assert terms
    assert len({t.factors for t in terms}) == len(terms)
