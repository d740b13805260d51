"""From the plant's states to those of flight mechanics: V alpha beta and Euler angles, exactly.

The plant holds position, quaternion, velocity against the Earth in body axes, rates, and further
states. Flight mechanics speaks of x = (V, alpha, beta, p, q, r, phi, theta, psi, place, h, further
states). `plant_state` is the map g(x), `tangent` its Jacobian T = dg/dx, both written so that they
take complex x: a derivative of T along a direction is then exact to rounding (Squire and Trapp,
Using Complex Variables to Estimate Derivatives of Real Functions, SIAM Review 40, 1998).

V, alpha and beta are relative to the wind at the point, taken as uniform in their definition; what
its shear does to the aircraft is in the plant's matrices.
"""

from __future__ import annotations

from functools import reduce
from typing import Any, Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse

Earth = Literal["flat", "wgs84"]
Quaternion = tuple[Any, ...]  # real or complex, scalar first

MOTION = ("V", "alpha", "beta", "p", "q", "r", "phi", "theta", "psi")
PLACE: dict[Earth, tuple[str, str, str]] = {
    "flat": ("north", "east", "h"),
    "wgs84": ("lat", "lon", "h"),
}
BODY_STATES = 13  # of the plant before its further states
FLIGHT_STATES = 12
# WGS-84, NIMA TR8350.2
_RADIUS, _FLATTENING = 6378137.0, 1.0 / 298.257223563
_ECCENTRICITY2 = _FLATTENING * (2.0 - _FLATTENING)


def flight_names(earth: Earth, further: tuple[str, ...] = ()) -> tuple[str, ...]:
    """Names of the flight states."""
    return (*MOTION, *PLACE[earth], *further)


def plant_state(x: Any, wind: Array, earth: Earth = "flat") -> Any:
    """The plant's state (13 + k,) of a flight state x (12 + k,), real or complex.

    wind: (3,) m/s, NED, the way it blows to.
    """
    turn = _turn_matrices(x[6:9])
    v = _air(x) + turn[0] @ turn[1] @ turn[2] @ wind
    attitude = reduce(_times, (_about(axis, a) for axis, a in _angles(x, earth)))
    return np.concatenate([_position(x, earth), attitude, v, x[3:6], x[12:]])


def tangent(x: Any, wind: Array, earth: Earth = "flat") -> Any:
    """T = d(plant state)/d(flight state), (13 + k, 12 + k), for real or complex x."""
    n = len(x) - FLIGHT_STATES
    T = np.zeros((BODY_STATES + n, FLIGHT_STATES + n), dtype=np.asarray(x).dtype)
    T[:3, 9:12] = _position_tangent(x, earth)
    # Each angle turns one link of the chain; latitude turns against its axis.
    chain = [(axis, _about(axis, angle)) for axis, angle in _angles(x, earth)]
    columns = (10, 9, 8, 7, 6)[-len(chain) :]
    for i, column in enumerate(columns):
        links = [q if i != j else _rate_of(q, axis) for j, (axis, q) in enumerate(chain)]
        T[3:7, column] = reduce(_times, links)
    if earth == "wgs84":
        T[3:7, 9] *= -1.0
    V, alpha, beta = x[0], x[1], x[2]
    ca, sa, cb, sb = np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta)
    T[7:10, 0] = [ca * cb, sb, sa * cb]
    T[7:10, 1] = [-V * sa * cb, 0.0, V * ca * cb]
    T[7:10, 2] = [-V * ca * sb, V * cb, -V * sa * sb]
    if np.any(wind):
        R, dR = _turn_matrices(x[6:9]), _turn_rates(x[6:9])
        T[7:10, 6] = dR[0] @ R[1] @ R[2] @ wind
        T[7:10, 7] = R[0] @ dR[1] @ R[2] @ wind
        T[7:10, 8] = R[0] @ R[1] @ dR[2] @ wind
    for i in range(3):
        T[10 + i, 3 + i] = 1.0
    for i in range(n):
        T[BODY_STATES + i, FLIGHT_STATES + i] = 1.0
    return T


def flight_state(state: Array, wind: Array, earth: Earth = "flat") -> Array:
    """The flight state (12 + k,) of a plant's state (13 + k,), rad and m.

    Raises BadInput where there is none: without airspeed, or with the nose straight up or down.
    """
    euler, place = _attitude_and_place(state, earth)
    R = _turn_matrices(euler)
    u, v, ww = state[7:10] - R[0] @ R[1] @ R[2] @ wind
    V = float(np.sqrt(u * u + v * v + ww * ww))
    plane = float(np.hypot(u, ww))
    if abs(np.cos(euler[1])) < 1e-5 or plane < 1e-3:
        raise refuse(
            "no_flight_angles",
            where="flight state",
            expected="an airspeed in the plane of symmetry, and a nose that is not straight up or "
            "down",
            found=f"V = {V:.3g} m/s, theta = {np.degrees(euler[1]):.6g} deg",
            do="Use the matrices in the plant's own states there.",
        )
    flow = [V, np.arctan2(ww, u), np.arcsin(v / V)]
    return np.concatenate([flow, state[10:13], euler, place, state[BODY_STATES:]])


def wind_from(state: Array, air_velocity: Array, earth: Earth = "flat") -> Array:
    """The wind (3,) m/s, NED, for which a plant state has this air velocity (3,), body axes."""
    euler, _ = _attitude_and_place(state, earth)
    R = _turn_matrices(euler)
    return np.asarray((R[0] @ R[1] @ R[2]).T @ (state[7:10] - air_velocity))


