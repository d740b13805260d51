"""What is wrong with formulas by coefficient, as a project or a plan states them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from difflib import get_close_matches

from alula.base.messages import BadInput, Message
from alula.model.grammar import parse
from alula.model.terms import COEFFICIENTS


def formula_problems(formulas: Mapping[str, str], where: str) -> list[Message]:
    """One error for each coefficient and each term that nobody knows. where: file and key.

    A misspelled coefficient would else be taken for one that no maneuver serves.
    """
    problems: list[Message] = []
    for name, formula in formulas.items():
        key = f"{where}.{name}"
        if name not in COEFFICIENTS:
            same = [c for c in COEFFICIENTS if c.lower() == name.lower()]
            near = same or get_close_matches(name, COEFFICIENTS, n=3, cutoff=0.5)
            problems.append(
                Message(
                    "unknown_coefficient",
                    "error",
                    key,
                    f"one of {', '.join(COEFFICIENTS)}",
                    f"'{name}'",
                    f"Did you mean {' or '.join(near)}?" if near else "Correct the name.",
                )
            )
        try:
            parse(formula)
        except BadInput as error:
            problems += [replace(m, where=f"{key}, {m.where}") for m in error.messages]
    return problems
