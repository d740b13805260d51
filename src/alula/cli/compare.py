"""`alula compare SOURCE...`: methods, data, models and predictions side by side."""

from __future__ import annotations

import math
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.contract import Command, JsonOption, QuietOption, SeedOption, ThreadsOption
from alula.cli.predict import HeightOption, Method, SpeedOption

if TYPE_CHECKING:
    from alula.campaign.compare import Comparison
    from alula.identify.compare import Difference, Row


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


def text_of(found: Comparison) -> str:
    """The columns with a number each, the parameters, and how each predicts."""
    lines = []
    for i, s in enumerate(found.sources, start=1):
        words = f"{i}  {s.column.name}: {s.column.method}"
        lines.append(words + (f"; se: {s.column.se_is}" if s.column.se_is else ""))
    lines += ["", _header(found), "-" * len(_header(found))]
    shown = [r for r in found.rows if not _own(r)]
    lines += [_line(found, row) for row in shown]
    if len(shown) < len(found.rows):
        lines.append(
            f"{len(found.rows) - len(shown)} initial states and biases that stand in one column "
            "alone: see --json."
        )
    lines.append(
        "ratio, its 95 % interval and the difference are to column 1; the difference is in "
        "combined se."
    )
    if any(_starred(d) for r in shown for d in r.differences):
        lines.append("* the rate's derivative alone, beside sums with the lag's.")
    if found.judged:
        ids = ", ".join(m.id for m in found.maneuvers)
        held = all(m.held_out for m in found.maneuvers)
        lines += ["", f"On {'held-out ' if held else ''}maneuvers {ids}:"]
        head = f"{'coefficient':<14}{'samples':>9}"
        head += "".join(f"{f'R2 ({i})':>11}{'RRMSE':>9}" for i in range(1, len(found.sources) + 1))
        lines += [head, "-" * len(head)]
        for c, every in found.judged.items():
            cells = "".join(
                f"{'-':>11}{'-':>9}" if j is None else f"{j.r2:>11.4f}{j.rrmse:>9.2%}"
                for j in every
            )
            lines.append(f"{c:<14}{found.samples[c]:>9d}{cells}")
        for i, s in enumerate(found.sources):
            saw = [id for id, words in found.seen.items() if words[i] != "no"]
            if saw:
                sure = all(found.seen[id][i] == "yes" for id in saw)
                lines.append(
                    f"{s.column.name} {'learned' if sure else 'may have learned'} from "
                    f"{', '.join(saw)}: no validation there"
                )
    return "\n".join(lines)


def _starred(d: Difference | None) -> bool:
    return d is not None and d.entry.verdict == "alone"


def _own(row: Row) -> bool:
    """Whether it is a nuisance of one result: an initial state or bias of a maneuver."""
    alone = sum(d is not None for d in row.differences) == 1
    return alone and ("(0)[" in row.name or row.name.startswith("b_"))


def _wide(found: Comparison) -> int:
    return max([12, *(len(r.name) + 1 for r in found.rows if not _own(r))])


def _header(found: Comparison) -> str:
    out = f"{'parameter':<{_wide(found)}}"
    for i in range(1, len(found.sources) + 1):
        out += f"{f'value ({i})':>12}{'se':>10}"
        if i > 1:
            out += f"{'ratio':>8}{'95 %':>17}{'diff/se':>9}"
    return out


def _line(found: Comparison, row: Row) -> str:
    out = f"{row.name:<{_wide(found)}}"
    for i, d in enumerate(row.differences):
        rest = i > 0
        if d is None:
            out += f"{'-':>12}{'-':>10}" + (f"{'-':>8}{'-':>17}{'-':>9}" if rest else "")
            continue
        e = d.entry
        if e.verdict == "not_identifiable":
            out += f"{'not ident.':>12}{'-':>10}"
        else:
            value = f"{e.value:.5g}" + ("*" if _starred(d) else "")
            out += f"{value:>12}" + (f"{e.se:>10.2g}" if math.isfinite(e.se) else f"{'-':>10}")
        if rest:
            # + 0.0: no minus before a zero
            out += f"{d.ratio + 0.0:>8.3f}" if math.isfinite(d.ratio) else f"{'-':>8}"
            low, high = d.ratio_ci95
            out += f"{f'{low:.2f} to {high:.2f}' if math.isfinite(low) else '-':>17}"
            out += f"{d.sigmas:>+9.2f}" if math.isfinite(d.sigmas) else f"{'-':>9}"
    return out
