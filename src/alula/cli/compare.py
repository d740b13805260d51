"""`alula compare SOURCE...`: methods, data, models and predictions side by side."""

from __future__ import annotations

from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.compare_output import text_of
from alula.cli.contract import Command, JsonOption, QuietOption, SeedOption, ThreadsOption
from alula.cli.predict import HeightOption, Method, SpeedOption

if TYPE_CHECKING:
    from alula.campaign.compare import Comparison
    from alula.identify.compare import Row


def compare(
    results: Annotated[
        list[Path],
        typer.Argument(
            metavar="SOURCE...",
            help="Results and predictions (--json), models, aircraft files (predicted now), AVL's "
            "ST or SB output, Digital Datcom's, tables; set against the first.",
        ),
    ],
    project: Annotated[
        Path | None,
        typer.Option(metavar="PROJECT", help="Judge each on this project's held-out maneuvers."),
    ] = None,
    limit: Annotated[
        float | None,
        typer.Option(
            metavar="SIGMAS",
            min=0.0,
            help="Exit 1 where a parameter differs by more combined standard errors.",
        ),
    ] = None,
    method: Annotated[
        list[Method] | None,
        typer.Option(help="How aircraft files are predicted, a column each; default combined."),
    ] = None,
    V: SpeedOption = None,
    h: HeightOption = 0.0,
    alpha_deg: Annotated[
        float | None,
        typer.Option(
            "--alpha-deg",
            metavar="DEG",
            help="Of predictions, of Datcom's table, and where a source in stability axes states "
            "none.",
        ),
    ] = None,
    origin: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z",
            help="Origin of AVL's and Datcom's axes: m, body axes from the aircraft's datum.",
        ),
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Set sources side by side, parameter by parameter, in one convention.

    Exit 0: done. 1: some parameter is not identifiable in one of them, or differs by more than
    --limit. 2: bad input.
    """
    command = Command("comparison", json, seed, threads, quiet)
    with command.run():
        from alula.campaign.compare import run_comparison
        from alula.campaign.predict import Asked

        alpha = None if alpha_deg is None else radians(alpha_deg)
        found = run_comparison(
            results,
            project=None if project is None else str(project),
            methods=[m.value for m in method or ()],
            asked=Asked(V=V, h=h, alpha=alpha),
            alpha=alpha,
            origin=_origin(origin),
            seed=seed,
            progress=command.progress,
        )
        far = [] if limit is None else [r for r in found.rows if r.widest > limit]
        command.messages = [*found.messages, *_apart(far, limit)]
        command.inputs = found.files
        command.result = result_of(found, limit)
        lost = any(
            e.verdict == "not_identifiable"
            for s in found.sources
            for e in s.column.entries.values()
        )
        if lost:
            command.status = "not_identifiable"
        elif far:
            command.status = "check_failed"
        command.say(text_of(found))


def _origin(text: str | None) -> Any:
    if text is None:
        return None
    import numpy as np

    from alula.base.messages import refuse

    try:
        found = np.array([float(x) for x in text.split(",")])
    except ValueError:
        found = np.empty(0)
    if found.shape != (3,) or not np.all(np.isfinite(found)):
        raise refuse(
            "usage",
            where="--origin",
            expected="three numbers, m: --origin 0.375,0,0",
            found=f"'{text}'",
            do="Correct it.",
        )
    return found


def _apart(rows: list[Row], limit: float | None) -> list[Any]:
    from alula.base.messages import warn

    if not rows or limit is None:
        return []
    names = ", ".join(f"{r.name} ({r.widest:.3g})" for r in rows)
    return [
        warn(
            "results_differ",
            where="--limit",
            expected=f"differences up to {limit:g} combined standard errors",
            found=names,
            do="One of the results is biased or its error bars are too narrow: compare their "
            "residuals, and fly a maneuver that excites these.",
        )
    ]


def result_of(found: Comparison, limit: float | None) -> dict[str, Any]:
    """The envelope's `result`."""
    return {
        "limit": limit,
        "columns": [
            {
                "name": s.column.name,
                "path": s.file.path,
                "sha256": s.file.sha256,
                "kind": s.column.kind,
                "method": s.column.method,
                "uncertainty": s.column.se_is,
                "status": s.column.status,
            }
            for s in found.sources
        ],
        "parameters": [
            {
                "name": row.name,
                "unit": row.unit,
                "entries": [
                    None
                    if d is None
                    else {
                        "value": d.entry.value,
                        "se": d.entry.se,
                        "verdict": d.entry.verdict,
                        "ratio": d.ratio,
                        "ratio_ci95": list(d.ratio_ci95),
                        "difference": d.difference,
                        "sigmas": d.sigmas,
                    }
                    for d in row.differences
                ],
            }
            for row in found.rows
        ],
        "maneuvers": [
            {"id": m.id, "held_out": m.held_out, "seen_by_estimate": list(found.seen[m.id])}
            for m in found.maneuvers
        ],
        "judged": {
            c: {
                "n": found.samples[c],
                "entries": [None if j is None else {"r2": j.r2, "rrmse": j.rrmse} for j in every],
            }
            for c, every in found.judged.items()
        },
    }
