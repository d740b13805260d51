"""Shapes that are none: each is refused with its place in the file, what was expected and found."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from alula.aircraft import Aircraft, load_aircraft
from alula.base.messages import BadInput, Message

GOOD = """schema = "alula.aircraft/1"
name = "test"
[reference]
S = 8.0
b = 8.0
c = 1.0
[controls.de]
sign = "+TED"
[controls.da]
sign = "+RTED"
[[geometry.surfaces]]
name = "wing"
role = "wing"
mirror = true
sections = [
  {position = [0.25, 0.0, 0.0], chord = 1.0, airfoil = "NACA 2412"},
  {position = [0.25, 2.0, 0.0], chord = 1.0, airfoil = "NACA 2412"},
  {position = [0.25, 4.0, 0.0], chord = 1.0, airfoil = "thin"},
]
controls = [
  {name = "flap", span = [0.1, 0.5], hinge = 0.8, gains = {de = 0.1}},
  {name = "aileron", span = [0.5, 1.0], hinge = [0.75, 0.7], gains = {da = 1.0}},
]
[[geometry.surfaces]]
name = "tailplane"
role = "tailplane"
mirror = true
sections = [
  {position = [-4.0, 0.0, -0.1], chord = 0.6, airfoil = "NACA 0009"},
  {position = [-4.0, 1.2, -0.1], chord = 0.6, airfoil = "NACA 0009"},
]
[[geometry.surfaces]]
name = "fin"
role = "fin"
mirror = false
sections = [
  {position = [-4.0, 0.0, -0.1], chord = 0.7, airfoil = "NACA 0009"},
  {position = [-4.2, 0.0, -1.0], chord = 0.5, airfoil = "NACA 0009"},
]
[[geometry.bodies]]
name = "fuselage"
stations = [[1.5, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.8, 1.0], [-4.5, 0.0, 0.0, 0.1, 0.2]]
[geometry.airfoils.thin]
thickness = 0.08
camber = [[0.0, 0.0], [0.4, 0.02], [1.0, 0.0]]
[geometry.airfoils.thin.polar]
alpha_deg = [-5.0, 0.0, 5.0]
c_l = [-0.4, 0.1, 0.6]
c_d = [0.012, 0.008, 0.012]
source = "made up"
"""
LAST = '{position = [0.25, 4.0, 0.0], chord = 1.0, airfoil = "thin"},'
POLAR = GOOD[GOOD.index("alpha_deg") : GOOD.index("source")]


def load(tmp_path: Path, text: str) -> Aircraft:
    path = tmp_path / "aircraft.toml"
    path.write_text(text)
    return load_aircraft(path)


def refusal(tmp_path: Path, text: str) -> tuple[Message, ...]:
    with pytest.raises(BadInput) as error:
        load(tmp_path, text)
    for m in error.value.messages:
        assert m.where
        assert m.expected
        assert m.found
        assert m.do
    return error.value.messages


def test_the_text_that_is_spoiled_below_is_good(tmp_path: Path) -> None:
    assert load(tmp_path, GOOD).messages == ()


@pytest.mark.parametrize(
    ("old", "new", "code", "where", "words"),
    [
        # zero area
        ("[0.25, 4.0, 0.0], chord = 1.0", "[0.25, 4.0, 0.0], chord = 0.0", "bad_value",
         "surfaces[1].sections[3].chord", "greater than 0"),
        ("[0.25, 2.0, 0.0]", "[0.25, 0.0, 0.0]", "zero_area", "wing.sections[2]", "no area"),
        ("[0.0, 0.0, 0.0, 0.8, 1.0]", "[0.0, 0.0, 0.0, 0.0, 1.0]", "zero_area",
         "fuselage.stations[2]", "0 and 1 m"),
        ("[1.5, 0.0, 0.0, 0.0, 0.0]", "[1.5, 0.0, 0.0, -0.1, 0.1]", "zero_area",
         "fuselage.stations[1]", "-0.1"),
        # crossing
        ("[0.25, 2.0, 0.0]", "[0.25, 5.0, 0.0]", "crossing_sections", "wing.sections",
         "the strip from section 2 to 3 lies over that from 1 to 2"),
        ("[0.25, 2.0, 0.0]", "[0.25, -2.0, 0.0]", "crossing_sections", "wing.sections", "-2"),
        ("[-4.2, 0.0, -1.0]", "[-4.2, 0.0, -0.101]", "crossing_sections", "fin.sections", "deg"),
        ('role = "fin"\nmirror = false', 'role = "fin"\nmirror = true', "coincident_surfaces",
         "surfaces.fin", "'fin' and its own mirror image"),
        # hinges and spans
        ("hinge = 0.8", "hinge = 1.2", "hinge_outside", "wing.controls.flap.hinge", "1.2"),
        ("hinge = 0.8", "hinge = 75", "hinge_outside", "wing.controls.flap.hinge", "75"),
        ("hinge = 0.8", "hinge = [0.8, -0.1]", "hinge_outside", "flap.hinge", "-0.1"),
        ("span = [0.1, 0.5]", "span = [0.1, 0.6]", "overlapping_controls", "wing.controls",
         "'flap' (0.1 to 0.6) and 'aileron' (0.5 to 1)"),
        ("span = [0.1, 0.5]", "span = [0.5, 0.1]", "control_span", "flap.span", "[0.5, 0.1]"),
        ("span = [0.5, 1.0]", "span = [2.0, 4.0]", "control_span", "aileron.span", "[2, 4]"),
        # controls
        ("gains = {da = 1.0}", "gains = {aileron = 1.0}", "unknown_control",
         "wing.controls.aileron.gains", "'aileron'"),
        ("gains = {da = 1.0}", "gains = {}", "bad_value", "gains", "at least 1"),
        ("gains = {da = 1.0}", "gains = {da = 0.0}", "control_without_surface", "gains.da", "0"),
        ('name = "flap"', 'name = "aileron"', "bad_value", "geometry", "'aileron' more than once"),
        ('name = "fin"', 'name = "wing"', "bad_value", "geometry", "'wing' more than once"),
        # bodies
        ("[0.0, 0.0, 0.0, 0.8, 1.0]", "[2.0, 0.0, 0.0, 0.8, 1.0]", "body_order",
         "fuselage.stations[2]", "0.5 m ahead"),
        ("[0.0, 0.0, 0.0, 0.8, 1.0], ", "", "bad_value", "bodies[1].stations", "at least 3"),
        ("[0.0, 0.0, 0.0, 0.8, 1.0]", "[0.0, 0.0, 0.8, 1.0]", "bad_value", "stations[2]", "5"),
        # airfoils and polars
        ('"NACA 2412"', '"NACA 2400"', "unknown_airfoil", "sections[1].airfoil", "NACA 2400"),
        ('"NACA 2412"', '"thn"', "unknown_airfoil", "sections[1].airfoil", "thn"),
        ("thickness = 0.08\n", "", "bad_airfoil", "airfoils.thin", "neither"),
        ("thickness = 0.08", 'naca = "24x2"', "bad_airfoil", "airfoils.thin.naca", "24x2"),
        ("[0.4, 0.02]", "[1.4, 0.02]", "bad_camber", "airfoils.thin.camber", "not increasing"),
        ("[0.0, 0.0], [0.4, 0.02]", "[0.1, 0.0], [0.4, 0.02]", "bad_camber", "thin.camber", "0.1"),
        ("[-5.0, 0.0, 5.0]", "[-5.0, 5.0, 0.0]", "polar_order", "thin.polar", "0 after 5"),
        ("[-5.0, 0.0, 5.0]", "[-5.0, 0.0, 0.0]", "polar_order", "thin.polar", "0 after 0"),
        ("[-0.4, 0.1, 0.6]", "[-0.4, nan, 0.6]", "bad_value", "polar.c_l[2]", "finite"),
        ("[-0.4, 0.1, 0.6]", "[-0.4, inf, 0.6]", "bad_value", "polar.c_l[2]", "finite"),
        ("[-0.4, 0.1, 0.6]", "[-0.4, 0, 0.1, 1]", "bad_value", "thin.polar",
         "3 of alpha_deg, 4 of c_l"),
        (POLAR, "", "bad_value", "thin.polar", "no alpha_deg, c_l, c_d"),
        (POLAR, 'file = "none.csv"\n', "file_not_readable", "none.csv", "No such file"),
        ('name = "fin"', 'name = "fin"\npanels = [0, 4]', "bad_value", "panels[1]", "0"),
    ],
)  # fmt: skip
def test_each_is_refused_with_its_place(
    tmp_path: Path, old: str, new: str, code: str, where: str, words: str
) -> None:
    assert old in GOOD
    messages = refusal(tmp_path, GOOD.replace(old, new, 1))
    assert any(
        m.code == code and where in m.where and words in f"{m.expected} {m.found}" for m in messages
    ), messages


@pytest.mark.parametrize(
    ("sections", "mirror", "names"),
    [
        # In the wing's plane and partly over it, moved and of another chord.
        ("[0.0, 1.0, 0.0], chord = 0.3", "[0.0, 3.0, 0.0], chord = 0.2", "'wing' and 'canard'"),
        # Across the plane of symmetry: it lies in both halves.
        ("[0.0, -1.0, 0.0], chord = 0.3", "[0.0, 1.0, 0.0], chord = 0.3", "'wing' and 'canard'"),
        # A thousandth of a millimeter above it.
        ("[0.2, 1.0, -1e-6], chord = 0.9", "[0.2, 2.0, -1e-6], chord = 0.9", "'canard'"),
    ],
)
def test_surfaces_in_one_place_are_named(
    tmp_path: Path, sections: str, mirror: str, names: str
) -> None:
    extra = f"""[[geometry.surfaces]]
