"""Downwash, wake, flaps, profile drag: closed forms and published values."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.predict.alpha_dot import tail_rates
from alula.predict.downwash import datcom, gradient, horseshoe, pressure_ratio
from alula.predict.flap import friction_loss, low_aspect, moment, turning
from alula.predict.handbook import Found, plus, scaled, times
from alula.predict.pitch_rate import tail, wing
from alula.predict.profile_drag import (
    DragItem,
    WettedPart,
    body_form,
    drag_of_items,
    friction,
    profile_drag,
    surface_form,
)


def induced(legs: float, arm: float, height: float) -> float:
    """Downwash of a unit horseshoe vortex, Biot and Savart summed along its three legs."""

    def leg(start: np.ndarray, end: np.ndarray) -> np.ndarray:
        u = np.linspace(0.0, 1.0, 20001)
        s = start + (end - start) * (0.5 * (u[1:] + u[:-1]))[:, None] ** 3  # dense at the start
        d = np.diff(u**3)[:, None] * (end - start)
        r = np.array([arm, 0.0, height]) - s
        return (np.cross(d, r) / np.linalg.norm(r, axis=1)[:, None] ** 3).sum(axis=0) / (4 * np.pi)

    left, right = np.array([0.0, -legs, 0.0]), np.array([0.0, legs, 0.0])
    far = np.array([2000.0, 0.0, 0.0])
    total = leg(left, right) - leg(left, left + far) + leg(right, right + far)
    return float(-total[2])  # x aft, y right, z up


@pytest.mark.parametrize(("arm", "height"), [(4.0, 0.0), (4.0, 1.2), (-2.0, 0.3)])
def test_horseshoe_against_summed_legs(arm: float, height: float) -> None:
    span, aspect, slope = 8.0, 7.0, 5.0
    circulation = slope * 2.0 * span / (aspect * np.pi)  # over V: C_L S = 2 Gamma (pi/4) b/V
    expected = circulation * induced(np.pi * span / 8.0, arm, height)
    # Sign of the bound vortex by the sum; 1e-3: straight steps along the legs.
    assert horseshoe(slope, aspect, span, arm, height).value == pytest.approx(expected, rel=1e-3)


def test_horseshoe_far_behind() -> None:
    found = horseshoe(5.0, 7.0, 8.0, 1e5).value
    assert found == pytest.approx(16.0 / np.pi**3 * 5.0 / 7.0, rel=1e-6)


def test_downwash_forms_agree_within_their_errors() -> None:
    chart = datcom(7.0, 0.6, 0.0, 8.65, 3.9, 0.1)
    vortex = horseshoe(4.6, 7.0, 8.65, 3.9, 0.1)
    both = gradient((chart, vortex))
    assert abs(chart.value - vortex.value) < 2.0 * both.se
    assert both.se >= 0.5 * abs(chart.value - vortex.value)


def test_downwash_falls_with_height_and_arm() -> None:
    for form in (
        lambda arm, h: datcom(7.0, 0.6, 0.0, 8.0, arm, h).value,
        lambda arm, h: horseshoe(4.6, 7.0, 8.0, arm, h).value,
    ):
        assert form(4.0, 0.0) > form(4.0, 1.0)
        assert form(3.0, 0.0) > form(5.0, 0.0)


def test_wake_of_naca_tr_651() -> None:
    """Loss 2.42 sqrt(c_d)/(x + 0.3) in the middle, none beyond 0.68 sqrt(c_d (x + 0.15))."""
    assert pressure_ratio(0.01, 2.0, 0.0).value == pytest.approx(1.0 - 0.242 / 2.3)
    edge = 0.68 * np.sqrt(0.01 * 2.15)
    assert pressure_ratio(0.01, 2.0, 0.999 * edge).value == pytest.approx(1.0, abs=1e-5)
    assert pressure_ratio(0.01, 2.0, 1.1 * edge).value == 1.0


@pytest.mark.parametrize(
    ("flap", "chord", "c_m", "c_l", "slope"),
    [
        (0.040, 0.31125, -0.584, 2.5, 5.73),  # flap, chord at the middle of its span
        (0.040, 0.27725, -0.602, 2.7, 5.73),  # aileron
        (0.050, 0.174, -0.645, 4.0, 5.90),  # elevator
        (0.055, 0.1575, -0.620, 4.5, 6.07),  # rudder, mean chords
    ],
)
def test_armhawk_flaps(flap: float, chord: float, c_m: float, c_l: float, slope: float) -> None:
    """Pusztai 2018, appendix C.

    His c_m_delta is thin-airfoil theory's to his last digit (the chord at mid-span may move it by
    0.0015). His c_l_delta is empirical: within 6 %, one digit printed.
    """
    hinge = 1.0 - flap / chord
    assert moment(hinge) == pytest.approx(c_m, abs=0.0015)
    assert turning(hinge) * slope == pytest.approx(c_l, rel=0.06)


def test_flap_limits() -> None:
    assert turning(1e-9) == pytest.approx(1.0, abs=1e-4)  # the whole chord
    assert turning(1.0 - 1e-9) == pytest.approx(0.0, abs=1e-3)
    assert low_aspect(0.5, 1e9) == pytest.approx(1.0)
    assert low_aspect(0.5, 0.0) == pytest.approx(2.0)  # slender: alpha_delta becomes 1
    assert friction_loss(2.0 * np.pi).value == 1.0
    with pytest.raises(BadInput, match="hinge"):
        turning(1.2)


def test_friction_of_plates() -> None:
    """Schlichting, Boundary-Layer Theory: 0.00300 at 1e7 turbulent; Blasius 1.328/sqrt(Re)."""
    assert friction(1e7) == pytest.approx(0.00300, abs=5e-6)
    assert friction(1e5, laminar=1.0) == pytest.approx(0.0042, abs=5e-6)
    assert friction(1e7, mach=0.8) < friction(1e7)


def test_drag_areas_of_the_armhawk() -> None:
    """Two of Pusztai's parts: 1.1 * 0.0015 + 0.5 * 0.0028 on 0.446 m2."""
    parts = [DragItem("servos", 1.1, 0.0015), DragItem("motor", 0.5, 0.0028)]
    assert drag_of_items(parts, 0.446).value == pytest.approx((0.00165 + 0.0014) / 0.446)


