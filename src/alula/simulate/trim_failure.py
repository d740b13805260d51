"""Why there is no trim: which force or moment stays, how much, which control is at its stop."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.simulate.airframe import Airframe
from alula.simulate.condition import Condition

if TYPE_CHECKING:
    from alula.simulate.trim_equations import Equations
    from alula.simulate.trim_solver import Solution

# The equation that each unknown is there for.
_FOR = {"thrust": "V", "dt": "V", "alpha": "alpha", "de": "q", "da": "p", "dr": "r"}
_WORDS = {
    "V": ("force along the flight path", "N"),
    "alpha": ("force across the flight path, in the plane of symmetry", "N"),
    "beta": ("side force", "N"),
    "p": ("rolling moment", "N m"),
    "q": ("pitching moment", "N m"),
    "r": ("yawing moment", "N m"),
}
Solve = Callable[["Equations", Array], "Solution"]


def failure(
    condition: Condition, airframe: Airframe, found: Solution, solve: Solve, tolerance: float
) -> BadInput:
    """The refusal of a condition that least squares could not meet.

    What least squares leaves is spread over all equations. So each unknown at its stop stays there,
    its own equation is given up, the others are solved again, and what is left of the one given up
    is the force or moment that is missing.
    """
    stops = at_stop(found)
    loads = _loads(airframe, found)
    pinned = found
    given_up = []
    for name in stops:
        row = _FOR.get(name.removesuffix("_command"))
        if row is None or row not in pinned.equations.rates:
            continue
        without = pinned.equations.pinned(name, row)
        again = solve(without, _at_limit(found, name, pinned.values))
        given_up.append(row)
        pinned = again
        if again.residual <= tolerance:
            left = _loads(airframe, again)
            loads = {row: left[row] for row in given_up}
            break
        stops = {**at_stop(again), **stops}
    if not loads or not np.isfinite(list(loads.values())).all():
        text = "no finite balance of forces"
    else:
        sizes = _sizes(airframe, condition)
        share = {row: abs(load) / sizes[row] for row, load in loads.items()}
        worst = sorted(share, key=lambda row: -share[row])
        # Only what is not small beside the largest is worth a word.
        worth = [row for row in worst[:2] if share[row] > 0.05 * share[worst[0]]]
        text = " and ".join(_missing(row, loads[row]) for row in worth)
    reached = ", ".join(_stop_words(n, v) for n, v in stops.items()) or "nothing is at its stop"
    return refuse(
        "no_trim",
        where=f"trim, {condition.words}",
        expected="a balance of forces and moments within the limits",
        found=f"{text} that cannot be balanced; at its stop: {reached}",
        do="Choose another airspeed, height or condition, or widen the limits.",
    )


def at_stop(found: Solution) -> dict[str, float]:
    """Unknowns at one of their limits, with the limit."""
    wanted = found.equations
    values = dict(zip(found.names, found.values.tolist(), strict=True))
    out = {}
    for name in wanted.free:
        if name.startswith(("X", "omega", "power")):
            continue  # attached flow or an engine at rest is no stop
        low, high = wanted.limits[name]
        near = 1e-4 * wanted.scale[name]
        for limit in (low, high):
            if abs(values[name] - limit) < near:
                out[name] = limit
    return out


def _at_limit(found: Solution, name: str, values: Array) -> Array:
    low, high = found.equations.limits[name]
    i = found.names.index(name)
    out = values.copy()
    out[i] = low if abs(values[i] - low) < abs(values[i] - high) else high
    return out


def _loads(airframe: Airframe, found: Solution) -> dict[str, float]:
    """What is left as forces (N) and moments (N m), by equation."""
    rate = dict(zip(found.names, found.rates.tolist(), strict=False))
    V = found.equations.V
    moment = airframe.inertia @ np.array([rate["p"], rate["q"], rate["r"]])
    return {
        "V": airframe.mass * rate["V"],
        "alpha": airframe.mass * V * rate["alpha"],
        "beta": airframe.mass * V * rate["beta"],
        "p": float(moment[0]),
        "q": float(moment[1]),
        "r": float(moment[2]),
    }


def _sizes(airframe: Airframe, condition: Condition) -> dict[str, float]:
    """Forces beside the weight, moments beside it times a radius of gyration."""
    weight = 9.80665 * airframe.mass
    radii = np.sqrt(np.diagonal(airframe.inertia) / airframe.mass)
    return {
        **dict.fromkeys(("V", "alpha", "beta"), weight),
        **dict(zip(("p", "q", "r"), (weight * radii).tolist(), strict=True)),
    }


def _missing(row: str, load: float) -> str:
    words, unit = _WORDS[row]
    way = {
        "V": ("forward", "backward: drag and weight exceed the thrust"),
        "alpha": ("down: lift is missing", "up: lift is too much"),
        "q": ("nose up", "nose down"),
        "p": ("right", "left"),
        "r": ("right", "left"),
        "beta": ("right", "left"),
    }[row][load < 0.0]
    return f"a {words} of {abs(load):.4g} {unit} ({way})"


def _stop_words(name: str, limit: float) -> str:
    plain = name.removesuffix("_command")
    if plain == "thrust":
        return f"thrust at {limit:.5g} N"
    if plain == "dt":
        return f"throttle at {limit:g}"
    if plain in ("alpha", "beta", "theta", "phi", "de", "da", "dr"):
        return f"{plain} at {limit:.4g} rad ({degrees(limit):.4g} deg)"
    return f"{plain} at {limit:.5g}"