name = "canard"
role = "other"
mirror = false
sections = [{{position = {sections}, airfoil = "NACA 0009"}},
  {{position = {mirror}, airfoil = "NACA 0009"}}]
[[geometry.bodies]]"""
    messages = refusal(tmp_path, GOOD.replace("[[geometry.bodies]]", extra))
    assert [m.code for m in messages] == ["coincident_surfaces"], messages
    assert names in messages[0].found


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("[0.0, 1.0, -0.5], chord = 0.3", "[0.0, 3.0, -0.5], chord = 0.2"),  # above the wing
        ("[2.0, 0.0, 0.0], chord = 0.5", "[2.0, 1.0, 0.0], chord = 0.5"),  # ahead of it
        ("[0.1, 4.0, 0.0], chord = 0.6", "[0.0, 4.0, -0.5], chord = 0.3"),  # a winglet
        ("[0.1, 2.0, 0.3], chord = 0.6", "[0.1, 2.0, -0.3], chord = 0.6"),  # a fence through it
    ],
)
def test_surfaces_that_only_meet_are_taken(tmp_path: Path, first: str, second: str) -> None:
    extra = f"""[[geometry.surfaces]]
name = "more"
role = "other"
mirror = false
sections = [{{position = {first}, airfoil = "NACA 0009"}},
  {{position = {second}, airfoil = "NACA 0009"}}]
