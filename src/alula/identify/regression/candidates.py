"""Candidate terms from a line of text: `(1, alpha, qhat, de)^2 + (alpha - [0.1, 0.2])+^2`.

    pool   = item { "+" item }
    item   = factor { "*" factor }                        every product of their members
    factor = "(" member { "," member } ")" [ "^" order ]  every product of `order` members
           | "(" variable ("-" | "+") "[" number { "," number } "]" ")" "+" [ "^" power ]
           | a factor of the model grammar                one member
    member = item

With 1 among the members of a list, the products up to that order; without it, of that order only.
A list of knots gives one spline each (Klein and Batterson, NASA TP-1916, 1981). What a member may
be is the business of the model grammar (`alula.model.grammar`); nothing is evaluated.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import combinations_with_replacement
from itertools import product as every

from alula.base.messages import BadInput, refuse
from alula.model import parse
from alula.model.terms import Term, product

MOST = 500  # candidates: a pool beyond that finds structure in noise
LONGEST = 4000  # characters
DEEPEST = 4  # lists within lists
_KNOTS = re.compile(r"\(\s*(\w+)\s*([+-])\s*\[([^\]]*)\]\s*\)\s*\+\s*(?:(?:\^|\*\*)\s*(\d))?\s*$")
_LIST = re.compile(r"\((.*)\)\s*(?:(?:\^|\*\*)\s*(\w+))?\s*$", re.DOTALL)


def candidates(pool: str) -> tuple[Term, ...]:
    """The terms of a pool, each once, in the order of the text.

    Raises BadInput that names the pool and what of it cannot be read, and for over 500 terms.
    """
    if not pool.strip() or len(pool) > LONGEST:
        raise _unreadable(pool, f"{len(pool)} characters" if pool.strip() else "nothing")
    found: dict[tuple[object, ...], Term] = {}
    for item in _split(pool, "+", pool):
        found.update((term.factors, term) for term in _item(item, pool, 0))
        _check_size(len(found), pool)
    return tuple(found.values())


def _item(text: str, pool: str, depth: int) -> list[Term]:
    members = [_factor(factor, pool, depth) for factor in _split(text, "*", pool)]
    size = 1
    for choice in members:
        size *= len(choice)
    _check_size(size, pool)
    return [_product(chosen, pool) for chosen in every(*members)]


def _product(terms: Sequence[Term], pool: str) -> Term:
    term = product([f for part in terms for f in part.factors])
    if any(f.power > 9 for f in term.factors):
        raise _unreadable(pool, f"'{term.formula}', a power over 9")
    return term


def _split(text: str, sign: str, pool: str) -> list[str]:
    """The parts between signs outside of parentheses; a '+' that closes a ramp joins nothing."""
    parts, depth, start = [], 0, 0
    opened: list[int] = []
    ramp = False  # the last thing read was a group '(variable - knot)', which needs its '+'
    i = 0
    while i < len(text):
        char = text[i]
        if char in "([":
            depth += 1
            opened.append(i)
        elif char in ")]":
            depth -= 1
            if depth < 0:
                raise _unreadable(pool, f"'{char}' that closes nothing")
            inside = text[opened.pop() + 1 : i]
            ramp = char == ")" and _is_ramp(inside)
        elif char == "*" and text[i : i + 2] == "**":
            i += 1
        elif char == "+" and ramp:
            ramp = False
        elif char == sign and depth == 0:
            parts.append(text[start:i])
            start = i + 1
        elif not char.isspace():
            ramp = False
        i += 1
    if depth:
        raise _unreadable(pool, "a parenthesis that is not closed")
    return [*parts, text[start:]]


def _is_ramp(inside: str) -> bool:
    return re.match(r"\s*\w+\s*[+-]\s*[\[\d.]", inside) is not None and not _commas(inside)


def _commas(text: str) -> bool:
    """Whether there is a comma outside of brackets."""
    return "," in re.sub(r"\[[^\]]*\]|\([^)]*\)", "", text)


def _factor(text: str, pool: str, depth: int) -> list[Term]:
    text = text.strip()
    knots = _KNOTS.match(text)
    if knots:
        variable, sign, numbers, power = knots.groups()
        tail = f"^{power}" if power else ""
        listed = [n.strip() for n in numbers.split(",")]
        return [_one(f"({variable} {sign} {n})+{tail}", pool) for n in listed]
    grouped = _LIST.match(text)
    if grouped and not _is_ramp(grouped[1]):
        if depth == DEEPEST:
            raise _unreadable(pool, f"lists within lists over {DEEPEST} deep")
        members = [t for m in _members(grouped[1]) for t in _item(m, pool, depth + 1)]
        order = grouped[2] or "1"
        if not re.fullmatch(r"[1-9]", order):
            raise _unreadable(pool, f"order '{order}', which is not a whole number from 1 to 9")
        count = 1
        for i in range(int(order)):  # of multisets
            count = count * (len(members) + i) // (i + 1)
        _check_size(count, pool)
        return [_product(c, pool) for c in combinations_with_replacement(members, int(order))]
    return [_one(text, pool)]


def _members(inside: str) -> list[str]:
    parts, depth, start = [], 0, 0
    for i, char in enumerate(inside):
        depth += (char in "([") - (char in ")]")
        if char == "," and depth == 0:
            parts.append(inside[start:i])
            start = i + 1
    return [*parts, inside[start:]]


def _one(text: str, pool: str) -> Term:
    """One term of the model grammar."""
    if not text.strip():
        raise _unreadable(pool, "a place where a term is missing")
    terms = parse(text.strip())
    if len(terms) != 1:
        raise _unreadable(pool, f"a sum '{text.strip()}' in a list")
    return terms[0]


def _check_size(size: int, pool: str) -> None:
    if size > MOST:
        raise refuse(
            "too_many_candidates",
            where=f"candidates '{pool}'",
            expected=f"at most {MOST} terms",
            found=f"{size} or more",
            do="Lower the order or list fewer variables.",
        )


def _unreadable(pool: str, found: str) -> BadInput:
    return refuse(
        "candidates_syntax",
        where=f"candidates '{pool[:60]}'",
        expected="terms, lists such as (1, alpha, qhat)^2, splines such as (alpha - [0.1, 0.2])+^2",
        found=found,
        do="Join them by '+'.",
    )
