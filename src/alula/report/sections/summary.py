"""The head of the page: what it is about, and the verdict in words."""

from __future__ import annotations

import math

from alula.base.filters import FILTERS
from alula.identify.result import Identification
from alula.reconstruct.result import Reconstruction
from alula.report.html import Html, escape, file_name, join, tag
from alula.report.input import ReportInput
from alula.report.names import WORDS
from alula.report.numbers import number
from alula.report.pictures import mark
from alula.report.sections.validation import reasons_of, verdict_of


def header(report: ReportInput) -> Html:
    """Title, project, aircraft and the verdict with its reasons."""
    level, words = verdict(report)
    facts = {"Project": file_name(report.path), "Date": report.date}
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
    if report.validation is not None:
        return verdict_of(report.validation)
    if identification is None or not identification.parameters:
        return _without_model(report)
    parameters = identification.parameters
    total, lost = len(parameters), sum(p.verdict == "not_identifiable" for p in parameters)
    zero = sum(p.zero_constant for p in parameters)
    weak = sum(p.verdict == "weak" for p in parameters) - zero
    if lost:
        return "bad", f"{lost} of {total} parameters are not identifiable"
    if weak:
        return "caution", f"{weak} of {total} parameters are weakly determined"
    words = f"All {total} parameters are resolved by these data"
    return "good", words + (
        f"; zero within their error: {_many(zero, 'trim constant')}" if zero else ""
    )


def _without_model(report: ReportInput) -> tuple[str, str]:
    """The verdict of a project that asks for no model, or did not come so far."""
    if report.navigation:
        if any(m.code in ("sensor_refused", "implausible_wind") for m in report.messages):
            return "bad", "The sensors contradict each other: see the messages"
        return "good", "The logs are navigated; no model was asked for"
    if report.reconstruction is None or not report.reconstruction.segments:
        return "caution", "No model was identified: this page shows the data only"
    unseen = [c.name for c in report.reconstruction.constants if not c.observable]
    if unseen:
        return "caution", (
            "The flight path is reconstructed, but these constants are not observable: "
            + ", ".join(unseen)
        )
    return "good", "The flight path is reconstructed; no model was asked for"


def reasons(report: ReportInput) -> list[Html]:
    """The findings behind the verdict, one sentence each."""
    found: list[Html] = []
    identification, reconstruction = report.identification, report.reconstruction
    if report.validation is not None:
        found += reasons_of(report.validation)
    if identification is not None:
        found += _parameters(identification) + _fits(identification)
        if identification.status:
            found.append(escape(sentence(identification.status)))
    if reconstruction is not None:
        found.append(escape(_reconstructed(reconstruction)))
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


def _parameters(result: Identification) -> list[Html]:
    """The parameters that are not resolved, by name."""
    found = []
    weak = [p for p in result.parameters if p.verdict == "weak"]
    for those, start in (
        (
            [p for p in result.parameters if p.verdict == "not_identifiable"],
            "Not identifiable, the data do not determine them: ",
        ),
        (
            [p for p in weak if not p.zero_constant],
            "Weak, the interval includes zero or the error is over half the value: ",
        ),
        (
            [p for p in weak if p.zero_constant],
            "Trim constants that are zero within their error: ",
        ),
    ):
        names = [tag("code", p.name) for p in those]
        if names:
            found.append(_listed(start, names))
    return found


def _fits(result: Identification) -> list[Html]:
    """How the models fit, how they predict, and which of them were never put to that test."""
    fits = list(result.fits.values())
    seen = [f for f in fits if f.n_held_out and math.isfinite(f.r2_held_out)]
    found = [_listed("R² on the data of the fit: ", [_r2(f.coefficient, f.r2) for f in fits])]
    if seen:
        codes = [_r2(f.coefficient, f.r2_held_out) for f in seen]
        found.append(_listed("R² on maneuvers that the fit never saw: ", codes))
    codes = [tag("code", f.coefficient) for f in fits if f not in seen]
    if codes:
        found.append(_listed("Not validated, no maneuver was held out: ", codes))
    return found if fits else []


def _r2(name: str, value: float) -> Html:
    words = f" ({WORDS[name]})" if name in WORDS else ""
    return join([tag("code", name), f"{words} {number(value, 4)}"])


def _listed(start: str, items: list[Html]) -> Html:
    """'start a, b.'"""
    return join([start, Html(", ".join(items)), "."])


def _reconstructed(result: Reconstruction) -> str:
    """How the flight path came about, in one sentence."""
    if result.method == "none":
        return sentence(result.status)
    failed = "" if result.converged else " did not converge"
    status = result.status.strip() or "no more is known"
    return f"Reconstruction ({method_words(result.method)}){failed}: {_stopped(status)}"


def sentence(text: str) -> str:
    """The text with a capital at its start and a full stop at its end."""
    return _stopped(text[:1].upper() + text[1:])


def _stopped(text: str) -> str:
    return text if text.endswith((".", "!", "?")) or not text else f"{text}."


def method_words(method: str) -> str:
    """What a method's short name stands for; itself where there are no words."""
    return FILTERS.get(method, method)


def _many(count: int, what: str) -> str:
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"
