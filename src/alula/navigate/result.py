"""What the navigation filters found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array, frozen
from alula.base.messages import Message
from alula.core import core
from alula.navigate.samples import TAKEN, Readings

# First error state of each part; turn: rad about the body axes.
JOINT_STATES: Mapping[str, slice] = {
    "turn": slice(0, 3), "velocity": slice(3, 6), "position": slice(6, 9),
    "gyro_bias": slice(9, 12), "force_bias": slice(12, 15), "wind": slice(15, 18),
    "gust": slice(18, 21), "height_bias": slice(21, 22),
}  # fmt: skip
PAIR_STATES: Mapping[str, slice] = {
    "turn": slice(0, 3), "gyro_bias": slice(3, 6), "position": slice(6, 9),
    "velocity": slice(9, 12), "force_bias": slice(12, 15),
}  # fmt: skip


@dataclass(frozen=True)
class Taking:
    """What became of one sensor's readings, in the order of arrival.

    nis (m,): normalized innovation squared of those that were judged, NaN else, of `width`
    degrees of freedom. deviation (m, 3): of the innovations. taken (m,) of indices into TAKEN, -1
    where it came after the last inertial sample. counts: by name.
    """

    kind: str
    width: int
    t: Array
    nis: Array
    deviation: Array
    taken: NDArray[np.int32]
    counts: Mapping[str, int]

    @property
    def mean_nis(self) -> float:
        """Mean of nis per degree of freedom, of what was taken: 1 where noise is as stated."""
        used = self.nis[self.taken == 0]
        return float(np.mean(used)) / self.width if len(used) else float("nan")


@dataclass(frozen=True)
class Navigation:
    """States at times t (n,), s, and the covariance (n, k, k) of their errors.

    q (n, 4): quaternion that turns NED into body axes. euler (n, 3): phi theta psi, rad. velocity,
    position (n, 3): NED. gyro_bias rad/s, force_bias m/s2 (n, 3), body axes. wind (n, 3): NED, the
    way it blows to, turbulence included; steady (n, 3): without; NaN from the pair. height_bias
    (n,) m. states: where each part stands in the covariance. takings: by sensor. inertial: what
    became of the inertial samples, by name.
    """

    filter: Literal["joint", "pair"]
    t: Array
    q: Array
    euler: Array
    velocity: Array
    position: Array
    gyro_bias: Array
    force_bias: Array
    wind: Array
    steady: Array
    height_bias: Array
    covariance: Array
    states: Mapping[str, slice]
    takings: tuple[Taking, ...]
    inertial: Mapping[str, int]
    messages: tuple[Message, ...] = ()

    def part(self, name: str) -> Array:
        """Covariance (n, 3, 3) of one part; 'wind' with its gust."""
        here = self.states[name]
        P: Array = self.covariance[:, here, here]
        if name != "wind":
            return P
        gust = self.states["gust"]
        cross = self.covariance[:, here, gust]
        return np.asarray(P + self.covariance[:, gust, gust] + cross + np.swapaxes(cross, 1, 2))

    def se(self, name: str) -> Array:
        """Standard errors (n, 3) of one part; of 'euler' as phi theta psi, to first order."""
        if name == "euler":
            return np.asarray(np.sqrt(np.einsum("nij,njk,nik->ni", *self._euler_parts())))
        return np.asarray(np.sqrt(np.maximum(np.einsum("nii->ni", self.part(name)), 0.0)))

    def _euler_parts(self) -> tuple[Array, Array, Array]:
        phi, theta = self.euler[:, 0], self.euler[:, 1]
        E = np.zeros((len(phi), 3, 3))  # rates of phi theta psi from a turn about body axes
        # at 90 degrees of pitch bank and heading are one: the error bar grows, it does not end
        cosine = np.where(np.abs(np.cos(theta)) > 1e-3, np.cos(theta), 1e-3)
        E[:, 0, 0] = 1.0
        E[:, 0, 1] = np.sin(phi) * np.sin(theta) / cosine
        E[:, 0, 2] = np.cos(phi) * np.sin(theta) / cosine
        E[:, 1, 1], E[:, 1, 2] = np.cos(phi), -np.sin(phi)
        E[:, 2, 1], E[:, 2, 2] = np.sin(phi) / cosine, np.cos(phi) / cosine
        return E, self.part("turn"), E

    def air(self) -> Array:
        """(n, 3) V (m/s), alpha, beta (rad) that follow from velocity, wind and attitude."""
        v = np.einsum("nij,nj->ni", rotations(self.q), self.velocity - self.wind)
        plane = np.hypot(v[:, 0], v[:, 2])
        return np.column_stack(
            [np.hypot(plane, v[:, 1]), np.arctan2(v[:, 2], v[:, 0]), np.arctan2(v[:, 1], plane)]
        )

    def air_covariance(self) -> Array:
        """Covariance (n, 3, 3) of what `air` gives, to first order; NaN from the pair: no wind."""
        n = len(self.t)
        if "wind" not in self.states:
            return np.full((n, 3, 3), np.nan)
        R = rotations(self.q)
        v = np.einsum("nij,nj->ni", R, self.velocity - self.wind)
        u, side, w = v.T
        J = np.zeros((n, 3, self.covariance.shape[-1]))  # of the air velocity, body axes
        J[:, :, self.states["turn"]] = np.cross(v[:, None, :], np.eye(3)).transpose(0, 2, 1)
        J[:, :, self.states["velocity"]] = R
        for part in ("wind", "gust"):
            J[:, :, self.states[part]] = -R
        speed2 = np.maximum(np.einsum("ni,ni->n", v, v), 1e-6)
        plane = np.sqrt(np.maximum(u**2 + w**2, 1e-6))
        A = np.zeros((n, 3, 3))  # V, alpha, beta from that
        A[:, 0] = v / np.sqrt(speed2)[:, None]
        A[:, 1, 0], A[:, 1, 2] = -w / plane**2, u / plane**2
        A[:, 2, 0], A[:, 2, 1] = -side * u / (plane * speed2), plane / speed2
        A[:, 2, 2] = -side * w / (plane * speed2)
        J = A @ J
        return np.asarray(J @ self.covariance @ J.transpose(0, 2, 1))


def rotations(q: Array) -> Array:
    """R_BE (n, 3, 3) of quaternions (n, 4)."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    return np.stack(
        [
            np.stack([w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)], -1),
            np.stack([2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)], -1),
            np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z], -1),
        ],
        axis=-2,
    )


