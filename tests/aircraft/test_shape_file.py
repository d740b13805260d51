"""Shapes from aircraft files: frames, airfoils, polars, and the SportStar's beside its source."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import aircraft_schema, load_aircraft
from alula.aircraft.naca import naca_camber, naca_digits
from data import data

SPORTSTAR = Path(__file__).parents[2] / "aircraft" / "sportstar.toml"
# Of the reference's frame (x aft, z up) the datum is the point at 30 % of c behind its leading
# edge, which is the reference's origin.
DATUM = 0.30 * 1.25


def test_sportstar_has_the_reference_s_shape() -> None:
    reference = json.loads(data("references", "vortex_lattice.json").read_text())
    case = next(c for c in reference["cases"] if "SportStar" in c["name"])
    aircraft = load_aircraft(SPORTSTAR)
    shape = aircraft.geometry
    assert shape is not None
    assert (aircraft.S, aircraft.b, aircraft.c) == (case["S"], case["b"], case["c"])
    assert case["x_ref"] == pytest.approx(0.25 * aircraft.c)
    assert "geometry" in aircraft.assumed
    panels = case["expected"][0]["panels"]
    for ours, theirs in zip(shape.surfaces, case["surfaces"], strict=True):
        assert ours.mirror == theirs["mirror"]
        assert list(ours.panels) == panels[theirs["name"]]
        for section, (x, y, z, chord) in zip(ours.sections, theirs["sections"], strict=True):
            np.testing.assert_allclose(section.position, [DATUM - x, y, -z], atol=1e-12)
            assert section.chord == chord
            assert section.twist == 0.0
            assert shape.airfoils[section.airfoil].camber is None  # thin and flat there
        (control,) = ours.controls
        assert control.hinge == (theirs["control"]["hinge"],) * 2
        assert (control.start, control.end) == (0.0, 1.0)
    (body,) = shape.bodies
    assert body.sections[0].position[0] - body.sections[-1].position[0] == pytest.approx(5.98)


TEXT = """schema = "alula.aircraft/1"
name = "test"
[datum]
name = "nose"
frame = "{frame}"
[reference]
S = 8.0
b = 8.0
c = 1.0
[[geometry.surfaces]]
name = "wing"
role = "wing"
mirror = true
sections = [
  {{position = [{x}, 0.0, {z}], chord = 1.0, airfoil = "NACA 2412"}},
  {{position = [{x}, 4.0, {z}], chord = 1.0, twist_deg = -3.0, airfoil = "tip"}},
]
controls = [{{name = "flap", span = [0.25, 0.5], hinge = [0.8, 0.7], gains = {{df = 1.0}}}}]
[geometry.airfoils.tip]
naca = "4412"
c_l_alpha = 6.0
alpha_0_deg = -4.0
[geometry.airfoils.tip.polar]
file = "tip.csv"
reynolds = 1e6
source = "made up"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    rows = "# a comment\nc_l,alpha_deg,c_d\n-0.4,-5,0.01\n0.1,0,0.008\n\n0.6,5,0.01\n"
    (tmp_path / "tip.csv").write_text(rows)
    return tmp_path


def test_frames_meet(folder: Path) -> None:
    shapes = []
    for frame, x, z in (("design", 2.0, 0.3), ("body", -2.0, -0.3)):
        path = folder / f"{frame}.toml"
        path.write_text(TEXT.format(frame=frame, x=x, z=z))
        shapes.append(load_aircraft(path).geometry)
    for shape in shapes:
        assert shape is not None
        (wing,) = shape.surfaces
        np.testing.assert_allclose(wing.sections[1].position, [-2.0, 4.0, -0.3])
        assert wing.sections[1].twist == pytest.approx(np.radians(-3.0))  # nose down in both
        tip = shape.airfoils["tip"]
        assert (tip.thickness, tip.c_l_alpha) == (0.12, 6.0)
        assert tip.alpha_0 == pytest.approx(np.radians(-4.0))
        assert tip.polar is not None
        np.testing.assert_allclose(np.degrees(tip.polar.alpha), [-5.0, 0.0, 5.0])
        np.testing.assert_array_equal(tip.polar.c_l, [-0.4, 0.1, 0.6])
        np.testing.assert_array_equal(tip.polar.c_m, 0.0)
        assert wing.arc()[-1] == 4.0
        lead, chord, twist = wing.at(0.5)
        np.testing.assert_allclose(lead, [-2.0, 2.0, -0.3])
        assert (chord, twist) == (1.0, pytest.approx(np.radians(-1.5)))


def test_naca_mean_lines() -> None:
    """NACA Report 460: camber m at p, level there; zero lift of the 2412 at -2.08 deg."""
    assert naca_digits("NACA 2412") == (0.02, 0.4, 0.12)
    assert naca_digits("naca0009") == (0.0, 0.0, 0.09)
    for name in ("NACA 23012", "NACA 2400", "NACA 2012", "Clark Y", "NACA 0412"):
        assert naca_digits(name) is None, name
    assert naca_camber(0.0, 0.0) is None
    line = naca_camber(0.02, 0.4)
    assert line is not None
    x, z = line.T
    assert (x[0], x[-1], z[0], z[-1]) == (0.0, 1.0, 0.0, 0.0)
    assert (np.diff(x) > 0.0).all()
    assert z.max() == pytest.approx(0.02, abs=1e-15)
    assert x[z.argmax()] == 0.4
    # Glauert: alpha_0 = -1/pi integral of dz/dx (cos(theta) - 1) dtheta, sign by lift up.
    slope = np.diff(z) / np.diff(x)
    theta = np.arccos(1.0 - 2.0 * x)
    weight = np.diff(np.sin(theta) - theta)
    alpha_0 = -float(slope @ weight) / np.pi
    # Abbott and von Doenhoff 1959 give -2.077 deg for this mean line; 100 straight pieces.
    assert np.degrees(alpha_0) == pytest.approx(-2.077, abs=0.002)


def test_schema_knows_the_geometry() -> None:
    schema = aircraft_schema()
    assert "geometry" in schema["properties"]
    assert {"SurfaceTable", "BodyTable", "AirfoilTable", "PolarTable"} <= set(schema["$defs"])
    assert "description" in schema["$defs"]["SectionTable"]["properties"]["position"]


def test_blades_of_no_engine_are_refused(folder: Path) -> None:
    from alula.base.messages import BadInput

    path = folder / "aircraft.toml"
    path.write_text(
        TEXT.format(frame="body", x=-2.0, z=0.0) + "[geometry.blades.nose]\ncount = 2\n"
    )
    with pytest.raises(BadInput):
        load_aircraft(path)