def _attitude_and_place(state: Array, earth: Earth) -> tuple[Array, Array]:
    """phi, theta, psi against north, east, down; north, east, h or latitude, longitude, h."""
    w, i, j, k = state[3:7] / np.linalg.norm(state[3:7])
    if earth == "wgs84":
        lat, lon, h = _geodetic(state[:3])
        a, *back = _times(_about(2, lon), _about(1, -lat - np.pi / 2.0))
        w, i, j, k = _times((a, *(-part for part in back)), (w, i, j, k))
        place = np.array([lat, lon, h])
    else:
        place = np.array([state[0], state[1], -state[2]])
    sine = np.clip(2.0 * (w * j - k * i), -1.0, 1.0)
    euler = np.array(
        [
            np.arctan2(2.0 * (w * i + j * k), 1.0 - 2.0 * (i * i + j * j)),
            np.arcsin(sine),
            np.arctan2(2.0 * (w * k + i * j), 1.0 - 2.0 * (j * j + k * k)),
        ]
    )
    return euler, place


def _air(x: Any) -> Any:
    V, alpha, beta = x[0], x[1], x[2]
    return V * np.array([np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)])


def _angles(x: Any, earth: Earth) -> list[tuple[int, Any]]:
    """The turns from the Earth's axes to the body's, in order: (axis, angle)."""
    ned = [(2, x[8]), (1, x[7]), (0, x[6])]
    if earth == "flat":
        return ned
    return [(2, x[10]), (1, -x[9] - np.pi / 2.0), *ned]


def _about(axis: int, angle: Any) -> Quaternion:
    q: list[Any] = [np.cos(angle / 2.0), 0.0, 0.0, 0.0]
    q[1 + axis] = np.sin(angle / 2.0)
    return tuple(q)


def _rate_of(q: Quaternion, axis: int) -> Quaternion:
    """Derivative by its angle of a turn about an axis: half a turn of 90 degrees further."""
    out: list[Any] = [-0.5 * q[1 + axis], 0.0, 0.0, 0.0]
    out[1 + axis] = 0.5 * q[0]
    return tuple(out)


def _times(a: Quaternion, b: Quaternion) -> Quaternion:
    """Product of quaternions, scalar first."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def _turn_matrices(euler: Any) -> tuple[Any, Any, Any]:
    """The factors of R_BE = R_x(phi) R_y(theta) R_z(psi)."""
    (sx, sy, sz), (cx, cy, cz) = np.sin(euler), np.cos(euler)
    return (
        np.array([[1.0, 0.0, 0.0], [0.0, cx, sx], [0.0, -sx, cx]]),
        np.array([[cy, 0.0, -sy], [0.0, 1.0, 0.0], [sy, 0.0, cy]]),
        np.array([[cz, sz, 0.0], [-sz, cz, 0.0], [0.0, 0.0, 1.0]]),
    )


def _turn_rates(euler: Any) -> tuple[Any, Any, Any]:
    """Each factor's derivative by its angle."""
    (sx, sy, sz), (cx, cy, cz) = np.sin(euler), np.cos(euler)
    return (
        np.array([[0.0, 0.0, 0.0], [0.0, -sx, cx], [0.0, -cx, -sx]]),
        np.array([[-sy, 0.0, -cy], [0.0, 0.0, 0.0], [cy, 0.0, -sy]]),
        np.array([[-sz, cz, 0.0], [-cz, -sz, 0.0], [0.0, 0.0, 0.0]]),
    )


def _position(x: Any, earth: Earth) -> Any:
    if earth == "flat":
        return np.array([x[9], x[10], -x[11]])
    lat, lon, h = x[9], x[10], x[11]
    N = _RADIUS / np.sqrt(1.0 - _ECCENTRICITY2 * np.sin(lat) ** 2)
    return np.array(
        [
            (N + h) * np.cos(lat) * np.cos(lon),
            (N + h) * np.cos(lat) * np.sin(lon),
            (N * (1.0 - _ECCENTRICITY2) + h) * np.sin(lat),
        ]
    )


def _position_tangent(x: Any, earth: Earth) -> Any:
    if earth == "flat":
        return np.diag([1.0, 1.0, -1.0])
    lat, lon, h = x[9], x[10], x[11]
    sl, cl, so, co = np.sin(lat), np.cos(lat), np.sin(lon), np.cos(lon)
    root = 1.0 - _ECCENTRICITY2 * sl**2
    N = _RADIUS / np.sqrt(root)
    M = N * (1.0 - _ECCENTRICITY2) / root
    north = np.array([-sl * co, -sl * so, cl])
    east = np.array([-so, co, 0.0])
    up = np.array([cl * co, cl * so, sl])
    return np.stack([(M + h) * north, (N + h) * cl * east, up], axis=1)


def _geodetic(r: Array) -> tuple[float, float, float]:
    """Latitude, longitude (rad) and height (m); Bowring's start and Newton steps to rounding."""
    across = float(np.hypot(r[0], r[1]))
    lat = float(np.arctan2(r[2], across * (1.0 - _ECCENTRICITY2)))
    for _ in range(8):  # each gains a factor of about 300
        N = _RADIUS / np.sqrt(1.0 - _ECCENTRICITY2 * np.sin(lat) ** 2)
        lat = float(np.arctan2(r[2] + _ECCENTRICITY2 * N * np.sin(lat), across))
    N = _RADIUS / np.sqrt(1.0 - _ECCENTRICITY2 * np.sin(lat) ** 2)
    h = across * np.cos(lat) + r[2] * np.sin(lat) - N * (1.0 - _ECCENTRICITY2 * np.sin(lat) ** 2)
    return lat, float(np.arctan2(r[1], r[0])), float(h)
