"""The windows of a project checked against its logs."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from alula.base.messages import BadInput, Message, note, warn
from alula.base.project import ManeuverSpec, Project
from alula.flight import Flight, Maneuver, gaps_within, split_at_gaps
from alula.flight.gaps import describe

LEAST = 10  # samples of the fastest channel: fewer are a slip in the window, not a maneuver


def maneuvers(
    project: Project, flights: Mapping[str, Flight]
) -> tuple[tuple[Maneuver, ...], tuple[Message, ...]]:
    """The project's maneuvers, split at gaps where they ask for it, and what there is to say.

    Raises BadInput, with all that is wrong, for a window outside its log, for one across a gap
    unless on_gap = 'split', and for a held-out window that shares samples with one that is not.
    Other windows that overlap are a warning (samples that serve the same part of the model count
    twice there), or a note where one is longitudinal and the other lateral.
    """
    out: list[Maneuver] = []
    messages: list[Message] = []
    problems: list[Message] = []
    for spec in project.maneuvers:
        flight = flights[spec.log]
        maneuver = Maneuver(
            id=spec.id,
            log=spec.log,
            kind=spec.kind,
            start=spec.start,
            end=spec.end,
            aspect=spec.aspect,
            configuration=dict(spec.configuration),
            held_out=spec.held_out,
        )
        outside = _outside(spec, flight)
        if outside is not None:
            problems.append(outside)
            continue
        parts, said, problem = _at_gaps(spec, maneuver, flight)
        messages += said
        if problem is not None:
            problems.append(problem)
        out += parts
    for a, b in combinations(project.maneuvers, 2):
        message = _overlap(a, b)
        if message is not None:
            (problems if message.level == "error" else messages).append(message)
    if problems:
        raise BadInput(*problems)
    return tuple(out), tuple(messages)


def _outside(spec: ManeuverSpec, flight: Flight) -> Message | None:
    where = f"maneuver {spec.id}"
    # Half a sample of rounding in a window's ends is no mistake.
    slack = 0.5 / max((c.rate for c in flight.channels.values() if len(c.t) > 2), default=1.0)
    if spec.start < flight.start - slack or spec.end > flight.end + slack:
        return Message(
            "window_outside_log",
            "error",
            where,
            f"a window within log {spec.log}: {flight.start:.6g} to {flight.end:.6g} s",
            f"{spec.start:.6g} to {spec.end:.6g} s",
            "Correct start and end; they are in the log's own time.",
        )
    most = max(samples(flight, name, spec.start, spec.end) for name in flight.channels)
    if most < LEAST:
        return Message(
            "too_few_samples",
            "error",
            where,
            f"{LEAST} samples or more of some channel",
            f"{most} from {spec.start:.6g} to {spec.end:.6g} s",
            "Make the window longer.",
        )
    return None


def samples(flight: Flight, name: str, start: float, end: float) -> int:
    """Number of valid samples of a channel within a window."""
    channel = flight[name]
    inside = (channel.t >= start) & (channel.t <= end)
    return int(np.isfinite(channel.values[inside]).sum())


def _at_gaps(
    spec: ManeuverSpec, maneuver: Maneuver, flight: Flight
) -> tuple[tuple[Maneuver, ...], list[Message], Message | None]:
    found = gaps_within(flight, spec.start, spec.end)
    if not found:
        return (maneuver,), [], None
    where = f"maneuver {spec.id}"
    names = sorted({name for gap in found for name in gap.channels})
    shown = ", ".join(names[:6]) + (" ..." if len(names) > 6 else "")
    what = f"{len(found)} gaps ({describe(found)}) in {shown}"
    expected = "samples without a gap (over 3 times the usual interval)"
    if spec.on_gap == "refuse":
        do = "Shorten the window, remove the channel, or write on_gap = 'split'."
        return (), [], Message("gap_in_maneuver", "error", where, expected, what, do)
    parts = tuple(
        p
        for p in split_at_gaps(flight, maneuver)
        if max(samples(flight, name, p.start, p.end) for name in flight.channels) >= LEAST
    )
    if not parts:
        do = "Shorten the window or map a faster channel."
        return (), [], Message("gap_in_maneuver", "error", where, expected, what, do)
    kept = ", ".join(f"{p.id} {p.start:.6g} to {p.end:.6g} s" for p in parts)
    said = note(
        "split_at_gaps",
        where=where,
        expected=expected,
        found=what,
        do=f"Split as asked into {kept}; parts of under {LEAST} samples are left out.",
    )
    return parts, [said], None


def _overlap(a: ManeuverSpec, b: ManeuverSpec) -> Message | None:
    start, end = max(a.start, b.start), min(a.end, b.end)
    if a.log != b.log or end <= start:
        return None
    where = f"maneuvers {a.id}, {b.id}"
    found = f"{start:.6g} to {end:.6g} s of log {a.log} in both"
    if {a.aspect, b.aspect} == {"longitudinal", "lateral"}:
        return note(
            "overlapping_windows",
            where=where,
            expected="windows apart",
            found=found,
            do="Nothing: one is longitudinal, the other lateral.",
        )
    if a.held_out != b.held_out:
        return Message(
            "overlapping_windows",
            "error",
            where,
            "held-out samples that the estimate never sees",
            found,
            "Move one of the windows.",
        )
    return warn(
        "overlapping_windows",
        where=where,
        expected="windows apart",
        found=found,
        do="Move one of them: samples that count twice make error bars too small.",
    )
