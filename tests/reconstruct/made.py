"""Flights made from a motion known in closed form, for any sensor place, rate, delay and wind.

The motion of the center of gravity is a sum of sines; accelerations are its exact derivatives, so
that the truth owes nothing to the code under test.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from alula.aircraft import Aircraft
from alula.aircraft.aircraft import Envelope
from alula.base.arrays import Array
from alula.base.project import ReconstructSpec
from alula.flight import Channel, Flight, Maneuver
from alula.reconstruct import Reconstruction, reconstruct

G = 9.80665
IMU = ("ax", "ay", "az", "p", "q", "r")
IMU_SIGMA = np.array([0.02, 0.02, 0.02, 5e-4, 5e-4, 5e-4])
SIGMA = {
    "h": 1.0, "phi": 0.003, "theta": 0.003, "psi": 0.005, "V": 0.1, "alpha": 0.002, "beta": 0.002,
    "v_north": 0.1, "v_east": 0.1, "v_down": 0.1, "north": 2.0, "east": 2.0,
}  # fmt: skip
UNIT = {
    "h": "m", "phi": "rad", "theta": "rad", "psi": "rad", "V": "m/s", "alpha": "rad",
    "beta": "rad", "v_north": "m/s", "v_east": "m/s", "v_down": "m/s", "north": "m", "east": "m",
}  # fmt: skip
ALL = tuple(SIGMA)
AIR = ("h", "phi", "theta", "psi", "V", "alpha", "beta")
BIAS = np.array([0.05, -0.04, 0.06, 2e-3, -1e-3, 1.5e-3])
WIND = np.array([3.0, -4.0, 0.5])
CALM = np.zeros(3)
# Each state: mean, then (amplitude, rad/s, phase) of its sines.
_MOTION = {
    "u": (60.0, (3.0, 0.25, 0.0)),
    "v": (0.0, (1.5, 0.5, 1.0)),
    "w": (4.0, (1.5, 0.9, 0.3)),
    "phi": (0.0, (0.3, 0.8, 0.0)),
    "theta": (0.05, (0.06, 0.6, 0.4)),
    "psi": (0.0, (0.25, 0.3, 0.2)),
}


def _sines(name: str, t: Array, order: int) -> Array:
    mean, (amplitude, rate, phase) = _MOTION[name]
    shift = phase + 0.5 * np.pi * order
    return np.where(order == 0, mean, 0.0) + amplitude * rate**order * np.sin(rate * t + shift)


def R_BE(phi: Array, theta: Array, psi: Array) -> Array:
    """Earth to body (n, 3, 3) as the product of three single rotations."""
    zero, one = np.zeros_like(phi), np.ones_like(phi)

    def matrix(rows: list[list[Array]]) -> Array:
        return np.moveaxis(np.array(rows), 2, 0)

    c, s = np.cos, np.sin
    X = matrix([[one, zero, zero], [zero, c(phi), s(phi)], [zero, -s(phi), c(phi)]])
    Y = matrix([[c(theta), zero, -s(theta)], [zero, one, zero], [s(theta), zero, c(theta)]])
    Z = matrix([[c(psi), s(psi), zero], [-s(psi), c(psi), zero], [zero, zero, one]])
    return X @ Y @ Z


@dataclass(frozen=True)
class Recipe:
    """What is to be recorded. every, offset: s, by sensor; delay: s, stamps late by that."""

    duration: float = 30.0
    dt: float = 0.02
    psi0: float = 0.4
    wind: tuple[float, float, float] = (3.0, -4.0, 0.5)
    bias: tuple[float, ...] = tuple(BIAS.tolist())
    imu: tuple[float, float, float] = (0.0, 0.0, 0.0)
    sensors: tuple[str, ...] = ALL
    places: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    every: Mapping[str, float] = field(default_factory=dict)
    offset: Mapping[str, float] = field(default_factory=dict)
    delay: Mapping[str, float] = field(default_factory=dict)
    noise: float = 1.0
    steady: bool = False  # straight and level instead of the sines


class Motion:
    """The truth at any time: attitude, velocity, specific force of any point of the body."""

    def __init__(self, recipe: Recipe) -> None:
        self.recipe = recipe
        self.size = 0.0 if recipe.steady else 1.0
        self._position = _position(recipe.psi0, recipe.steady, recipe.duration + 2.0)

    def _get(self, name: str, t: Array, order: int = 0) -> Array:
        mean = _MOTION[name][0] + (self.recipe.psi0 if name == "psi" else 0.0)
        wave = _sines(name, t, order) - (_MOTION[name][0] if order == 0 else 0.0)
        return (mean if order == 0 else 0.0) + self.size * wave

    def attitude(self, t: Array) -> Array:
        """(n, 3) phi, theta, psi."""
        return np.column_stack([self._get(n, t) for n in ("phi", "theta", "psi")])

    def rates(self, t: Array) -> Array:
        """(n, 3) p, q, r by the kinematics of Euler angles 3-2-1."""
        phi, theta, _ = self.attitude(t).T
        dphi, dtheta, dpsi = (self._get(n, t, 1) for n in ("phi", "theta", "psi"))
        return np.column_stack(
            [
                dphi - dpsi * np.sin(theta),
                dtheta * np.cos(phi) + dpsi * np.cos(theta) * np.sin(phi),
                dpsi * np.cos(theta) * np.cos(phi) - dtheta * np.sin(phi),
            ]
        )

    def accelerations(self, t: Array) -> Array:
        """(n, 3) pdot, qdot, rdot; central differences over 1e-4 s are good to 1e-9 rad/s2."""
        return (self.rates(t + 5e-5) - self.rates(t - 5e-5)) / 1e-4

    def velocity(self, t: Array, arm: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
        """(n, 3) against the Earth, body axes, of the point at `arm` from the center of gravity."""
        v = np.column_stack([self._get(n, t) for n in ("u", "v", "w")])
        return v + np.cross(self.rates(t), arm)

    def air(self, t: Array, arm: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
        """(n, 3) V, alpha, beta of that point."""
        R = R_BE(*self.attitude(t).T)
        u, v, w = (self.velocity(t, arm) - R @ np.array(self.recipe.wind)).T
        V = np.sqrt(u**2 + v**2 + w**2)
        return np.column_stack([V, np.arctan2(w, u), np.arcsin(v / V)])

    def force(self, t: Array, arm: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
        """(n, 3) specific force at that point."""
        dv = np.column_stack([self._get(n, t, 1) for n in ("u", "v", "w")])
        rates = self.rates(t)
        down = R_BE(*self.attitude(t).T) @ np.array([0.0, 0.0, G])
        f = dv + np.cross(rates, self.velocity(t)) - down
        turn = np.cross(self.accelerations(t), arm)
        return f + turn + np.cross(rates, np.cross(rates, arm))

    def position(self, t: Array, arm: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
        """(n, 3) north, east, down of that point."""
        R = R_BE(*self.attitude(t).T)
        return self._position(t).T + np.swapaxes(R, 1, 2) @ np.array(arm)

    def sensor(self, name: str, t: Array) -> Array:
        """What a perfect sensor at its place reads."""
        arm = self.recipe.places.get(name, (0.0, 0.0, 0.0))
        if name in ("phi", "theta", "psi"):
            return self.attitude(t)[:, ("phi", "theta", "psi").index(name)]
        if name in ("V", "alpha", "beta"):
            return self.air(t, arm)[:, ("V", "alpha", "beta").index(name)]
        if name.startswith("v_"):
            v_E = np.swapaxes(R_BE(*self.attitude(t).T), 1, 2) @ self.velocity(t, arm)[:, :, None]
            return v_E[:, ("v_north", "v_east", "v_down").index(name), 0]
        where = self.position(t, arm)
        return 1000.0 - where[:, 2] if name == "h" else where[:, ("north", "east").index(name)]


@cache
def _position(psi0: float, steady: bool, end: float):  # type: ignore[no-untyped-def]
    motion = object.__new__(Motion)
    motion.recipe, motion.size = Recipe(psi0=psi0, steady=steady), 0.0 if steady else 1.0

    def rate(t: float, _: Array) -> Array:
        at = np.array([t])
        return R_BE(*motion.attitude(at).T)[0].T @ motion.velocity(at)[0]

    return solve_ivp(rate, (-2.0, end), np.zeros(3), rtol=1e-9, atol=1e-7, dense_output=True).sol


def record(recipe: Recipe, seed: int = 1) -> tuple[Flight, Motion]:
    """The flight that the sensors record."""
    truth, rng = Motion(recipe), np.random.default_rng(seed)
    t = np.arange(0.0, recipe.duration + 1e-9, recipe.dt)
    exact = np.column_stack([truth.force(t, recipe.imu), truth.rates(t)])
    noise = recipe.noise * IMU_SIGMA * rng.standard_normal((len(t), 6))
    inputs = exact + np.array(recipe.bias) + noise
    channels = {
        name: Channel(name, t, inputs[:, i], "m/s2" if i < 3 else "rad/s", "made")
        for i, name in enumerate(IMU)
    }
    for name in recipe.sensors:
        step = recipe.every.get(name, recipe.dt)
        own = np.arange(recipe.offset.get(name, 0.0), recipe.duration + 1e-9, step)
        values = truth.sensor(name, own - recipe.delay.get(name, 0.0))
        values = values + recipe.noise * SIGMA[name] * rng.standard_normal(len(own))
        channels[name] = Channel(name, own, values, UNIT[name], "made")
    return Flight("made", channels), truth


def aircraft(recipe: Recipe) -> Aircraft:
    """Datum at the center of gravity; sensors where the recipe has them."""
    sensors = {"imu": np.array(recipe.imu)}
    sensors |= {name: np.array(place) for name, place in recipe.places.items()}
    return Aircraft(
        "made", 10.0, 10.0, 1.0, np.zeros(3), None, sensors, (), {}, {}, Envelope(),
        "center of gravity", (), "", "",
    )  # fmt: skip


def spec(sensors: Sequence[str] = ALL, **more: object) -> ReconstructSpec:
    """The noise as it is; everything else by default."""
    return ReconstructSpec.model_validate(
        {
            "gravity": G,
            "imu": {n: {"sigma": float(s)} for n, s in zip(IMU, IMU_SIGMA, strict=True)},
            "sensors": {name: {"sigma": SIGMA[name]} for name in sensors},
            **more,
        }
    )


def solve(
    recipe: Recipe, flight: Flight | None = None, seed: int = 1, **more: object
) -> tuple[Reconstruction, Motion]:
    """Record (unless a flight is given) and reconstruct as one maneuver."""
    made, truth = record(recipe, seed)
    flight = flight or made
    maneuver = Maneuver("m", flight.id, "", 0.0, recipe.duration)
    result = reconstruct(
        {flight.id: flight}, [maneuver], aircraft(recipe), spec(recipe.sensors, **more)
    )
    return result, truth


def constants(result: Reconstruction) -> dict[str, tuple[float, float]]:
    """Value and standard error by name."""
    return {c.name: (c.value, c.se) for c in result.constants}


def replaced(flight: Flight, name: str, channel: Channel) -> Flight:
    """The flight with one channel changed or added."""
    return replace(flight, channels={**flight.channels, name: channel})
