"""`alula navigate PROJECT`: attitude, velocity, position and wind of a project's logs."""

from __future__ import annotations

from enum import StrEnum
from functools import partial
from math import degrees
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.contract import (
    Command,
    JsonOption,
    ProjectArgument,
    QuietOption,
    ReportOption,
    SeedOption,
    ThreadsOption,
    writable,
)

if TYPE_CHECKING:
    from alula.campaign.navigate import NavigationJob
    from alula.navigate import Navigation


class NavigationFilter(StrEnum):
    """The filters of `alula.navigate`."""

    joint = "joint"
    pair = "pair"


def navigate(
    project: ProjectArgument,
    log: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="Only this log; may be repeated.")
    ] = None,
    filter: Annotated[
        NavigationFilter | None, typer.Option(help="Instead of the project's.")
    ] = None,
    report: ReportOption = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Filter a project's logs: attitude, velocity, position, sensor biases, wind.

    Exit 0: done. 1: a sensor contradicts the others. 2: bad input.
    """
    command = Command("navigation", json, seed, threads, quiet)
    with command.run():
        writable(report, "report")
        from alula.campaign.navigate import report_of_navigation, run_navigation

        done = run_navigation(
            str(project),
            filter=None if filter is None else filter.value,
            logs=log or (),
            progress=command.progress,
        )
        command.messages = done.all_messages()
        command.inputs = done.checked.files
        command.timing = done.seconds
        command.result = {"logs": [result_of(name, done) for name in done.found]}
        if done.failed:
            command.status = "check_failed"
        if report is not None:
            command.write_report(report, partial(report_of_navigation, done))
        command.say("\n".join(text_of(name, done) for name in done.found))
        command.written(Report=report)


def result_of(name: str, done: NavigationJob) -> dict[str, Any]:
    """One log of the envelope's `result`."""
    found = done.found[name]
    se = degrees(1.0) * found.se("euler")[-1]
    return {
        "log": name,
        "filter": found.filter,
        "start": float(found.t[0]),
        "end": float(found.t[-1]),
        "inertial": dict(found.inertial),
        "last": {
            "attitude_deg": [degrees(a) for a in found.euler[-1]],
            "attitude_se_deg": [float(s) for s in se],
            "gyro_bias_deg_s": [degrees(b) for b in found.gyro_bias[-1]],
            "force_bias": [float(b) for b in found.force_bias[-1]],
            "wind": wind_of(found),
            "wind_se": wind_se(found),
        },
        "sensors": [
            {"kind": s.kind, "counts": dict(s.counts), "nis": s.mean_nis} for s in found.takings
        ],
        "attitude_difference_deg": {
            k: degrees(v) for k, v in done.attitude_difference[name].items()
        },
    }


def wind_of(found: Navigation) -> list[float]:
    """Wind without turbulence at the end, NED; not a number from the pair, which has none."""
    return [float(w) for w in found.steady[-1]]


def wind_se(found: Navigation) -> list[float]:
    """Its standard errors."""
    if "wind" not in found.states:
        return [float("nan")] * 3
    here = found.states["wind"]
    return [float(v) ** 0.5 for v in found.covariance[-1, here, here].diagonal()]


def text_of(name: str, done: NavigationJob) -> str:
    """What the command prints of one log."""
    found = done.found[name]
    values = zip(("phi", "theta", "psi"), found.euler[-1], found.se("euler")[-1], strict=True)
    at_end = ", ".join(f"{n} {degrees(v):.2f} ± {degrees(s):.2f}" for n, v, s in values)
    lines = [
        f"{name}: {found.filter} filter, {found.t[0]:.5g} to {found.t[-1]:.5g} s",
        f"  at the end   {at_end} deg",
    ]
    if "wind" in found.states:
        parts = zip(("north", "east", "down"), wind_of(found), wind_se(found), strict=True)
        wind = ", ".join(f"{n} {v:.2f} ± {s:.2f}" for n, v, s in parts)
        lines.append(f"  wind         {wind} m/s")
    for s in found.takings:
        others = ", ".join(f"{n} {k.replace('_', ' ')}" for k, n in s.counts.items())
        nis = "" if s.mean_nis != s.mean_nis else f", NIS {s.mean_nis:.2f}"
        lines.append(f"  {s.kind:<12} {others}{nis}")
    difference = done.attitude_difference[name]
    if difference:
        words = ", ".join(f"{k} {degrees(v):.2f}" for k, v in difference.items())
        lines.append(f"  estimate minus recorded, rms of the second half: {words} deg")
    return "\n".join(lines)
