"""The maneuvers of a plan, one by one: which loading, from which condition, with which inputs."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from alula.base.messages import refuse
from alula.flight import Maneuver
from alula.simulate.inputs import (
    Pulse,
    Signal,
    Steps,
    Sum,
    Sweep,
    bank_to_bank,
    doublet,
    input_3211,
)
from alula.simulate.multisine import Multisine, multisines
from alula.simulate.virtual_plan import Aspect, ConditionSpec, InputSpec, ManeuverPlan, Plan

DEG = np.pi / 180.0
_ASPECT: Mapping[str, Aspect] = {
    "de": "longitudinal", "df": "longitudinal", "da": "lateral", "dr": "lateral",
}  # fmt: skip


@dataclass(frozen=True)
class Condition:
    """A steady flight: true airspeed m/s, height m, climb angle, heading and flap in rad."""

    id: str
    V: float
    h: float
    gamma: float = 0.0
    psi: float = 0.0
    df: float = 0.0


@dataclass(frozen=True)
class VirtualManeuver:
    """One maneuver that is to be flown.

    maneuver: window and kind; its log has its id. loading: id of the plan's. signals: rad on top of
    trim, by control. first, last: s, when the inputs begin and end; 0 without any. free: controls
    float after the last input.
    """

    maneuver: Maneuver
    loading: str
    condition: Condition
    signals: Mapping[str, Signal]
    first: float
    last: float
    free: bool = False


def conditions_of(spec: ConditionSpec) -> tuple[Condition, ...]:
    """Every airspeed at every height."""
    speeds = spec.V if isinstance(spec.V, list) else [spec.V]
    heights = spec.h if isinstance(spec.h, list) else [spec.h]
    several = len(speeds) * len(heights) > 1
    out = []
    for h in heights:
        for V in speeds:
            parts = [spec.id] if spec.id else []
            parts += [f"V{V:g}", f"h{h:g}"] if several or not spec.id else []
            out.append(
                Condition(
                    "_".join(parts), V, h, spec.gamma_deg * DEG, spec.psi_deg * DEG,
                    spec.df_deg * DEG,
                )
            )  # fmt: skip
    return tuple(out)


def maneuvers_of(plan: Plan) -> tuple[VirtualManeuver, ...]:
    """All maneuvers of the plan in its order: by loading, condition, maneuver, repeat.

    Raises BadInput where an input does not end within its maneuver, or two maneuvers would have
    one name.
    """
    out = []
    for loading in [x.id for x in plan.loadings] or [""]:
        for spec in plan.conditions:
            if spec.loadings != "all" and loading not in spec.loadings:
                continue
            for condition in conditions_of(spec):
                for asked in plan.maneuvers:
                    if asked.conditions != "all" and spec.id not in asked.conditions:
                        continue
                    for k in range(asked.repeats):
                        out.append(_maneuver(plan, loading, condition, asked, k))
    ids = [m.maneuver.id for m in out]
    twice = sorted({i for i in ids if ids.count(i) > 1}) if len(set(ids)) < len(ids) else []
    if twice:
        raise refuse(
            "duplicate_id",
            where=f"{plan.path}: conditions",
            expected="a name of its own for each maneuver",
            found=f"'{twice[0]}' several times",
            do="Give the conditions ids.",
        )
    if not out:
        raise refuse(
            "no_maneuver",
            where=str(plan.path),
            expected="a maneuver at one of the conditions",
            found="none",
            do="Check 'conditions' and 'loadings'; \"all\" takes all.",
        )
    return tuple(out)


def _maneuver(
    plan: Plan, loading: str, condition: Condition, asked: ManeuverPlan, repeat: int
) -> VirtualManeuver:
    parts = [loading, condition.id, asked.id, str(repeat + 1) if asked.repeats > 1 else ""]
    id = re.sub(r"\s+", "_", "_".join(p for p in parts if p))
    duration = asked.duration or plan.duration
    signals, last = signals_of(asked, condition.V)
    if last > duration:
        raise refuse(
            "input_too_long",
            where=f"{plan.path}: maneuver {id}",
            expected=f"inputs that end within the maneuver's {duration:g} s",
            found=f"an end at {last:.3g} s (widths are stretched at low airspeed)",
            do="Lengthen 'duration', or shorten the input.",
        )
    aspects = {_ASPECT[i.control] for i in asked.inputs}
    aspect: Aspect = asked.aspect or (aspects.pop() if len(aspects) == 1 else "both")
    samples = int(np.floor(duration * plan.rate * (1.0 + 1e-9)))
    return VirtualManeuver(
        maneuver=Maneuver(
            id=id,
            log=id,
            kind="+".join(dict.fromkeys(i.kind for i in asked.inputs)) or "trim",
            start=0.0,
            end=samples / plan.rate,
            aspect=aspect,
            configuration={
                "flaps_deg": f"{condition.df / DEG:g}",
                "controls": asked.controls,
                **({"loading": loading} if loading else {}),
            },
            held_out=asked.held_out,
        ),
        loading=loading,
        condition=condition,
        signals=signals,
        first=min((i.start for i in asked.inputs), default=duration),
        last=last,
        free=asked.controls == "free",
    )


def signals_of(asked: ManeuverPlan, V: float) -> tuple[dict[str, Signal], float]:
    """Signals by control, rad on top of trim, at airspeed V m/s; and when the last one ends, s."""
    stretch = (asked.reference_V or V) / V
    gain = stretch**asked.amplitude_exponent * DEG
    sines = [i for i in asked.inputs if i.kind == "multisine"]
    several: tuple[Multisine, ...] = ()
    if sines:
        one = sines[0]
        assert one.duration is not None  # the schema has seen to it
        assert one.band_hz is not None
        several = _multisines(
            tuple(gain * i.amplitude_deg for i in sines),
            one.duration * stretch,
            (one.band_hz[0] / stretch, one.band_hz[1] / stretch),
            start=one.start,
        )
    of_sines = dict(zip([id(i) for i in sines], several, strict=True))
    parts: dict[str, list[Signal]] = {}
    last = 0.0
    for spec in asked.inputs:
        signal = of_sines.get(id(spec)) or _signal(spec, gain * spec.amplitude_deg, stretch)
        parts.setdefault(spec.control, []).append(signal)
        last = max(last, signal.end + spec.ramp)
    return {k: v[0] if len(v) == 1 else Sum(tuple(v)) for k, v in parts.items()}, last


_multisines = lru_cache(multisines)  # the same for every condition of one airspeed


def _signal(spec: InputSpec, amplitude: float, stretch: float) -> Pulse | Steps | Sweep:
    start, ramp = spec.start, spec.ramp
    width, duration = (spec.width or 0.0) * stretch, (spec.duration or 0.0) * stretch
    if spec.kind == "pulse":
        return Pulse(amplitude, start, width, ramp)
    if spec.kind == "doublet":
        return doublet(amplitude, start, width, ramp)
    if spec.kind == "3211":
        return input_3211(amplitude, start, width, ramp)
    if spec.kind == "bank_to_bank":
        return bank_to_bank(amplitude, start, width, spec.hold * stretch, ramp)
    if spec.kind == "sweep":
        low, high = (f / stretch for f in spec.band_hz or (0.0, 0.0))
        return Sweep(amplitude, start, duration, low, high, spec.logarithmic, spec.fade * stretch)
    return Steps(
        amplitude,
        start,
        tuple(w * stretch for w in spec.widths or ()),
        tuple(spec.levels or ()),
        ramp,
    )
