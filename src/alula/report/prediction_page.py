"""The report of a prediction: one page, no script, nothing from outside."""

from __future__ import annotations

from math import degrees

from alula.predict.combine import as_flown
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.prediction import Prediction
from alula.report.html import Html, join, table, tag
from alula.report.numbers import MISSING, number, percent, plus_minus
from alula.report.pictures import mark
from alula.report.plain_page import Chapter, chapters_page
from alula.report.sections.geometry import geometry
from alula.report.span_loads import STYLE, span_load

_LOADED = 1e-4  # c_l below which a surface carries nothing to be drawn
_SHORT = 150  # letters of a source that stand unfolded
_MODEST = 0.35  # of the value: errors above it are marked
_STYLE = "td .source,td details.source{min-width:230px}"


def prediction_page(found: Prediction) -> str:
    """The page as HTML; the same input gives the same text."""
    return chapters_page(
        f"{found.aircraft.name} · prediction",
        "derivatives predicted from the shape",
        found.aircraft.name,
        _facts(found),
        _sections(found),
        STYLE + _STYLE,
    )


def _sections(found: Prediction) -> list[Chapter]:
    out = [("derivatives", "Derivatives", _derivatives(found))]
    point = found.neutral_point
    words = None if point is None else (point, f"predicted, ± {number(found.neutral_se, 2)} m")
    out.append(("geometry", "Geometry", geometry(found.aircraft, words)))
    if found.loads is not None:
        out.append(("loads", "Span loads", _loads(found)))
    if found.study is not None:
        out.append(("mesh", "Mesh study", _mesh(found)))
    out.append(("methods", "Methods and conditions", _methods(found)))
    out.append(("messages", "Messages", _messages(found)))
    return out


def _facts(found: Prediction) -> dict[str, str]:
    a, flow = found.aircraft, found.flow
    margin = found.margin
    return {
        "Method": found.derivatives.method,
        "True airspeed": f"{number(flow.V)} m/s",
        "Height": f"{number(found.h)} m",
        "Mach number": number(flow.mach, 3),
        "Angle of attack": f"{number(degrees(found.alpha), 3)}°",
        "S, b, c": f"{a.S:g} m², {a.b:g} m, {a.c:g} m",
        "Static margin, controls fixed": MISSING
        if margin is None
        else f"{percent(margin, 3)} of c",
    }


def _derivatives(found: Prediction) -> Html:
    shown = found.along("stability")
    turned = found.along("model")
    flown = {n: e for n, e in as_flown(shown).items() if n not in shown.values}
    several = len(found.parts) > 1
    head = ["Derivative", "Value ± standard deviation", "Of the value", "About body axes"]
    head += [p.method.capitalize() for p in found.parts] if several else []
    head += ["Source"]
    rows = []
    for name, e in [*shown.values.items(), *flown.items()]:
        body = turned.values.get(name)
        row: list[object] = [
            tag("code", name), _value(e), _share(e),
            _value(body) if body is not None and name not in flown else MISSING,
        ]  # fmt: skip
        if several:
            row += [_value(d.values.get(name)) for d in found.parts]
        rows.append([*row, _source(e.source) if name not in flown else "sum of the two"])
    said = [tag("p", words, class_="note") for words in found.conventions("stability")]
    return join(
        [
            *said,
            table(
                "Derivatives in stability axes; the last rows are what flight can tell of them.",
                head, rows, numeric=range(1, len(head) - 1), class_="dense",
            ),
        ]
    )  # fmt: skip


def _value(e: Estimate | None) -> str:
    if e is None:
        return MISSING
    return plus_minus(e.value, e.se) if e.se > 0.0 else number(e.value)


def _source(words: str) -> Html:
    """A long account folds: its head stands in the table."""
    if len(words) <= _SHORT:
        return tag("span", words, class_="source")
    head = words[:_SHORT].rsplit(" ", 1)[0]
    return tag("details", tag("summary", f"{head} …"), words, class_="source")


def _share(e: Estimate) -> object:
    if not e.value:
        return MISSING
    share = abs(e.se / e.value)
    words = percent(share, 2) if share <= 1.0 else "all of it"
    return mark("caution", words) if share > _MODEST else words


def _loads(found: Prediction) -> Html:
    r = found.loads
    assert r is not None
    c = r.coefficients("stability")
    words = (
        f"Surfaces alone, without bodies, at {number(degrees(r.alpha), 3)}°: CL "
        f"{number(c['CL'])}, induced CD {number(r.induced_drag, 3)} in the Trefftz plane, Oswald "
        f"factor {number(r.oswald, 3)} of {r.oswald_of}."
    )
    loaded = [s for s in r.span_loads if float(abs(s.c_l).max()) > _LOADED]
    figures = (
        tag("figure", tag("figcaption", s.surface), span_load(s, found.aircraft.c)) for s in loaded
    )
    rest = [s.surface for s in r.span_loads if s not in loaded]
    idle = tag("p", f"Without load: {', '.join(rest)}.", class_="note") if rest else None
    return join([tag("p", words), tag("div", *figures, class_="grid"), idle])


def _mesh(found: Prediction) -> Html:
    s = found.study
    assert s is not None
    rows = [
        [
            tag("code", name),
            *(number(float(v)) for v in values),
            number(s.limit[name]),
            number(s.error[name], 2),
        ]
        for name, values in s.values.items()
    ]
    head = ["Derivative", *(f"{n:.0f} panels" for n in s.counts), "No panel size", "Mesh error"]
    mesh = ", ".join(f"{n} {m} × {k}" for n, (m, k) in s.result.panels.mesh.items())
    words = (
        f"Surfaces alone at {number(degrees(s.result.alpha), 3)}°, body axes. First mesh: {mesh} "
        "(chord × span). The error, distance to the extrapolated value and departure from the "
        "line, is in the standard deviations above."
    )
    return join(
        [tag("p", words, class_="note"),
         table("Derivatives on ever finer panels.", head, rows, numeric=range(1, len(head)))]
    )  # fmt: skip


def _methods(found: Prediction) -> Html:
    return join(_conditions(part) for part in found.parts)


def _conditions(part: Derivatives) -> Html:
    rows = [[key, text] for key, text in part.conditions.items()]
    return table(f"{part.method.capitalize()}: conditions.", ["", ""], rows, class_="text")


def _messages(found: Prediction) -> Html:
    serious = [m for m in found.messages if m.level != "info"]
    said: list[Html] = [
        tag("li", mark("caution", m.code), f" {m.where}: expected {m.expected}, found {m.found}. ",
            m.do) for m in serious
    ]  # fmt: skip
    said += [
        tag("li", tag("code", m.code), f" {m.where}: {m.found}. {m.do}")
        for m in found.messages
        if m.level == "info"
    ]
    said += [tag("li", words) for words in found.derivatives.notes]
    return tag("ul", *said) if said else tag("p", mark("good", "Nothing outside its range."))
