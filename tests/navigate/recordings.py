"""Exact motions, and what sensors without errors make of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.navigate import Inertial, Readings, rotations

G = 9.80665
FIELD = np.array([21.0e-6, 1.6e-6, 43.8e-6])  # T, NED


@dataclass(frozen=True)
class Motion:
    """t (n,), q (n, 4), euler, velocity, position (n, 3) NED, rate, force (n, 3) body axes."""

    t: Array
    q: Array
    euler: Array
    velocity: Array
    position: Array
    rate: Array
    force: Array

    @property
    def inertial(self) -> Inertial:
        return Inertial(self.t, self.rate, self.force)


def turning(
    seconds: float, *, rate: float = 400.0, V: float = 30.0, turn: float = 0.2,
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Motion:  # fmt: skip
    """A coordinated level turn through air that moves as a whole; turn rad/s, 0: straight on."""
    t = np.arange(round(seconds * rate) + 1) / rate
    phi, psi, zero = np.arctan(turn * V / G), turn * t, np.zeros(len(t))
    half = 0.5 * psi
    c, s = np.cos(0.5 * phi), np.sin(0.5 * phi)
    q = np.column_stack([c * np.cos(half), s * np.cos(half), s * np.sin(half), c * np.sin(half)])
    if turn:
        place = V / turn * np.column_stack([np.sin(psi), 1.0 - np.cos(psi), zero])
    else:
        place = np.column_stack([V * t, zero, zero])
    w = np.array(wind)
    return Motion(
        t,
        q,
        np.column_stack([zero + phi, zero, (psi + np.pi) % (2.0 * np.pi) - np.pi]),
        V * np.column_stack([np.cos(psi), np.sin(psi), zero]) + w,
        place + np.outer(t, w) + np.array([0.0, 0.0, -100.0]),
        np.tile([0.0, turn * np.sin(phi), turn * np.cos(phi)], (len(t), 1)),
        np.tile([0.0, 0.0, -G / np.cos(phi)], (len(t), 1)),
    )


def sensors(m: Motion, V: float = 30.0, delay: float = 0.2) -> list[Readings]:
    """All of them, exact, with the noise they are said to have."""
    rate = round(1.0 / float(m.t[1] - m.t[0]))
    air, gps = np.arange(0, len(m.t), rate // 50), np.arange(0, len(m.t), rate // 5)
    field = np.einsum("nij,j->ni", rotations(m.q), FIELD)[air]
    ta, tg, flat = m.t[air], m.t[gps], np.zeros(len(air))
    return [
        Readings("position", tg, m.position[gps], 1.5, tg + delay),
        Readings("velocity", tg, m.velocity[gps], 0.15, tg + delay),
        Readings("field", ta, field, 0.5e-6),
        Readings("height", ta, -m.position[air, 2], 0.5),
        Readings("V", ta, flat + V, 0.3),
        Readings("alpha", ta, flat, 0.005),
        Readings("beta", ta, flat, 0.005),
    ]


def without(readings: list[Readings], *kinds: str) -> list[Readings]:
    return [r for r in readings if r.kind not in kinds]
