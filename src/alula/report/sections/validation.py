"""The evidence index: requirement, maneuver, measured, model, tolerance, verdict; and the match."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from alula.report.html import Html, escape, join, table, tag
from alula.report.names import meaning
from alula.report.numbers import MISSING, number, percent, plus_minus, shown, span
from alula.report.pictures import mark

if TYPE_CHECKING:
    from alula.validate.result import Criterion, Evidence, Flown, Validation

_VERDICT = {
    "pass": ("good", "pass"),
    "fail": ("bad", "fail"),
    "not_judged": ("caution", "not judged"),
}
SEEN = {
    "yes": "seen by the estimate: no validation",
    "unknown": "not known whether the estimate saw it",
}
_SHORT = {"yes": "seen by the estimate", "unknown": "seen? not known"}
_UNIT = {"deg": "°", "deg/s": "°/s", "1": ""}


def anchor(result: Validation, maneuver: str) -> str:
    """Where on the page the overlay of a maneuver stands."""
    ids = [one.maneuver.id for one in result.flown]
    return f"flown-{ids.index(maneuver) + 1}"


def verdict_of(result: Validation) -> tuple[str, str]:
    """(good, caution or bad; the sentence) for the head of the page."""
    total = len(result.evidence)
    if result.failed:
        return "bad", f"{result.count('fail')} of {total} requirements are not met by the model"
    seen = [one for one in result.flown if one.seen != "no"]
    if seen:
        return "caution", (
            f"Not a validation: {len(seen)} of {len(result.flown)} maneuvers are, or may be, those "
            "that the model was estimated from"
        )
    if not result.count("pass"):
        return "caution", "No requirement could be judged on these maneuvers"
    if result.count("not_judged"):
        return "caution", (
            f"The model meets {result.count('pass')} of {total} requirements; the others could "
            "not be judged"
        )
    return "good", f"The model flies like the aircraft: all {total} requirements are met"


def reasons_of(result: Validation) -> list[Html]:
    """The findings behind the verdict, one sentence each."""
    out: list[Html] = []
    for verdict, words in (("fail", "Not met: "), ("not_judged", "Not judged: ")):
        rows = [e for e in result.evidence if e.verdict == verdict]
        named = dict.fromkeys((e.title, e.maneuver) for e in rows)
        if named:
            linked = [
                tag("a", f"{title}, {id}", href=f"#{anchor(result, id)}") for title, id in named
            ]
            out.append(join([words, Html("; ".join(linked)), "."]))
    for seen, words in SEEN.items():
        ids = [one.maneuver.id for one in result.flown if one.seen == seen]
        if ids:
            out.append(join([tag("strong", f"{words[0].upper()}{words[1:]}: "), ", ".join(ids)]))
    for one in result.flown:
        if one.diverged_at is not None:
            out.append(
                escape(
                    f"The model's flight of {one.maneuver.id} diverged at "
                    f"{number(one.diverged_at, 5)} s."
                )
            )
    return out


def evidence(result: Validation) -> Html:
    """The index: every requirement with its maneuver, linked to the overlay, and its verdict."""
    facts = {
        "Model": result.model,
        "Where it comes from": result.source,
        "Judged by": result.regulation,
    }
    return join(
        [
            tag(
                "dl",
                join(tag("div", tag("dt", k), tag("dd", v)) for k, v in facts.items()),
                class_="facts wideFacts",
            ),
            _index(result),
            tag(
                "p",
                "The recorded controls and thrust are flown through the model, open loop, from the "
                "reconstructed state at the start of each maneuver; the flight of the model takes "
                "the simulator's place in the regulation. Of alternatives in one requirement one "
                "suffices. Time histories are judged sample by sample from the beginning of the "
                "input to 5 s after its end; the values shown are those of the sample that uses "
                "most of its tolerance, and the share is that of samples within. Periods and "
                "damping ratios are those of damped sines matched to the free response of both "
                "flights; ± is the standard error of their difference, and where twice it exceeds "
                "the tolerance nothing is judged.",
                class_="note",
            ),
            _matches(result),
        ]
    )


def _index(result: Validation) -> Html:
    rows = [
        [
            tag("code", e.entry),
            e.title,
            tag("a", e.maneuver, href=f"#{anchor(result, e.maneuver)}"),
            e.tolerance,
            _lines(e, lambda c: escape(c.quantity)),
            _lines(e, lambda c: _value(c.measured, c)),
            _lines(e, lambda c: _value(c.model, c)),
            _lines(e, _difference),
            _lines(e, lambda c: join(["±", _value(c.tolerance, c)])),
            _verdict(e),
        ]
        for e in result.evidence
    ]
    if not rows:
        return tag("p", mark("caution", "No maneuver serves a requirement of the regulation."))
    return table(
        f"Evidence index. Requirements of {result.regulation}.",
        [
            "Entry",
            "Requirement",
            "Maneuver",
            "Tolerance",
            "Quantity",
            "Measured",
            "Model",
            "Difference",
            "Allowed",
            "Verdict",
        ],
        rows,
        numeric=(5, 6, 7, 8),
        class_="evidence dense",
    )


def _lines(row: Evidence, cell: Callable[[Criterion], Html]) -> Html | str:
    """One line of the cell for each alternative."""
    return join(tag("span", cell(c), class_="line") for c in row.criteria) or MISSING


def _value(value: float, c: Criterion) -> Html:
    unit = _UNIT.get(c.unit, f"\u00a0{c.unit}")
    return escape(number(value, 3) + unit)


def _difference(c: Criterion) -> Html:
    known = c.deviation_se > 0.0
    text = plus_minus(c.deviation, c.deviation_se) if known else number(c.deviation, 3)
    sign = "+" if c.deviation > 0.0 and not text.startswith("(") else ""
    return escape(sign + text + _UNIT.get(c.unit, f"\u00a0{c.unit}"))


def _share(value: float) -> str:
    """A share to a hundredth."""
    return f"{value:.2f}" if math.isfinite(value) else MISSING


def _verdict(e: Evidence) -> Html:
    level, words = _VERDICT[e.verdict]
    if e.seen != "no" and level == "good":
        level = "caution"
    shares = [c.within_share for c in e.criteria if c.within_share is not None]
    said = [f"{percent(max(shares), 3)} of the time within"] if shares and max(shares) < 1 else []
    said += [e.reason] if e.reason else []
    return join(
        [
            mark(level, words),
            tag("span", _SHORT[e.seen], class_="tag") if e.seen in SEEN else "",
            tag("span", "; ".join(said), class_="tied") if said else "",
        ]
    )


def _matches(result: Validation) -> Html:
    """Per channel and maneuver: R2, RRMSE, Theil's coefficient and its parts."""
    return join(
        [
            tag("h3", "Match by channel"),
            *(_match(result, one) for one in result.flown),
            tag(
                "p",
                "R² about the measured mean; RRMSE is the rms error over the range of the "
                "measured. Theil's inequality coefficient U is taken about the measured mean: 0 is "
                "perfect, below 0.3 usually called good, 1 no better than a constant. Its bias, "
                "variance and covariance parts are shares of the mean squared error and sum to "
                "one: a good model errs in the last. All are open loop over the whole horizon, "
                "where small errors of moment add up in attitude and heading.",
                class_="note",
            ),
        ]
    )


def _match(result: Validation, one: Flown) -> Html:
    rows = []
    for c in one.channels.values():
        if not (c.in_axis and c.recorded):
            continue
        q = c.quality
        factor, unit = shown(c.unit)
        rows.append(
            [
                join([tag("code", c.name), f" {meaning(c.name)}"]),
                f"{number(factor * q.rms, 3)} {unit}",
                number(q.r2, 3),
                percent(q.rrmse, 3),
                number(q.theil, 3),
                *(_share(x) for x in (q.bias, q.variance, q.covariance)),
                "as recorded: proves nothing" if c.as_recorded else "",
            ]
        )
    m = one.maneuver
    caption = join(
        [
            tag("a", m.id, href=f"#{anchor(result, m.id)}"),
            f": horizon {number(one.horizon, 4)} s, {span(float(one.t[0]), float(one.t[-1]))} s "
            "of the log. ",
            tag("span", SEEN[one.seen], class_="tag") if one.seen in SEEN else "",
        ]
    )
    head = ["Channel", "Rms error", "R²", "RRMSE", "Theil U", "Bias", "Variance", "Covariance", ""]
    return table(caption, head, rows, numeric=range(1, 8))
