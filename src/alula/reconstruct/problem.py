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
from alula.reconstruct.unknowns import COMMON, INERTIAL, WIND, Unknown, choose_unknowns

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
        return _first(self.records[0].readings[:, sensor])


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
    free = _windy_start(records[0], sensors, free, spec)
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


def _first(values: Array) -> float:
    valid = values[np.isfinite(values)]
    return float(valid[0]) if len(valid) else 0.0


def _initial(
    record: Record, sensors: Sequence[Sensor], motion: int, free: Sequence[Unknown]
) -> Array:
    """Motion at the first sample from the first readings, and a generous deviation of each."""
    first = {}
    for i, sensor in enumerate(sensors):
        kind = sensor.kind.removesuffix("_linear")
        if kind not in first and np.isfinite(record.readings[:, i]).any():
            first[kind] = (_first(record.readings[:, i]), sensor.sigma)
    x, sd = np.zeros(motion), np.zeros(motion)
    for i, name in ((0, "h"), (4, "phi"), (5, "theta"), (6, "psi")):
        x[i], sigma = first.get(name, (0.0, 100.0 if name == "h" else 0.1))
        sd[i] = 5.0 * sigma
    if "psi" not in first:
        sd[6] = 1.0  # a radian is "unknown" to the filters
    ground = all(n in first for n in ("v_north", "v_east", "v_down"))
    windy = any(u.name == "wind_n" for u in free)
    if ground and (windy or "V" not in first):
        v_E = np.array([first[n][0] for n in ("v_north", "v_east", "v_down")])
        x[1:4] = _R_BE(*x[4:7]) @ v_E
        sd[1:4] = 5.0 * first["v_north"][1] + 5.0 * float(np.linalg.norm(v_E)) * sd[6] / 5.0
    else:
        V, sigma = first.get("V", (30.0, 10.0))
        alpha = first.get("alpha", (x[5], 0.05))
        beta = first.get("beta", first.get("beta_flank", (0.0, 0.05)))
        x[1:4] = V * np.array(
            [np.cos(alpha[0]) * np.cos(beta[0]), np.sin(beta[0]), np.sin(alpha[0])]
        )
        sd[1:4] = 5.0 * sigma + V * np.array([0.02, 5.0 * beta[1], 5.0 * alpha[1]])
        sd[1:4] += 0.05 * V * np.array([0.0, 1.0, 1.0])  # upwash, boom, bias
        if windy:
            sd[1:4] += 15.0
    for i, name in ((7, "north"), (8, "east")):
        if i < motion:
            x[i], sigma = first.get(name, (0.0, 100.0))
            sd[i] = 5.0 * sigma
    return np.concatenate([x, sd])


def _started(
    record: Record,
    sensors: Sequence[Sensor],
    motion: int,
    free: Sequence[Unknown],
    spec: ReconstructSpec,
) -> Array:
    """As `_initial`, with the values that the project states."""
    out = _initial(record, sensors, motion, free)
    for name, entry in spec.initial.get(record.maneuver.id, {}).items():
        out[MOTION.index(name)] = entry.value_si
    return out


def _windy_start(
    record: Record, sensors: Sequence[Sensor], free: tuple[Unknown, ...], spec: ReconstructSpec
) -> tuple[Unknown, ...]:
    """Wind by the first readings, where they tell it and the project does not.

    Started from calm air the filters would take the drift for sideslip and angle of attack: their
    first linearization then learns of sidewash and upwash what no reading ever told.
    """
    kinds = [s.kind.removesuffix("_linear") for s in sensors]
    needed = ("v_north", "v_east", "v_down", "V", "phi", "theta", "psi")
    if not all(name in kinds for name in needed):
        return free
    first = {kind: _first(record.readings[:, kinds.index(kind)]) for kind in kinds}
    alpha, beta = first.get("alpha", first["theta"]), first.get("beta", 0.0)
    v_B = first["V"] * np.array(
        [np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)]
    )
    v_E = np.array([first[name] for name in needed[:3]])
    wind = v_E - _R_BE(first["phi"], first["theta"], first["psi"]).T @ v_B
    guess = dict(zip(WIND, wind.tolist(), strict=True))
    return tuple(
        replace(u, value=guess[u.name]) if u.name in WIND and u.name not in spec.unknowns else u
        for u in free
    )


def _R_BE(phi: float, theta: float, psi: float) -> Array:
    """Earth to body. ISO 1151; Euler angles 3-2-1."""
    sp, cp, st, ct, sy, cy = (f(a) for a in (phi, theta, psi) for f in (np.sin, np.cos))
    return np.array(
        [
            [ct * cy, ct * sy, -st],
            [sp * st * cy - cp * sy, sp * st * sy + cp * cy, sp * ct],
            [cp * st * cy + sp * sy, cp * st * sy - sp * cy, cp * ct],
        ]
    )


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
