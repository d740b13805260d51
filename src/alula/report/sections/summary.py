"""The head of the page: what it is about, and the verdict in words."""

from __future__ import annotations

import math

from alula.report.html import Html, escape, join, tag
from alula.report.input import ReportInput
from alula.report.names import WORDS
from alula.report.numbers import number
from alula.report.pictures import mark


def header(report: ReportInput) -> Html:
    """Title, project, aircraft and the verdict with its reasons."""
    level, words = verdict(report)
    facts = {"Project": tag("code", report.path), "Date": report.date}
    facts.update({k: escape(v) for k, v in report.aircraft.items()})
    return tag(
        "header",
        tag("p", "Alula · flight data analysis report", class_="kicker"),
        tag("h1", report.name),
        tag(
            "div",
            tag("h2", mark(level, words)),
            tag("ul", *(tag("li", r) for r in reasons(report))),
            class_=f"verdict-box {level}",
        ),
        tag(
            "dl",
            join(tag("div", tag("dt", k), tag("dd", v)) for k, v in facts.items()),
            class_="facts",
        ),
    )


def verdict(report: ReportInput) -> tuple[str, str]:
    """(good, caution or bad; the sentence). The worst finding decides."""
    identification, reconstruction = report.identification, report.reconstruction
    if any(m.level == "error" for m in report.all_messages()):
        return "bad", "An error was found: the result must not be used"
    if reconstruction is not None and not reconstruction.converged:
        return "bad", "The reconstruction did not converge: the result must not be used"
    if identification is None:
        return "caution", "No model was identified: this page shows the data only"
    count = {"ok": 0, "weak": 0, "not_identifiable": 0}
    for p in identification.parameters:
        count[p.verdict] += 1
    total = len(identification.parameters)
    if count["not_identifiable"]:
        return "bad", f"{count['not_identifiable']} of {total} parameters are not identifiable"
    if count["weak"]:
        return "caution", f"{count['weak']} of {total} parameters are weakly determined"
    return "good", f"All {total} parameters are resolved by these data"


def reasons(report: ReportInput) -> list[Html]:
    """The findings behind the verdict, one sentence each."""
    found: list[Html] = []
    identification, reconstruction = report.identification, report.reconstruction
    if identification is not None:
        for verdict_, start in (
            ("not_identifiable", "Not identifiable, the data do not determine them: "),
            ("weak", "Weak, the interval includes zero or the error is over half the value: "),
        ):
            names = [p.name for p in identification.parameters if p.verdict == verdict_]
            if names:
                codes = join(
                    ", " if k % 2 else tag("code", names[k // 2]) for k in range(2 * len(names) - 1)
                )
                found.append(join([start, codes, "."]))
        for fit in identification.fits.values():
            words = f" ({WORDS[fit.coefficient]})" if fit.coefficient in WORDS else ""
            held = (
                f"R² {number(fit.r2_held_out, 3)} on {fit.n_held_out} samples held out of the fit"
                if fit.n_held_out and math.isfinite(fit.r2_held_out)
                else "no maneuver was held out, so the model is not validated on data it never saw"
            )
            found.append(
                join(
                    [
                        tag("code", fit.coefficient),
                        f"{words}: R² {number(fit.r2, 3)} on {fit.n} samples of the fit; {held}.",
                    ]
                )
            )
        if identification.status:
            found.append(escape(f"Identification: {identification.status}"))
    if reconstruction is not None:
        state = "converged" if reconstruction.converged else "did not converge"
        found.append(
            escape(f"Reconstruction ({reconstruction.method}) {state}. {reconstruction.status}")
        )
    levels = [m.level for m in report.all_messages()]
    count = {k: levels.count(k) for k in ("error", "warning", "info")}
    found.append(
        join(
            [
                f"Messages: {_many(count['error'], 'error')}, "
                f"{_many(count['warning'], 'warning')}, {_many(count['info'], 'note')} "
                "on what was done to the data; ",
                tag("a", "all are listed below", href="#messages"),
                ".",
            ]
        )
    )
    return found


def _many(count: int, what: str) -> str:
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"
