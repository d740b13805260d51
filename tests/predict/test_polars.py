"""Section polars: what is refused, what is scaled, and the whole circle of a finite surface."""

from __future__ import annotations

import numpy as np
import pytest

from alula.aircraft.geometry import Airfoil, Polar
from alula.base.messages import BadInput
from alula.predict.full_circle import full_circle, plate_drag
from alula.predict.plain_flap import thin_flap
from alula.predict.polars import (
    check_polar,
    lift_slope,
    neuralfoil_polar,
    section_polar,
    zero_lift,
)


def polar(slope: float = 5.5, zero: float = -0.03) -> Polar:
    alpha = np.radians(np.arange(-16.0, 16.1, 1.0))
    c_l = 1.2 * np.tanh(slope / 1.2 * (alpha - zero))
    return Polar(alpha, c_l, 0.01 + 0.02 * c_l**2, np.full_like(alpha, -0.02), 2e5, "made")


def test_the_stated_slope_scales_the_lift_and_says_so() -> None:
    given = polar()
    airfoil = Airfoil("a", 0.12, c_l_alpha=6.0, polar=given)
    made = section_polar(airfoil, "here")
    assert lift_slope(made) == pytest.approx(6.0, rel=1e-12)  # a linear fit is linear in c_l
    assert zero_lift(made) == pytest.approx(-0.03, abs=1e-4)  # c_l is straight to 1e-4 rad here
    np.testing.assert_array_equal(made.c_d, given.c_d)
    assert "stated slope" in made.source


def test_without_a_polar_slope_and_thickness_make_one() -> None:
    made = section_polar(Airfoil("plain", 0.12, c_l_alpha=5.8, alpha_0=-0.02), "here")
    assert lift_slope(made) == pytest.approx(5.8, rel=2e-3)  # the corner of the stall rounds it
    assert zero_lift(made) == pytest.approx(-0.02, abs=1e-3)  # half degree steps, linear between
    assert 0.9 < made.c_l.max() < 1.2
    assert "assumed" in made.source


@pytest.mark.parametrize("column", ["c_l", "c_d", "c_m", "alpha"])
def test_numbers_that_are_none_are_refused(column: str) -> None:
    given = polar()
    values = {k: np.array(getattr(given, k)) for k in ("alpha", "c_l", "c_d", "c_m")}
    values[column][7] = np.nan
    with pytest.raises(BadInput, match=rf"polar\.{column}.*nan in place 8"):
        check_polar(Polar(**values, reynolds=None, source=""), "polar")


def test_a_polar_of_one_side_is_refused() -> None:
    given = polar()
    half = given.alpha >= 0.0
    with pytest.raises(BadInput, match="0 to 16 deg"):
        check_polar(
            Polar(given.alpha[half], given.c_l[half], given.c_d[half], given.c_m[half], None, ""),
            "polar",
        )


@pytest.mark.parametrize("aspect", [3.0, 5.04, 12.0])
def test_across_the_flow_the_surface_is_a_plate(aspect: float) -> None:
    k, induced = 0.7, 0.06
    table = full_circle(polar(), k, induced, aspect)
    alpha = np.linspace(-180.0, 180.0, table.shape[1])
    c_l, c_d, c_m = table
    for side in (-90.0, 90.0):
        at = int(np.argmin(np.abs(alpha - side)))
        assert c_l[at] == pytest.approx(0.0, abs=1e-12)
        assert c_d[at] + induced * c_l[at] ** 2 == pytest.approx(plate_drag(aspect), rel=1e-12)
        # Center of pressure at mid-chord: a quarter chord behind the reference.
        assert c_m[at] == pytest.approx(-0.25 * np.sign(side) * plate_drag(aspect), rel=1e-12)


def test_the_known_part_is_kept_and_nothing_jumps() -> None:
    given = polar()
    k, induced = 0.7, 0.06
    table = full_circle(given, k, induced, 5.0)
    alpha = np.linspace(-np.pi, np.pi, table.shape[1])
    inside = np.abs(alpha) <= np.radians(16.0)
    for row, column, scale in ((0, given.c_l, k), (1, given.c_d, 1.0), (2, given.c_m, 1.0)):
        expected = scale * np.interp(alpha[inside], given.alpha, column)
        # Straight lines against a monotone cubic through the same points.
        np.testing.assert_allclose(table[row][inside], expected, atol=2e-3)
    # Half a degree changes none of them by more than the steepest lift, from behind: 0.7 of 6/rad.
    assert np.abs(np.diff(table, axis=1)).max() < 0.06
    total = table[1] + induced * table[0] ** 2
    assert total.min() > 0.0
    np.testing.assert_allclose(table[:, 0], table[:, -1], atol=1e-12)


def test_a_symmetric_section_stays_symmetric() -> None:
    given = polar(zero=0.0)
    table = full_circle(
        Polar(given.alpha, given.c_l, given.c_d, 0.0 * given.c_m, None, ""), 0.7, 0.06, 4.0
    )
    np.testing.assert_allclose(table[0], -table[0][::-1], atol=1e-12)
    np.testing.assert_allclose(table[1], table[1][::-1], atol=1e-12)
    np.testing.assert_allclose(table[2], -table[2][::-1], atol=1e-12)


# Pusztai 2018, appendix C: hinges by his chords, c_l_delta and c_m_delta as printed, from Schmidt's
# charts. Thin airfoil theory with the section's efficiency meets the lift within 6 %, the moment
# within 5 %: what measured flaps scatter by.
@pytest.mark.parametrize(
    ("hinge", "slope", "c_l_delta", "c_m_delta"),
    [
        (1.0 - 0.040 / 0.311, 5.73, 2.5, -0.584),  # flap, chord between y_1 and y_2
        (1.0 - 0.040 / 0.277, 5.73, 2.7, -0.602),  # aileron, from there to the tip
        (1.0 - 0.050 / 0.174, 5.90, 4.0, -0.645),
        (0.65, 6.07, 4.5, -0.620),
    ],
)
def test_flaps_of_thin_airfoil_theory_meet_the_published_ones(
    hinge: float, slope: float, c_l_delta: float, c_m_delta: float
) -> None:
    lift, moment = thin_flap(hinge)
    assert lift * slope / (2.0 * np.pi) == pytest.approx(c_l_delta, rel=0.06)
    assert moment == pytest.approx(c_m_delta, rel=0.05)


def test_a_flap_of_the_whole_chord_is_the_airfoil() -> None:
    lift, moment = thin_flap(0.0)
    assert lift == pytest.approx(2.0 * np.pi)
    assert moment == pytest.approx(0.0, abs=1e-12)


def test_neuralfoil_gives_a_polar_or_says_what_to_install() -> None:
    try:
        import neuralfoil  # noqa: F401
    except ImportError:
        with pytest.raises(BadInput, match=r"alula\[polars\]"):
            neuralfoil_polar(0.09, None, 168e3)
        return
    made = neuralfoil_polar(0.09, None, 168e3)
    # Pusztai's own computation for this section and Reynolds number: 5.90 1/rad.
    assert lift_slope(made) == pytest.approx(5.90, rel=0.05)
