"""SportStar maneuvers flown once, and what sensors make of them with many seeds.

For the rows that judge estimators: the motion is the truth, noise is drawn anew for every seed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import lfilter

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.flight import Maneuver
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.model import AeroModel, load_model
from alula.plan.expected import without_noise
from alula.simulate import Airframe, Condition, SimulatedFlight, airframe_of, fly, trim
from alula.simulate.inputs import Signal
from alula.simulate.pilot import Pilot
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft" / "sportstar.toml"
# Standard deviations per sample of a light aircraft's sensors, SI (Dittrich 2016, ch. 4, sizes).
SIGMA: Mapping[str, float] = {
    "V": 0.3, "alpha": 3e-3, "beta": 3e-3,
    "p": 3e-3, "q": 3e-3, "r": 3e-3,
    "phi": 3e-3, "theta": 3e-3,
    "ax": 0.05, "ay": 0.05, "az": 0.1,
    "pdot": 0.05, "qdot": 0.05, "rdot": 0.05,
}  # fmt: skip
LONGITUDINAL = ("V", "alpha", "theta", "q", "ax", "az")
LATERAL = ("beta", "p", "r", "phi", "ay")


@dataclass(frozen=True)
class Aircraft:
    """Airframe with a given thrust, its true model, control limits."""

    airframe: Airframe
    model: AeroModel
    cg: Array


def sportstar(values: Mapping[str, float] | None = None, *, stall: bool = False) -> Aircraft:
    """The SportStar of its aircraft file with some of its derivatives replaced."""
    path = AIRCRAFT
    frame = airframe_of(load_aircraft(path))
    model = load_model(path.with_name("sportstar_aero.toml"))
    changed = {**model.params, **(values or {})}
    model = replace(
        model,
        values=np.array([changed[n] for n in model.names]),
        stall=model.stall if stall else None,
    )
    return Aircraft(frame, model, np.asarray(frame.cg))


def flown(
    aircraft: Aircraft,
    id: str,
    signals: Mapping[str, Signal],
    *,
    V: float = 38.0,
    h: float = 915.0,
    seconds: float = 20.0,
    rate: float = 50.0,
    aspect: str = "both",
    gains: Mapping[tuple[str, str], float] | None = None,
    substeps: int = 20,
    disturbed: float = 0.0,
    follow: Mapping[str, Signal] | None = None,
) -> SimulatedFlight:
    """A maneuver from trimmed level flight. gains: of a pilot who holds what was trimmed.

    substeps: many, because he looks once a step, and what is recorded is a line between samples.
    disturbed: pitch rate to start with, rad/s. follow: what he adds to what he holds, by sight.
    """
    start = trim(aircraft.airframe, aircraft.model, Condition(V, h))
    t = np.arange(round(seconds * rate) + 1) / rate
    controls: dict[str, Array | float] = {**start.inputs}
    for name, signal in signals.items():
        controls[name] = start.controls[name] + signal.value(t)
    held = {"alpha": start.alpha, "theta": start.theta, "V": V}
    first = np.array(start.state)
    first[11] += disturbed
    pilot = None
    if gains is not None:
        references = {sight: held.get(sight, 0.0) for _, sight in gains}
        wanted: dict[str, Array | float] = {**references}
        for sight, change in (follow or {}).items():
            wanted[sight] = references[sight] + change.value(t)
        pilot = Pilot(gains, wanted)
    return fly(
        aircraft.airframe,
        aircraft.model,
        first,
        t,
        controls,
        substeps=substeps,
        maneuver=Maneuver(id, id, "simulated", 0.0, seconds, aspect),
        pilot=pilot,
    )


def noise(names: tuple[str, ...], n: int, seed: int, memory: float = 0.0) -> dict[str, Array]:
    """Noise (n,) by output, of `SIGMA` each. memory: what stays to the next sample; 0: white."""
    random = np.random.default_rng(seed)
    out = {}
    for name in names:
        white = random.standard_normal(n + 200)
        if memory:
            white = lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], white)
        out[name] = SIGMA[name] * white[200:]
    return out


def measured(
    aircraft: Aircraft,
    flight: SimulatedFlight,
    outputs: tuple[str, ...],
    seed: int | None,
    memory: float = 0.0,
) -> MeasuredManeuver:
    """The maneuver with noise on its outputs; seed None: without. Inputs are exact."""
    exact = without_noise(flight, aircraft.airframe, aircraft.model)
    added = {} if seed is None else noise(outputs, len(exact.t), seed, memory)
    return replace(exact, outputs={o: exact.outputs[o] + added.get(o, 0.0) for o in outputs})
