"""Slender bodies beside the reference, Munk's table, and momentum by other means."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

from alula.aircraft import load_aircraft
from alula.aircraft.geometry import Body, CrossSection
from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput
from alula.predict.body_carry_over import bodies_at_wing, body_at_wing, upwash, wing_body_lift
from alula.predict.planform import Planform
from alula.predict.slender_body import apparent_mass_factor, slender_bodies, slender_body
from data import data

SPORTSTAR = Path(__file__).parents[2] / "aircraft" / "sportstar.toml"
S, B, C = 10.6, 8.65, 1.25


def body(x: Array, w: Array, h: Array | None = None, z: float = 0.0) -> Body:
    h = w if h is None else h
    return Body("body", tuple(
        CrossSection(frozen([a, 0.0, z]), float(p), float(q))
        for a, p, q in zip(x, w, h, strict=True)
    ))  # fmt: skip


def ellipsoid(n: int, wide: float = 1.1, high: float = 1.1) -> Body:
    xi = np.linspace(-1.0, 1.0, n)
    r = np.sqrt(np.maximum(1.0 - xi**2, 0.0))
    return body(-3.0 * xi, wide * r, high * r)


def test_ellipsoid_converges_to_the_reference() -> None:
    path = data("references", "vortex_lattice.json")
    truth = json.loads(path.read_text())["slender_body"]["Cm_alpha"]
    for n in (10, 20, 40):
        d = slender_body(ellipsoid(n), S, B, C, np.zeros(3))
        # Even spacing of a parabola of areas: exact by the rule; five digits are printed.
        assert d.values["Cm_alpha"].value == pytest.approx(truth, rel=2e-5)
        assert d.values["CL_alpha"].value == 0.0
    cosine = -np.cos(np.linspace(0.0, np.pi, 20))
    d = slender_body(body(-3.0 * cosine, 1.1 * np.sqrt(1.0 - cosine**2)), S, B, C, np.zeros(3))
    assert d.values["Cm_alpha"].value == pytest.approx(truth, rel=0.01)


@pytest.mark.parametrize(("fineness", "factor"), [(4.99, 0.836), (6.01, 0.873), (9.97, 0.939)])
def test_apparent_mass_is_munks(fineness: float, factor: float) -> None:
    """NACA Report 184, Table I: k2 - k1, three digits there, differences of rounded ones."""
    assert apparent_mass_factor(fineness) == pytest.approx(factor, abs=2e-3)
    plain = slender_body(ellipsoid(21), S, B, C, np.zeros(3))  # a station at the thickest place
    with_it = slender_body(ellipsoid(21), S, B, C, np.zeros(3), apparent_mass=True)
    ratio = with_it.values["Cm_alpha"].value / plain.values["Cm_alpha"].value
    assert ratio == pytest.approx(apparent_mass_factor(6.0 / 1.1), rel=1e-12)
    assert apparent_mass_factor(1.0) == 0.0  # a sphere has no moment
    assert apparent_mass_factor(1e3) == pytest.approx(1.0, abs=1e-4)


def test_pitch_goes_by_width_and_yaw_by_height() -> None:
    flat = slender_body(ellipsoid(20, 1.1, 0.5), S, B, C, np.zeros(3)).values
    round_ = slender_body(ellipsoid(20), S, B, C, np.zeros(3)).values
    assert flat["Cm_alpha"].value == pytest.approx(round_["Cm_alpha"].value)
    ratio = flat["Cn_beta"].value / round_["Cn_beta"].value
    assert ratio == pytest.approx((0.5 / 1.1) ** 2)
    # The same body turned on its side: the same moment, on the other reference length and sign.
    assert round_["Cn_beta"].value == pytest.approx(-round_["Cm_alpha"].value * C / B)


def test_base_area_lifts() -> None:
    """A cone: CL_alpha = 2 A_base/S, at two thirds of its length (slender-body theory)."""
    x = np.linspace(0.0, -3.0, 31)
    d = slender_body(body(x, -x / 3.0), S, B, C, np.array([-2.0, 0.0, 0.0])).values
    base = np.pi / 4.0
    assert d["CL_alpha"].value == pytest.approx(2.0 * base / S)
    assert d["Cm_alpha"].value == pytest.approx(0.0, abs=1e-5)  # squares of widths: monotone cubics
    assert d["CY_beta"].value == pytest.approx(-2.0 * base / S)
    assert d["Cn_beta"].value == pytest.approx(0.0, abs=1e-5)
    closed = slender_body(body(x, -x / 3.0), S, B, C, np.zeros(3), base=False).values
    assert closed["CL_alpha"].value == 0.0
    assert closed["CL_alpha"].se > 0.0  # that a tail does not separate is not certain


def test_rates_by_momentum_integrated_numerically() -> None:
    """d(rho A w)/ds with w of alpha, q, beta, r and their rates, by quadrature of the forces."""
    x = np.linspace(1.0, -5.0, 25)
    w = 0.2 + 1.0 * np.sin(np.pi * (1.0 - x) / 7.0) ** 2
    h = 0.3 + 0.8 * np.sin(np.pi * (1.0 - x) / 7.5) ** 2
    point = np.array([0.3, 0.0, 0.1])
    d = slender_body(body(x, w, h, z=-0.2), S, B, C, point).values
    from alula.predict.body_shape import BodyShape

    shape, e = BodyShape(body(x, w, h)), 1e-5

    def circle(square: Array, f: float) -> float:
        return 0.25 * np.pi * float(square) * f

    def force(kind: str, flow: object) -> tuple[float, float]:
        """Force over rho V^2 and moment (force times x - x_point) for a cross-flow over V."""
        assert callable(flow)
        square = shape.width2 if kind == "w" else shape.height2

        def momentum(s: float) -> float:
            return circle(square(np.array(s)), flow(shape.x_nose - s - point[0]))

        def density(s: float) -> float:
            low, high = max(s - e, 0.0), min(s + e, shape.length)
            return (momentum(high) - momentum(low)) / (high - low)

        nose = momentum(0.0)  # a blunt nose takes up its momentum at once
        L = nose + quad(density, 0, shape.length, limit=400, epsabs=1e-8)[0]
        M = nose * (shape.x_nose - point[0]) + quad(
            lambda s: density(s) * (shape.x_nose - s - point[0]), 0, shape.length, limit=400,
            epsabs=1e-8)[0]  # fmt: skip
        return L, M

    # alpha: w/V = 1. q: w/V = -q x/V with q = 2 V/c qhat. beta, r: force against the flow.
    for kind, name, flow in (("w", "alpha", lambda x: 1.0), ("w", "q", lambda x: -2.0 * x / C)):
        L, M = force(kind, flow)
        assert d[f"CL_{name}"].value == pytest.approx(2.0 * L / S, rel=1e-4)
        assert d[f"Cm_{name}"].value == pytest.approx(2.0 * M / (S * C), rel=1e-4)
    for kind, name, flow in (("v", "beta", lambda x: 1.0), ("v", "r", lambda x: 2.0 * x / B)):
        L, M = force(kind, flow)
        assert d[f"CY_{name}"].value == pytest.approx(-2.0 * L / S, rel=1e-4)
        assert d[f"Cn_{name}"].value == pytest.approx(-2.0 * M / (S * B), rel=1e-4)
    # The body's axis lies 0.3 m above the point: every side force rolls.
    assert d["Cl_beta"].value == pytest.approx(d["CY_beta"].value * 0.3 / B, rel=1e-9)
    # Plunging is pitching seen from the nose: what a closed body gains by q it loses by alphadot.
    closed = slender_body(ellipsoid(20), S, B, C, point).values
    assert closed["Cm_q"].value == pytest.approx(-closed["Cm_alphadot"].value)
    assert closed["Cn_r"].value == pytest.approx(closed["Cn_betadot"].value)


def test_lift_carried_over_is_the_report_s() -> None:
    """NACA Report 1307, Table I: three digits; and both limits."""
    for t, on_wing, on_body in ((0.1, 1.077, 0.133), (0.2, 1.162, 0.278), (0.5, 1.450, 0.800)):
        found = wing_body_lift(t, 1.0)
        assert found.on_wing == pytest.approx(on_wing, abs=6e-4)
        assert found.on_body == pytest.approx(on_body, abs=6e-4)
        assert found.total == pytest.approx((1.0 + t) ** 2)
    assert wing_body_lift(0.0, 1.0).on_wing == 1.0
    assert wing_body_lift(1e-7, 1.0).on_wing == pytest.approx(1.0, abs=1e-6)
    assert wing_body_lift(0.999, 1.0).on_body == pytest.approx(2.0, abs=5e-3)
    with pytest.raises(BadInput):
        wing_body_lift(1.0, 1.0)


@pytest.mark.parametrize("x", [0.2, 1.0, 4.0, 20.0])
def test_upwash_is_biot_savart_of_an_elliptic_line(x: float) -> None:
    s = 4.0

    def flow(phi: float) -> float:
        y = s * np.sin(phi)
        r = np.hypot(x, y)
        bound = np.cos(phi) * x / r**3 * s * np.cos(phi)
        trailing = (1.0 - x / r) / s  # both legs, sin(phi)/y taken out
        return float(bound - trailing)

    # Gamma_0/(4 pi V) times this; CL/(pi A) is Gamma_0/(2 b V).
    expected = quad(flow, -np.pi / 2, np.pi / 2, epsabs=1e-11)[0] / (4.0 * np.pi) * (4.0 * s)
    assert upwash(np.array(x), 2.0 * s) == pytest.approx(expected, rel=1e-7)


def wing(aspect: float = 8.0, span: float = 8.0) -> Planform:
    zero = frozen(np.zeros(3))
    return Planform("w", span**2 / aspect, span, aspect, 1.0, 1.0, zero, zero, 2.0, 0, 0, 0)


def test_flow_at_the_wing_turns_the_body() -> None:
    """Ahead more than alone, along the chord nothing, behind less."""
    x = np.linspace(3.0, -3.0, 61)
    tube = body(x, np.full(61, 0.5))
    per = np.pi / (2.0 * S * C) * 0.25

    # A wing without lift only straightens the flow along its chord.
    joined, alone = body_at_wing(tube, wing(), (0.5, -0.5), 0.0, S, C)
    assert alone == pytest.approx(6.0 * per)
    assert joined == pytest.approx(5.0 * per, rel=1e-9)
    # With all of the flow turned at the tail, 2.5 m behind, half of what is behind remains.
    joined, _ = body_at_wing(tube, wing(), (0.5, -0.5), 0.0, S, C, tail=(-3.0, 0.0))
    assert joined == pytest.approx((2.5 + 1.25) * per, rel=1e-9)
    # Two-dimensional plate: the flow angle ahead is sqrt(1 + c/d); its integral in closed form. An
    # elliptic wing has 4/pi of the mean circulation in the middle.
    infinite = wing(aspect=1e5, span=1e5)
    joined, _ = body_at_wing(tube, infinite, (0.5, -0.5), 2.0 * np.pi, S, C, tail=(-3.0, 1.0))
    d = 2.5
    plate = np.sqrt(d * (d + 1.0)) + np.arcsinh(np.sqrt(d)) - d
    assert joined == pytest.approx(
        (d + 4.0 / np.pi * plate) * per, rel=1e-3
    )  # the aspect ratio is not infinite


def test_sportstar_body_is_destabilizing_with_an_error_bar() -> None:
    aircraft = load_aircraft(SPORTSTAR)
    alone = slender_bodies(aircraft)
    at_wing = bodies_at_wing(aircraft, 4.6, 0.45)
    assert 0.2 < alone.values["Cm_alpha"].value < 0.7
    assert -0.15 < alone.values["Cn_beta"].value < -0.02
    assert all(v.se > 0.0 and v.source for v in alone.values.values())
    # The neutral point's shift by the body, less than a tenth of the chord.
    shift = (alone.values["Cm_alpha"].value + at_wing.values["Cm_alpha"].value) / 4.6
    assert 0.02 < shift < 0.1


def test_what_is_missing_is_said(tmp_path: Path) -> None:
    path = tmp_path / "bare.toml"
    path.write_text('schema = "alula.aircraft/1"\nname = "bare"\n'
                    "[reference]\nS = 10.0\nb = 8.0\nc = 1.25\n")  # fmt: skip
    bare = load_aircraft(path)
    for call in (lambda: slender_bodies(bare), lambda: bodies_at_wing(bare, 4.6)):
        with pytest.raises(BadInput) as error:
            call()
        assert error.value.messages[0].code == "missing_bodies"
    short = slender_body(ellipsoid(20, 3.0, 3.0), S, B, C, np.zeros(3))
    assert "2 times as long" in short.notes[0]
