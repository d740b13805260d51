"""What an identification shows beyond values: estimates over time, bias, amplitudes over Hz."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from alula.identify.result import History, Identification
from alula.report import ReportInput, render
from report.conftest import Opened
from report.example import MANEUVERS, example


def plots(text: str) -> list[dict[str, Any]]:
    block = re.search(r'id="alula-plots">(.*?)</script>', text, re.S)
    assert block is not None
    figures: list[dict[str, Any]] = json.loads(block[1])["figures"]
    return figures


def identified(report: ReportInput) -> Identification:
    assert report.identification is not None
    return report.identification


@pytest.fixture(scope="module")
def recursive() -> ReportInput:
    """Cl over two maneuvers that have constants of their own."""
    t = np.arange(500) / 20.0
    names = ("Cl_0[aileron]", "Cl_0[rudder]", "Cl_beta")
    se = 1e-3 + np.exp(-t)[:, None] * np.ones((1, 3))
    se[:5] = np.nan
    histories = tuple(
        History("Cl", m.id, names, t + m.start, -0.09 + 0.5 * se, se, np.full(len(t), 0.998))
        for m in MANEUVERS[1:]
    )
    report = example()
    return replace(report, identification=replace(identified(report), histories=histories))


def test_estimates_over_time_have_a_panel_for_each_of_the_maneuvers_own(
    recursive: ReportInput,
) -> None:
    text = render(recursive)
    assert "Cl over time · aileron" in text
    assert "Cl over time · rudder" in text
    drawn = [f for f in plots(text) if any(p["label"] == "Cl_0" for p in f["panels"])]
    assert [[p["label"] for p in f["panels"]] for f in drawn] == [["Cl_0", "Cl_beta"]] * 2
    assert text.count("Forgetting factor down to 0.998 per sample.") == 2
    assert "Estimates over time" not in render(example())


def test_amplitudes_over_frequency_are_not_drawn_over_time() -> None:
    report = example()
    first = identified(report).series[0]
    f = np.linspace(0.05, 2.0, len(first.t))
    amplitudes = replace(first, coefficient="q", t=f, over="Hz")
    text = render(replace(report, identification=replace(identified(report), series=(amplitudes,))))
    (figure,) = [p for p in plots(text) if p.get("over") == "Hz"]
    assert figure["group"] == "elevator, Hz"  # zooms by itself
    assert figure["panels"][0]["label"] == "q (°/s)"
    assert "over 0.05 to 2 Hz." in text


def test_bias_stands_beside_the_value_where_a_method_has_one() -> None:
    report = example()
    found = identified(report)
    assert "<th>Bias" not in render(report).replace(' scope="col"', "")
    biased = tuple(replace(p, bias=0.0123) for p in found.parameters)
    words = replace(found, parameters=biased, uncertainty="block bootstrap")
    text = render(replace(report, identification=words))
    assert text.count("0.012</td>") >= len(biased)
    assert "The method is biased" in text
    assert "‘se’: block bootstrap" in text


def test_sums_of_rates_and_terms_that_were_given_are_said() -> None:
    report = example()
    named = [replace(p, name=p.name.removesuffix("hat")) for p in identified(report).parameters]
    found = replace(
        identified(report),
        parameters=tuple(named),
        fixed={"Cm_df": -0.25},
        tied={"Cl_dr": ("Cl_da", -0.06)},
    )
    text = render(replace(report, identification=found))
    rates = [p.name for p in named if p.name.endswith(("_q", "_r"))]
    assert rates
    for name in rates:
        lag = "alphadot" if name.endswith("_q") else "betadot"
        assert re.search(rf"{name} is {name} . {name[:-2]}_{lag}", text)
    assert "Cm_df = −0.25" in text
    assert "Cl_dr = −0.0600 Cl_da" in text
    assert "Not estimated" not in render(report)


def test_all_of_it_draws_without_complaint(
    visit: Callable[..., Opened], recursive: ReportInput
) -> None:
    found = identified(recursive)
    first = found.series[0]
    amplitudes = replace(first, coefficient="q", t=np.linspace(0.05, 2.0, len(first.t)), over="Hz")
    both = replace(found, series=(*found.series, amplitudes))
    opened = visit(render(replace(recursive, identification=both)))
    assert opened.complaints == []
