"""One row of a linear model as text: `Lp*p + Lr*r + Lda*da - 0.5*Ldr*dr + L0`.

    row    = ["-"] term { ("+" | "-") term }
    term   = factor { "*" factor | "/" number }
    factor = number | parameter | state or input

A name that is no state and no input is a parameter. A term has at most one of each, so that the row
is linear in both; a term without a variable is a constant. Read by a parser of its own, never by
`eval`.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass

from alula.base.messages import BadInput, refuse

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<sign>\S))",
    re.ASCII,
)
_LONGEST = 4000


@dataclass(frozen=True)
class LinearTerm:
    """factor * parameter * variable; None where there is no parameter or no variable."""

    factor: float
    parameter: str | None
    variable: str | None


def parse_row(row: str, text: str, variables: Collection[str]) -> tuple[LinearTerm, ...]:
    """The terms of one row. row: its name, for messages. variables: states and inputs.

    Raises BadInput on what is not linear or cannot be read.
    """
    where = f"row {row} = '{text[:60]}'"
    if not text.strip() or len(text) > _LONGEST:
        raise _error(where, 1, f"1 to {_LONGEST} characters", "nothing" if not text else "too many")
    tokens = [
        (m.lastgroup or "sign", m[m.lastgroup or "sign"], m.start(m.lastgroup or "sign") + 1)
        for m in _TOKEN.finditer(text)
    ]
    tokens.append(("end", "the end", len(text) + 1))
    terms: list[LinearTerm] = []
    at = 0
    sign = 1.0
    if tokens[0][1] in ("+", "-"):
        sign, at = (-1.0 if tokens[0][1] == "-" else 1.0), 1
    while True:
        factor, parameter, variable = sign, None, None
        divide = False
        while True:
            kind, word, position = tokens[at]
            if kind == "number":
                if divide and float(word) == 0.0:
                    raise _error(where, position, "a divisor other than zero", word)
                factor = factor / float(word) if divide else factor * float(word)
            elif kind != "name" or divide:
                expected = "a number behind '/'" if divide else "a number, parameter or variable"
                raise _error(where, position, expected, f"'{word}'")
            elif word in variables:
                if variable is not None:
                    raise _error(where, position, "one state or input a term", f"'{word}' too")
                variable = word
            else:
                if parameter is not None:
                    raise _error(
                        where, position, "one parameter a term", f"'{word}' beside '{parameter}'"
                    )
                parameter = word
            _, word, position = tokens[at + 1]
            at += 1
            if word not in ("*", "/"):
                break
            divide = word == "/"
            at += 1
        terms.append(LinearTerm(factor, parameter, variable))
        if tokens[at][0] == "end":
            return tuple(terms)
        if word not in ("+", "-"):
            raise _error(where, position, "'+', '-' or '*'", f"'{word}'")
        sign = -1.0 if word == "-" else 1.0
        at += 1


def _error(where: str, position: int, expected: str, found: str) -> BadInput:
    return refuse(
        "formula_syntax",
        where=f"{where}, character {position}",
        expected=expected,
        found=found,
        do="Write a sum such as 'Lp*p + Lr*r + Lda*da + L0': one parameter, one variable a term.",
    )
