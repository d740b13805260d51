"""Which unknowns a trimmed flight has, and which equations they must satisfy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, inf, radians, sin, tan
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.simulate.airframe import Airframe
from alula.simulate.condition import GRAVITY, Condition
from alula.simulate.coordinates import (
    BODY_STATES,
    FLIGHT_STATES,
    Earth,
    flight_names,
    plant_state,
)
from alula.simulate.plant import further_states, plant_inputs, settled, wind_at

CONTROLS = ("de", "da", "dr", "df", "dt")
DRAWN = ("charge", "fuel_used")  # states that only count what was used: they do not rest
_DEGREES_20, _DEGREES_30, _DEGREES_85 = radians(20.0), radians(30.0), radians(85.0)


@dataclass(frozen=True)
class Equations:
    """Unknowns `free` with limits and scale by name, and equations.

    rates: flight states whose rate must have a value, by name. outputs: the same of outputs. climb:
    None where the climb angle is found. Rows come in that order, the climb angle's last.
    """

    free: tuple[str, ...]
    limits: Mapping[str, tuple[float, float]]
    scale: Mapping[str, float]
    rates: Mapping[str, float]
    outputs: Mapping[str, float]
    gamma: float | None
    V: float

    @property
    def rows(self) -> tuple[str, ...]:
        """Names of the equations."""
        return (*self.rates, *self.outputs, *(() if self.gamma is None else ("gamma",)))

    def pinned(self, name: str, row: str) -> Equations:
        """Without the unknown `name` and without the equation `row` that it was there for."""
        return replace(
            self,
            free=tuple(n for n in self.free if n != name),
            rates={k: v for k, v in self.rates.items() if k != row},
        )

    def residuals(
        self,
        names: Sequence[str],
        outputs: Sequence[str],
        values: Array,
        f0: Array,
        y: Array,
        J: Array,
        Jy: Array,
    ) -> tuple[Array, Array]:
        """What is left of each equation, in m/s2 and rad/s2, and its Jacobian by all values."""
        left, slope = [], []
        for name, value in self.rates.items():
            i = names.index(name)
            size = 1.0
            if name in ("alpha", "beta"):
                size = self.V  # so that they are accelerations
            elif i >= FLIGHT_STATES:
                size = 1.0 / self.scale[name]
            left.append(size * (f0[i] - value))
            slope.append(size * J[i])
        for name, value in self.outputs.items():
            i = outputs.index(name)
            left.append(y[i] - value)
            slope.append(Jy[i])
        if self.gamma is not None:
            sine, row = _climb(names, values)
            left.append(GRAVITY * (sine - sin(self.gamma)))
            slope.append(GRAVITY * row)
        return np.array(left), np.array(slope)

    @staticmethod
    def climb(names: Sequence[str], values: Array) -> float:
        """Climb angle against the air, rad."""
        return float(np.arcsin(np.clip(_climb(names, values)[0], -1.0, 1.0)))


def rest(
    plant: Any,
    condition: Condition,
    airframe: Airframe,
    held: Mapping[str, float],
    earth: Earth,
    alpha: float = 0.05,
    power: float = 0.5,
) -> tuple[dict[str, float], Array]:
    """All flight states and inputs by name, in order, at a guess; the wind there, NED.

    power: throttle, or given thrust over twice the mass, m/s2.

    An input that shares its name with an actuator's position is called '<name>_command'.
    """
    further = further_states(plant)
    values = dict.fromkeys(flight_names(earth, further), 0.0)
    g, V = GRAVITY, condition.V
    bank, gamma = condition.bank_guess, condition.gamma
    theta = gamma + alpha * cos(bank)
    turn = g * tan(bank) / (V * cos(gamma)) if condition.kind == "turn" else 0.0
    pull = (condition.load_factor_guess - cos(gamma)) * g / V if condition.kind == "pull_up" else 0
    values.update(
        V=V, alpha=alpha, phi=bank, theta=theta, psi=condition.psi, h=condition.h,
        p=-turn * sin(theta), q=turn * sin(bank) + pull, r=turn * cos(bank),
    )  # fmt: skip
    first, second = ("lat", "lon") if earth == "wgs84" else ("north", "east")
    values[first], values[second] = condition.place
    control = power_input(airframe)
    for name in plant_inputs(plant):
        key = f"{name}_command" if name in values else name
        values[key] = held.get(name, 0.0)
        if name == control and name not in held:
            guess = power if name == "dt" else 2.0 * power * airframe.mass
            values[key] = condition.power if condition.kind == "glide" else guess
        if key != name:
            values[name] = values[key]
    for name in held:
        if name not in (*CONTROLS, "thrust"):
            raise refuse(
                "unknown_control",
                where="trim, controls held",
                expected=f"one of {', '.join((*CONTROLS, 'thrust'))}",
                found=f"'{name}'",
                do="Use Alula's names of the controls.",
            )
    n = len(flight_names(earth, further))
    start = np.array(list(values.values()))
    wind = wind_at(plant, plant_state(start[:n], np.zeros(3), earth), start[n:], earth)
    x = plant_state(start[:n], wind, earth)
    for name, value in zip(further, settled(plant, x, start[n:])[BODY_STATES:], strict=True):
        values[name] = float(value)
    return values, wind


def power_input(airframe: Airframe) -> str:
    """'dt' where an engine answers a throttle, 'thrust' where thrust is given."""
    kinds = {engine.kind for engine in airframe.engines}
    return "dt" if kinds - {"given"} else "thrust"


def equations(
    condition: Condition,
    airframe: Airframe,
    further: Sequence[str],
    inputs: Sequence[str],
    limits: Mapping[str, tuple[float, float]],
    held: Mapping[str, float],
    useful: set[str],
) -> Equations:
    """Unknowns and equations of a condition. useful: inputs that move anything."""
    power = power_input(airframe)
    turning, gliding = condition.kind == "turn", condition.kind == "glide"
    rates = dict.fromkeys(("V", "alpha", "beta", "p", "q", "r", "phi", "theta", "psi"), 0.0)
    outputs: dict[str, float] = {}
    unknowns = ["alpha", "beta", "theta", "p", "q", "r"]
    controls: list[str] = [n for n in ("de", "da", "dr") if n in useful and n not in held]
    rudder = "dr" in controls
    if turning:
        if condition.turn_rate is not None:
            rates["psi"] = condition.turn_rate
        else:
            del rates["psi"]
        if condition.load_factor is not None:
            outputs["az"] = -condition.load_factor_guess * GRAVITY
        if condition.bank is None:
            unknowns.append("phi")
        if rudder:
            outputs["ay"] = 0.0
    elif condition.kind == "pull_up":
        del rates["theta"]
        outputs["az"] = -condition.load_factor_guess * GRAVITY
    elif not rudder:
        unknowns.append("phi")
    if not gliding and power not in held:
        controls.append(power)
    for name in further:
        if name not in DRAWN:
            unknowns.append(name)
            rates[name] = 0.0
    free = (*unknowns, *(f"{n}_command" if n in further else n for n in controls))
    own = {
        "alpha": (-_DEGREES_20, _DEGREES_20),
        "beta": (-_DEGREES_20, _DEGREES_20),
        "theta": (-_DEGREES_85, _DEGREES_85),
        "phi": (-_DEGREES_85, _DEGREES_85),
        **dict.fromkeys(("de", "da", "dr"), (-_DEGREES_30, _DEGREES_30)),
        "thrust": (0.0, 10.0 * airframe.mass),
        "dt": (0.0, 1.0),
    }
    ranges = {**own, **{n: (float(a), float(b)) for n, (a, b) in limits.items()}}
    scale = {"thrust": airframe.mass, "dt": 1.0}
    for name in further:
        ranges.setdefault(name, _further_limits(name))
        scale[name] = _further_scale(name)
    for name in free:
        plain = name.removesuffix("_command")
        ranges.setdefault(name, ranges.get(plain, (-inf, inf)))
        scale.setdefault(name, scale.get(plain, 0.1))
    return Equations(
        free, ranges, scale, rates, outputs, None if gliding else condition.gamma, condition.V
    )


def _climb(names: Sequence[str], values: Array) -> tuple[float, Array]:
    """Sine of the climb angle against the air, and its derivatives by all values."""
    i, j, k, m = (names.index(n) for n in ("alpha", "beta", "phi", "theta"))
    (sa, sb, sp, st), (ca, cb, cp, ct) = (f(values[[i, j, k, m]]) for f in (np.sin, np.cos))
    row = np.zeros(len(values))
    row[i] = -sa * cb * st - ca * cb * cp * ct
    row[j] = -ca * sb * st - (cb * sp - sa * sb * cp) * ct
    row[k] = -(sb * cp - sa * cb * sp) * ct
    row[m] = ca * cb * ct + (sb * sp + sa * cb * cp) * st
    return float(ca * cb * st - (sb * sp + sa * cb * cp) * ct), row


def _further_limits(name: str) -> tuple[float, float]:
    if name.startswith(("X", "stall")):
        return 0.0, 1.0
    return (0.0, inf) if name.startswith(("rotor", "omega", "power", "engine")) else (-inf, inf)


def _further_scale(name: str) -> float:
    return 100.0 if name.startswith(("rotor", "omega")) else 1.0
