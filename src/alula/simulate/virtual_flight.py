"""One maneuver of a virtual flight test: trimmed, and flown by whoever has the controls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, warn
from alula.model import AeroModel
from alula.simulate.airframe import Airframe, core_model
from alula.simulate.fly import SimulatedFlight, fly
from alula.simulate.pilot_law import Law, floating, holding
from alula.simulate.trim import Trim, trim_level
from alula.simulate.virtual_loading import Loading
from alula.simulate.virtual_maneuvers import Condition, VirtualManeuver
from alula.simulate.virtual_plan import Plan
from alula.simulate.virtual_sensing import generator
from alula.simulate.wind import CosineGust, Turbulence

_ROUNDING = 1e-6  # rad; a trim at its stop is there to rounding


@dataclass(frozen=True)
class Flown:
    """What came of one maneuver. readings: by channel, SI, NaN where a sensor has no sample."""

    plan: VirtualManeuver
    flight: SimulatedFlight
    trim: Trim
    readings: Mapping[str, Array]


def airframe(plan: Plan, loading: Loading) -> Airframe:
    """The airframe of a loading with the engines and actuators that the plan asks for."""
    return loading.airframe(plan.engines, plan.actuators)


def trimmed(plan: Plan, loading: Loading, model: AeroModel, condition: Condition) -> Trim:
    """The steady flight of a condition, within the control limits of the aircraft file.

    Raises BadInput where there is none.
    """
    return trim_level(
        airframe(plan, loading),
        model,
        condition.V,
        condition.h,
        gamma=condition.gamma,
        psi=condition.psi,
        controls={"df": condition.df},
        limits={k: v for k, v in loading.aircraft.control_limits.items() if k != "df"},
        wind=np.array(plan.wind),
    )


def fly_maneuver(
    plan: Plan,
    asked: VirtualManeuver,
    loading: Loading,
    model: AeroModel,
    trim: Trim,
    seed: int = 0,
) -> SimulatedFlight:
    """The true motion of one maneuver from its trim; nothing in it is random but turbulence.

    Deflections stop at the control limits of the aircraft file, with a warning. Raises BadInput
    where it diverges.
    """
    t = times(plan, asked)
    frame, wind, V = airframe(plan, loading), np.array(plan.wind), asked.condition.V
    controls: dict[str, Array | float] = {**trim.controls, "thrust": trim.thrust}
    limits = dict(loading.aircraft.control_limits)
    said: list[Message] = []
    for name, signal in asked.signals.items():
        low, high = limits.get(name, (-np.inf, np.inf))
        wanted = trim.controls[name] + signal.value(t)
        controls[name] = np.clip(wanted, low, high)
        if np.max(np.abs(wanted - controls[name])) > _ROUNDING:
            said.append(_at_stop(asked.maneuver.id, name, (low, high), wanted))
    same: dict[str, Any] = {
        "wind": wind,
        "substeps": max(1, int(np.ceil(1.0 / (plan.rate * plan.step) - 1e-9))),
        "maneuver": asked.maneuver,
    }
    hands = _hands(plan, asked, frame, model, trim)
    air = _air(plan, asked, t, V)
    if plan.turbulence is not None:
        spec = plan.turbulence
        eddies = Turbulence(
            spec.wind_20ft,
            spec.sigma,
            int(generator(seed, f"{asked.maneuver.id}/air").integers(2**31)),
        )
        # Flown once for the air alone, so that pilots may change hands in the same turbulence.
        holding_on = hands[0][2] if hands else None
        still: dict[str, Array | float] = {**trim.controls, "thrust": trim.thrust}
        air = fly(
            frame, model, trim.state, t, still, gusts=air, turbulence=eddies,
            pilot=None if holding_on is None else holding_on.pilot(limits), **same,
        ).inputs[:, 6:]  # fmt: skip
    parts, state = [], trim.state
    for begin, end, law in hands or [(0, len(t) - 1, None)]:
        cut = slice(begin, end + 1)
        now = {
            k: v[cut] if isinstance(v, np.ndarray) and v.ndim else v for k, v in controls.items()
        }
        part = fly(
            frame, model, state, t[cut], now, gusts=None if air is None else air[cut],
            pilot=None if law is None else law.pilot(limits), **same,
        )  # fmt: skip
        parts.append(part)
        state = part.plant_states[-1]
    flight = joined(parts)
    return replace(flight, messages=(*said, *flight.messages))


def _at_stop(id: str, control: str, limits: tuple[float, float], wanted: Array) -> Message:
    scale, unit = (1.0, "") if control == "dt" else (np.degrees(1.0), " deg")
    low, high = (scale * x for x in limits)
    return warn(
        "input_at_stop",
        where=f"maneuver {id}, {control}",
        expected=f"{low:.4g} to {high:.4g}{unit}, the aircraft file's limits",
        found=f"{scale * wanted.min():.4g} to {scale * wanted.max():.4g}{unit} asked for",
        do="It is flown against the stop. Take a smaller amplitude, or correct the limits.",
    )


def _hands(
    plan: Plan, asked: VirtualManeuver, frame: Airframe, model: AeroModel, trim: Trim
) -> list[tuple[int, int, Law | None]]:
    """Who steers from which sample to which: the holding pilot, nobody, who keeps an axis, or the
    floating surfaces. Empty where nobody has anything to do.
    """
    calm = plan.gust is None and plan.turbulence is None
    keeps = list(plan.pilot.keeps)
    holds = plan.pilot.hold and not calm  # in calm air a trimmed aircraft stays
    if not (holds or keeps or asked.free):
        return []
    plant, V = core_model(frame, model, np.array(plan.wind)), asked.condition.V
    law = holding(plant, trim, V)
    n = round(asked.maneuver.end * plan.rate)
    first = min(max(round(asked.first * plan.rate), 0), n)
    last = min(max(int(np.ceil(asked.last * plan.rate)), first), n)
    free = None
    if asked.free:
        ratios = {str(name): (f.alpha, f.rate) for name, f in plan.floats.items()}
        free = floating(plant, trim, V, ratios)
    after = law.of(keeps) if keeps else None
    phases = [(0, first, law if holds else None), (first, last, after), (last, n, free or after)]
    return [phase for phase in phases if phase[1] > phase[0]]


def _air(plan: Plan, asked: VirtualManeuver, t: Array, V: float) -> Array | None:
    """The stated gust, (n, 6); None where there is none."""
    if plan.gust is None:
        return None
    g = plan.gust
    return CosineGust(np.array(g.peak), g.start, g.length, V, returns=True).value(t)


def joined(parts: Sequence[SimulatedFlight]) -> SimulatedFlight:
    """Flights that begin where the one before ended, as one; the later has the common sample."""
    if len(parts) == 1:
        return parts[0]

    def chain(arrays: Sequence[Array]) -> Array:
        return frozen(np.concatenate([*(a[:-1] for a in arrays[:-1]), arrays[-1]]))

    def merged(values: Sequence[Any]) -> Any:
        one = values[0]
        if isinstance(one, np.ndarray):
            return chain(values)
        if isinstance(one, Mapping):
            return {k: chain([v[k] for v in values]) for k in one}
        return one

    def fields_of(items: Sequence[Any], but: tuple[str, ...]) -> dict[str, Any]:
        return {
            f.name: merged([getattr(i, f.name) for i in items])
            for f in fields(items[0])
            if f.name not in but
        }

    motions = [p.motion for p in parts]
    motion = replace(motions[0], **fields_of(motions, ("maneuver", "window_s")))
    own = fields_of(parts, ("motion", "messages"))
    said = tuple(dict.fromkeys(m for p in parts for m in p.messages))
    return replace(parts[0], motion=motion, messages=said, **own)


def times(plan: Plan, asked: VirtualManeuver) -> Array:
    """The log's time stamps, (n,) s from 0."""
    return np.arange(round(asked.maneuver.end * plan.rate) + 1) / plan.rate
