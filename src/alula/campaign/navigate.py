"""A project's logs through the navigation filters."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse, warn
from alula.base.project import Project
from alula.campaign.check import Checked, Progress, check_project
from alula.campaign.field import field_of
from alula.flight import Flight
from alula.navigate import (
    JointSettings,
    Navigation,
    PairSettings,
    assumed_sideslip,
    first_state,
    navigate_joint,
    navigate_pair,
)
from alula.navigate.from_flight import samples_of
from alula.report import ReportInput

ROWS = 20_000  # of the result, at most, for each log
_ARMS = ("V", "v_north")  # whose sensors' positions matter
CONTRADICTIONS = ("sensor_refused", "sensor_not_usable", "implausible_wind")
MOST_WIND = 0.8  # of the airspeed: an airplane that hardly makes way over ground
INERTIAL = {"not_finite": "not numbers", "backwards": "back in time", "gap": "after a hole"}
LEAST_TAKEN = 0.5  # of a sensor's readings; below it sensor and filter contradict each other


@dataclass(frozen=True)
class NavigationJob:
    """What was found, by log. attitude_difference: rms of estimate minus recorded phi theta psi,
    rad, by log and name, where the log has them.
    """

    checked: Checked
    found: Mapping[str, Navigation]
    attitude_difference: Mapping[str, Mapping[str, float]]
    messages: tuple[Message, ...]
    seconds: Mapping[str, float]

    @property
    def failed(self) -> bool:
        """Whether a sensor contradicts the others."""
        return any(m.code in CONTRADICTIONS for m in self.messages)

    def all_messages(self) -> tuple[Message, ...]:
        """The messages of every stage, each once."""
        return tuple(dict.fromkeys([*self.checked.all_messages(), *self.messages]))


def run_navigation(
    path: str,
    *,
    filter: str | None = None,
    logs: Sequence[str] = (),
    progress: Progress = lambda _: None,
) -> NavigationJob:
    """Filter each log of a project, or those named, which alone are read.

    Raises BadInput for what cannot be used.
    """
    begin = time.perf_counter()
    checked = check_project(path, (), progress, logs)
    read = time.perf_counter()
    spec = checked.project.navigate
    kind = filter or spec.filter
    if kind == "pair" and spec.field is None:
        raise refuse(
            "missing_field",
            where=f"{path}: navigate.field",
            expected="the Earth's magnetic field, which the pair takes its heading from",
            found="none",
            do="Add it under [navigate], or take --filter joint.",
        )
    found, difference = {}, {}
    messages: list[Message] = []
    for name in checked.flights:
        progress(f"navigating {name}")
        flight = checked.flights[name]
        found[name], said = navigate_flight(
            checked.project, flight, checked.aircraft_of(flight.id), kind
        )
        difference[name] = _difference(flight, found[name])
        messages += [*said, *found[name].messages, *_refusals(name, found[name])]
    seconds = {"read": read - begin, "navigate": time.perf_counter() - read}
    return NavigationJob(checked, found, difference, tuple(messages), seconds)


def navigate_flight(
    project: Project,
    flight: Flight,
    aircraft: Aircraft | None,
    kind: str = "joint",
    without: Sequence[str] = (),
    rows: int = ROWS,
) -> tuple[Navigation, list[Message]]:
    """One flight through a filter, 'joint' or 'pair'; and what was noticed.

    aircraft: where the sensors sit; None: all at one place. without: kinds of readings that are
    not taken. rows: of the result, at most. Raises BadInput where an inertial channel is missing.
    """
    spec, reconstruct = project.navigate, project.reconstruct
    samples = samples_of(flight, {**reconstruct.sensors, **spec.sensors}, reconstruct.imu)
    readings = [r for r in samples.readings if r.kind not in without]
    said = list(samples.messages)
    kinds = {r.kind for r in readings}
    if "field" in kinds and spec.field is None:
        said.append(
            note(
                "field_not_taken",
                where=f"log {flight.id}",
                expected="the Earth's magnetic field in [navigate]",
                found="none; the magnetometer is not taken",
                do="Add field = [north, east, down] in uT.",
            )
        )
        readings = [r for r in readings if r.kind != "field"]
    if not kinds & {"velocity", "position"}:
        said.append(
            warn(
                "no_satellites",
                where=f"log {flight.id}",
                expected="v_north, v_east, v_down, or north, east, down, or lat, lon, h_gps",
                found="none; only the air data can tell gravity from acceleration",
                do="Map them in [channels]; without them doubt the attitude and the wind.",
            )
        )
    if kind == "joint" and "V" in kinds and "beta" not in kinds:
        readings.append(assumed_sideslip(samples.inertial))
        said.append(
            note(
                "assumed_sideslip",
                where=f"log {flight.id}",
                expected="a sideslip sensor",
                found="none; sideslip is taken to be zero within 7 deg",
                do="Nothing: without it the wind across is not known before the flight turns.",
            )
        )
    field = None
    if "field" in kinds or kind == "pair":
        field, by_model = field_of(spec, flight)
        said += by_model
    start, heading_said = first_state(
        samples.inertial, readings, None if field is None else np.array(field),
        reconstruct.gravity, samples.heading,
    )  # fmt: skip
    said += heading_said
    noise: dict[str, Any] = {"gravity": reconstruct.gravity}
    if samples.gyro is not None:
        noise["gyro"] = samples.gyro
    every = max(1, -(-len(samples.inertial.t) // rows))
    if kind == "pair":
        assert field is not None
        pair = PairSettings(field=field, **noise)
        return navigate_pair(samples.inertial, readings, pair, start, every), said
    if samples.accelerometer is not None:
        noise["accelerometer"] = samples.accelerometer
    air, gps = (_arm(aircraft, n) for n in _ARMS)
    joint = JointSettings(
        field=field, gust=(spec.gust,) * 3, gust_length=(spec.gust_length,) * 3,
        air_sensor=(float(air[0]), float(air[1]), float(air[2])),
        antenna=(float(gps[0]), float(gps[1]), float(gps[2])), **noise,
    )  # fmt: skip
    result = navigate_joint(samples.inertial, readings, joint, start, every)
    return replace(result, messages=tuple(heading_said)), said


def _arm(aircraft: Aircraft | None, channel: str) -> Array:
    """Where a channel's sensor sits from the inertial sensor, (3,) m."""
    if aircraft is None:
        return np.zeros(3)
    return np.asarray(aircraft.sensor_position(channel) - aircraft.sensor_position("ax"))


