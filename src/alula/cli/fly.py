"""`alula fly PLAN`: a virtual flight test, written as logs with the truth beside them."""

from __future__ import annotations

from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.contract import Command, JsonOption, QuietOption, SeedOption

if TYPE_CHECKING:
    from alula.simulate.virtual_campaign import Campaign


def fly(
    plan: Annotated[Path, typer.Argument(metavar="PLAN", help="The plan file.")],
    out: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Where to; default: PLAN's name without .toml, here."),
    ] = None,
    sample: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            help="Fly the N-th aircraft drawn from the aircraft file's [uncertainty].",
        ),
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: Annotated[
        int,
        typer.Option(
            metavar="N", min=0, help="Maneuvers flown side by side; 0: one per processor."
        ),
    ] = 0,
    quiet: QuietOption = False,
) -> None:
    """Fly a plan of maneuvers; write logs, truth and project.

    Exit 0: all of them flown. 1: some do not trim or diverge; they are named. 2: bad input.
    """
    command = Command("flight", json, seed, quiet=quiet)
    with command.run():
        from alula.cli.condition import source_of
        from alula.simulate.virtual_campaign import fly_plan
        from alula.simulate.virtual_plan import load_plan

        asked = load_plan(plan)
        command.seed = asked.seed if seed is None else seed
        folder = out or Path(plan.name).with_suffix("")
        command.inputs = [source_of(plan)]
        found = fly_plan(
            asked, folder, seed=seed, threads=threads, sample=sample, progress=command.progress
        )
        command.messages = [
            *found.messages,
            *(message for messages in found.failed.values() for message in messages),
        ]
        command.timing = found.seconds
        command.result = result_of(found)
        command.status = "check_failed" if found.failed else "ok"
        command.say(text_of(found))


def result_of(found: Campaign) -> dict[str, Any]:
    """The envelope's `result`. Angles in degrees where the name says so, else SI."""
    return {
        "folder": str(found.folder),
        "project": str(found.project),
        "constants": dict(found.constants),
        "maneuvers": [
            {
                "id": w.plan.maneuver.id,
                "kind": w.plan.maneuver.kind,
                "aspect": w.plan.maneuver.aspect,
                "loading": w.plan.loading,
                "condition": w.plan.condition.id,
                "V": w.plan.condition.V,
                "h": w.plan.condition.h,
                "samples": w.samples,
                "duration_s": w.plan.maneuver.end,
                "trim": {
                    "alpha_deg": degrees(w.trim.alpha),
                    "theta_deg": degrees(w.trim.theta),
                    "de_deg": degrees(w.trim.controls["de"]),
                    "thrust": w.trim.thrust,
                },
                "files": [{"path": f.name, "bytes": f.bytes, "sha256": f.sha256} for f in w.files],
            }
            for w in found.maneuvers
        ],
        "failed": [
            {"id": id, "reasons": [m.code for m in messages]}
            for id, messages in found.failed.items()
        ],
    }


def text_of(found: Campaign) -> str:
    """What the command prints."""
    seconds = sum(w.plan.maneuver.end for w in found.maneuvers)
    size = sum(f.bytes for w in found.maneuvers for f in w.files)
    count = len(found.maneuvers)
    lines = [
        f"{count} maneuver{'s' * (count != 1)} flown, {seconds:.0f} s in the air, "
        f"{size / 1e6:.1f} MB in {found.folder}",
    ]
    if found.failed:
        lines.append(f"{len(found.failed)} not flown: {', '.join(found.failed)}")
    lines += [
        "  logs/    each maneuver as CSV and Parquet, with the sensors' errors",
        "  truth/   what really happened; truth.json: derivatives and the sensors' errors",
        f"next: alula identify {found.project} --truth {found.folder / 'truth.json'}",
    ]
    return "\n".join(lines)
