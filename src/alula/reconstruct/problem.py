"""A reconstruction problem: records, sensors, unknowns and the core's table of them.

The state is the motion of the inertial sensor (h u v w phi theta psi, and north east where a
position is measured), then the free unknowns. `u v w` are inertial where wind is an unknown and
relative to the air mass otherwise, which is the same while the wind is steady.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn
from alula.base.project import ReconstructSpec
from alula.core import core
from alula.flight import Flight, Maneuver
from alula.reconstruct.record import Record, channel_on, make_record
from alula.reconstruct.sensors import KINDS, Sensor, choose_sensors
from alula.reconstruct.start import first_motion, first_reading, windy_start
from alula.reconstruct.unknowns import COMMON, INERTIAL, Unknown, choose_unknowns

MOTION = ("h", "u", "v", "w", "phi", "theta", "psi", "north", "east")
# Noise assumed of an inertial sensor that the project says nothing about, per sample.
_IMU_SIGMA = {"ax": 0.05, "ay": 0.05, "az": 0.05, "p": 0.002, "q": 0.002, "r": 0.002}
_STEEP = np.deg2rad(80.0)  # Euler angles lose a digit here


@dataclass(frozen=True)
class Problem:
    """What one method solves at once. initial: (maneuvers, 2 motion) values, then deviations."""

    records: tuple[Record, ...]
    sensors: tuple[Sensor, ...]
    unknowns: tuple[Unknown, ...]  # the free ones, as in the state
    fixed: tuple[Unknown, ...]
    motion: int
    initial: Array
    held: tuple[Array | None, ...]  # (n, motion) for each record: states taken as measured
    position: Array  # of the inertial sensor, from the aircraft's datum
    positions: tuple[Array, ...]  # of the sensors, from the inertial sensor
    gravity: float
    imu_sigma: Array
    stated: bool  # whether the project states the first record's initial motion
    messages: tuple[Message, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The state's components."""
        return MOTION[: self.motion] + tuple(u.name for u in self.unknowns)

    def column(self, name: str) -> int | None:
        """Where a free unknown stands in the state."""
        names = [u.name for u in self.unknowns]
        return self.motion + names.index(name) if name in names else None

    def model(self, sigma: Sequence[float] | None = None) -> core.PathModel:
        """The core's table; sigma replaces the sensors' standard deviations."""
        table = core.PathModel()
        table.motion = self.motion
        table.states = self.motion + len(self.unknowns)
        table.dynamic = self.motion + sum(u.inertial for u in self.unknowns)
        table.gravity = self.gravity
        values = {u.name: u.value for u in self.fixed}
        for index, name in enumerate(COMMON):
            column = self.column(name)
            table.set_unknown(index, -1 if column is None else column, values.get(name, 0.0))
        table.wind = any(
            self.column(n) is not None or values.get(n, 0.0) != 0.0 for n in COMMON[-3:]
        )
        table.set_input_sigma([float(s) for s in self.imu_sigma])
        for offset, unknown in enumerate(self.unknowns):
            table.set_walk(self.motion + offset, unknown.walk)
        for i, sensor in enumerate(self.sensors):
            scale, bias = self.column(f"k_{sensor.channel}"), self.column(f"b_{sensor.channel}")
            table.add_sensor(
                KINDS[sensor.kind].quantity,
                [float(x) for x in self.positions[i]],
                float(sensor.sigma if sigma is None else sigma[i]),
                reference=self._reference(i),
                scale=values.get(f"k_{sensor.channel}", 0.0),
                bias=values.get(f"b_{sensor.channel}", 0.0),
                scale_slot=-1 if scale is None else scale,
                bias_slot=-1 if bias is None else bias,
            )
        return table

    def _reference(self, sensor: int) -> float:
        if self.sensors[sensor].reference == "zero":
            return 0.0
        if self.stated:
            bare = core.PathModel()
            bare.motion = bare.states = bare.dynamic = self.motion
            arm = [float(x) for x in self.positions[sensor]]
            bare.add_sensor(KINDS[self.sensors[sensor].kind].quantity, arm, 1.0)
            start = np.ascontiguousarray(self.initial[:1, : self.motion])
            return float(core.path_readings(bare, self.records[0].inputs[:1], start)[0, 0])
        return first_reading(self.records[0].readings[:, sensor])


