"""Blades from tables and files of others: what is wrong is named, with no value made of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.aircraft.load_blades import load_blades
from alula.aircraft.load_propeller import load_propeller
from alula.aircraft.propeller_files import read_blades, read_qprop
from alula.base.messages import BadInput

GOOD = {
    "count": 3,
    "diameter": 1.0,
    "r": [0.1, 0.3, 0.5],
    "chord": [0.06, 0.07, 0.03],
    "beta_deg": [40.0, 20.0, 12.0],
}
QPROP = """
Test

 2  3.0  ! Nblades  R
 0.5 5.8
 -0.3 1.2
 0.028 0.05 0.02 0.5
 70000 -0.7
 0.0254 0.0254 1.0
 0. 0. 0.
# r chord beta
 0.75 0.66 27.5
 1.5  0.63 15.2
 3.0  0.19  4.2
"""


def test_blades_are_in_si_and_radians() -> None:
    b = load_blades({**GOOD, "sense": "left"}, "a.toml, geometry.blades.left")
    assert (b.count, b.radius, b.hub_radius, b.sense) == (3, 0.5, 0.1, -1.0)
    assert b.pitch == pytest.approx(np.radians(GOOD["beta_deg"]))
    helix = load_blades({**GOOD, "beta_deg": None, "pitch": 0.8}, "a.toml")
    assert helix.helix == 0.8
    assert np.tan(helix.pitch) * 2.0 * np.pi * helix.r == pytest.approx(0.8)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"r": [0.1, 0.5, 0.3]}, "'r' increasing"),
        ({"r": [0.1, 0.3, 0.3]}, "'r' increasing"),
        ({"r": [0.1, 0.3, 0.6]}, "the tip at 0.5"),
        ({"r": [0.0, 0.3, 0.5]}, "between 0 and the tip"),
        ({"chord": [0.06, 0.0, 0.03]}, "0 m, station 2"),
        ({"chord": [0.06, -0.1, 0.03]}, "-0.1 m, station 2"),
        ({"chord": [0.06, 0.03]}, "2 of chord"),
        ({"chord": [0.06, float("nan"), 0.03]}, "finite"),
        ({"beta_deg": [95.0, 20.0, 10.0]}, "95 at station 1"),
        ({"beta_deg": None}, "neither"),
        ({"pitch": 0.4}, "both"),
        ({"hub_radius": 0.6}, "hub_radius 0.6"),
        ({"count": 0}, "greater than or equal to 1"),
        ({"polar": {"c_l_alpha": float("inf")}}, "polar.c_l_alpha"),
        ({"polar": {"alpha_deg": [0.0, 5.0], "c_l": [0.0, float("nan")], "c_d": [0.1, 0.1]}},
         "polar.c_l"),
        ({"polar": {"alpha_deg": [5.0, 0.0], "c_l": [0.0, 0.1], "c_d": [0.1, 0.1]}},
         "'alpha_deg' increasing"),
        ({"polar": {"c_d_0": 0.02}}, "neither"),
        ({"polar": {"c_l_alpha": 5.0, "c_l_min": 1.0, "c_l_max": 0.5}}, "c_l_min below"),
        ({"polars": [{"c_l_alpha": 5.0}]}, "one per station"),
        ({"momentum": {"c_l_alpha": 5.0, "alpha_max_deg": 0.0, "c_d_alpha": 1.0, "pitch": 0.3}},
         "alpha_max_deg"),
        ({"blade": 2}, "unknown_key"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(change, words) -> None:
    given = {k: v for k, v in {**GOOD, **change}.items() if v is not None}
    with pytest.raises(BadInput) as wrong:
        load_blades(given, "a.toml, geometry.blades.front")
    assert words in str(wrong.value)
    assert "a.toml, geometry.blades.front" in str(wrong.value)


def test_qprop_files_are_scaled_by_their_own_factors(tmp_path: Path) -> None:
    path = tmp_path / "p.def"
    path.write_text(QPROP)
    b = read_qprop(path)
    assert (b.name, b.count) == ("Test", 2)
    assert b.radius == pytest.approx(3.0 * 0.0254)
    assert b.chord[0] == pytest.approx(0.66 * 0.0254)
    assert b.polars[0].reynolds_power == -0.7
    path.write_text(QPROP.replace(" 2  3.0 ", " 2 ").replace("0. 0. 0.", "0. 0. 1.5"))
    b = read_qprop(path)
    assert b.radius == pytest.approx(3.0 * 0.0254)  # the last station's
    assert b.pitch[0] == pytest.approx(np.radians(29.0))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (" 0.5 5.8", " 0.5", "line 5"),
        (" 1.5  0.63 15.2", " 1.5  0.63", "3 numbers"),
        (" 1.5  0.63 15.2", " 0.5  0.63 15.2", "increasing"),
        (" 1.5  0.63 15.2", " 1.5  0.0 15.2", "station 2"),
        (" 1.5  0.63 15.2", " 1.5  nan 15.2", "finite"),
        ("70000", "seventy", "numbers"),
        (QPROP, "", "0 lines"),
        (QPROP, "\x00\x01\xff", "lines"),
    ],
)
def test_qprop_files_that_are_none_are_refused(tmp_path, old, new, words) -> None:
    path = tmp_path / "p.def"
    path.write_text(QPROP.replace(old, new))
    with pytest.raises(BadInput, match=words):
        read_qprop(path)


def test_uiuc_geometry_needs_a_diameter(tmp_path: Path) -> None:
    path = tmp_path / "blade.txt"
    path.write_text("r/R c/R beta\n0.2 0.1 30\n0.6 0.15 20\n1.0 0.05 10\n")
    with pytest.raises(BadInput, match="no_diameter"):
        read_blades(path)
    assert read_blades(path, 0.25, 3).chord[1] == pytest.approx(0.15 * 0.125)
    named = tmp_path / "maker_11x5.5_geom.txt"
    named.write_text(path.read_text())
    assert read_blades(named).diameter == pytest.approx(11 * 0.0254)
    for wrong in ("r/R c/R\n0.2 0.1\n", "", "r/R c/R beta\n", "r/R c/R beta\n0.2 x 30\n"):
        path.write_text(wrong)
        with pytest.raises(BadInput, match="bad_propeller_file"):
            read_blades(path, 0.25)


def test_other_files_are_refused(tmp_path: Path) -> None:
    for name, content in (("a.PE0", b"nothing"), ("b.toml", b"x ="), ("c.def", b"\xff\xfe\x00")):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(BadInput):
            load_propeller(path)
    with pytest.raises(BadInput, match="file_not_readable"):
        load_propeller(tmp_path / "none.def")


def test_the_example_of_the_page_is_a_propeller_file(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "propeller_file.md").read_text()
    path = tmp_path / "page.toml"
    path.write_text(page.split("```toml\n")[1].split("```")[0])
    found = load_propeller(path)
    assert found.blades.name == "20x10"
    assert found.blades.momentum is not None
    assert found.static_test is not None
    assert found.fit.J_max == 0.9
