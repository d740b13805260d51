"""`alula airdata PROJECT`: errors of the air data from the flight itself, wind along."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    SeedOption,
    ThreadsOption,
    writable,
)

if TYPE_CHECKING:
    from alula.base.project import LogSpec, Project


def airdata(
    project: Annotated[Path, typer.Argument(metavar="PROJECT", help="The project file.")],
    log: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="Only this log; several times.")
    ] = None,
    start: Annotated[
        float | None, typer.Option(metavar="S", help="Time of the log to begin at.")
    ] = None,
    end: Annotated[float | None, typer.Option(metavar="S", help="Time to end at.")] = None,
    report: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a page, HTML.")] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Calibrate air data in flight: airspeed scale, upwash, vane bias, static error, wind.

    Any maneuvering flight with GPS velocity and attitude will do. Exit 0: done. 1: the flight does
    not determine something, which is named. 2: bad input.
    """
    command = Command("airdata", json, seed, threads, quiet)
    with command.run():
        if report is not None:
            writable(report, "report")
        from alula.airdata.inflight import calibrate_in_flight
        from alula.airdata.inflight_record import record_of
        from alula.base.messages import refuse
        from alula.base.project import load_project
        from alula.logs.reader import read

        loaded = load_project(project)
        known = [one.id for one in loaded.logs]
        unknown = [id for id in log or [] if id not in known]
        if unknown:
            raise refuse(
                "unknown_log",
                where="alula airdata --log",
                expected=f"one of {', '.join(known)}",
                found=", ".join(unknown),
                do="Name a log of this project.",
            )
        found, messages, files = {}, [], []
        for spec in loaded.logs:
            if log and spec.id not in log:
                continue
            command.progress(f"reading {spec.id}")
            flight = read(spec, loaded.channels_of(spec))
            files += list(flight.files)
            messages += list(flight.messages)
            record = record_of(flight, start, end, arms=_arms(loaded, spec))
            command.progress(f"calibrating by {spec.id}")
            found[spec.id] = calibrate_in_flight(record)
            messages += list(found[spec.id].messages)
        command.inputs, command.messages = files, messages
        command.status = (
            "ok" if all(one.determined for one in found.values()) else "not_identifiable"
        )
        command.result = {
            "logs": [{"id": id, **one.as_dict()} for id, one in found.items()],
        }
        for id, one in found.items():
            command.say(f"Log {id}: reading = (1 + k) truth + b\n{one.summary()}")
            if not one.rich:
                command.say("Not rich enough: airspeed error and wind are not told apart.")
        if report is not None:
            from alula.base.files import write_whole
            from alula.report.air_data_page import air_data_page

            write_whole(report, air_data_page(loaded.name, found))
            command.say(f"Report: {report}")


def _arms(project: Project, log: LogSpec) -> dict[str, tuple[float, float, float]]:
    """Where the sensors sit from the center of gravity, m; nothing without an aircraft file."""
    path = log.aircraft or project.aircraft
    if path is None:
        return {}
    import numpy as np

    from alula.aircraft import load_aircraft

    aircraft = load_aircraft(path)
    center = aircraft.mass_properties(np.zeros(1)).cg[0] if aircraft.mass else None
    if center is None:
        return {}
    channels = {"V": "V", "alpha": "alpha", "beta": "beta", "gps": "v_north", "imu": "ax"}
    out = {}
    for name, channel in channels.items():
        x, y, z = (float(k) for k in aircraft.sensor_position(channel) - center)
        if x or y or z:
            out[name] = (x, y, z)
    return out
