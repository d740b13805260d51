"""The parameters with error bars, verdicts and tied combinations."""

from __future__ import annotations

import math

from alula.identify.result import Identification, Parameter
from alula.report.html import Html, join, table, tag
from alula.report.names import WORDS
from alula.report.numbers import MISSING, interval, number, percent, plus_minus
from alula.report.pictures import interval_picture, mark

_VERDICT = {
    "ok": ("good", "ok"),
    "weak": ("caution", "weak"),
    "not_identifiable": ("bad", "not identifiable"),
}


def parameters(result: Identification) -> Html:
    """One table per coefficient, after the words that say how to read them."""
    names = list(dict.fromkeys(p.coefficient for p in result.parameters))
    return join(
        [
            tag(
                "p",
                f"Method: {result.method}. ‘se’ includes colored residuals and the uncertainty of "
                "the reconstruction; ‘plain se’ would hold if the residuals were white. The "
                "picture shows the 95 % interval and the value beside zero (upright line), or "
                "beside the truth (diamond) where that is known. Verdicts: ",
                mark("good", "ok"),
                " resolved; ",
                mark("caution", "weak"),
                " the interval includes zero or the error is over half the value; ",
                mark("bad", "not identifiable"),
                " these data do not determine it, whatever value a fit may give.",
            ),
            *(
                _table(name, [p for p in result.parameters if p.coefficient == name])
                for name in names
            ),
        ]
    )


def _table(coefficient: str, members: list[Parameter]) -> Html:
    truth = any(p.truth is not None for p in members)
    words = f", {WORDS[coefficient]}" if coefficient in WORDS else ""
    head = [
        "Parameter",
        "Value ± se",
        "Unit",
        "95 % interval",
        "Zero and interval",
        "se / value",
        "Plain se",
        "VIF",
        "Verdict",
    ]
    rows = []
    for p in members:
        row = _row(p)
        if truth:
            row.insert(4, number(p.truth) if p.truth is not None else MISSING)
        rows.append(row)
    if truth:
        head.insert(4, "Truth")
        head[head.index("Zero and interval")] = "Truth ◇ and interval"
    right = (1, 3, 4, 6, 7, 8) if truth else (1, 3, 5, 6, 7)
    return table(
        join([tag("code", coefficient), words]), head, rows, numeric=right, class_="dense whole"
    )


def _row(p: Parameter) -> list[object]:
    level, words = _VERDICT[p.verdict]
    resolved = p.verdict != "not_identifiable"
    verdict = [mark(level, words)]
    if p.tied_to:
        verdict.append(tag("span", "tied to ", tag("code", combination(p)), class_="tied"))
    return [
        tag("code", p.name),
        plus_minus(p.value, p.se),
        p.unit if p.unit not in ("", "1") else "–",
        interval(*p.ci95),
        interval_picture(p.value, *p.ci95, p.truth) if resolved else "",
        percent(p.se / abs(p.value)) if p.value and math.isfinite(p.value) else MISSING,
        number(p.se_white, 2),
        number(p.vif, 3),
        join(verdict),
    ]


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
