"""The parameters with error bars, verdicts and tied combinations."""

from __future__ import annotations

import math
from collections.abc import Callable

from alula.identify.result import Identification, Parameter
from alula.identify.typical import flown_sum
from alula.report.html import Html, join, table, tag
from alula.report.names import WORDS
from alula.report.numbers import MISSING, interval, number, percent, plus_minus
from alula.report.pictures import interval_picture, mark

_VERDICT = {
    "ok": ("good", "ok"),
    "weak": ("caution", "weak"),
    "not_identifiable": ("bad", "not identifiable"),
}
_BIASED = (
    "The method is biased: ‘Bias’ is what it is estimated to shift the value by; the interval "
    "includes it, se does not. "
)


def parameters(result: Identification) -> Html:
    """One table per coefficient, after the words that say how to read them."""
    names = list(dict.fromkeys(p.coefficient for p in result.parameters))
    return join(
        [
            tag(
                "p",
                f"Method: {result.method}. ‘se’: {result.uncertainty}; ‘plain se’ would hold if "
                "the residuals were white. "
                + (_BIASED if any(p.bias is not None for p in result.parameters) else "")
                + "The picture shows the 95 % interval and the value beside zero (upright line), "
                "or beside the truth (diamond) where that is known. Verdicts: ",
                mark("good", "ok"),
                " resolved; ",
                mark("caution", "weak"),
                " the interval includes zero or the error is over half the value; ",
                mark("bad", "not identifiable"),
                " these data do not determine it, whatever value a fit may give.",
                _sums(result),
                _given(result),
            ),
            *(
                _table(name, [p for p in result.parameters if p.coefficient == name])
                for name in names
            ),
        ]
    )


def _sums(result: Identification) -> str:
    """What the rates' derivatives stand for, as flight cannot take the parts apart."""
    sums = {p.name: flown for p in result.parameters if (flown := flown_sum(p.name))}
    if not sums:
        return ""
    words = ", ".join(f"{name} is {flown.replace('-', '−')}" for name, flown in sums.items())
    return f" Of the rates' derivatives flight tells sums: {words}."


def _given(result: Identification) -> str:
    """The terms that were not estimated."""
    held = [f"{name} = {number(value)}" for name, value in result.fixed.items()]
    held += [f"{n} = {number(k, 3)} {of}" for n, (of, k) in result.tied.items()]
    return f" Not estimated: {', '.join(held)}." if held else ""


def _table(coefficient: str, members: list[Parameter]) -> Html:
    truth = any(p.truth is not None for p in members)
    biased = any(p.bias is not None for p in members)
    words = f", {WORDS[coefficient]}" if coefficient in WORDS else ""
    columns: list[tuple[str, bool, Callable[[Parameter], object]]] = [  # head, right, cell
        ("Parameter", False, lambda p: tag("code", p.name)),
        ("Value ± se", True, lambda p: plus_minus(p.value, p.se)),
        *([("Bias", True, lambda p: number(p.bias, 2))] if biased else []),
        ("Unit", False, lambda p: p.unit if p.unit not in ("", "1") else "–"),
        ("95 % interval", True, lambda p: interval(*p.ci95)),
        *([("Truth", True, lambda p: number(p.truth))] if truth else []),
        (f"{'Truth ◇' if truth else 'Zero'} and interval", False, _picture),
        ("se / value", True, _share),
        ("Plain se", True, lambda p: number(p.se_white, 2)),
        ("VIF", True, lambda p: number(p.vif, 3)),
        ("Verdict", False, _verdict),
    ]
    return table(
        join([tag("code", coefficient), words]),
        [head for head, _, _ in columns],
        [[cell(p) for _, _, cell in columns] for p in members],
        numeric=[i for i, (_, right, _) in enumerate(columns) if right],
        class_="dense whole",
    )


def _picture(p: Parameter) -> object:
    return interval_picture(p.value, *p.ci95, p.truth) if p.verdict != "not_identifiable" else ""


def _share(p: Parameter) -> str:
    return percent(p.se / abs(p.value)) if p.value and math.isfinite(p.value) else MISSING


def _verdict(p: Parameter) -> Html:
    verdict = [mark(*_VERDICT[p.verdict])]
    if p.tied_to:
        verdict.append(tag("span", "tied to ", tag("code", combination(p)), class_="tied"))
    return join(verdict)


def combination(p: Parameter) -> str:
    """The unresolved combination as a sum: 'Cm_q + 2.1 Cm_alphadot'."""
    text = ""
    for tie in p.tied_to:
        size = abs(tie.weight)
        factor = "" if abs(size - 1.0) < 5e-3 else f"{number(size, 2)} "
        sign = (
            ("− " if tie.weight < 0 else "") if not text else (" − " if tie.weight < 0 else " + ")
        )
        text += f"{sign}{factor}{tie.name}"
    return text