def euler_angles(q: Array) -> Array:
    """phi theta psi (n, 3), rad, of quaternions (n, 4).

    By sum and difference of bank and heading, each of which is lost only where it does not matter:
    at 90 deg of pitch, where bank and heading are one angle, they still make up the attitude.
    """
    w, x, y, z = np.moveaxis(q, -1, 0)
    difference = 2.0 * np.arctan2(x - z, w + y)  # phi - psi, by half angles
    total = 2.0 * np.arctan2(x + z, w - y)
    theta = 2.0 * np.arctan2(np.hypot(w + y, x - z), np.hypot(w - y, x + z)) - 0.5 * np.pi
    phi, psi = 0.5 * (total + difference), 0.5 * (total - difference)
    turn = 2.0 * np.pi
    phi, psi = (angle - turn * np.round(angle / turn) for angle in (phi, psi))
    return np.column_stack([phi, theta, psi])


def quaternion(phi: float, theta: float, psi: float) -> Array:
    """Quaternion (4,) of Euler angles, rad."""
    out = np.empty(4)
    core.quaternion_from_euler(float(phi), float(theta), float(psi), out)
    return out


def takings_of(
    found: Mapping[str, Any], rows: Array, whose: NDArray[np.intp], readings: Sequence[Readings]
) -> tuple[Taking, ...]:
    """The core's verdicts by sensor."""
    out = []
    for i, sensor in enumerate(readings):
        mine = whose == i
        taken = np.asarray(found["taken"])[mine]
        judged = (taken == 0) | (taken == TAKEN.index("gated"))
        counts = {name: int(np.sum(taken == k)) for k, name in enumerate(TAKEN)}
        counts["after_the_end"] = int(np.sum(taken == -1))
        out.append(
            Taking(
                kind=sensor.kind,
                width=3 if sensor.kind in ("position", "velocity", "field") else 1,
                t=frozen(rows[mine, 1]),
                nis=frozen(np.where(judged, np.asarray(found["nis"])[mine], np.nan)),
                deviation=frozen(np.asarray(found["deviation"])[mine]),
                taken=taken,
                counts={name: n for name, n in counts.items() if n},
            )
        )
    return tuple(out)


def inertial_counts(found: Mapping[str, Any]) -> dict[str, int]:
    """What became of the inertial samples, by name."""
    taken = np.asarray(found["taken_inertial"])
    return {name: int(np.sum(taken == k)) for k, name in enumerate(TAKEN) if np.any(taken == k)}
