"""Linear equations of motion about any point of flight, steady or not.

dx/dt = f0 + A (x - x0) + B (u - u0), y = y0 + C (x - x0) + D (u - u0) (Dittrich 2016, Eq. 2.70 to
2.77). The plant gives the matrices in its own states; here they are turned, exactly, into V, alpha,
beta and Euler angles: with the map x_plant = g(x) and T = dg/dx, T dx/dt = f(g(x), u) holds at
every x, so that A = T^+ (A_plant T - dT/dx f0), B = T^+ B_plant, C = C_plant T. The term dT/dx f0
is zero in steady straight flight and the rest of the answer elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.simulate.coordinates import (
    BODY_STATES,
    Earth,
    flight_names,
    flight_state,
    plant_state,
    tangent,
)
from alula.simulate.plant import (
    PlantMatrices,
    further_states,
    plant_inputs,
    plant_matrices,
    plant_outputs,
    wind_at,
)

# Dittrich 2016, Eq. (2.78), and its counterpart for Eq. (2.68); h and psi may be added.
LONGITUDINAL = ("V", "alpha", "q", "theta")
LATERAL = ("beta", "p", "r", "phi")
# Where the aircraft is and where it heads changes nothing of its motion.
NAVIGATION = ("psi", "north", "east", "lat", "lon")
_STEADY = 1e-6  # m/s2, rad/s2, rad/s: below it the point is a steady flight


@dataclass(frozen=True)
class LinearModel:
    """Matrices between named states (n), inputs (m) and outputs (k); SI, rad.

    A (n, n), B (n, m), C (k, n), D (k, m).
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    A: Array
    B: Array
    C: Array
    D: Array

    def part(
        self,
        states: Sequence[str] | None = None,
        inputs: Sequence[str] | None = None,
        outputs: Sequence[str] | None = None,
    ) -> LinearModel:
        """The rows and columns of these names, in this order; None: all there are.

        Couplings to states that are left out are dropped. Raises BadInput for an unknown name.
        """
        x = _places("state", self.states, states)
        u = _places("input", self.inputs, inputs)
        y = _places("output", self.outputs, outputs)
        return LinearModel(
            tuple(self.states[i] for i in x),
            tuple(self.inputs[i] for i in u),
            tuple(self.outputs[i] for i in y),
            frozen(self.A[np.ix_(x, x)]),
            frozen(self.B[np.ix_(x, u)]),
            frozen(self.C[np.ix_(y, x)]),
            frozen(self.D[np.ix_(y, u)]),
        )


@dataclass(frozen=True)
class Linearization(LinearModel):
    """The full linear model and its point: x0 (n,), u0 (m,), rates f0 (n,), outputs y0 (k,).

    earth: the last three body states are north east h on a flat Earth, lat lon h (rad, m) on
    WGS-84.
    """

    x0: Array
    u0: Array
    f0: Array
    y0: Array
    earth: Earth

    @property
    def point(self) -> dict[str, float]:
        """States and inputs of the point by name; an input may share its name with a state."""
        inputs = {f"{n}_command" if n in self.states else n: n for n in self.inputs}
        return {
            **dict(zip(self.states, self.x0.tolist(), strict=True)),
            **dict(zip(inputs, self.u0.tolist(), strict=True)),
        }

    @property
    def unsteady(self) -> dict[str, float]:
        """Rates of the states that matter and do not rest, by name: empty in steady flight."""
        resting = (*NAVIGATION, "h", "charge", "fuel_used")
        return {
            name: float(rate)
            for name, rate in zip(self.states, self.f0, strict=True)
            if name not in resting and abs(rate) > _STEADY
        }

    def longitudinal(self, *more: str) -> LinearModel:
        """V, alpha, q, theta (Dittrich 2016, Eq. 2.78) and `more`, such as 'h'."""
        wanted = [n for n in ("de", "dt", "thrust") if n in self.inputs]
        return self.part((*LONGITUDINAL, *more), wanted)

    def lateral(self, *more: str) -> LinearModel:
        """beta, p, r, phi and `more`, such as 'psi'."""
        return self.part((*LATERAL, *more), ("da", "dr"))

    def motion(self) -> LinearModel:
        """All states but heading and horizontal place, on which nothing depends on a flat Earth."""
        return self.part([n for n in self.states if n not in NAVIGATION])


