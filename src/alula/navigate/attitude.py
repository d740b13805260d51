"""Attitude from gravity and the magnetic field, sample by sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.core import core


@dataclass(frozen=True)
class VectorAttitude:
    """euler (n, 3): phi theta psi, rad. gain (n,): acceleration gain 0 to 1, how far gravity as
    seen may be believed. heading, valid (n,) of bool: whether psi, and whether all of it is one.
    """

    euler: Array
    gain: Array
    heading: np.ndarray
    valid: np.ndarray


def gravity_seen(force: Array, rate: Array, velocity: Array) -> Array:
    """Gravity in body axes (n, 3), m/s2: w x v - f, Pusztai 2018, Eq. (3.23).

    force (m/s2), rate (rad/s), velocity (m/s, body axes; in steady flight the one through the air
    is the one that stands still there): (n, 3).
    """
    return np.asarray(np.cross(rate, velocity) - force)


def attitude_from_vectors(
    gravity_B: Array, field_B: Array, field_E: Array, gravity: float = 9.80665
) -> VectorAttitude:
    """Attitude from gravity and field in body axes (n, 3), the field NED (3,) in the same unit.

    Pusztai 2018, Eq. (3.24) to (3.28). A field of the wrong size or dip gives no heading; bank and
    pitch are then gravity's alone. No gravity (free fall) gives nothing: valid is False.
    """
    out = np.empty((len(gravity_B), 6))
    core.measured_attitude(
        np.ascontiguousarray(gravity_B, dtype=np.float64),
        np.ascontiguousarray(field_B, dtype=np.float64),
        np.array(field_E, dtype=np.float64),
        gravity,
        out,
    )
    return VectorAttitude(
        frozen(out[:, :3]), frozen(out[:, 3]), out[:, 4].astype(bool), out[:, 5].astype(bool)
    )
