"""Planforms beside closed forms and Pusztai's published surfaces."""

from __future__ import annotations

import numpy as np
import pytest

from alula.aircraft.geometry import (
    Airfoil,
    Body,
    CrossSection,
    Geometry,
    LiftingSurface,
    Role,
    Section,
)
from alula.base.arrays import frozen
from alula.predict.body_shape import BodyShape
from alula.predict.planform import exposed_area, planform, tail_volume, wetted_area


def surface(role: Role, mirror: bool, *rows: tuple[float, float, float, float]) -> LiftingSurface:
    """Rows x, y, z of the leading edge and chord, m."""
    sections = tuple(Section(frozen(row[:3]), row[3], 0.0, "flat") for row in rows)
    return LiftingSurface("surface", role, sections, mirror)


def test_armhawk_wing_as_printed() -> None:
    """Pusztai 2018, appendix C.1; the tolerances are half a unit of the last printed digit."""
    half, sweep = 0.75, np.radians(4.04)
    wing = planform(
        surface("wing", True, (-0.22, 0, 0, 0.335), (-0.22 - half * np.tan(sweep), half, 0, 0.260))
    )
    assert wing.area == pytest.approx(0.446, abs=5e-4)
    assert wing.aspect == pytest.approx(5.04, abs=5e-3)
    assert wing.taper == pytest.approx(0.776, abs=5e-4)
    assert wing.chord == pytest.approx(0.299, abs=5e-4)
    # Printed as 0.360: he divides rounded chords; the formula gives 0.3592.
    assert wing.y_mean == pytest.approx(0.360, abs=2e-3)
    assert np.degrees(wing.sweep_leading) == pytest.approx(4.04, abs=5e-3)
    assert np.degrees(wing.sweep_quarter) == pytest.approx(2.62, abs=0.01)  # his 'MAC', rounded
    # X_ac, behind the root's leading edge.
    assert -0.22 - wing.quarter_chord[0] == pytest.approx(0.100, abs=5e-4)


def test_armhawk_tailplane_as_printed() -> None:
    """Appendix C.2."""
    tail = planform(surface("tailplane", True, (-1.21, 0, 0, 0.174), (-1.21, 0.325, 0, 0.174)))
    assert tail.area == pytest.approx(0.1131, abs=5e-5)
    assert tail.aspect == pytest.approx(3.74, abs=5e-3)
    assert -1.21 - tail.quarter_chord[0] == pytest.approx(0.0435, abs=5e-5)


def test_armhawk_fin_is_half_of_a_mirrored_wing() -> None:
    """Appendix C.3: b and A are the mirrored wing's, S is the fin's."""
    height, sweep = 0.28, np.radians(11.1)
    fin = planform(
        surface("fin", False, (-1.21, 0, 0, 0.200),
                (-1.21 - height * np.tan(sweep), 0, -height, 0.115))
    )  # fmt: skip
    assert fin.area == pytest.approx(0.0441, abs=5e-5)
    assert fin.span == pytest.approx(0.56, abs=1e-12)
    assert fin.aspect == pytest.approx(3.56, abs=5e-3)
    assert fin.taper == pytest.approx(0.575, abs=5e-4)
    assert fin.chord == pytest.approx(0.161, abs=5e-4)
    assert fin.y_mean == pytest.approx(0.128, abs=2e-3)  # of rounded chords, as the wing's
    assert np.degrees(fin.sweep_quarter) == pytest.approx(6.87, abs=0.02)  # 11.1 has three digits
    assert -1.21 - fin.quarter_chord[0] == pytest.approx(0.0654, abs=1e-4)  # as his sweep
    assert fin.dihedral == pytest.approx(np.pi / 2)
    # A pair of them is twice the area and the same shape.
    twin = surface("fin", True, (-1.21, 0.3, 0, 0.200), (-1.3, 0.3, -height, 0.115))
    assert planform(twin).area == pytest.approx(2.0 * fin.area)
    assert planform(twin).aspect == pytest.approx(fin.aspect)


def test_mean_chord_of_an_ellipse() -> None:
    """c_bar = 8 c_0/(3 pi), area pi/4 b c_0; by 400 strips, their error is 1e-4."""
    y = 4.0 * np.sin(np.linspace(0.0, np.pi / 2, 401))
    c = np.maximum(np.sqrt(1.0 - (y / 4.0) ** 2), 1e-9)
    wing = planform(surface("wing", True, *zip(c / 4.0, y, 0.0 * y, c, strict=True)))
    assert wing.area == pytest.approx(np.pi / 4.0 * 8.0, rel=1e-4)
    assert wing.chord == pytest.approx(8.0 / (3.0 * np.pi), rel=1e-4)
    assert wing.y_mean == pytest.approx(4.0 * 4.0 / (3.0 * np.pi), rel=1e-4)
    assert wing.quarter_chord[0] == pytest.approx(0.0, abs=1e-12)
    assert wing.sweep_quarter == pytest.approx(0.0, abs=1e-12)


