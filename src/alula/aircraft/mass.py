"""Mass, center of gravity and inertia, as totals or from components, with fuel burn.

The inertia tensor is J = [[Ixx, -Ixy, -Ixz], [-Ixy, Iyy, -Iyz], [-Ixz, -Iyz, Izz]] with the
products as positive integrals: Ixz is the integral of x z dm. Body axes, kg m2.
Source: Dittrich 2016, Eq. (2.41) and (2.42).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from alula.aircraft.tanks import Tank, remaining
from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn

ROUNDING = 0.01  # of the largest principal moment: what figures of two or three digits may miss by
COUNTER_SLACK = 0.01  # of the fuel on board: what a fuel counter may run over


@dataclass(frozen=True)
class MassProperties:
    """Along a flight: mass (n,) kg, cg (n, 3) m from the datum, inertia (n, 3, 3) about that cg."""

    mass: Array
    cg: Array
    inertia: Array


@dataclass(frozen=True)
class Component:
    """A part of the aircraft: mass kg, position (3,) m from the datum, own inertia (3, 3)."""

    name: str
    mass: float
    position: Array
    inertia: Array


@dataclass(frozen=True)
class MassModel:
    """The aircraft at zero fuel used, and the fuel that it will burn.

    mass kg, cg (3,) m from the datum, inertia (3, 3) about the CG, all with the fuel on board.
    fuel: what is burned, part of these totals; None where mass is constant. tanks: where it is,
    if the file says so; then the fuel keeps to its tanks as it burns, else all of it burns in
    proportion.
    """

    mass: float
    cg: Array
    inertia: Array
    fuel: Component | None = None
    tanks: tuple[Tank, ...] = ()
    messages: tuple[Message, ...] = field(default=())

    def at(self, fuel_used: Array) -> MassProperties:
        """Mass properties after burning `fuel_used` (n,) kg.

        Where the aircraft file states no fuel, all is constant. NaN stays NaN. Raises BadInput
        when more is burned than was on board.
        """
        used = np.atleast_1d(np.asarray(fuel_used, dtype=np.float64))
        n = len(used)
        if self.fuel is None:
            return MassProperties(
                frozen(np.full(n, self.mass)),
                frozen(np.tile(self.cg, (n, 1))),
                frozen(np.tile(self.inertia, (n, 1, 1))),
            )
        _check_fuel(used, self.fuel.mass)
        if self.tanks:
            return self._from_tanks(np.clip(used, 0.0, self.fuel.mass))
        mass = self.mass - used
        cg = (self.mass * self.cg - used[:, None] * self.fuel.position) / mass[:, None]
        inertia = (
            self.inertia
            + self.mass * point_inertia(self.cg - cg)
            - used[:, None, None] * point_inertia(self.fuel.position - cg)
            - (used / self.fuel.mass)[:, None, None] * self.fuel.inertia
        )
        return MassProperties(frozen(mass), frozen(cg), frozen(inertia))

    def _from_tanks(self, used: Array) -> MassProperties:
        """The aircraft without fuel, and what is left in each tank."""
        assert self.fuel is not None
        dry = self.mass - self.fuel.mass
        dry_cg = (self.mass * self.cg - self.fuel.mass * self.fuel.position) / dry
        dry_inertia = (
            self.inertia
            + self.mass * point_inertia(self.cg - dry_cg)
            - self.fuel.mass * point_inertia(self.fuel.position - dry_cg)
            - self.fuel.inertia
        )
        left = remaining(self.tanks, used)
        parts = [tank.content(fuel) for tank, fuel in zip(self.tanks, left, strict=True)]
        mass = dry + np.sum([m for m, _, _ in parts], axis=0)
        cg = (dry * dry_cg + sum(m[:, None] * r for m, r, _ in parts)) / mass[:, None]
        inertia = dry_inertia + dry * point_inertia(dry_cg - cg)
        for m, r, own in parts:
            inertia = inertia + own + m[:, None, None] * point_inertia(r - cg)
        return MassProperties(frozen(mass), frozen(cg), frozen(inertia))


def inertia_tensor(
    Ixx: float, Iyy: float, Izz: float, Ixz: float = 0.0, Ixy: float = 0.0, Iyz: float = 0.0
) -> Array:
    """The tensor (3, 3) from moments and products; products are positive integrals."""
    return np.array([[Ixx, -Ixy, -Ixz], [-Ixy, Iyy, -Iyz], [-Ixz, -Iyz, Izz]], dtype=np.float64)


def point_inertia(r: Array) -> Array:
    """Inertia (..., 3, 3) of a unit mass at r (..., 3) about the origin."""
    square = np.sum(r * r, axis=-1)[..., None, None]
    return np.asarray(square * np.eye(3) - r[..., :, None] * r[..., None, :])


def combine(parts: Sequence[Component]) -> tuple[float, Array, Array]:
    """Mass, CG and inertia about that CG of several parts (Dittrich 2016, Eq. 2.41, 2.42)."""
    mass = sum(part.mass for part in parts)
    moment = sum((part.mass * part.position for part in parts), np.zeros(3))
    cg = moment / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        inertia += part.inertia + part.mass * point_inertia(part.position - cg)
    return mass, cg, inertia


def check_inertia(inertia: Array, where: str) -> tuple[Message, ...]:
    """Whether a rigid body of positive mass can have this tensor (3, 3).

    The principal moments must be positive, and none may exceed the sum of the other two, because
    their difference is twice an integral of a square. Raises BadInput where they cannot be; a
    miss that rounding of the figures explains is a warning, returned.
    """
    small, middle, large = (float(x) for x in np.linalg.eigvalsh(inertia))
    found = f"principal moments {small:.5g}, {middle:.5g}, {large:.5g} kg m2"
    do = (
        "Check units, the axes and the sign of the products of inertia "
        "(Ixz is the integral of x z dm, x forward, z down)."
    )
    if not small > 0.0:
        raise refuse(
            "impossible_inertia",
            where=where,
            expected="three positive principal moments of inertia",
            found=found,
            do=do,
        )
    excess = large - (small + middle)
    expected = (
        f"the largest principal moment at most the sum of the others, {small + middle:.5g} kg m2"
    )
    if excess > ROUNDING * large:
        raise refuse("impossible_inertia", where=where, expected=expected, found=found, do=do)
    if excess > 1e-9 * large:
        return (
            warn(
                "inertia_at_limit",
                where=where,
                expected=expected,
                found=f"{found}: {100 * excess / large:.2g} % over, as rounded figures may be",
                do="Moments come out as stated; better figures would be well used.",
            ),
        )
    return ()


def _check_fuel(used: Array, on_board: float) -> None:
    slack = COUNTER_SLACK * on_board
    known = used[~np.isnan(used)]
    low, high = float(known.min(initial=0.0)), float(known.max(initial=0.0))
    if low < -slack or high > on_board + slack:
        raise refuse(
            "fuel_used_range",
            where="channel 'fuel_used'",
            expected=f"0 to {on_board:.5g} kg, the fuel of the aircraft file",
            found=f"{low:.5g} to {high:.5g} kg",
            do="Check the channel's unit and offset, or mass.fuel.mass in the aircraft file.",
        )
