"""Linearization: against closed forms, against differences, at any point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from alula.base.messages import BadInput
from alula.core import core
from alula.simulate import Condition, fly, initial_state, linearize, modes_of, trim
from alula.simulate.airframe import core_model
from alula.simulate.coordinates import flight_state, plant_state, tangent
from alula.simulate.plant import INPUTS, plant_rates
from simulate.light_aircraft import IYY, MASS, REFERENCE, VALUES, airframe, light

G = 9.80665
# Points of flight: (V, alpha, beta, phi, theta, psi), rates, controls; steady and far from steady.
POINTS = {
    "level": ((45.0, 0.02, 0.0, 0.0, 0.02, 0.3), (0.0, 0.0, 0.0), {"thrust": 600.0}),
    "pulling": ((45.0, 0.11, 0.0, 0.0, 0.3, 0.0), (0.0, 0.4, 0.0), {"de": -0.1, "thrust": 900.0}),
    "tumbling": (
        (38.0, 0.15, -0.12, 1.9, -0.7, 2.5),
        (0.8, -0.5, 0.6),
        {"de": 0.1, "da": -0.2, "dr": 0.15, "thrust": 300.0},
    ),
}
WIND = np.array([6.0, -4.0, 1.0])


def point(name: str, wind: np.ndarray | None = None) -> tuple[np.ndarray, dict[str, float]]:
    (V, alpha, beta, phi, theta, psi), rates, controls = POINTS[name]
    state = initial_state(
        V, alpha, theta, 900.0, beta=beta, phi=phi, psi=psi, rates=rates, wind=wind
    )
    return state, controls


def closed_form(name: str) -> np.ndarray:
    """By hand: Dittrich 2016, Eq. (2.79), with its errata, at a point of symmetric flight."""
    (V, a, _, _, theta, _), (_, q, _), u = POINTS[name]
    rho = core_density(900.0)
    S, c, m = REFERENCE.S, REFERENCE.c, MASS
    C, de, F = VALUES, u.get("de", 0.0), u["thrust"]
    lift = C["CL_0"] + a * C["CL_alpha"] + de * C["CL_de"]
    drag = C["CD_0"] + a * C["CD_alpha"] + de * C["CD_de"]
    pitch = C["Cm_0"] + a * C["Cm_alpha"] + de * C["Cm_de"]
    gamma = theta - a
    return np.array(
        [
            [
                -rho * V * S / m * (drag + c * q / (4 * V) * C["CD_q"]),
                -rho * V**2 * S / (2 * m) * C["CD_alpha"] - F / m * np.sin(a) + G * np.cos(gamma),
                -rho * V * S * c / (4 * m) * C["CD_q"],
                -G * np.cos(gamma),
            ],
            [
                F * np.sin(a) / (m * V**2) - rho * S / (2 * m) * lift - G / V**2 * np.cos(gamma),
                G / V * np.sin(gamma) - rho * V * S / (2 * m) * C["CL_alpha"]
                - F * np.cos(a) / (m * V),
                1.0 - rho * S * c / (4 * m) * C["CL_q"],
                -G / V * np.sin(gamma),
            ],
            [
                rho * V * S * c / IYY * (pitch + c * q / (4 * V) * C["Cm_q"]),
                rho * V**2 * S * c / (2 * IYY) * C["Cm_alpha"],
                rho * V * S * c**2 / (4 * IYY) * C["Cm_q"],
                0.0,
            ],
            [0.0, 0.0, 1.0, 0.0],
        ]
    )  # fmt: skip


def core_density(h: float) -> float:
    out = np.empty((1, 4))
    core.standard_atmosphere(np.array([h]), out)
    return float(out[0, 2])


@pytest.mark.parametrize("name", ["level", "pulling"])
def test_longitudinal_matrix_is_the_corrected_closed_form(name: str) -> None:
    state, controls = point(name)
    found = linearize(core_model(airframe(), light()), state, controls).longitudinal()
    assert found.states == ("V", "alpha", "q", "theta")
    by_hand = closed_form(name)
    np.testing.assert_allclose(found.A, by_hand, rtol=1e-7, atol=1e-7)
    V, a = POINTS[name][0][:2]
    # Controls: Eq. (2.79e, f, k, p) and L_F = -sin(alpha)/(m V).
    rho, S, c = core_density(900.0), REFERENCE.S, REFERENCE.c
    by_hand_B = [
        [-rho * V**2 * S / (2 * MASS) * VALUES["CD_de"], np.cos(a) / MASS],
        [-rho * V * S / (2 * MASS) * VALUES["CL_de"], -np.sin(a) / (MASS * V)],
        [rho * V**2 * S * c / (2 * IYY) * VALUES["Cm_de"], 0.0],
        [0.0, 0.0],
    ]
    at = [found.inputs.index(n) for n in ("de", "thrust")]
    np.testing.assert_allclose(found.B[:, at], by_hand_B, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("name", POINTS)
@pytest.mark.parametrize("wind", [None, WIND], ids=["still", "wind"])
def test_equals_central_differences(name: str, wind: np.ndarray | None) -> None:
    """Differences of the rates of V, alpha, beta and Euler angles, written down apart from it."""
    plant = core_model(airframe(thrust_point=np.array([1.6, 0.2, -0.1])), light(), wind)
    state, controls = point(name, wind)
    found = linearize(plant, state, controls)
    w = np.zeros(3) if wind is None else wind

    def rates(z: np.ndarray) -> np.ndarray:
        """d(flight state)/dt by Dittrich 2016, Eq. (2.54), (2.58): u v w to V alpha beta."""
        n = len(found.states)
        x = plant_state(z[:n], w)
        f, y = plant_rates(plant, x, z[n:])
        phi, theta = z[6], z[7]
        p, q, r = z[3:6]
        R = rotation(*z[6:9])
        u = x[7:10] - R @ w  # in the air
        du = f[7:10] + np.cross(z[3:6], R @ w)  # d(R w)/dt = -omega x R w
        V = np.linalg.norm(u)
        plane = u[0] ** 2 + u[2] ** 2
        V_dot = u @ du / V
        return np.concatenate([
            [V_dot, (u[0] * du[2] - u[2] * du[0]) / plane,
             (du[1] - u[1] * V_dot / V) / np.sqrt(plane)],
            f[10:13],
            [p + np.tan(theta) * (q * np.sin(phi) + r * np.cos(phi)),
             q * np.cos(phi) - r * np.sin(phi),
             (q * np.sin(phi) + r * np.cos(phi)) / np.cos(theta)],
            [f[0], f[1], -f[2]],
            y[:6],
        ])  # fmt: skip

    z0 = np.concatenate([found.x0, found.u0])
    np.testing.assert_allclose(rates(z0)[:12], found.f0, rtol=1e-12, atol=1e-12)
    J = []
    for i, value in enumerate(z0):
        # h^2/6 of third derivatives and rounding over h, extrapolated once: under 1e-9 of an entry
        h = 1e-3 * max(abs(value), 1.0)
        e = np.zeros(len(z0))
        e[i] = h
        wide = (rates(z0 + 2 * e) - rates(z0 - 2 * e)) / (4 * h)
        narrow = (rates(z0 + e) - rates(z0 - e)) / (2 * h)
        J.append((4 * narrow - wide) / 3)
    by_differences = np.array(J).T
    n = len(found.states)
    for exact, near in (
        (found.A, by_differences[:12, :n]),
        (found.B, by_differences[:12, n:]),
        (found.C[:6], by_differences[12:, :n]),
        (found.D[:6], by_differences[12:, n:]),
    ):
        np.testing.assert_allclose(exact, near, rtol=1e-7, atol=1e-7)


def rotation(phi: float, theta: float, psi: float) -> np.ndarray:
    """R_BE, Dittrich 2016, Eq. (2.16)."""
    s, c = np.sin([phi, theta, psi]), np.cos([phi, theta, psi])
    return np.array([
        [c[1] * c[2], c[1] * s[2], -s[1]],
        [s[0] * s[1] * c[2] - c[0] * s[2], s[0] * s[1] * s[2] + c[0] * c[2], s[0] * c[1]],
        [c[0] * s[1] * c[2] + s[0] * s[2], c[0] * s[1] * s[2] - s[0] * c[2], c[0] * c[1]],
    ])  # fmt: skip


@pytest.mark.parametrize("earth", ["flat", "wgs84"])
def test_coordinates_go_there_and_back(earth) -> None:
    x = np.array([50.0, 0.1, -0.05, 0.1, 0.2, 0.3, -2.3, 0.4, 2.0, 0.7, -1.2, 1000.0, 5.0])
    state = plant_state(x, WIND, earth)
    # Earth's radius times the rounding of an angle is a nanometer
    np.testing.assert_allclose(flight_state(state, WIND, earth), x, rtol=1e-12, atol=1e-9)
    # The tangent is the map's derivative, by complex steps: exact but for rounding of 6.4e6 m.
    step = 1e-30
    J = [np.imag(plant_state(x + 1j * step * e, WIND, earth)) / step for e in np.eye(len(x))]
    T = tangent(x, WIND, earth)
    np.testing.assert_allclose(
        T, np.array(J).T, rtol=1e-12, atol=1e-9 if earth == "wgs84" else 1e-13
    )


def test_euler_angles_are_the_cores() -> None:
    q = np.empty(4)
    core.quaternion_from_euler(0.4, -0.9, 2.2, q)
    x = np.array([50.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.4, -0.9, 2.2, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(plant_state(x, np.zeros(3))[3:7], q, atol=1e-15)


def test_it_needs_no_engine() -> None:
    found = linearize(core_model(airframe(), light()), point("level")[0], {})
    assert np.isfinite(found.A).all()
    assert found.point["thrust"] == 0.0


def test_a_linear_model_predicts_the_flight() -> None:
    """A step of the elevator of 0.1 deg: the flight's change over one second."""
    frame, model = airframe(), light()
    steady = trim(frame, model, Condition(45.0, 1000.0))
    found = linearize(core_model(frame, model), steady.state, steady.inputs)
    assert found.unsteady == {}
    t = np.linspace(0.0, 1.0, 101)
    step = np.radians(0.1)
    flown = fly(
        frame, model, steady.state, t, {**steady.inputs, "de": steady.controls["de"] + step}
    )
    lon = found.longitudinal("h")
    x = np.zeros(5)
    b = lon.B[:, lon.inputs.index("de")] * step
    n = len(x)
    both = expm(np.block([[lon.A, b[:, None]], [np.zeros((1, n + 1))]]))
    x = both[:n, n]
    change = [flown.motion.V[-1] - 45.0, flown.motion.alpha[-1] - steady.alpha, flown.motion.q[-1]]
    # quadratic terms: (0.2 deg of alpha / 1 rad)
    np.testing.assert_allclose(change, x[:3], rtol=1e-2)


