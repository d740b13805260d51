"""A rigid body as a cloud of particles: sums over them are the truth for mass properties."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array


def sums(m: Array, r: Array) -> tuple[float, Array, Array]:
    """Mass, CG (3,) and inertia (3, 3) about it of particles m (n,) kg at r (n, 3) m."""
    mass = float(m.sum())
    cg = m @ r / mass
    x, y, z = (r - cg).T
    xy, xz, yz = m @ (x * y), m @ (x * z), m @ (y * z)
    return (
        mass,
        cg,
        np.array(
            [
                [m @ (y * y + z * z), -xy, -xz],
                [-xy, m @ (x * x + z * z), -yz],
                [-xz, -yz, m @ (x * x + y * y)],
            ]
        ),
    )


def cloud(seed: int, n: int, center: tuple[float, float, float]) -> tuple[Array, Array]:
    """n particles spread over meters around a center."""
    rng = np.random.default_rng(seed)
    return rng.uniform(1.0, 9.0, n), np.array(center) + rng.normal(size=(n, 3)) * [3.0, 4.0, 0.7]


def table(J: Array) -> str:
    """The inertia (3, 3) as the aircraft file writes it."""
    return (
        (
            f"{{Ixx = {J[0, 0]!r}, Iyy = {J[1, 1]!r}, Izz = {J[2, 2]!r}, "
            f"Ixz = {-J[0, 2]!r}, Ixy = {-J[0, 1]!r}, Iyz = {-J[1, 2]!r}}}"
        )
        .replace("np.float64(", "")
        .replace(")", "")
    )
