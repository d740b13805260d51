"""A flight test designed for one condition: steps by the a-priori modes, amplitudes by the limits,
and what the maneuvers will tell.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from alula.aircraft import Aircraft
from alula.base.messages import Message, refuse, warn
from alula.base.project_messages import validated
from alula.model import AeroModel
from alula.plan.amplitude import Limits, largest_amplitude, limits_of, outside
from alula.plan.expected import Method, expected
from alula.plan.information import Prediction
from alula.plan.widths import Timing, timing
from alula.simulate.airframe import core_model
from alula.simulate.fly import SimulatedFlight
from alula.simulate.linearize import linearize
from alula.simulate.modes import Mode, modes_of
from alula.simulate.trim import Trim
from alula.simulate.virtual_flight import airframe, fly_maneuver, trimmed
from alula.simulate.virtual_loading import Loading, loadings_of
from alula.simulate.virtual_maneuvers import DEG, maneuvers_of
from alula.simulate.virtual_plan import Plan
from alula.simulate.virtual_project import formulas_of

START = 1.0  # s of steady flight before the first input
SHRINK = 0.85  # of all amplitudes of a maneuver, until their sum stays inside the limits
NAMES = {"de": "elevator", "da": "aileron", "dr": "rudder"}
# Ordinary flight-test instruments (compare van den Hoek 2017, Table 1): used where none are stated.
SENSORS: Mapping[str, Mapping[str, Any]] = {
    **{n: {"sigma": 0.03, "bias_sigma": 0.05, "unit": "m/s2"} for n in ("ax", "ay", "az")},
    **{n: {"sigma": 0.05, "bias_sigma": 0.1, "unit": "deg/s"} for n in ("p", "q", "r")},
    **{n: {"sigma": 0.1, "unit": "deg"} for n in ("phi", "theta", "psi")},
    "V": {"sigma": 0.2, "unit": "m/s"},
    **{n: {"sigma": 0.1, "bias_sigma": 0.3, "scale_sigma": 0.05, "unit": "deg"}
       for n in ("alpha", "beta")},
    "h": {"sigma": 0.3, "unit": "m"},
    **{n: {"sigma": 0.1, "unit": "m/s"} for n in ("v_north", "v_east", "v_down")},
    **{n: {"sigma": 0.02, "unit": "deg"} for n in ("de", "da", "dr")},
    "thrust": {"sigma": 3.0, "unit": "N"},
}  # fmt: skip


@dataclass(frozen=True)
class DesignedInput:
    """One control's input: amplitude rad, with the sign of the first step, what bounds it, and its
    step length.
    """

    control: str
    kind: str
    amplitude: float
    bound: str
    timing: Timing


@dataclass(frozen=True)
class DesignedManeuver:
    """Inputs of one maneuver, what it is predicted to tell, and what it reaches (SI, rad)."""

    id: str
    inputs: tuple[DesignedInput, ...]
    reached: Mapping[str, tuple[float, float]]
    predictions: tuple[Prediction, ...]


@dataclass(frozen=True)
class Design:
    """tree: the plan file as tables. together: predictions by all maneuvers, for `method`."""

    tree: Mapping[str, Any]
    trim: Trim
    modes: tuple[Mode, ...]
    maneuvers: tuple[DesignedManeuver, ...]
    together: tuple[Prediction, ...]
    messages: tuple[Message, ...]
    method: Method = "ee"


def planned(tree: Mapping[str, Any]) -> Plan:
    """The plan of a tree of tables; raises BadInput as `load_plan` does."""
    return validated(Plan, tree, Path("plan"))


def design(
    aircraft: Path,
    model: AeroModel,
    model_path: Path,
    V: float,
    h: float,
    *,
    requests: Sequence[tuple[str, str]] = (),
    rate: float = 100.0,
    sensors: Mapping[str, Any] | None = None,
    wind: Sequence[float] = (0.0, 0.0, 0.0),
    engines: Literal["modeled", "given"] = "modeled",
    method: Method = "ee",
) -> Design:
    """Design maneuvers from level flight at V (m/s, true) and h (m) for an aircraft file.

    requests: (control, kind) for maneuvers of one input each; none: an elevator 3-2-1-1, and a
    bank to bank with a rudder doublet behind it, as far as the model has these controls. sensors:
    tables of the plan file; default ordinary flight-test instruments. engines: of the aircraft
    file, or the trimmed thrust stays. method: of identification, whose standard errors are
    predicted. Raises BadInput where the condition does not trim, a control is not in the model, or
    output error has no sensor to compare.
    """
    tree: dict[str, Any] = {
        "schema": "alula.plan/1",
        "name": f"Flight test at {V:g} m/s and {h:g} m",
        "aircraft": str(aircraft),
        "model": str(model_path),
        "rate": rate,
        "wind": [float(w) for w in wind],
        "engines": engines,
        "conditions": [{"V": float(V), "h": float(h)}],
        "maneuvers": [{"id": "trim"}],
        "sensors": {k: dict(v) for k, v in (SENSORS if sensors is None else sensors).items()},
    }
    loading = next(iter(loadings_of(planned(tree)).values()))
    craft = loading.aircraft
    condition = maneuvers_of(planned(tree))[0].condition
    trim = trimmed(planned(tree), loading, model, condition)
    calm = planned({**tree, "wind": [0.0, 0.0, 0.0]})
    frame = airframe(calm, loading)
    level = trimmed(calm, loading, model, condition)
    linear = linearize(core_model(frame, model), level.state, level.inputs)
    modes = modes_of(linear.motion(), V)
    limits = limits_of(replace(craft, path=str(aircraft)), model)
    desk = _Desk(tree, loading, model, trim, limits)
    done = [desk.maneuver(wanted, modes) for wanted in _wanted(requests, model)]
    tree["maneuvers"] = [table for table, _, _ in done]
    plan = planned(tree)
    formulas = formulas_of(plan, model)
    sigma = {n: plan.sensors[n].in_si(plan.sensors[n].sigma) for n in plan.sensors}

    def tell(flights: Sequence[SimulatedFlight]) -> tuple[Prediction, ...]:
        return expected(method, flights, frame, model, formulas, sigma)

    maneuvers = tuple(
        DesignedManeuver(table["id"], inputs, _reached(flight), tell([flight]))
        for table, inputs, flight in done
    )
    together = tell([flight for _, _, flight in done])
    said = (*limits.messages, *_small(maneuvers, craft))
    return Design(tree, trim, modes, maneuvers, together, said, method)


def _wanted(
    requests: Sequence[tuple[str, str]], model: AeroModel
) -> list[tuple[tuple[str, str], ...]]:
    known = {c for f in model.formulas.values() for c in NAMES if c in f.split()}
    for control, _ in requests:
        if control not in known:
            raise refuse(
                "unknown_control",
                where="--control",
                expected="a control of the aerodynamic model: "
                + (", ".join(sorted(known)) or "none"),
                found=f"'{control}'",
                do="Name one of them.",
            )
    if requests:
        return [((control, kind),) for control, kind in requests]
    whole = [(("de", "3211"),), (("da", "bank_to_bank"), ("dr", "doublet"))]
    chosen = [tuple(pair for pair in group if pair[0] in known) for group in whole]
    return [group for group in chosen if group]


class _Desk:
    """Flies candidates of one condition."""

    def __init__(
        self,
        tree: Mapping[str, Any],
        loading: Loading,
        model: AeroModel,
        trim: Trim,
        limits: Limits,
    ) -> None:
        self.tree, self.loading, self.model = tree, loading, model
        self.trim, self.limits = trim, limits

    def maneuver(
        self, wanted: Sequence[tuple[str, str]], modes: Sequence[Mode]
    ) -> tuple[dict[str, Any], tuple[DesignedInput, ...], SimulatedFlight]:
        """The table of a maneuver, its inputs, and its flight."""
        inputs, start = [], START
        tables = []
        for control, kind in wanted:
            when = timing(control, kind, modes)
            table = _table(control, kind, when, start)
            # A pull may have more room than a push.
            ways = [(*self._amplitude(table, control, sign), sign) for sign in (1.0, -1.0)]
            amplitude, bound, sign = max(ways, key=lambda way: way[0])
            table["amplitude_deg"] = sign * _floor(amplitude / DEG)
            inputs.append(DesignedInput(control, kind, table["amplitude_deg"] * DEG, bound, when))
            tables.append(table)
            start = math.ceil(10.0 * (start + _steps(kind) * when.width + when.settles)) / 10.0
        out = {
            "id": "_".join(NAMES[c] for c, _ in wanted),
            "duration": float(max(math.ceil(start), 8)),
            "inputs": tables,
        }
        flight = self.fly(out)
        while outside(flight, self.limits) and any(abs(t["amplitude_deg"]) > 0.1 for t in tables):
            for table in tables:
                size = _floor(SHRINK * abs(table["amplitude_deg"]))
                table["amplitude_deg"] = math.copysign(size, table["amplitude_deg"])
            flight = self.fly(out)
        final = tuple(
            DesignedInput(i.control, i.kind, t["amplitude_deg"] * DEG, i.bound, i.timing)
            for i, t in zip(inputs, tables, strict=True)
        )
        return out, final, flight

    def fly(self, maneuver: Mapping[str, Any]) -> SimulatedFlight:
        """The flight of a maneuver's table."""
        plan = planned({**self.tree, "maneuvers": [dict(maneuver)]})
        return fly_maneuver(plan, maneuvers_of(plan)[0], self.loading, self.model, self.trim)

    def _amplitude(self, table: Mapping[str, Any], control: str, sign: float) -> tuple[float, str]:
        at = self.trim.controls[control]
        low, high = self.loading.aircraft.control_limits.get(control, (at - 0.35, at + 0.35))
        width = float(table["width"])
        end = table["start"] + (_steps(table["kind"]) + 1.0) * width + 4.0

        def flown(amplitude: float) -> SimulatedFlight:
            one = {**table, "amplitude_deg": sign * amplitude / DEG}
            return self.fly({"id": "candidate", "duration": end, "inputs": [one]})

        return largest_amplitude(flown, max(min(high - at, at - low), 0.0), self.limits)