def test_names_and_parts() -> None:
    found = linearize(core_model(airframe(), light()), *point("tumbling"))
    assert found.inputs == INPUTS[: len(found.inputs)]
    part = found.part(("theta", "V"), ("thrust",), ("az",))
    i, j = found.states.index("theta"), found.states.index("V")
    np.testing.assert_array_equal(
        part.A, [[found.A[i, i], found.A[i, j]], [found.A[j, i], found.A[j, j]]]
    )
    assert part.C.shape == (1, 2)
    with pytest.raises(BadInput, match="unknown_state"):
        found.part(("gamma",))
    assert {"V", "alpha", "p", "phi"} <= set(found.unsteady)


@pytest.mark.parametrize("theta", [np.pi / 2, -np.pi / 2])
def test_the_nose_straight_up_is_refused(theta: float) -> None:
    plant = core_model(airframe(), light())
    with pytest.raises(BadInput, match="no_flight_angles"):
        linearize(plant, initial_state(45.0, 0.0, theta, 900.0), {})


def test_no_airspeed_is_refused() -> None:
    plant = core_model(airframe(), light())
    with pytest.raises(BadInput, match="no_flight_angles"):
        linearize(plant, initial_state(0.0, 0.0, 0.0, 900.0), {})


def test_on_the_turning_earth() -> None:
    """Level flight rests there too, with the Earth's and the path's turning in p, q, r; modes move
    by about the Earth's rate.
    """
    asked = Condition(45.0, 1000.0, psi=0.7, place=(0.85, 0.3))
    flat = airframe()
    roots = {}
    for frame in (flat, replace(flat, earth="wgs84")):
        steady = trim(frame, light(), asked, wind=WIND * [1, 1, 0])
        plant = core_model(frame, light(), WIND * [1, 1, 0])
        found = linearize(plant, steady.state, steady.inputs, earth=frame.earth)
        assert found.unsteady == {}
        assert found.point["h"] == pytest.approx(1000.0, abs=1e-6)
        motion = found.motion()
        roots[frame.earth] = {m.name: m.eigenvalue for m in modes_of(motion, 45.0)}
    turning = np.array([steady.p, steady.q, steady.r])
    # Earth's rate and V/R of the path: 7.3e-5 and 7e-6 rad/s
    assert 6e-5 < np.linalg.norm(turning) < 9e-5
    place = dict(zip(found.states, found.x0, strict=True))
    assert (place["lat"], place["lon"]) == pytest.approx((0.85, 0.3), abs=1e-12)
    assert set(roots["flat"]) == set(roots["wgs84"])
    for name, root in roots["flat"].items():
        # gravity at 49 deg and 1000 m is 9.8066 m/s2, too; what is left is the turning
        assert roots["wgs84"][name] == pytest.approx(root, abs=2e-3), name


