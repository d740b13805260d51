"""What the sensors of each maneuver read, carried to the center of gravity.

Output error and filter error compare with readings: what a smoother gives back has forgotten the
noise that they weigh by. So each reading is moved by the difference of the two motions that
reconstruction knows, at the sensor and at the center of gravity (lever arm, wind, delay), and freed
of bias and scale error: state at the center + (reading - what it should have been) x slope.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.messages import Message, note
from alula.base.project import ReconstructSpec
from alula.campaign.check import Checked
from alula.flight import Flight, Motion
from alula.identify import Reference, Thrust
from alula.identify.flown.carried import Shifts
from alula.identify.flown.measured_maneuver import MeasuredManeuver, measured_maneuver
from alula.reconstruct import Reconstruction, Segment
from alula.reconstruct.sensors import kind_of
from alula.reconstruct.transfer import engines_on

AIR_AND_ATTITUDE = ("V", "alpha", "beta", "phi", "theta")
INERTIAL = ("p", "q", "r", "ax", "ay", "az")
ACCELERATIONS = ("pdot", "qdot", "rdot")


@dataclass(frozen=True)
class Reading:
    """One sensor: t (k,) s, off (k,) reading minus what it should have been, SI; sigma, gain.

    slope: (n,) of the quantity by the channel at the motion's stamps, 1 where they are the same.
    """

    channel: str
    quantity: str
    t: Array
    off: Array
    sigma: float
    gain: float
    slope: Array | float = 1.0


def engines_of(flight: Flight, aircraft: Aircraft, motion: Motion) -> list[Thrust]:
    """The engines whose thrust is known, along the motion."""
    forces = engines_on(flight, aircraft, motion.t)
    return [
        Thrust(e.position, e.direction, forces[e.name], e.thrust_se)
        for e in aircraft.engines
        if e.name in forces
    ]


def measured_maneuvers(
    checked: Checked, reconstruction: Reconstruction
) -> tuple[tuple[MeasuredManeuver, ...], tuple[Message, ...], list[Shifts]]:
    """Every reconstructed maneuver as output error takes it, with what is to be said of it and
    how its readings move with what reconstruction is unsure of.

    Raises BadInput where mass properties are missing or an input is not a number.
    """
    spec = checked.project.reconstruct
    base = checked.aircraft
    reference = Reference(base.S, base.b, base.c, base.reference_point)
    out: list[MeasuredManeuver] = []
    said: list[Message] = []
    sensors: list[Mapping[str, Reading]] = []
    for segment in reconstruction.segments:
        motion, log = segment.motion, segment.maneuver.log
        flight, aircraft = checked.flights[log], checked.aircraft_of(log)
        fuel = np.zeros(len(motion.t)) if motion.fuel_used is None else motion.fuel_used
        mass = aircraft.mass_properties(fuel)
        chosen, remarks = best_sensors(segment, flight, _gains(reconstruction, segment, spec))
        sensors.append(chosen)
        readings = _at_center(motion, chosen)
        outputs = [*readings, *(n for n in INERTIAL if n in flight)]
        if motion.window_s == 0.0:  # recorded, not differentiated here
            outputs += [n for n in ACCELERATIONS if n in flight]
        said += remarks
        out.append(
            measured_maneuver(
                motion,
                reference,
                mass=mass.mass,
                cg=mass.cg,
                inertia=mass.inertia,
                thrust=engines_of(flight, aircraft, motion),
                readings=readings,
                outputs=outputs,
                gravity=spec.gravity,
            )
        )
    return tuple(out), tuple(dict.fromkeys(said)), reading_shifts(reconstruction, out, sensors)


def reading_shifts(
    reconstruction: Reconstruction,
    maneuvers: Sequence[MeasuredManeuver],
    sensors: Sequence[Mapping[str, Reading]],
) -> list[Shifts]:
    """How the readings move, for each independent direction of the constants' uncertainty.

    A bias b and scale error k that are off by db, dk move a corrected reading x by -(db + dk x),
    over the gain and times the slope of the sensor that was read. sensors: those of each maneuver,
    by output; inertial ones are read as they are.
    """
    if not reconstruction.constants:
        return []
    names = [c.name for c in reconstruction.constants]
    size, turn = np.linalg.eigh(reconstruction.constants_cov)
    out: list[Shifts] = []
    for variance, direction in zip(size, turn.T, strict=True):
        if variance <= 0.0:
            continue
        off = dict(zip(names, (np.sqrt(variance) * direction).tolist(), strict=True))
        moved: dict[str, dict[str, Array]] = {}
        for m, read in zip(maneuvers, sensors, strict=True):
            tags = ("", f"[{m.maneuver.log}]", f"[{m.maneuver.id}]")
            for name, x in m.outputs.items():
                channel = read[name].channel if name in read else name
                share = read[name].slope / read[name].gain if name in read else 1.0
                bias = sum(off.get(f"b_{channel}{tag}", 0.0) for tag in tags)
                scale = sum(off.get(f"k_{channel}{tag}", 0.0) for tag in tags)
                if bias or scale:
                    moved.setdefault(m.maneuver.id, {})[name] = -share * (bias + scale * x)
        if moved:
            out.append(moved)
    return out


def sensor_readings(
    segment: Segment, flight: Flight, gain: Callable[[str], float]
) -> tuple[dict[str, Array], list[Message]]:
    """Readings (n,) of air data and attitude at the motion's stamps, NaN where there is none.

    gain: 1 + scale error by channel. Where two sensors measure one quantity the better one is
    taken. A reading between two stamps goes to the nearer, moved along with the motion.
    """
    best, said = best_sensors(segment, flight, gain)
    return _at_center(segment.motion, best), said


def best_sensors(
    segment: Segment, flight: Flight, gain: Callable[[str], float]
) -> tuple[dict[str, Reading], list[Message]]:
    """The better sensor of each quantity, and what is to be said of those that are left."""
    best: dict[str, Reading] = {}
    said = []
    for reading in _of(segment, flight, gain):
        other = best.get(reading.quantity)
        if other is None or reading.sigma < other.sigma:
            best[reading.quantity] = reading
        if other is not None:
            said.append(
                note(
                    "sensor_not_compared",
                    where=f"maneuver {segment.maneuver.id}, {reading.quantity}",
                    expected="one sensor for each output",
                    found=f"{other.channel} and {reading.channel}",
                    do=f"{best[reading.quantity].channel} is compared: it is the better by the "
                    "standard deviation stated; reconstruction used both.",
                )
            )
    return best, said


def _at_center(motion: Motion, sensors: Mapping[str, Reading]) -> dict[str, Array]:
    """The readings (n,) by quantity at the motion's stamps, moved to the center of gravity."""
    return {
        name: getattr(motion, name) + r.slope * _on_stamps(motion.t, r.t, r.off / r.gain)
        for name in AIR_AND_ATTITUDE
        if (r := sensors.get(name)) is not None
    }


