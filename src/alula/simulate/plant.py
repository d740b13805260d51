"""The core's AircraftModel as trim and linearization see it: rates, outputs and their Jacobians."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.simulate.coordinates import Earth, wind_from

INPUTS = (
    "de", "da", "dr", "df", "dt", "thrust", "ug", "vg", "wg", "pg", "qg", "rg",
)  # fmt: skip
OUTPUTS = (
    "ax", "ay", "az", "pdot", "qdot", "rdot", "V", "alpha", "beta", "mach", "rho",
    "C_0", "C_1", "C_2", "Cl", "Cm", "Cn",
    "FX_engine", "FY_engine", "FZ_engine", "MX_engine", "MY_engine", "MZ_engine",
    "thrust",
)  # fmt: skip


@dataclass(frozen=True)
class PlantMatrices:
    """At one point: rates f (n,), outputs y (k,), and A (n, n), B (n, m), C (k, n), D (k, m)."""

    f: Array
    y: Array
    A: Array
    B: Array
    C: Array
    D: Array


def further_states(plant: Any) -> tuple[str, ...]:
    """Names of the plant's states behind position, attitude, velocity and rates."""
    return tuple(plant.further_states)


def plant_inputs(plant: Any) -> tuple[str, ...]:
    """Names of the plant's inputs, in its order: rad, throttle 0 to 1, N, m/s, rad/s."""
    return INPUTS[: plant.input_count]


def plant_outputs(plant: Any) -> tuple[str, ...]:
    """Names of the plant's outputs: m/s2, rad/s2, m/s, rad, kg/m3, N, N m; C_0 to C_2 are CX CY CZ
    or, in stability axes, CD CY CL.
    """
    return OUTPUTS[: plant.output_count]


def plant_rates(plant: Any, x: Array, u: Array) -> tuple[Array, Array]:
    """Rates f (n,) and outputs y (k,) at state x (n,) and input u (m,)."""
    f, y = np.empty(len(x)), np.empty(len(plant_outputs(plant)))
    plant.rates(np.ascontiguousarray(x), np.ascontiguousarray(u), f, y)
    return f, y


def wind_at(plant: Any, x: Array, u: Array, earth: Earth) -> Array:
    """The plant's wind (3,) m/s, NED, at a state: velocity against the Earth less that in the air.

    Gusts are inputs and no part of it.
    """
    still = np.array(u, dtype=np.float64)
    still[6:] = 0.0
    V, alpha, beta = plant_rates(plant, x, still)[1][6:9]
    air = V * np.array([np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)])
    wind = wind_from(x, air, earth)
    # What rounding leaves of no wind is no wind.
    return np.asarray(np.where(np.abs(wind) < 1e-12 * max(V, 1.0), 0.0, wind))


def settled(plant: Any, x: Array, u: Array) -> Array:
    """The state (n,) with the further states as they come to rest in this motion."""
    out = np.array(x, dtype=np.float64)
    if further_states(plant):
        plant.settle(np.ascontiguousarray(x), np.ascontiguousarray(u), out)
    return out


def plant_matrices(plant: Any, x: Array, u: Array) -> PlantMatrices:
    """Rates, outputs, exact Jacobians at state x (n,) and input u (m,), in the plant's states."""
    f, y = plant_rates(plant, x, u)
    A, B, C, D = plant.jacobian(np.ascontiguousarray(x), np.ascontiguousarray(u))
    return PlantMatrices(f, y, A, B, C, D)