def test_more_sections_of_one_shape_change_nothing() -> None:
    few = surface("wing", True, (0, 0, 0, 2.0), (-1.0, 5.0, -0.5, 1.0))
    lead = [few.at(f) for f in np.linspace(0.0, 1.0, 8)]
    many = surface("wing", True, *((x[0], x[1], x[2], c) for x, c, _ in lead))
    a, b = planform(few), planform(many)
    for name in ("area", "span", "aspect", "taper", "chord", "y_mean", "sweep_quarter",
                 "sweep_leading", "dihedral"):  # fmt: skip
        assert getattr(a, name) == pytest.approx(getattr(b, name), rel=1e-12), name
    np.testing.assert_allclose(a.quarter_chord, b.quarter_chord, atol=1e-12)
    assert a.dihedral == pytest.approx(np.arctan(0.1))
    assert a.area == pytest.approx(3.0 * np.hypot(5.0, 0.5))  # in its own plane


def test_a_wing_that_begins_at_the_fuselage_goes_through_it() -> None:
    whole = planform(surface("wing", True, (0, 0, 0, 1.0), (0, 4.0, 0, 1.0)))
    parted = planform(surface("wing", True, (0, 0.5, 0, 1.0), (0, 4.0, 0, 1.0)))
    assert parted.area == pytest.approx(whole.area)
    assert parted.aspect == pytest.approx(whole.aspect)
    winglet = planform(surface("other", True, (0, 4.0, 0, 1.0), (0, 4.0, -1.0, 1.0)))
    assert winglet.area == pytest.approx(2.0)


def test_exposed_and_wetted_area_of_a_wing_through_a_tube() -> None:
    tube = Body("tube", tuple(CrossSection(frozen([x, 0, 0]), 1.0, 1.0) for x in (5.0, 0.0, -5.0)))
    wing = surface("wing", True, (1.0, 0, 0, 1.0), (1.0, 4.0, 0, 1.0))
    # 7 m of 8 stand out; a station of 400 is 0.02 m2 of both halves.
    assert exposed_area(wing, (tube,)) == pytest.approx(7.0, abs=0.02)
    assert exposed_area(wing, ()) == pytest.approx(8.0)
    high = surface("wing", True, (1.0, 0, -0.6, 1.0), (1.0, 4.0, -0.6, 1.0))
    assert exposed_area(high, (tube,)) == pytest.approx(8.0)
    shape = Geometry((wing,), (tube,), {"flat": Airfoil("flat", 0.12)})
    assert wetted_area(wing, shape) == pytest.approx(7.0 * (1.977 + 0.52 * 0.12), rel=3e-3)


def test_tail_volume() -> None:
    tail = planform(surface("tailplane", True, (-3.0, 0, 0, 0.8), (-3.0, 1.0, 0, 0.8)))
    # 1.6 m2, 3.2 m behind the reference, over 8 m2 times 1 m.
    assert tail_volume(tail, np.zeros(3), 8.0, 1.0) == pytest.approx(1.6 * 3.2 / 8.0)


def test_body_volume_and_skin_of_a_spheroid_and_a_cylinder() -> None:
    cylinder = Body("c", tuple(CrossSection(frozen([-x, 0, 0]), 2.0, 2.0) for x in (0, 1, 4)))
    assert BodyShape(cylinder).volume == pytest.approx(4.0 * np.pi)
    assert BodyShape(cylinder).wetted_area == pytest.approx(8.0 * np.pi)
    xi = -np.cos(np.linspace(0.0, np.pi, 60))
    w = 1.1 * np.sqrt(np.maximum(1.0 - xi**2, 0.0))
    egg = BodyShape(Body("e", tuple(
        CrossSection(frozen([-3 * x, 0, 0]), float(d), float(d)) for x, d in zip(xi, w, strict=True)
    )))  # fmt: skip
    assert egg.volume == pytest.approx(np.pi / 6.0 * 6.0 * 1.1**2, rel=1e-4)
    e = np.sqrt(1.0 - (0.55 / 3.0) ** 2)
    skin = 2.0 * np.pi * 0.55**2 * (1.0 + 3.0 / (0.55 * e) * np.arcsin(e))
    assert egg.wetted_area == pytest.approx(skin, rel=1e-3)  # straight between 60 stations
    # Flat section: twice as wide as high, the perimeter of an ellipse (Ramanujan 1914).
    flat = Body("f", tuple(CrossSection(frozen([-x, 0, 0]), 2.0, 1.0) for x in (0, 1, 4)))
    h = (1.0 / 3.0) ** 2
    around = np.pi * 1.5 * (1.0 + 3.0 * h / (10.0 + np.sqrt(4.0 - 3.0 * h)))
    assert BodyShape(flat).wetted_area == pytest.approx(4.0 * around, rel=1e-6)
