"""Model formulas as text: `1 + alpha + qhat + de + alpha*de + abs(beta) + (alpha - 0.2)+^2`.

    formula = term { "+" term }
    term    = factor { "*" factor } [ "~" number ]      ~: the size below which it does not matter
    factor  = base [ "^" whole number 1 to 9 ]
    base    = "1" | variable | ("abs" | "sign") "(" variable ")"
            | "(" variable ("-" | "+") number ")" "+" | table "(" variable { "," variable } ")"

The drag's formula may name the lift coefficient, `CD = "1 + CL^2"`, whose terms come first then. A
table is one of the model's, called with its own axes in their order: `cxt(alpha, de)`. A formula
names terms only; their values are what identification finds, so there are no factors other than 1
and no minus signs between terms. Read by a parser of its own, never by `eval`.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.model.lookup import LookupTable
from alula.model.terms import LIFT, VARIABLES, Factor, Term, product

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<sign>\*\*|.))",
    re.ASCII,
)
_LONGEST = 4000  # characters; the largest model of 64 terms stays far below


class _Token(NamedTuple):
    kind: str  # 'number', 'name', 'sign' or 'end'
    text: str
    position: int  # 1-based


class _Parser:
    def __init__(self, formula: str, tables: Mapping[str, LookupTable]) -> None:
        self.formula = formula
        self.tables = tables
        self.tokens: list[_Token] = []
        at = 0
        end = len(formula.rstrip())
        while at < end:
            match = _TOKEN.match(formula, at)
            if match is None:  # a line break where a sign was expected
                raise self.error("unreadable", at + 1, "a term", repr(formula[at]))
            kind = match.lastgroup or "sign"
            self.tokens.append(_Token(kind, match[kind], match.start(kind) + 1))
            at = match.end()
        self.tokens.append(_Token("end", "the end", end + 1))
        self.next = 0

    def error(self, code: str, position: int, expected: str, found: str, do: str = "") -> BadInput:
        return refuse(
            code,
            where=f"formula '{self.formula}', character {position}",
            expected=expected,
            found=found,
            do=do or "Write sums of products, such as '1 + alpha + qhat + alpha*de'.",
        )

    @property
    def token(self) -> _Token:
        return self.tokens[self.next]

    def take(self) -> _Token:
        token = self.token
        self.next += token.kind != "end"
        return token

    def accept(self, *signs: str) -> bool:
        if self.token.kind == "sign" and self.token.text in signs:
            self.next += 1
            return True
        return False

    def expect(self, sign: str) -> None:
        if not self.accept(sign):
            raise self.unexpected(f"'{sign}'")

    def unexpected(self, expected: str, do: str = "") -> BadInput:
        token = self.token
        found = token.text if token.kind == "end" else f"'{token.text}'"
        return self.error("formula_syntax", token.position, expected, found, do)

    def sum(self) -> tuple[Term, ...]:
        terms: list[Term] = []
        while True:
            position = self.token.position
            term = self.product()
            if any(t.factors == term.factors for t in terms):
                raise self.error(
                    "duplicate_term", position, "each term once", f"'{term.formula}' again",
                    "Remove one of the two; the data cannot tell them apart.",
                )  # fmt: skip
            terms.append(term)
            if self.token.kind == "end":
                return tuple(terms)
            if not self.accept("+"):
                raise self.unexpected("'+' or '*'", "Terms are joined by '+'; values carry signs.")

    def product(self) -> Term:
        factors = self.factor()
        while self.accept("*"):
            factors += self.factor()
        scale = self.number("a number behind '~'") if self.accept("~") else None
        return product(factors, scale)

    def factor(self) -> list[Factor]:
        token = self.take()
        if token.kind == "number":
            if float(token.text) != 1.0:
                raise self.error(
                    "formula_syntax", token.position, "a variable or the constant 1",
                    f"'{token.text}'",
                    "Leave numbers out: each term gets its own value from the data.",
                )  # fmt: skip
            if self.accept("^", "**"):
                self.power_number()
            return []
        if token.text in ("abs", "sign"):
            self.expect("(")
            base = Factor(self.variable(), kind="abs" if token.text == "abs" else "sign")
            self.expect(")")
        elif token.kind == "name" and token.text in self.tables:
            base = self.table(token)
        elif token.kind == "name":
            base = Factor(self.known(token))
        elif token.text == "(":
            variable = self.variable()
            sign = -1.0 if self.token.text == "+" else 1.0
            if not self.accept("+", "-"):
                raise self.unexpected("'-' or '+' and the knot of a spline")
            knot = sign * self.number("the knot of a spline")
            self.expect(")")
            self.expect("+")
            base = Factor(variable, kind="ramp", knot=knot + 0.0)  # no negative zero
        else:
            self.next -= token.kind != "end"
            raise self.unexpected("a variable, 1, abs(...) or (variable - knot)+")
        if not self.accept("^", "**"):
            return [base]
        return [replace(base, power=self.power_number())]

    def table(self, token: _Token) -> Factor:
        lookup = self.tables[token.text]
        call = f"{token.text}({', '.join(lookup.variables)})"
        for i, name in enumerate(lookup.variables):
            self.expect("," if i else "(")
            if self.token.text != name:
                raise self.unexpected(f"'{name}'", f"Write {call}, the table with its own axes.")
            self.take()
        self.expect(")")
        first = lookup.variables[0]
        return Factor(first, kind="table", table=token.text, lookup=lookup)

    def power_number(self) -> int:
        if re.fullmatch(r"[1-9]", self.token.text) is None:
            raise self.unexpected("a whole power from 1 to 9")
        return int(self.take().text)

    def number(self, expected: str) -> float:
        if self.token.kind != "number" or not np.isfinite(float(self.token.text)):
            raise self.unexpected(expected)
        return float(self.take().text)

    def variable(self) -> str:
        if self.token.kind != "name":
            raise self.unexpected("a variable", f"Known variables: {', '.join(VARIABLES)}.")
        return self.known(self.take())

    def known(self, token: _Token) -> str:
        if token.text in VARIABLES or token.text == LIFT:
            return token.text
        names = (*VARIABLES, *self.tables)
        near = difflib.get_close_matches(token.text, names, n=1)
        short = {"p": "phat", "q": "qhat", "r": "rhat"}.get(token.text)
        hint = short or (near[0] if near else None)
        raise self.error(
            "unknown_term", token.position, f"one of {', '.join(names)}", f"'{token.text}'",
            f"Did you mean '{hint}'?" if hint else "Use one of the known variables.",
        )  # fmt: skip


def parse(formula: str, tables: Mapping[str, LookupTable] | None = None) -> tuple[Term, ...]:
    """The terms of a formula, in its order; tables: those it may call, by name.

    Raises BadInput that names the formula, the position and the known variables.
    """
    if not formula.strip() or len(formula) > _LONGEST:
        raise refuse(
            "formula_syntax",
            where=f"formula '{formula[:40]}'",
            expected=f"1 to {_LONGEST} characters",
            found=f"{len(formula)} characters" if formula.strip() else "nothing",
            do="Write a formula such as '1 + alpha + qhat + de'.",
        )
    return _Parser(formula, tables).sum() if tables else _parse_plain(formula)


@lru_cache(maxsize=1024)
def _parse_plain(formula: str) -> tuple[Term, ...]:
    """Without tables. Estimators ask for the same few formulas thousands of times."""
    return _Parser(formula, {}).sum()


def check_lift(coefficient: str, terms: Iterable[Term], where: str) -> None:
    """Raise BadInput where a formula other than the drag's names the lift coefficient."""
    bad = None if coefficient == "CD" else next((t for t in terms if t.needs_lift), None)
    if bad is not None:
        raise refuse(
            "unknown_term",
            where=where,
            expected=f"'{LIFT}' in the formula of CD only",
            found=f"'{bad.formula}' in that of {coefficient}",
            do=f"Use one of {', '.join(VARIABLES)}.",
        )


def regressors(
    coefficient: str, formula: str, variables: Mapping[str, Array]
) -> tuple[tuple[str, ...], Array]:
    """Names (k) of a formula's parameters and the matrix (n, k) of their regressors.

    variables: arrays (n,) by name, see `VARIABLES`. Raises BadInput on an unknown term or a
    variable that is missing.
    """
    terms = parse(formula)
    check_lift(coefficient, terms, f"model of {coefficient}")
    if not variables:
        raise refuse(
            "missing_variable",
            where=f"model of {coefficient}",
            expected="arrays of the model's variables",
            found="none",
            do="Give at least one variable, so that the number of samples is known.",
        )
    n = len(next(iter(variables.values())))
    matrix = np.empty((n, len(terms)))
    for k, term in enumerate(terms):
        matrix[:, k] = term.values(variables)
    return tuple(term.name(coefficient) for term in terms), matrix


def reference_scales(coefficient: str, formula: str) -> dict[str, float]:
    """The sizes below which parameters do not matter, by name, where the formula states them."""
    return {
        term.name(coefficient): term.reference_scale
        for term in parse(formula)
        if term.reference_scale is not None
    }