def _table(control: str, kind: str, when: Timing, start: float) -> dict[str, Any]:
    width = max(round(when.width, 2), 0.05)
    return {
        "control": control,
        "kind": kind,
        "amplitude_deg": 0.0,
        "start": start,
        "width": width,
        "ramp": round(min(0.5 * width, 0.3), 2),  # a hand, or a servo at its rate
    }


def _steps(kind: str) -> float:
    """Length in widths."""
    return {"pulse": 1.0, "doublet": 2.0, "3211": 7.0}.get(kind, 4.0)


def _floor(degrees: float) -> float:
    """Two digits after the point, toward zero: what was inside stays inside."""
    return math.floor(100.0 * degrees) / 100.0


def _reached(flight: SimulatedFlight) -> dict[str, tuple[float, float]]:
    m = flight.motion
    values = {"V": m.V, "alpha": m.alpha, "beta": m.beta, "phi": m.phi, "n": -m.az / 9.80665}
    return {k: (float(v.min()), float(v.max())) for k, v in values.items()}


def _small(maneuvers: Sequence[DesignedManeuver], aircraft: Aircraft) -> list[Message]:
    return [
        warn(
            "no_amplitude",
            where=f"maneuver {m.id}, {i.control}",
            expected="room between the trim and the limits",
            found=f"none: {i.bound} is at its limit",
            do="Choose another condition, or widen the limits if they are not real.",
        )
        for m in maneuvers
        for i in m.inputs
        if i.amplitude == 0.0
    ]
