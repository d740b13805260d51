"""Fuel in tanks of given shape, lying on the floor of the tank and burning from the top.

The surface stays parallel to the aircraft's x-y plane, as in coordinated flight near level; the
fuel does not slosh. In a wing tank with taper the depth of every section falls by the same share,
so that dihedral lets no fuel run inward.

The fuel's own inertia is that of a solid of its shape, or 'reduced': liquid in a full closed tank
does not turn with it. For a liquid ellipsoid with second moments s_i = integral of r_i^2 dm, the
moment about axis 3 falls from s_1 + s_2 to (s_1 - s_2)^2/(s_1 + s_2) (Lamb, Hydrodynamics, 6th
ed., Art. 110). The same is used of other shapes: a full box of square section keeps 16 % where the
formula says none, of 2 to 1 keeps 45 % (36 %), of 4 to 1 keeps 80 % (78 %).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen

# Gauss-Legendre with four points integrates polynomials of degree 7 exactly; the integrands of a
# tank with straight edges have at most degree 4.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True)
class Content:
    """What fills a tank: mass (n,) kg, position (n, 3) m, moments (n, 3, 3) kg m2.

    moments: the integrals of r_i r_j dm about the fuel's own CG.
    """

    mass: Array
    position: Array
    moments: Array


@dataclass(frozen=True)
class TaperedTank:
    """A tank between two rectangles across y: a box, or a wing tank with taper, sweep, dihedral.

    centers: (2, 3) m from the datum; lengths, depths: (2,) m along x and z.
    """

    centers: Array
    lengths: Array
    depths: Array

    @property
    def volume(self) -> float:
        """m3 when full."""
        return float(self._weights(np.ones(1)).sum())

    def _weights(self, filled: Array) -> Array:
        """Volume (n, 4) that each node across the tank stands for."""
        s = 0.5 * (1.0 + _NODES)
        length = self.lengths[0] + s * (self.lengths[1] - self.lengths[0])
        depth = self.depths[0] + s * (self.depths[1] - self.depths[0])
        span = abs(self.centers[1, 1] - self.centers[0, 1])
        return np.asarray(0.5 * span * _WEIGHTS * length * depth * filled[:, None])

    def content(self, filled: Array, density: float) -> Content:
        """The fuel where the share `filled` (n,) of the tank is full; density: kg/m3."""
        s = 0.5 * (1.0 + _NODES)
        length = self.lengths[0] + s * (self.lengths[1] - self.lengths[0])
        depth = self.depths[0] + s * (self.depths[1] - self.depths[0])
        center = self.centers[0] + s[:, None] * (self.centers[1] - self.centers[0])
        weights = density * self._weights(filled)
        points = np.broadcast_to(center, (len(filled), 4, 3)).copy()
        points[:, :, 2] += 0.5 * depth * (1.0 - filled[:, None])  # z is down: the floor is below
        mass = weights.sum(axis=1)
        share = (density * self._weights(np.ones(1)))[0]
        share = share / share.sum()  # the same at every level, so that an empty tank has a place
        position = np.einsum("k,nki->ni", share, points)
        r = points - position[:, None, :]
        moments = np.einsum("nk,nki,nkj->nij", weights, r, r)
        moments[:, 0, 0] += weights @ (length**2) / 12.0
        moments[:, 2, 2] += np.sum(weights * (depth * filled[:, None]) ** 2, axis=1) / 12.0
        return Content(mass, position, moments)


@dataclass(frozen=True)
class CylinderTank:
    """A cylinder along one of the body axes. center: (3,) m from the datum; axis: 0, 1 or 2."""

    center: Array
    diameter: float
    length: float
    axis: int

    @property
    def volume(self) -> float:
        """m3 when full."""
        return 0.25 * np.pi * self.diameter**2 * self.length

    def content(self, filled: Array, density: float) -> Content:
        """The fuel where the share `filled` (n,) of the tank is full; density: kg/m3."""
        n, R, L = len(filled), 0.5 * self.diameter, self.length
        mass = density * self.volume * filled
        position, moments = np.tile(self.center, (n, 1)), np.zeros((n, 3, 3))
        if self.axis == 2:
            position[:, 2] += 0.5 * L * (1.0 - filled)
            moments[:, 0, 0] = moments[:, 1, 1] = 0.25 * R**2 * mass
            moments[:, 2, 2] = (L * filled) ** 2 / 12.0 * mass
            return Content(mass, position, moments)
        # A segment of a circle below its chord; half is half the angle that the chord subtends.
        half = _half_angle(filled)
        sine, cosine = np.sin(half), np.cos(half)
        area = R**2 * np.pi * np.maximum(filled, 1e-12)
        down = 2.0 * R**3 * sine**3 / (3.0 * area)
        per_area = density * L
        along = half - sine * cosine
        vertical = 0.25 * R**4 * (along + 2.0 * sine**3 * cosine) - area * down**2
        across = R**4 / 12.0 * (3.0 * along - 2.0 * sine**3 * cosine)
        position[:, 2] += np.minimum(down, R)
        side = 1 - self.axis
        moments[:, self.axis, self.axis] = L**2 / 12.0 * mass
        moments[:, side, side] = per_area * np.maximum(across, 0.0)
        moments[:, 2, 2] = per_area * np.maximum(vertical, 0.0)
        return Content(mass, position, moments)


def _half_angle(filled: Array) -> Array:
    """Half the angle (n,) whose segment is the share `filled` of a circle, by bisection."""
    low, high = np.zeros(len(filled)), np.full(len(filled), np.pi)
    for _ in range(54):  # to the last bit of pi
        middle = 0.5 * (low + high)
        less = middle - np.sin(middle) * np.cos(middle) < np.pi * filled
        low, high = np.where(less, middle, low), np.where(less, high, middle)
    return np.asarray(0.5 * (low + high))


@dataclass(frozen=True)
class Tank:
    """A tank with its fuel at zero fuel used, kg, and the fuel's density, kg/m3.

    burn: tanks burn in this order; those of equal number together, in proportion to what they
    held. reduced: whether the fuel's own inertia is that of a liquid.
    """

    name: str
    shape: TaperedTank | CylinderTank
    fuel: float
    density: float
    burn: int = 1
    reduced: bool = False

    @property
    def capacity(self) -> float:
        """kg of fuel that the tank can hold."""
        return self.density * self.shape.volume

    def content(self, fuel: Array) -> tuple[Array, Array, Array]:
        """Mass (n,), position (n, 3) and own inertia (n, 3, 3) with `fuel` (n,) kg inside."""
        known = np.isfinite(fuel)
        filled = np.clip(np.where(known, fuel, 0.0) / self.capacity, 0.0, 1.0)
        content = self.shape.content(filled, self.density)
        lost = np.where(known, 0.0, np.nan)
        inertia = _inertia(content.moments, self.reduced)
        return content.mass + lost, content.position + lost[:, None], inertia + lost[:, None, None]


def _inertia(moments: Array, reduced: bool) -> Array:
    """Inertia tensors (n, 3, 3) from the integrals of r_i r_j dm, as a solid or a liquid."""
    if not reduced:
        return np.asarray(np.trace(moments, axis1=1, axis2=2)[:, None, None] * np.eye(3) - moments)
    s, axes = np.linalg.eigh(moments)
    own = np.empty_like(s)
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        total = s[:, j] + s[:, k]
        own[:, i] = (s[:, j] - s[:, k]) ** 2 / np.where(total > 0.0, total, 1.0)
    return np.asarray(np.einsum("nij,nj,nkj->nik", axes, own, axes))


def remaining(tanks: Sequence[Tank], used: Array) -> list[Array]:
    """Fuel (n,) kg left in each tank after burning `used` (n,) kg in the tanks' order."""
    left: dict[int, Array] = {}
    for order in sorted({tank.burn for tank in tanks}):
        held = sum(tank.fuel for tank in tanks if tank.burn == order)
        burned = np.minimum(used, held)  # NaN stays NaN
        left[order] = 1.0 - burned / held
        used = used - burned
    return [frozen(tank.fuel * left[tank.burn]) for tank in tanks]
