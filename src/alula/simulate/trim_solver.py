"""Solves the equations of a trimmed flight: bounded least squares, then Newton steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from alula.base.arrays import Array
from alula.simulate.airframe import Airframe
from alula.simulate.condition import Condition
from alula.simulate.coordinates import Earth, plant_state
from alula.simulate.linearize import flight_matrices
from alula.simulate.plant import further_states, plant_inputs, plant_matrices, plant_outputs
from alula.simulate.trim_equations import Equations, equations, rest

TOLERANCE = 1e-8  # m/s2 and rad/s2: far below any sensor


@dataclass(frozen=True)
class Solution:
    """Where the solver ended: all states and inputs, rates of the states, outputs, what is left.

    left: (k,) residuals of `equations`, scaled: m/s2, rad/s2.
    """

    equations: Equations
    names: tuple[str, ...]
    values: Array
    rates: Array
    outputs: Array
    gamma: float
    left: Array

    @property
    def residual(self) -> float:
        """The largest of what is left; NaN counts as infinite."""
        worst = float(np.max(np.abs(self.left), initial=0.0))
        return worst if np.isfinite(worst) else float("inf")


class Problem:
    """The equations of one condition on one plant: values are flight states, then inputs."""

    def __init__(
        self,
        plant: Any,
        condition: Condition,
        airframe: Airframe,
        limits: Mapping[str, tuple[float, float]],
        held: Mapping[str, float],
        earth: Earth,
    ) -> None:
        self.plant, self.condition, self.earth = plant, condition, earth
        self._guess = partial(rest, plant, condition, airframe, held, earth)
        first, self.wind = self._guess()
        self.names = tuple(first)
        self.n = len(self.names) - len(plant_inputs(plant))
        start = np.array(list(first.values()))
        effect = self._linear(start)[2][:, self.n :]
        useful = {
            name
            for name, column in zip(plant_inputs(plant), effect.T, strict=True)
            if np.max(np.abs(column[:9])) > 1e-9  # any rate of the motion, per rad, 1 or N
            or name in further_states(plant)
        }
        self.equations = equations(
            condition, airframe, further_states(plant), plant_inputs(plant), limits, held, useful
        )

    def input_name(self, name: str) -> str:
        """The key of an input, which may share its name with an actuator's position."""
        return name if f"{name}_command" not in self.names else f"{name}_command"

    def _linear(self, values: Array) -> tuple[Array, Array, Array, Array]:
        """Rates, outputs, and their Jacobians by all values."""
        x, u = values[: self.n], values[self.n :]
        found = plant_matrices(self.plant, plant_state(x, self.wind, self.earth), u)
        A, B, f0, T = flight_matrices(found, x, self.wind, self.earth)
        return f0, found.y, np.hstack([A, B]), np.hstack([found.C @ T, found.D])

    def solve(self, wanted: Equations | None = None, start: Array | None = None) -> Solution:
        """Bounded least squares from several guesses, until one fits."""
        wanted = wanted or self.equations
        # A motor that would brake gives no thrust to climb on: more power, then.
        guesses = [(0.05, 0.5), (0.05, 0.9), (0.0, 0.5), (0.15, 0.5), (-0.05, 0.9)]
        best: Solution | None = None
        for alpha, power in guesses[: 1 if start is not None else None]:
            guess = start
            if guess is None:
                guess = np.array(list(self._guess(alpha, power)[0].values()))
            found = self._from(wanted, guess)
            if best is None or found.residual < best.residual:
                best = found
            if best.residual <= TOLERANCE:
                break
        assert best is not None
        return best

    def _from(self, wanted: Equations, start: Array) -> Solution:
        where = [self.names.index(n) for n in wanted.free]
        scale = np.array([wanted.scale[n] for n in wanted.free])
        limits = [wanted.limits[n] for n in wanted.free]
        low, high = (np.array(b) / scale for b in zip(*limits, strict=True))
        outputs = plant_outputs(self.plant)

        def full(z: Array) -> Array:
            values = start.copy()
            values[where] = z * scale
            return values

        def at(z: Array) -> tuple[Array, Array]:
            values = full(z)
            f0, y, J, Jy = self._linear(values)
            left, slope = wanted.residuals(self.names, outputs, values, f0, y, J, Jy)
            return left, slope[:, where] * scale

        def left_at(z: Array) -> Array:
            return at(z)[0]

        def slope_at(z: Array) -> Array:
            return at(z)[1]

        z = np.clip(start[where] / scale, low, high)
        z = _newton(at, z, low, high, 10)
        if np.max(np.abs(at(z)[0])) > TOLERANCE:
            inside = 1e-6 * np.minimum(1.0, high - low)
            z = np.clip(start[where] / scale, low + inside, high - inside)
            z = least_squares(
                left_at, z, jac=slope_at, bounds=(low, high),
                xtol=1e-12, ftol=1e-12, gtol=1e-12, max_nfev=60,
            ).x  # fmt: skip
            z = _newton(at, np.clip(z, low, high), low, high, 4)
        values = full(z)
        values[np.abs(values) < 1e-13] = 0.0  # rounding: symmetric flight stays symmetric
        f0, y, J, Jy = self._linear(values)
        left, _ = wanted.residuals(self.names, outputs, values, f0, y, J, Jy)
        return Solution(wanted, self.names, values, f0, y, wanted.climb(self.names, values), left)


def _newton(
    at: Callable[[Array], tuple[Array, Array]], z: Array, low: Array, high: Array, steps: int
) -> Array:
    """Newton steps as far as the limits let them, while they lower the largest residual."""
    left, slope = at(z)
    for _ in range(steps):
        size = np.max(np.abs(left))
        if size <= 1e-2 * TOLERANCE or not np.isfinite(size):
            break
        following = np.clip(z + np.linalg.lstsq(slope, -left, rcond=None)[0], low, high)
        left, slope = at(following)
        if not np.max(np.abs(left)) < size:
            break
        z = following
    return z