[[geometry.bodies]]"""
    assert load(tmp_path, GOOD.replace("[[geometry.bodies]]", extra)).messages == ()


def test_a_control_that_moves_nothing_is_said(tmp_path: Path) -> None:
    text = GOOD.replace("[controls.da]", '[controls.dr]\nsign = "+TEL"\n[controls.da]')
    (message,) = load(tmp_path, text).messages
    assert message.code == "control_without_surface"
    assert message.level == "warning"
    assert "'dr'" in message.expected


def test_a_wing_of_another_span_than_the_reference_is_said(tmp_path: Path) -> None:
    found = load(tmp_path, GOOD.replace("b = 8.0", "b = 4.0").replace("c = 1.0\n", "c = 2.0\n"))
    (message,) = found.messages
    assert message.code == "geometry_reference"
    assert "8 from the sections" in message.found


def test_body_in_the_other_frame_is_told(tmp_path: Path) -> None:
    text = GOOD.replace("[reference]", '[datum]\nname = "nose"\nframe = "design"\n[reference]')
    messages = refusal(tmp_path, text)
    assert any("all from tail to nose" in m.found and "frame" in m.do for m in messages)


@pytest.mark.parametrize(
    ("csv", "code", "words"),
    [
        ("alpha_deg,c_l,c_d\n-5,-.4,.01\n0,nan,.01\n5,.6,.01\n", "polar_not_finite", "line 3"),
        ("# run 7\nalpha_deg,c_l,c_d\n-5,-.4,.01\n0,0,\n5,.6,.01\n", "polar_not_finite", "line 4"),
        ("alpha_deg,c_l,c_d\n-5,-.4,.01\n5,0,.01\n0,.6,.01\n", "polar_order", "0 after 5"),
        ("alpha,cl,cd\n-5,-.4,.01\n", "polar_columns", "alpha,cl,cd"),
        ("", "polar_columns", "no line"),
        ("alpha_deg,c_l,c_d\n-5,-.4,.01\n0,0,.01\n", "polar_columns", "2"),
    ],
)
def test_polar_files(tmp_path: Path, csv: str, code: str, words: str) -> None:
    (tmp_path / "thin.csv").write_text(csv)
    messages = refusal(tmp_path, GOOD.replace(POLAR, 'file = "thin.csv"\n'))
    assert messages[0].code == code
    assert words in str(messages[0])
    assert "thin.csv" in messages[0].where


def test_every_wrong_thing_has_its_message(tmp_path: Path) -> None:
    text = GOOD.replace("hinge = 0.8", "hinge = 1.5").replace("[0.0, 0.0, 0.0, 0.8, 1.0]",
        "[2.0, 0.0, 0.0, 0.8, 1.0]").replace("gains = {da", "gains = {dx")  # fmt: skip
    codes = {m.code for m in refusal(tmp_path, text)}
    assert codes == {"hinge_outside", "body_order", "unknown_control"}


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(*[st.sampled_from([-1e12, -1.0, 0.0, 1e-9, 0.5, 1.0, 1e12])] * 4),
        min_size=2, max_size=4,
    ),
    st.booleans(),
)  # fmt: skip
def test_any_sections_load_or_are_refused(
    tmp_path_factory: pytest.TempPathFactory,
    sections: list[tuple[float, float, float, float]],
    mirror: bool,
) -> None:
    rows = ",".join(
        f'{{position = [{x!r}, {y!r}, {z!r}], chord = {c!r}, airfoil = "NACA 0009"}}'
        for x, y, z, c in sections
    )
    start, end = (
        GOOD.index("mirror = true\nsections"),
        GOOD.index('[[geometry.surfaces]]\nname = "t'),
    )
    text = f"{GOOD[:start]}mirror = {str(mirror).lower()}\nsections = [{rows}]\n{GOOD[end:]}"
    with contextlib.suppress(BadInput):
        shape = load(tmp_path_factory.getbasetemp(), text).geometry
        assert shape is not None
        assert shape.surfaces[0].arc()[-1] > 0.0