def _difference(flight: Flight, found: Navigation) -> dict[str, float]:
    """Rms of estimate minus recorded angle, rad, over the second half: the first one settles."""
    out = {}
    late = found.t > 0.5 * (found.t[0] + found.t[-1])
    for i, name in enumerate(("phi", "theta", "psi")):
        if name not in flight:
            continue
        channel = flight[name]
        good = np.isfinite(channel.values)
        if good.sum() < 2:
            continue
        recorded = np.interp(found.t, channel.t[good], np.unwrap(channel.values[good]))
        off = np.angle(np.exp(1j * (found.euler[:, i] - recorded)))[late]
        out[name] = float(np.sqrt(np.mean(np.square(off)))) if len(off) else float("nan")
    return out


def _refusals(log: str, found: Navigation) -> list[Message]:
    """A sensor whose readings are for the most part not taken; samples that were no numbers."""
    out = []
    idle = []
    for sensor in found.takings:
        gated, taken = sensor.counts.get("gated", 0), sensor.counts.get("taken", 0)
        if gated + taken and taken < LEAST_TAKEN * (gated + taken):
            out.append(
                warn(
                    "sensor_refused",
                    where=f"log {log}, {sensor.kind}",
                    expected="readings that agree with the other sensors",
                    found=f"{gated} of {gated + taken} refused",
                    do="Check its sign, unit, delay_s and stated sigma.",
                )
            )
        if taken + gated < LEAST_TAKEN * sensor.counts.get("unusable", 0):
            idle.append(sensor.kind)
    if idle:
        out.append(
            warn(
                "sensor_not_usable",
                where=f"log {log}, {', '.join(idle)}",
                expected="readings above the least airspeed, attitude and velocity roughly known",
                found="most readings not taken, because one of these was not so",
                do="Check unit and zero of V; map satellites' velocity or position, and a heading.",
            )
        )
    wind, speed = float(np.linalg.norm(found.steady[-1])), float(np.median(found.air()[:, 0]))
    if wind > MOST_WIND * speed and speed > 10.0:
        out.append(
            warn(
                "implausible_wind",
                where=f"log {log}",
                expected="a wind well below the airspeed",
                found=f"{wind:.3g} m/s at {speed:.3g} m/s of airspeed",
                do="Check the signs and units of v_north, v_east, psi and V.",
            )
        )
    for what, words in INERTIAL.items():
        if found.inertial.get(what):
            out.append(
                warn(
                    f"inertial_{what}",
                    where=f"log {log}, inertial samples",
                    expected="finite samples, one after another, without holes",
                    found=f"{found.inertial[what]} {words}",
                    do="Nothing has to be done: refused, or bridged with growing variances.",
                )
            )
    return out


def report_of_navigation(done: NavigationJob, date: str, seed: int | None) -> ReportInput:
    """What the report shows of it."""
    from alula.base.provenance import provenance

    project = done.checked.project
    return ReportInput(
        name=project.name,
        path=str(project.path),
        date=date,
        cards=done.checked.cards,
        maneuvers=(),
        navigation=done.found,
        messages=done.all_messages(),
        provenance=provenance(seed),
    )
