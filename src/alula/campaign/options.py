"""Entries of [identify.options]: each is of the kind that its method wants."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

from alula.base.messages import BadInput, refuse
from alula.identify.likelihood.parameters import Prior

Kind = Literal[
    "text", "flag", "number", "pair", "list", "names", "numbers", "texts", "pairs", "any"
]
_TIE = re.compile(r"\s*(?:([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*\*)?\s*([A-Za-z]\w*)\s*")


def _number(x: Any) -> bool:
    return isinstance(x, (int, float)) and not isinstance(x, bool)


def _pair(x: Any) -> bool:
    return isinstance(x, list) and len(x) == 2 and all(map(_number, x))


def _list(x: Any) -> bool:
    return isinstance(x, list) and all(isinstance(v, str) for v in x)


def _table(of: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda x: isinstance(x, Mapping) and all(map(of, x.values()))


_KINDS: Mapping[Kind, tuple[Callable[[Any], bool], str]] = {
    "text": (lambda x: isinstance(x, str), "text"),
    "flag": (lambda x: isinstance(x, bool), "true or false"),
    "number": (_number, "a number"),
    "pair": (_pair, "two numbers, [low, high]"),
    "list": (_list, 'a list of names, ["alpha", "q"]'),
    "names": (lambda x: isinstance(x, str) or _list(x), "a name or a list of names"),
    "numbers": (_table(_number), "a table of numbers"),
    "texts": (_table(lambda x: isinstance(x, str)), "a table of texts"),
    "pairs": (_table(_pair), "a table of pairs of numbers"),
    "any": (lambda _: True, ""),
}


def checked_options(given: Mapping[str, Any], kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """The options, each of its kind. Raises BadInput for one that is not."""
    for name, value in given.items():
        fits, words = _KINDS[kinds[name]]
        if not fits(value):
            raise refuse(
                "bad_option",
                where=f"identify.options.{name}",
                expected=words,
                found=repr(value),
                do="Correct it.",
            )
    return dict(given)


def factors(tied: Mapping[str, str]) -> dict[str, tuple[str, float]]:
    """Ties by name from texts such as '0.5*Cl_da'. Raises BadInput for what is not one."""
    out = {}
    for name, text in tied.items():
        found = _TIE.fullmatch(text)
        if found is None:
            raise refuse(
                "bad_option",
                where=f"identify.options.tied.{name}",
                expected="a factor and a parameter, '0.5*Cl_da'",
                found=repr(text),
                do="Correct it.",
            )
        out[name] = (found[2], float(found[1] or 1.0))
    return out


def priors_of(given: Mapping[str, list[float]]) -> dict[str, Prior]:
    """Gaussian priors from pairs of mean and standard error. Raises BadInput for an error of 0."""
    for name, (_, se) in given.items():
        if not se > 0.0:
            raise refuse(
                "bad_option",
                where=f"identify.options.priors.{name}",
                expected="[mean, standard error], the error above zero",
                found=repr(given[name]),
                do="Correct it; a value without error is `fixed`.",
            )
    return {name: Prior(float(mean), float(se)) for name, (mean, se) in given.items()}


def one_of(name: str, value: str, known: Sequence[str]) -> None:
    """Refuse a value of the option that is none of those known."""
    if value not in known:
        raise bad_option(name, "one of " + ", ".join(known), repr(value))


def bad_option(name: str, expected: str, found: str) -> BadInput:
    """The refusal of an option's value."""
    return refuse(
        "bad_option",
        where=f"identify.options.{name}",
        expected=expected,
        found=found,
        do="Correct it.",
    )