def test_equals_differences_on_the_turning_earth() -> None:
    frame = replace(airframe(), earth="wgs84")
    plant = core_model(frame, light())
    x0 = np.array([40.0, 0.1, -0.05, 0.3, -0.2, 0.4, 0.8, 0.3, 2.0, 0.85, -0.4, 2000.0])
    state = plant_state(x0, np.zeros(3), "wgs84")
    found = linearize(plant, state, {"thrust": 500.0}, earth="wgs84")

    def rates(z: np.ndarray) -> np.ndarray:
        f, _ = plant_rates(plant, plant_state(z, np.zeros(3), "wgs84"), found.u0)
        T = tangent(z, np.zeros(3), "wgs84")
        place = np.linalg.solve(T[:3, 9:12], f[:3])
        rest = np.linalg.lstsq(T[3:, :9], f[3:] - T[3:, 9:12] @ place, rcond=None)[0]
        return np.concatenate([rest, place])

    J = []
    for i, value in enumerate(found.x0):
        e = np.zeros(12)
        # angles by 1e-3, as before; 1e-3 rad of latitude are 6 km and 1e-3 of gravity
        e[i] = h = 1e-3 * max(abs(value), 1.0)
        wide = (rates(found.x0 + 2 * e) - rates(found.x0 - 2 * e)) / (4 * h)
        J.append((4 * (rates(found.x0 + e) - rates(found.x0 - e)) / (2 * h) - wide) / 3)
    np.testing.assert_allclose(found.A, np.array(J).T, rtol=1e-6, atol=1e-6)