def test_profile_drag_is_the_sum_of_its_parts() -> None:
    parts = [WettedPart("wing", 20.0, 1.25, surface_form(0.15)),
             WettedPart("body", 15.0, 6.0, body_form(6.0, 1.1))]  # fmt: skip
    total, by_name = profile_drag(parts, 10.0, 50.0, 1.46e-5, items=[DragItem("gear", 0.3, 0.1)])
    assert total.value == pytest.approx(sum(by_name.values()), rel=1e-12)
    assert by_name["gear"] == pytest.approx(0.003)
    assert 0.005 < total.value - 0.003 < 0.03
    slow, _ = profile_drag(parts, 10.0, 0.01, 1.46e-5)
    assert any("Reynolds number of wing" in n for n in slow.notes)


def test_lag_of_downwash() -> None:
    """The tail at alpha-dot feels d epsilon/d alpha l/V of it, as a pitch rate's share."""
    lift, gain = Found(0.6, 0.0, "a"), Found(0.4, 0.0, "b")
    rates, q = tail_rates(lift, 3.9, 1.25, gain), tail(lift, 3.9, 1.25)
    assert rates["CL_alphadot"].value == pytest.approx(0.4 * q["CL_q"].value)
    assert rates["Cm_alphadot"].value == pytest.approx(0.4 * q["Cm_q"].value)
    assert q["Cm_q"].value == pytest.approx(-2.0 * 0.6 * (3.9 / 1.25) ** 2)


def test_thin_airfoil_in_pitch() -> None:
    """Infinite wing turning about its quarter chord: CL_q = 2 pi, Cm_q = -pi/4 (Glauert)."""
    found = wing(Found(2.0 * np.pi, 0.0, ""), 2.0 * np.pi, 15.0, 0.0, 0.0)
    assert found["CL_q"].value == pytest.approx(2.0 * np.pi)
    assert found["Cm_q"].value == pytest.approx(-np.pi / 4.0)
    # Turning about three quarters of the chord no lift arises.
    back = wing(Found(2.0 * np.pi, 0.0, ""), 2.0 * np.pi, 15.0, 0.0, -0.5)
    assert back["CL_q"].value == pytest.approx(0.0, abs=1e-12)


def test_errors_of_sums_and_products() -> None:
    a, b = Found(3.0, 0.3, "a"), Found(2.0, 0.4, "b", ("beyond",))
    assert plus(a, b).se == pytest.approx(0.5)
    assert times(a, b).se == pytest.approx(np.hypot(0.3 * 2.0, 0.4 * 3.0))
    assert times(a, b).notes == ("beyond",)
    assert scaled(a, -2.0).se == pytest.approx(0.6)