def linearize(
    plant: Any,
    x: Array,
    u: Array | Mapping[str, float],
    *,
    earth: Earth = "flat",
) -> Linearization:
    """Linearize the core's AircraftModel at its state x (13 + k,) under inputs u.

    u: (m,) in the plant's order, or by name (absent ones are zero). earth: the plant's. Raises
    BadInput without airspeed, with the nose straight up or down, or where a number is not finite.
    """
    names = plant_inputs(plant)
    inputs = _by_name(u, names) if isinstance(u, Mapping) else np.asarray(u, dtype=np.float64)
    state = np.asarray(x, dtype=np.float64)
    air = wind_at(plant, state, inputs, earth)
    x0 = flight_state(state, air, earth)
    found = plant_matrices(plant, plant_state(x0, air, earth), inputs)
    if not all(np.isfinite(part).all() for part in (found.f, found.A, found.B, found.C, found.D)):
        raise refuse(
            "not_finite",
            where="linearization",
            expected="finite derivatives",
            found="a state, an input or a derivative that is not finite",
            do="Choose a point inside the model's range.",
        )
    A, B, f0, T = flight_matrices(found, x0, air, earth)
    return Linearization(
        states=flight_names(earth, further_states(plant)),
        inputs=names,
        outputs=plant_outputs(plant),
        A=frozen(A),
        B=frozen(B),
        C=frozen(found.C @ T),
        D=frozen(found.D),
        x0=frozen(x0),
        u0=frozen(inputs),
        f0=frozen(f0),
        y0=frozen(found.y),
        earth=earth,
    )


def flight_matrices(
    found: PlantMatrices, x0: Array, wind: Array, earth: Earth
) -> tuple[Array, Array, Array, Array]:
    """A, B and rates f0 in flight states, and T, from the plant's matrices at x0 (12 + k,)."""
    T = tangent(x0, wind, earth)
    # T is block triangular: place from its own rows, in which positions of millions of meters may
    # stand; then motion from the next ten; what follows is the same in both.
    place = np.linalg.inv(T[:3, 9:12])
    motion, drift = T[3:BODY_STATES, :9], T[3:BODY_STATES, 9:12]
    back = np.linalg.inv(motion.T @ motion) @ motion.T

    def solve(right: Array) -> Array:
        out = np.concatenate([right[3:12], right[:3], right[BODY_STATES:]])
        out[9:12] = place @ right[:3]
        rest = right[3:BODY_STATES] - drift @ out[9:12]
        out[:9] = back @ rest
        out[:9] += back @ (rest - motion @ out[:9])  # what the normal equations lost
        return out

    f0 = solve(found.f)
    step = 1e-30  # complex: no difference is taken, so that nothing is lost
    bend = np.imag(tangent(x0 + 1j * step * f0, wind, earth)) / step
    n = T.shape[1]
    both = solve(np.hstack([found.A @ T - bend, found.B]))
    return both[:, :n], both[:, n:], f0, T


def _by_name(values: Mapping[str, float], names: tuple[str, ...]) -> Array:
    out = np.zeros(len(names))
    for place, name in zip(_places("input", names, list(values)), values, strict=True):
        out[place] = values[name]
    return out


def _places(kind: str, have: tuple[str, ...], wanted: Sequence[str] | None) -> list[int]:
    if wanted is None:
        return list(range(len(have)))
    for name in wanted:
        if name not in have:
            raise refuse(
                f"unknown_{kind}",
                where="linear model",
                expected=f"one of {', '.join(have)}",
                found=f"'{name}'",
                do=f"Name {kind}s as the linear model does.",
            )
    return [have.index(name) for name in wanted]
