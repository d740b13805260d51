"""The evidence index and the overlays, as text and in a browser."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from alula.flight import Maneuver
from alula.report import ReportInput, render
from alula.validate import Criterion, Evidence, Validation, judge, validate
from report.conftest import Opened
from validate.flights import aileron, changed, elevator, rudder, truth

HOSTILE = "<img src=x onerror=alert(1)>"


@pytest.fixture(scope="module")
def result() -> Validation:
    model = truth()
    covariance = np.diag((0.02 * model.values) ** 2)
    cases = [elevator(), replace(aileron(), seen="yes"), rudder()]
    return validate(replace(changed(model, Cm_de=1.5), covariance=covariance), cases, draws=4)


def page(result: Validation) -> str:
    report = ReportInput(
        name="Demo",
        path="demo.toml",
        date="2024-05-17",
        maneuvers=tuple(one.maneuver for one in result.flown),
        validation=result,
    )
    return render(report)


@pytest.fixture(scope="module")
def text(result: Validation) -> str:
    return page(result)


def test_every_requirement_is_in_the_index_and_links_to_its_overlay(
    result: Validation, text: str
) -> None:
    (table,) = re.findall(r'<table class="evidence.*?</table>', text, re.S)
    rows = re.findall(r"<tr>(.*?)</tr>", table, re.S)[1:]
    assert len(rows) == len(result.evidence) == 7
    for row, evidence in zip(rows, result.evidence, strict=True):
        assert evidence.entry in row
        assert evidence.title in row
        assert {"pass": "pass", "fail": "fail", "not_judged": "not judged"}[evidence.verdict] in row
        (anchor,) = re.findall(r'href="#(flown-\d)"', row)
        assert f'id="{anchor}"' in text
        k = int(anchor.removeprefix("flown-")) - 1
        assert result.flown[k].maneuver.id == evidence.maneuver
    assert "14 CFR Part 60, Appendix A, Table A2A (1-1-14 edition)" in table


def test_head_tells_the_worst(result: Validation, text: str) -> None:
    head = text[text.index("<header>") : text.index("</header>")]
    failed = result.count("fail")
    assert failed > 0
    assert f"{failed} of 7 requirements are not met by the model" in head
    assert "verdict-box bad" in head
    good = validate(truth(), [elevator()], draws=0)
    assert "The model flies like the aircraft: all 2 requirements are met" in page(good)


def test_what_the_estimate_saw_is_never_called_a_validation(result: Validation) -> None:
    seen = validate(truth(), [replace(elevator(), seen="yes")], draws=0)
    assert not seen.failed
    text = page(seen)
    head = text[text.index("<header>") : text.index("</header>")]
    assert "Not a validation" in head
    assert "verdict-box caution" in head
    (row,) = [r for r in re.findall(r"<tr>(.*?)</tr>", text, re.S) if "normal acceleration" in r]
    assert "seen by the estimate" in row
    assert "verdict good" not in row
    assert "Seen by the estimate: no validation." in text
    assert "The estimate never saw this maneuver." not in text


def test_divergence_and_offsets_and_recorded_coefficients_are_told() -> None:
    model = changed(truth(), Cm_alpha=-6.0, Cm_q=0.1)
    text = page(validate(model, [elevator()], draws=0, trim="entry"))
    assert re.search(r"flight diverged at 10\d\.\d+ s; shown and compared", text)
    assert "Trim offsets were added" in text
    drag = [k for k, (c, _) in enumerate(truth().terms) if c != "CD"]
    part = replace(
        truth(), terms=tuple(truth().terms[k] for k in drag), values=truth().values[drag]
    )
    text = page(validate(part, [elevator()], draws=0))
    assert "The model has no CD; the recorded history was flown" in text
    assert "as recorded: proves nothing" in text


def test_alternatives_stand_one_below_the_other(result: Validation, text: str) -> None:
    (row,) = [r for r in re.findall(r"<tr>(.*?)</tr>", text, re.S) if "or ±2 °/s pitch rate" in r]
    for column in re.findall(r"<td.*?</td>", row, re.S)[3:8]:
        assert column.count('class="line"') == 2


def test_numbers_that_are_none_are_dashes() -> None:
    row = Evidence("2.d.2", "Roll", "elevator", "±2", (), "not_judged", "no", None, "no reason")
    none = replace(validate(truth(), [elevator()], draws=0), evidence=(row,))
    assert not re.search(r"\bnan\b", page(none))
    criterion = Criterion("roll rate", "deg/s", 1.0, 2.0, 1.0, 2.0, True)
    one = replace(none, evidence=(replace(row, criteria=(criterion,), verdict="pass"),))
    assert "±2.00°/s" in page(one)


def test_names_from_a_project_stay_text(visit: Callable[..., Opened], result: Validation) -> None:
    first = result.flown[0]
    named = replace(first, maneuver=replace(first.maneuver, id=HOSTILE, kind=HOSTILE))
    evidence = tuple(replace(e, maneuver=HOSTILE) for e in judge(named))
    text = page(replace(result, model=HOSTILE, source=HOSTILE, flown=(named,), evidence=evidence))
    opened = visit(text)
    assert opened.complaints == []
    assert opened.page.locator("img").count() == 0


@pytest.mark.parametrize("width", [1280, 400])
def test_opens_with_every_plot_drawn(visit: Callable[..., Opened], text: str, width: int) -> None:
    opened = visit(text, width)
    assert opened.plots() == text.count("data-plot=") >= 3 * 5
    assert opened.complaints == []
    assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
    opened.page.locator('.evidence a[href="#flown-3"]').first.click()
    opened.page.wait_for_function(
        "() => Math.abs(document.querySelector('#flown-3').getBoundingClientRect().top) < 60"
    )


def test_an_empty_index_says_so() -> None:
    case = elevator()
    still = replace(case.motion, maneuver=Maneuver("m", "l", "spiral", 100.0, 112.0, "lateral"))
    text = page(validate(truth(), [replace(case, motion=still)], draws=0))
    assert "No maneuver serves a requirement of the regulation." in text
    assert "No requirement could be judged" in text