def make_problem(
    flights: dict[str, Flight],
    maneuvers: Sequence[Maneuver],
    aircraft: Aircraft,
    spec: ReconstructSpec,
) -> Problem:
    """Assemble the problem of these maneuvers. Raises BadInput where it cannot be solved at all."""
    channels = sorted(set.intersection(*(set(flights[m.log].channels) for m in maneuvers)))
    sensors, messages = choose_sensors(channels, spec.sensors)
    if not sensors:
        raise refuse(
            "no_sensor",
            where="[reconstruct.sensors]",
            expected="at least one measured channel of " + ", ".join(KINDS),
            found="none",
            do='Map one, or take filter = "none".',
        )
    if len(sensors) > core.MAX_OUTPUTS:
        raise refuse(
            "too_many_sensors",
            where="[reconstruct.sensors]",
            expected=f"at most {core.MAX_OUTPUTS}",
            found=str(len(sensors)),
            do="Switch some off with use = false.",
        )
    unknowns, said = _without_drift(choose_unknowns(sensors, spec.unknowns), sensors)
    messages = messages + said
    free = tuple(u for u in unknowns if u.free)
    motion = 9 if any(s.kind in ("north", "east") for s in sensors) else 7
    if motion + len(free) > core.MAX_STATES:
        raise refuse(
            "too_many_unknowns",
            where="[reconstruct.unknowns]",
            expected=f"at most {core.MAX_STATES - motion} free unknowns",
            found=str(len(free)),
            do='Switch some off with state = "off".',
        )
    records = []
    for maneuver in maneuvers:
        record, said = make_record(
            flights[maneuver.log], maneuver, sensors, spec.vibration_filter_hz
        )
        records.append(record)
        messages += said
    free = windy_start(records[0], sensors, free, spec)
    position = aircraft.sensor_position("ax")
    problem = Problem(
        records=tuple(records),
        sensors=sensors,
        unknowns=free,
        fixed=tuple(u for u in unknowns if not u.free),
        motion=motion,
        initial=np.array([_started(r, sensors, motion, free, spec) for r in records]),
        stated=records[0].maneuver.id in spec.initial,
        held=tuple(_held(flights[r.maneuver.log], r, spec.given, motion) for r in records),
        position=position,
        positions=tuple(aircraft.sensor_position(s.channel) - position for s in sensors),
        gravity=spec.gravity,
        imu_sigma=np.array(
            [spec.imu[n].sigma_si if n in spec.imu else _IMU_SIGMA[n] for n in INERTIAL]
        ),
        messages=tuple(messages + _doubts(records, sensors)),
    )
    return problem


def _without_drift(
    unknowns: tuple[Unknown, ...], sensors: Sequence[Sensor]
) -> tuple[tuple[Unknown, ...], list[Message]]:
    """Horizontal wind is held where nothing is measured against the ground: all motion relative to
    a steadily drifting air mass is the same (Galileo), whatever a linearized filter seems to learn.
    """
    if any(s.kind in ("v_north", "v_east", "north", "east") for s in sensors):
        return unknowns, []
    held = [u.name for u in unknowns if u.free and u.name in ("wind_n", "wind_e")]
    said = [
        warn(
            "not_observable",
            where=f"unknown {name}",
            expected="a speed or position over ground",
            found="air data and inertial sensors alone",
            do=f"It is held at its stated value. Map GPS channels, or take {name} out.",
        )
        for name in held
    ]
    return tuple(replace(u, free=False) if u.name in held else u for u in unknowns), said


def _started(
    record: Record,
    sensors: Sequence[Sensor],
    motion: int,
    free: Sequence[Unknown],
    spec: ReconstructSpec,
) -> Array:
    """As `first_motion`, with the values that the project states."""
    out = first_motion(record, sensors, motion, free)
    for name, entry in spec.initial.get(record.maneuver.id, {}).items():
        out[MOTION.index(name)] = entry.value_si
    return out


def _held(flight: Flight, record: Record, given: Sequence[str], motion: int) -> Array | None:
    if not given:
        return None
    out = np.full((len(record.t), motion), np.nan)
    for name in given:
        out[:, MOTION.index(name)] = channel_on(flight, name, record.t)
    return out


def _doubts(records: Sequence[Record], sensors: Sequence[Sensor]) -> list[Message]:
    out = []
    kinds = [s.kind for s in sensors]
    for record in records:
        if "theta" in kinds:
            steepest = np.nanmax(np.abs(record.readings[:, kinds.index("theta")]), initial=0.0)
            if steepest > _STEEP:
                out.append(
                    warn(
                        "steep_attitude",
                        where=f"maneuver {record.maneuver.id}",
                        expected="pitch angles below 80 deg",
                        found=f"{np.rad2deg(steepest):.0f} deg",
                        do="Euler angles lose their digits there; choose another window.",
                    )
                )
    return out
