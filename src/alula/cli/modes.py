"""`alula modes AIRCRAFT`: the natural motions, and what specifications make of them."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.condition import Asked, Kind, at_condition, load, trim_result
from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    SeedOption,
    ThreadsOption,
    writable,
)

if TYPE_CHECKING:
    from alula.simulate import Judgment, Mode


class Against(StrEnum):
    """Specifications."""

    mil = "mil"
    cs23 = "cs23"
    cs25 = "cs25"


_EDITIONS = {Against.mil: "MIL-F-8785C", Against.cs23: "CS-23", Against.cs25: "CS-25"}


@at_condition
def modes(
    asked: Asked,
    against: Annotated[
        list[Against] | None,
        typer.Option(help="Fail (exit 1) what this one asks and the modes miss; several times."),
    ] = None,
    aircraft_class: Annotated[
        str, typer.Option("--class", metavar="CLASS", help="MIL-F-8785C: I, II, III or IV.")
    ] = "I",
    category: Annotated[
        str, typer.Option(metavar="CATEGORY", help="MIL-F-8785C flight phase: A, B or C.")
    ] = "B",
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the s-plane there, as SVG.")
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Short period, phugoid, Dutch roll, roll, spiral, against MIL-F-8785C, CS-23 and CS-25.

    Exit 0: done. 1: a specification named by --against is missed. 2: bad input.
    """
    command = Command("modes", json, seed, threads, quiet)
    with command.run():
        writable(plot, "picture")
        from alula.simulate import judge, modes_of

        loaded = load(asked)
        found = loaded.trimmed()
        linear = loaded.linear(found)
        motion = linear.motion()
        roots = modes_of(motion, asked.V)
        turns = asked.kind in (Kind.turn, Kind.pull_up)
        not_straight = f"in a {asked.kind.value}" if turns else ""
        judged = judge(
            roots, motion, asked.V, asked.h,
            aircraft_class=aircraft_class, category=category, not_straight=not_straight,
        )  # fmt: skip
        missed = _missed(judged, against or ())
        command.inputs = loaded.files
        command.messages = [*loaded.aircraft.messages, *found.messages, *missed]
        command.status = "check_failed" if missed else "ok"
        command.result = {
            "trim": trim_result(found),
            "unsteady": linear.unsteady,
            **modes_result(roots, judged, motion, asked.V),
            "class": aircraft_class,
            "category": category,
        }
        if plot is not None:
            from alula.base.files import write_whole
            from alula.report.s_plane import s_plane

            title = f"{loaded.aircraft.name}, {loaded.condition.words}"
            write_whole(plot, s_plane(roots, title, alone=True) + "\n")
        command.say(f"{loaded.aircraft.name}, {loaded.condition.words}\n{text_of(roots, judged)}")
        command.written(Picture=plot)


def modes_result(
    roots: Sequence[Mode], judged: Sequence[Judgment], linear: Any, V: float
) -> dict[str, Any]:
    """The envelope's `result`: SI, rad; null where a mode has no such number."""
    from alula.simulate.handling import load_factor_per_alpha

    return {
        "modes": [
            {
                "name": m.name,
                "family": m.family,
                "form": m.form,
                "eigenvalue": [m.eigenvalue.real, m.eigenvalue.imag],
                "frequency": m.frequency,
                "damping": m.damping,
                "period": m.period,
                "time_constant": m.time_constant,
                "time_to_half": m.time_to_half,
                "time_to_double": m.time_to_double,
                "cycles_to_tenth": _known(m.cycles_to_tenth),
                "participation": m.participation,
            }
            for m in roots
        ],
        "n_alpha": load_factor_per_alpha(linear, V),
        "requirements": [
            {
                "edition": j.edition,
                "paragraph": j.paragraph,
                "requirement": j.requirement,
                "mode": j.mode,
                "value": _known(j.value),
                "unit": j.unit,
                "limits": j.limits,
                "verdict": j.verdict,
                "why": j.why,
            }
            for j in judged
        ],
    }


def _known(value: float | None) -> float | None:
    """None for an infinite number of cycles: they never end."""
    return value if value is not None and isfinite(value) else None


def _missed(judged: Sequence[Judgment], against: Sequence[Against]) -> list[Any]:
    from alula.base.messages import warn

    wanted = tuple(_EDITIONS[a] for a in against)
    return [
        warn(
            "requirement_missed",
            where=f"{j.edition}, {j.paragraph}",
            expected=f"{j.requirement}: {j.limits}",
            found=f"{j.verdict}" + ("" if j.value is None else f", {j.value:.4g} {j.unit}"),
            do="Look at the mode's derivatives, or at another flight condition.",
        )
        for j in judged
        if wanted and j.edition.startswith(wanted) and j.verdict in ("not met", "below level 3")
    ]


def text_of(roots: Sequence[Mode], judged: Sequence[Judgment]) -> str:
    """What the command prints."""
    lines = [
        f"{'mode':<26}{'root, 1/s':>22}{'rad/s':>9}{'damping':>9}{'period s':>10}"
        f"{'half s':>9}{'double s':>9}"
    ]
    for m in roots:
        root = f"{m.eigenvalue.real:.4g}"
        if m.eigenvalue.imag:
            root += f" ± {m.eigenvalue.imag:.4g}i"
        numbers = (
            (m.frequency, 9), (m.damping, 9), (m.period, 10), (m.time_to_half, 9),
            (m.time_to_double, 9),
        )  # fmt: skip
        row = "".join(f"{'–' if v is None else f'{v:.4g}':>{w}}" for v, w in numbers)
        lines.append(f"{m.words:<26}{root:>22}{row}")
    edition = ""
    for j in judged:
        if j.edition != edition:
            edition = j.edition
            lines += ["", edition]
        known = _known(j.value)
        unit = "" if j.unit == "1" else f" {j.unit}"
        value = "–" if known is None else f"{known:.4g}{unit}"
        lines.append(f"  {j.paragraph:<10} {j.verdict:<14} {value:<14} {j.requirement}")
        lines.append(f"  {'':<26}{j.why or j.limits}")
    return "\n".join(lines)
