"""Many flights of one aircraft: a Monte Carlo, a grid of starts, winds or inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypeVar

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn
from alula.flight import Maneuver
from alula.model import AeroModel
from alula.simulate.airframe import GRAVITY, Airframe, core_model, set_wind
from alula.simulate.flight_check import check_step
from alula.simulate.fly import (
    SimulatedFlight,
    as_flight,
    control_rows,
    divergence,
    even_times,
    full_start,
    gust_rows,
)
from alula.simulate.pilot import Pilot
from alula.simulate.wind import Turbulence, Wind, as_wind

T = TypeVar("T")


def fly_many(
    airframe: Airframe,
    model: AeroModel,
    x0: Array,
    t: Array,
    controls: Mapping[str, Array | float],
    *,
    wind: Array | Wind | Sequence[Array | Wind] | None = None,
    gravity: float = GRAVITY,
    substeps: int = 1,
    maneuvers: Sequence[Maneuver] | None = None,
    hold: bool = False,
    gusts: Array | None = None,
    turbulence: Turbulence | Sequence[Turbulence | None] | None = None,
    pilot: Pilot | Sequence[Pilot | None] | None = None,
    stall: bool = True,
    check: bool = False,
    diverged: Literal["refuse", "cut"] = "refuse",
) -> tuple[SimulatedFlight, ...]:
    """Fly k flights of one aircraft over times t (n,); each is what `fly` gives, to rounding.

    x0: (k, 13) or (k, all states), one start for each. controls: as for `fly`, one number, (n,)
    for all flights, or (k, n) for each. wind: one for all, or k of them ((k, 3) m/s, or a sequence
    of winds). gusts: (n, 6) or (k, n, 6). turbulence, pilot: one for all (the same seed for all),
    or k of them. maneuvers: k of them. Other arguments: see `fly`.

    On one thread, four flights (two on processors without AVX2) go side by side in one register,
    which takes about a third of the time of `fly` for each, from two flights of some hundred steps
    on. A lookup table is read for one flight after the other, which takes some of the gain.
    Flights with turbulence or a pilot, and winds of which only some have the logarithmic profile,
    are flown one after the other: no faster than `fly`. The numbers of a flight do not depend on
    the others.

    diverged: a flight whose state stops being finite is refused with its number, or 'cut' there,
    with a warning in its messages. Raises BadInput as `fly` does.
    """
    t, dt = even_times(t)
    n = len(t)
    x0 = np.asarray(x0, dtype=np.float64)
    if x0.ndim != 2 or len(x0) == 0:
        raise _shape("initial_state", "initial states", "one row for each flight", x0.shape)
    k = len(x0)
    inputs = _each_control(controls, k, n)
    winds = _each_wind(wind, k)
    each_gusts = None if gusts is None else _each_gust(gusts, k, n)
    names: list[Maneuver | None] = _each("maneuvers", maneuvers, k)
    stirred = _each("turbulence", turbulence, k)
    piloted = _each("pilot", pilot, k)

    plant = core_model(airframe, model, None, gravity, stall=stall)
    starts, messages = np.empty((k, plant.state_count)), []
    for i in range(k):
        set_wind(plant, winds[i])
        u = inputs[i % len(inputs), 0]
        starts[i] = full_start(plant, x0[i], u)
        messages.append(check_step(plant.jacobian(starts[i], u)[0], dt / substeps) if check else ())

    states = np.empty((k, n, plant.state_count))
    outputs = np.empty((k, n, plant.output_count))
    flown_inputs = np.empty((k, n, plant.input_count))
    flown = np.empty(k, dtype=np.int32)
    alone = any(stirred) or any(piloted) or len({w.logarithmic for w in winds}) > 1
    if alone:
        for i in range(k):
            set_wind(plant, winds[i])
            extra: dict[str, Any] = {}
            if each_gusts is not None:
                extra["gusts"] = each_gusts[i % len(each_gusts)]
            if (air := stirred[i]) is not None:
                extra |= air.arguments(model.reference.b, (n - 1) * substeps + 1)
            if (steering := piloted[i]) is not None:
                extra |= steering.arguments(n)
            flown[i] = plant.fly(
                starts[i], inputs[i % len(inputs)], dt, substeps, states[i], outputs[i],
                flown_inputs[i], hold, **extra,
            )  # fmt: skip
    else:
        plant.fly_many(
            starts, inputs, _wind_rows(winds), winds[0].logarithmic, dt, substeps, states, outputs,
            flown_inputs, flown, hold, each_gusts,
        )  # fmt: skip

    flights = []
    for i in range(k):
        said: tuple[Message, ...] = messages[i]
        m = int(flown[i])
        if m < n:
            where = f"simulation, flight {i}"
            if diverged == "refuse" or m == 0:
                raise refuse("diverged", **divergence(where, float(t[m])))
            said = (*said, warn("diverged", **divergence(where, float(t[m]))))
        maneuver = names[i] or Maneuver(
            f"flight_{i}", "simulation", "simulated", float(t[0]), float(t[-1])
        )
        flights.append(
            as_flight(
                airframe,
                model,
                maneuver,
                t[:m],
                plant.further_states,
                states[i, :m],
                outputs[i, :m],
                flown_inputs[i, :m],
                said,
            )
        )
    return tuple(flights)


def _each_control(controls: Mapping[str, Array | float], k: int, n: int) -> Array:
    """Rows (k, n, 6), or (1, n, 6) where all flights have the same."""
    several = {
        name: np.asarray(values, dtype=np.float64)
        for name, values in controls.items()
        if np.ndim(values) == 2
    }
    for name, values in several.items():
        if values.shape != (k, n):
            raise _shape(
                "bad_control", f"control {name}", f"({k}, {n}), ({n},) or ()", values.shape
            )
    common = {name: values for name, values in controls.items() if name not in several}
    return np.stack(
        [
            control_rows({**common, **{name: values[i] for name, values in several.items()}}, n)
            for i in range(k if several else 1)
        ]
    )


def _each_wind(wind: Array | Wind | Sequence[Array | Wind] | None, k: int) -> list[Wind]:
    one = wind is None or isinstance(wind, Wind)
    if not one and not any(isinstance(w, Wind) for w in wind):  # type: ignore[union-attr]
        one = np.ndim(wind) == 1  # type: ignore[arg-type]
    winds = [as_wind(wind)] * k if one else [as_wind(w) for w in wind]  # type: ignore
    if len(winds) != k or any(np.shape(w.steady) != (3,) for w in winds):
        raise _shape("bad_wind", "wind", f"one wind or {k}, each (3,) or a Wind", (len(winds),))
    return winds


def _wind_rows(winds: list[Wind]) -> Array:
    """(k, 9): steady, shear, reference height, roughness, ground."""
    rows = [[*w.steady, *w.shear, w.reference_height, w.roughness, w.ground] for w in winds]
    return np.array(rows, dtype=np.float64)


def _each_gust(gusts: Array, k: int, n: int) -> Array:
    """(k, n, 6), or (1, n, 6) where all flights have the same."""
    if np.ndim(gusts) == 3 and len(gusts) != k:
        raise _shape("bad_gust", "gusts", f"({n}, 6) or ({k}, {n}, 6)", np.shape(gusts))
    return np.stack([gust_rows(g, n) for g in (gusts if np.ndim(gusts) == 3 else [gusts])])


def _each(name: str, given: T | Sequence[T | None] | None, k: int) -> list[T | None]:
    if not isinstance(given, Sequence):
        return [given] * k
    if len(given) != k:
        raise _shape(f"bad_{name}", name, f"one or {k}", (len(given),))
    return list(given)


def _shape(code: str, where: str, expected: str, found: tuple[int, ...]) -> Exception:
    return refuse(
        code,
        where=f"simulation of several flights, {where}",
        expected=expected,
        found=f"shape {found}",
        do="Give one for all flights or one for each.",
    )
