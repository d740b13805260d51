"""The page stays under 3 MB whatever the project, and says what it leaves out for that."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from alula.base.arrays import Array, frozen
from alula.report import ReportInput, render
from alula.report.budget import LEAST
from alula.report.figures import Figure, FigureStore, Line, Panel
from report.conftest import Opened
from report.example import example


def campaign(count: int, rate: float) -> ReportInput:
    """The example's maneuvers over and over, each under a name and with a log of its own."""
    one = example(rate)
    assert one.reconstruction is not None
    assert one.identification is not None
    random = np.random.default_rng(5)  # equal arrays would be carried once

    def noisy(values: Array) -> Array:
        return frozen(values + random.normal(0.0, 1e-3, len(values)))

    maneuvers, segments, cards, series = [], [], [], []
    for k in range(count):
        j = k % 3
        segment, card = one.reconstruction.segments[j], one.cards[j]
        m = replace(segment.maneuver, id=f"maneuver_{k:04d}", log=f"log_{k:04d}")
        maneuvers.append(m)
        m = replace(m, held_out=k == 2)
        motion = replace(segment.motion, maneuver=m)
        states = segment.states + random.normal(0.0, 1e-3, segment.states.shape)
        sensors = tuple(
            replace(s, measured=noisy(s.measured), innovation=noisy(s.innovation))
            for s in segment.sensors
        )
        segments.append(
            replace(segment, maneuver=m, motion=motion, states=frozen(states), sensors=sensors)
        )
        files = tuple(replace(f, path=f"{m.log}.csv") for f in card.files)
        cards.append(replace(card, log=m.log, files=files))
        series += [
            replace(s, maneuver=m.id, held_out=m.held_out, measured=noisy(s.measured))
            for s in one.identification.series
            if s.maneuver == one.reconstruction.segments[j].maneuver.id
        ]
    return replace(
        one,
        cards=tuple(cards),
        maneuvers=tuple(maneuvers),
        reconstruction=replace(one.reconstruction, segments=tuple(segments)),
        identification=replace(one.identification, series=tuple(series)),
    )


@cache
def page(count: int, rate: float) -> str:
    """The campaign's page; several tests look at the same one."""
    return render(campaign(count, rate))


def plots(text: str) -> dict[str, Any]:
    found = re.search(r'id="alula-plots">(.*?)</script>', text, re.S)
    assert found
    data: dict[str, Any] = json.loads(found[1])
    return data


def samples(data: dict[str, Any], figure: dict[str, Any]) -> int:
    if "n" in figure["t"]:
        return int(figure["t"]["n"])
    jumps = figure["t"].get("jumps")
    content = base64.b64decode(data["arrays"][jumps or figure["t"]["y"]])
    return len(content) // (2 if jumps else 8)


@pytest.mark.parametrize(("count", "rate"), [(3, 1000.0), (44, 50.0), (1000, 10.0)])
def test_page_stays_under_3_megabytes(count: int, rate: float) -> None:
    text = page(count, rate)
    assert len(text.encode()) < 3_000_000
    data = plots(text)
    assert len(data["figures"]) > 50
    # no plot is so thin that its course is lost: half of the least, where extremes coincide
    assert min(samples(data, f) for f in data["figures"]) >= min(LEAST // 2, 25 * rate)


def test_the_room_is_used() -> None:
    assert len(page(44, 50.0).encode()) > 2_000_000


def test_what_is_left_out_is_named_and_the_held_out_is_drawn() -> None:
    text = page(44, 50.0)
    drawn = {f["group"] for f in plots(text)["figures"]}
    assert "maneuver_0002" in drawn
    said = re.search(r"Plots of (\d+) of 44 maneuvers are drawn.*?</p>", text, re.S)
    assert said
    left = re.findall(r"<code>(maneuver_\d+)</code>", said[0])
    assert len(left) == 44 - int(said[1])
    assert 0 < len(left) < 44
    section = text[text.index('id="reconstruction"') : text.index('id="coefficients"')]
    for name in left:  # in the tables all the same
        assert name in section.replace(said[0], "")


def test_long_tables_say_what_they_leave_out() -> None:
    text = page(1000, 10.0)
    assert "600 further rows are left out" in text  # of the 1000 maneuvers
    assert "The channels of 875 of 1000 logs are left out" in text  # eight channels each


def test_a_small_page_leaves_out_nothing() -> None:
    text = render(example())
    for words in ("left out", "hown thinned", "maneuvers are drawn"):
        assert words not in text


def test_thinned_values_are_rounded_far_below_a_pixel() -> None:
    """What the 16 bits hold, against the samples themselves."""
    t = np.linspace(3.0, 23.0, 4001)
    values = 1000.0 + np.sin(t)
    values[2000:2100] = np.nan
    store = FigureStore(300)
    place = store.add(Figure("y", "m", t, (Panel("y", (Line("y", values, "estimate"),)),)))
    (figure,) = json.loads(re.search(r">(.*)</script>", store.block())[1])["figures"]  # type: ignore[index]
    arrays = json.loads(re.search(r">(.*)</script>", store.block())[1])["arrays"]  # type: ignore[index]
    low, step, name = figure["panels"][0]["lines"][0]["y"]
    whole = np.frombuffer(base64.b64decode(arrays[name]), "<u2")
    jumps = np.frombuffer(base64.b64decode(arrays[figure["t"]["jumps"]]), "<u2")
    at = np.cumsum(jumps)
    assert at[0] == 0
    assert at[-1] == 4000
    assert (whole == 65535).tolist() == np.isnan(values[at]).tolist()
    there = whole < 65535
    # half a step of a 65534th of the range of 2
    np.testing.assert_allclose(low + step * whole[there], values[at][there], atol=1.6e-5)
    assert "Shown thinned" in place


def test_a_thinned_page_opens_with_every_plot_drawn(visit: Callable[..., Opened]) -> None:
    opened = visit(render(campaign(12, 100.0)))
    assert opened.complaints == []
    assert opened.plots() > 100
    low, high = opened.drawn(0)
    assert high - low == pytest.approx(25.0, abs=0.01)
