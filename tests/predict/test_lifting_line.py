"""Lifting line beside the elliptic wing's closed forms and Pusztai's published surfaces."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.predict.lift_slope import helmbold, polhamus
from alula.predict.lifting_line import correction, lifting_line
from alula.predict.oswald import (
    aircraft_factor,
    effective_aspect,
    lift_correction,
    lifting_line_factor,
    nita_scholz,
    raymer,
)
from alula.predict.trapezoid import Trapezoid

A = 7.0
SLOPE = 6.0
SPAN, AREA = 7.0, 7.0
# The series ends after 120 terms; on a smooth chord it is exact to rounding.
EXACT = 1e-9


def elliptic():
    root = 4.0 * AREA / (np.pi * SPAN)
    return lifting_line(lambda eta: root * np.sqrt(1.0 - eta**2), SPAN, AREA, SLOPE)


def test_elliptic_wing_lift_and_drag() -> None:
    """Prandtl: c_l_alpha/(1 + c_l_alpha/(pi A)), delta and tau zero."""
    found = correction(elliptic(), SLOPE)
    assert found.slope == pytest.approx(SLOPE / (1.0 + SLOPE / (np.pi * A)), rel=EXACT)
    assert found.delta == pytest.approx(0.0, abs=EXACT)
    assert found.tau == pytest.approx(0.0, abs=EXACT)


def test_elliptic_wing_in_roll() -> None:
    """Damping -(c_l_alpha/8)/(1 + 2 c_l_alpha/(pi A)); Cn_p by hand from its two harmonics.

    With A_1 of the lift and A_2 of the roll, tilt gives -pi A A_1/8 and the induced drag
    -6 pi A A_1 A_2/8.
    """
    line = elliptic()
    rolling = line.load(line.eta)
    k = SLOPE / (np.pi * A)
    assert line.roll(rolling) == pytest.approx(-SLOPE / 8.0 / (1.0 + 2.0 * k), rel=EXACT)
    base = line.load(np.full_like(line.eta, 0.1))
    first, second = base.A[0], -k / (2.0 * (1.0 + 2.0 * k))
    assert rolling.A[1] == pytest.approx(second, rel=EXACT)
    by_hand = -np.pi * A * first * (1.0 + 6.0 * second) / 8.0
    found = line.tilted(base, line.eta) + line.yaw(base, rolling)
    assert found == pytest.approx(by_hand, rel=1e-6)  # a product of series, by quadrature


def test_faster_right_half_rolls_left() -> None:
    line = elliptic()
    base = line.load(np.full_like(line.eta, 0.1))
    # Elliptic circulation, faster by eta: -A g0 integral of cos^2 sin^2 = -A A_1 pi/8.
    expected = -A * base.A[0] * np.pi / 8.0
    assert line.slowed(base, line.eta) == pytest.approx(expected, rel=1e-6)


def test_carried_lift() -> None:
    """Times one it is the lift; times eta squared, of the elliptic load, a quarter of it."""
    line = elliptic()
    base = line.load(np.full_like(line.eta, 0.1))
    assert line.carried(base, np.ones_like(line.eta)) == pytest.approx(line.lift(base), rel=EXACT)
    assert line.carried(base, line.eta**2) == pytest.approx(0.25 * line.lift(base), rel=EXACT)


@pytest.mark.parametrize(
    ("wing", "section", "k", "e"),
    [
        (Trapezoid(1.5, 0.335, 0.260), 5.73, 0.714, 0.981),
        (Trapezoid(0.65, 0.174, 0.174), 5.90, 0.639, 0.976),
        (Trapezoid(0.56, 0.200, 0.115), 6.07, 0.639, 0.995),
    ],
)
def test_armhawk_surfaces(wing: Trapezoid, section: float, k: float, e: float) -> None:
    """Pusztai 2018, appendix C; his delta and tau are read from a chart of Dubs."""
    assert lift_correction(wing, section) == pytest.approx(k, abs=0.002)
    assert lifting_line_factor(wing, section).value == pytest.approx(e, abs=0.008)
    assert effective_aspect(wing, section) < wing.aspect


def test_polhamus_is_helmbold_without_sweep() -> None:
    for aspect in (2.0, 6.0, 12.0):
        found = polhamus(aspect, 2.0 * np.pi, 0.0).value
        assert found == pytest.approx(helmbold(aspect), rel=1e-12)
    # Slender and infinite wing: pi A/2 and 2 pi.
    assert polhamus(0.01, 2.0 * np.pi, 0.0).value == pytest.approx(0.005 * np.pi, rel=1e-2)
    assert polhamus(1e6, 2.0 * np.pi, 0.0).value == pytest.approx(2.0 * np.pi, rel=1e-5)


def test_outside_its_range_a_formula_says_so() -> None:
    inside, outside = polhamus(6.0, 6.0, 0.0), polhamus(0.5, 6.0, 0.0)
    assert inside.notes == ()
    assert "aspect ratio = 0.5" in outside.notes[0]
    assert outside.se / outside.value == pytest.approx(2.0 * inside.se / inside.value)


def test_whole_aircraft_lies_below_the_wing_alone() -> None:
    wing = Trapezoid(10.0, 1.6, 0.9)
    alone = lifting_line_factor(wing, 6.0).value
    forms = (raymer(wing.aspect), nita_scholz(wing.aspect, wing.taper, 0.0, 0.1))
    whole = aircraft_factor(forms)
    assert 0.6 < whole.value < alone
    assert whole.se >= abs(forms[0].value - forms[1].value) / np.sqrt(2.0)  # the spread is in it


def test_raymer_forms_join() -> None:
    swept = raymer(8.0, np.radians(30.0)).value
    assert swept == pytest.approx(
        4.61 * (1.0 - 0.045 * 8.0**0.68) * np.cos(np.radians(30.0)) ** 0.15 - 3.1, rel=1e-4
    )
    assert raymer(8.0, np.radians(15.0)).value == pytest.approx(
        0.5 * (raymer(8.0).value + swept), rel=1e-4
    )


def test_no_wing_is_refused() -> None:
    with pytest.raises(BadInput, match="root"):
        Trapezoid(1.0, -0.1, 0.1)
