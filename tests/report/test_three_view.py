"""The three-view drawing: everything at its place, at one scale, in the report."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import Aircraft, load_aircraft
from alula.identify.result import Identification, Parameter
from alula.report import render
from alula.report.sections.geometry import identified_neutral_point
from alula.report.three_view import three_view, views
from report.conftest import Opened
from report.example import example

SPORTSTAR = Path(__file__).parents[2] / "aircraft" / "sportstar.toml"


@pytest.fixture(scope="module")
def aircraft() -> Aircraft:
    return load_aircraft(SPORTSTAR)


def numbers(path: str) -> np.ndarray:
    return np.array([float(x) for x in re.findall(r"-?[\d.]+", path)]).reshape(-1, 2)


def test_views_have_one_scale_and_the_aircraft_s_sizes(aircraft: Aircraft) -> None:
    found = {}
    for title, svg in views(aircraft, np.array([-0.2, 0.0, 0.0])):
        root = ET.fromstring(svg)
        surfaces = [
            numbers(p.get("d", "")) for p in root.iter("path") if p.get("class") == "surface"
        ]
        every = np.concatenate(surfaces)
        found[title] = np.ptp(every, axis=0)
        width, height = float(root.get("width", 0)), float(root.get("height", 0))
        # Nothing is cut off.
        for p in root.iter("path"):
            if p.get("class") in ("surface", "body", "disk"):
                xy = numbers(p.get("d", ""))
                assert (xy >= 0.0).all()
                assert (xy <= [width, height]).all()
        names = [t.text for t in root.iter("text")]
        assert {"CG", "NP", "imu", "airdata", "propeller"} <= set(names)
        assert "reference" not in names  # the CG is there
    scale = found["from above"][0] / 8.65
    # Coordinates have a tenth of a pixel.
    assert found["from ahead"][0] == pytest.approx(8.65 * scale, abs=0.2)
    length = 0.444 + 4.225  # foremost leading edge to the rudder's trailing edge
    assert found["from above"][1] == pytest.approx(length * scale, abs=0.3)
    assert found["from the left"][0] == pytest.approx(length * scale, abs=0.3)
    assert found["from the left"][1] == pytest.approx(1.3 * scale, abs=0.3)


def test_directions(aircraft: Aircraft) -> None:
    """Above: nose up, right wing right. Left: nose left, fin up. Ahead: right wing on the left."""
    drawn = {title: ET.fromstring(svg) for title, svg in views(aircraft)}

    def sensor(view: str) -> np.ndarray:
        marks = [p for p in drawn[view].iter("path") if p.get("class") == "sensor"]
        return numbers(marks[1].get("d", "").split("l")[0])[0]  # airdata: under the left wing

    def engine(view: str) -> np.ndarray:
        (dot,) = [p for p in drawn[view].iter("circle") if p.get("class") == "engine"]
        return np.array([float(dot.get("cx", 0)), float(dot.get("cy", 0))])

    def surface(view: str, k: int) -> np.ndarray:
        paths = [p for p in drawn[view].iter("path") if p.get("class") == "surface"]
        return numbers(paths[k].get("d", ""))

    assert sensor("from above")[0] < engine("from above")[0]  # left is left
    assert engine("from above")[1] < surface("from above", 0)[:, 1].min()
    assert engine("from the left")[0] < surface("from the left", 0)[:, 0].min()
    assert surface("from the left", -1)[:, 1].min() < surface("from the left", 0)[:, 1].min()
    assert sensor("from ahead")[0] > engine("from ahead")[0]  # left is right


def test_names_do_not_cover_each_other(aircraft: Aircraft) -> None:
    for _, svg in views(aircraft, np.array([-0.2, 0.0, 0.0])):
        boxes = []
        for t in ET.fromstring(svg).iter("text"):
            x, y, wide = float(t.get("x", 0)), float(t.get("y", 0)), 6.5 * len(t.text or "")
            boxes.append((x - wide if t.get("text-anchor") == "end" else x, y, wide))
        for i, (x, y, wide) in enumerate(boxes):
            for u, v, w in boxes[i + 1 :]:
                assert abs(y - v) >= 12.0 or x + wide <= u or u + w <= x


def test_alone_is_xml_with_its_style(aircraft: Aircraft) -> None:
    named = replace(aircraft, name="<b>&'", sensors={"<i>": np.zeros(3)})
    root = ET.fromstring(three_view(named))
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert "threeview" in (root.find("{*}style").text or "")  # type: ignore[union-attr]
    assert len(root.findall("{*}g")) == 3


def identification(**values: float) -> Identification:
    given = example().identification
    assert given is not None
    first: Parameter = given.parameters[0]
    chosen = (replace(first, name=k, value=v, verdict="ok") for k, v in values.items())
    return replace(given, parameters=tuple(chosen))


def test_neutral_point_of_what_was_identified(aircraft: Aircraft) -> None:
    # Static margin of 10 %: x = -0.1 c behind the reference point.
    found = identified_neutral_point(aircraft, identification(Cm_alpha=-0.5, CL_alpha=5.0))
    assert found is not None
    np.testing.assert_allclose(found[0] - aircraft.reference_point, [-0.125, 0.0, 0.0])
    by_z = identified_neutral_point(aircraft, identification(Cm_alpha=-0.5, CZ_alpha=-5.0))
    assert by_z is not None
    np.testing.assert_allclose(by_z[0], found[0])
    assert "CZ_alpha" in by_z[1]
    assert identified_neutral_point(aircraft, identification(Cm_alpha=-0.5)) is None
    assert identified_neutral_point(aircraft, None) is None


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark")])
def test_report_has_the_drawing(
    visit: Callable[..., Opened], aircraft: Aircraft, width: int, scheme: str
) -> None:
    opened = visit(render(replace(example(), shape=aircraft)), width, scheme)
    assert opened.complaints == []
    drawings = opened.page.locator("#geometry svg.threeview")
    assert drawings.count() == 3
    assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
    boxes = [drawings.nth(k).bounding_box() for k in range(3)]
    assert len({round(b["width"]) for b in boxes}) == 1  # one scale
    assert boxes[0]["width"] > 300
    assert "NACA 0015" in opened.page.locator("#geometry").inner_text()


def test_no_section_without_a_geometry(aircraft: Aircraft) -> None:
    assert 'id="geometry"' not in render(replace(example(), shape=replace(aircraft, geometry=None)))
    assert 'id="geometry"' not in render(example())