def _of(segment: Segment, flight: Flight, gain: Callable[[str], float]) -> Iterator[Reading]:
    motion = segment.motion
    if segment.state_names:
        for s in segment.sensors:
            quantity = {"beta_flank": "beta"}.get(kind_of(s.name) or "", kind_of(s.name) or "")
            if quantity in AIR_AND_ATTITUDE and len(s.t):
                slope = _flank_slope(motion) if kind_of(s.name) == "beta_flank" else 1.0
                off = s.measured - s.fitted
                yield Reading(s.name, quantity, s.t, off, s.sigma, gain(s.name), slope)
        return
    for name in AIR_AND_ATTITUDE:  # as recorded: the motion is the channel, linear between samples
        if name not in flight or len(flight[name].t) < 2:
            continue
        channel = flight[name]
        use = (channel.t >= motion.t[0]) & (channel.t <= motion.t[-1])
        use &= np.isfinite(channel.values)
        t = channel.t[use]
        if len(t):
            off = channel.values[use] - np.interp(t, motion.t, getattr(motion, name))
            yield Reading(name, name, t, off, 0.0, 1.0)


def _on_stamps(stamps: Array, t: Array, values: Array) -> Array:
    """The values (k,) at the nearest of the stamps (n,), several at one averaged; else NaN."""
    right = np.clip(np.searchsorted(stamps, t), 1, len(stamps) - 1)
    at = right - (t - stamps[right - 1] < stamps[right] - t)
    total, count = np.zeros(len(stamps)), np.zeros(len(stamps))
    np.add.at(total, at, values)
    np.add.at(count, at, 1.0)
    return np.where(count > 0.0, total / np.maximum(count, 1.0), np.nan)


def _flank_slope(motion: Motion) -> Array:
    """d beta / d beta_flank: tan(beta) = tan(beta_flank) cos(alpha)."""
    cos, tan = np.cos(motion.alpha), np.tan(motion.beta)
    slope: Array = cos * (1.0 + (tan / cos) ** 2) / (1.0 + tan**2)
    return slope


def _gains(
    reconstruction: Reconstruction, segment: Segment, spec: ReconstructSpec
) -> Callable[[str], float]:
    """1 + scale error by channel: as estimated for this maneuver, or as the project states it."""
    found: Mapping[str, float] = {c.name: c.value for c in reconstruction.constants}
    m = segment.maneuver

    def gain(channel: str) -> float:
        name = f"k_{channel}"
        for key in (name, f"{name}[{m.log}]", f"{name}[{m.id}]"):
            if key in found:
                return 1.0 + found[key]
        return 1.0 + (spec.unknowns[name].value if name in spec.unknowns else 0.0)

    return gain
