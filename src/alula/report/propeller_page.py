"""The report of a propeller: one page, no script, nothing from outside."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite

import numpy as np

from alula.aircraft.blades import Blades
from alula.base.arrays import Array
from alula.base.messages import Message
from alula.predict.propeller_curves import PropellerCurves
from alula.predict.propeller_fit import PropellerFit
from alula.predict.propeller_test import PropellerTest
from alula.report.html import Html, join, table, tag
from alula.report.numbers import MISSING, number, percent, plus_minus
from alula.report.pictures import mark
from alula.report.plain_page import chapters_page
from alula.report.propeller_picture import STYLE, key, propeller_picture

_VERDICT = {"ok": "good", "weak": "caution", "not_identifiable": "bad"}


def propeller_page(
    blades: Blades,
    rpm: float | None,
    curves: Mapping[str, tuple[PropellerCurves, float]],
    fits: Mapping[str, PropellerFit],
    test: PropellerTest | None,
    fitted_below: float | None,
    messages: Sequence[Message],
) -> str:
    """The page as HTML. curves: by model, with the J of its windmill. rpm: of Reynolds numbers."""
    sections = [("curves", "Curves", _curves(curves, test, fitted_below))]
    sections += [
        (f"fit{i}", f"Fitted to the {name}", _fit(fit))
        for i, (name, fit) in enumerate(fits.items(), 1)
    ]
    sections += [
        (f"table{i}", name[0].upper() + name[1:], _table(curve))
        for i, (name, (curve, _)) in enumerate(curves.items(), 1)
    ]
    sections.append(("messages", "Messages", _messages(messages)))
    facts = {
        "Diameter": f"{number(blades.diameter)} m",
        "Blades": str(blades.count),
        "Speed of revolution": "–" if rpm is None else f"{number(rpm)} rpm",
        "From": blades.source,
    }
    return chapters_page(
        f"{blades.name} · propeller",
        "a propeller over its advance ratio",
        blades.name,
        facts,
        sections,
        STYLE,
    )


def _curves(
    curves: Mapping[str, tuple[PropellerCurves, float]],
    test: PropellerTest | None,
    fitted_below: float | None,
) -> Html:
    parts = [c for c, _ in curves.values()]
    measured: dict[str, tuple[Array, Array]] = {}
    if test is not None:
        drives = (test.J > 0.0) & (test.CP > 0.0) & (test.CT > -0.3 * test.CP)
        eta = test.J[drives] * test.CT[drives] / test.CP[drives]
        measured = {
            "CT": (test.J, test.CT), "CP": (test.J, test.CP), "eta": (test.J[drives], eta)
        }  # fmt: skip
    pictures = [
        tag(
            "figure",
            tag("figcaption", words),
            propeller_picture(
                f"{words} over the advance ratio",
                [_line(c, name) for c in parts],
                measured.get(name),
                fitted_below,
            ),
        )
        for name, words in (("CT", "Thrust CT"), ("CP", "Power CP"), ("eta", "Efficiency J CT/CP"))
    ]
    listed = [
        tag("li", key(i), f" {name}: {c.method}; windmill beyond J = {number(last)}")
        for i, (name, (c, last)) in enumerate(curves.items())
    ]
    if test is not None:
        words = "Dots: the test" + (
            "." if fitted_below is None else f"; hollow ones, from J = {fitted_below:g}, unfitted."
        )
        listed.append(tag("li", words))
    return join([tag("ul", *listed, class_="plain"), tag("div", *pictures, class_="grid")])


def _line(c: PropellerCurves, name: str) -> tuple[Array, Array]:
    """Values over J; an efficiency where the propeller pulls: CP is zero further on."""
    keep = (c.CT >= 0.0) if name == "eta" else np.ones(len(c.J), dtype=bool)
    return c.J[keep], getattr(c, name)[keep]


def _fit(fit: PropellerFit) -> Html:
    rows = []
    for e in fit.estimates:
        verdict = e.verdict.replace("_", " ")
        tied = "tied to " + ", ".join(n for n, _ in e.tied_to) if e.tied_to else ""
        rows.append(
            [
                tag("code", e.name),
                plus_minus(e.value, e.se)
                if isfinite(e.se) and e.verdict != "given"
                else number(e.value),
                e.unit,
                mark(_VERDICT[e.verdict], verdict) if e.verdict in _VERDICT else verdict,
                ", ".join(w for w in (tied, e.note) if w),
            ]
        )
    words = (
        f"{len(fit.test.J)} values; the rest of the fit has an rms of {percent(fit.rms_CT, 3)} of "
        f"the largest CT and {percent(fit.rms_CP, 3)} of the largest CP: {fit.status}."
    )
    head = ["Parameter", "Value ± standard error", "Unit", "Verdict", "Remark"]
    return join(
        [tag("p", words), table("Parameters of the momentum disk.", head, rows, numeric=(1,))]
    )


def _table(c: PropellerCurves) -> Html:
    rows = [
        [*(number(float(v)) for v in values), number(float(eta)) if values[1] >= 0.0 else MISSING]
        for *values, eta in zip(c.J, c.CT, c.CP, c.eta, strict=True)
    ]
    notes = [tag("p", words, class_="note") for words in c.notes]
    caption = f"{c.method[0].upper()}{c.method[1:]}."
    return join([*notes, table(caption, ["J", "CT", "CP", "Efficiency"], rows, numeric=range(4))])


def _messages(messages: Sequence[Message]) -> Html:
    if not messages:
        return tag("p", mark("good", "Nothing to say."))
    return tag(
        "ul",
        *(
            tag("li", mark("caution", m.code) if m.level != "info" else tag("code", m.code),
                f" {m.where}: expected {m.expected}, found {m.found}. {m.do}")
            for m in messages
        ),
    )  # fmt: skip
