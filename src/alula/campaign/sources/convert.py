"""Every column in one convention, said what was converted and what could not be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse, warn
from alula.campaign.sources.conventions import to_body_axes, to_point, to_reference
from alula.campaign.sources.stated import Stated
from alula.identify.compare import Column, Entry
from alula.model import Reference

_SAME = 1e-6  # of a length
_UNIT = 0.01  # of a ratio of lengths: rounding of a reference that is only in another unit


@dataclass(frozen=True)
class Frame:
    """What coefficients refer to; None where a source does not say. point: (3,) m, datum."""

    reference: Reference | None = None
    point: Array | None = None


def convert(
    columns: Sequence[Column],
    frames: Sequence[Frame],
    stated: Sequence[Stated | None],
    *,
    alpha: float | None = None,
    origin: Array | None = None,
) -> tuple[list[Column], list[Message]]:
    """Columns along body axes, on the first known reference, about the first known point.

    stated: of those that are neither results nor models. alpha: rad, for sources that state none.
    origin: (3,) m, of AVL's and Datcom's axes, from the aircraft's datum. Raises BadInput for a
    point beside the plane of symmetry.
    """
    out, said = [], []
    for s in stated:
        said += list(s.messages) if s is not None else []
    reference = next((f.reference for f in frames if f.reference is not None), None)
    # A program's own axes are not the datum's: they say where only with an origin.
    placed = [_placed(f, s, reference, origin) for f, s in zip(frames, stated, strict=True)]
    point = next((p for p in placed if p is not None), None)
    for column, frame, own, s in zip(columns, frames, placed, stated, strict=True):
        entries = dict(column.entries)
        at = alpha if s is None or s.alpha is None else s.alpha
        if s is not None and s.axes == "stability":
            entries, more = _turned(entries, column.name, at)
            said += more
        if frame.reference is not None and reference is not None:
            entries, more = _scaled(entries, column, frame.reference, reference)
            said += more
        if own is not None and point is not None and reference is not None:
            entries, more = _moved(entries, column.name, own - point, reference, at or 0.0)
            said += more
        elif s is not None and point is not None and own is None:
            said.append(_taken(column.name, s))
        out.append(replace(column, entries=entries))
    return out, said + _force_axes(out)


def _placed(
    frame: Frame, s: Stated | None, reference: Reference | None, origin: Array | None
) -> Array | None:
    if s is None or s.aft is None:
        return frame.point
    if origin is None:
        return None
    x, y, z = s.aft
    unit = 1.0
    if s.reference is not None and reference is not None:
        unit = _unit(s.reference, reference) or 1.0
    return np.asarray(origin) + np.array([-x, y, -z]) / unit


def _turned(
    entries: Mapping[str, Entry], name: str, alpha: float | None
) -> tuple[dict[str, Entry], list[Message]]:
    if alpha is None:
        lateral = [n for n in entries if n.split("_")[0] in ("Cl", "Cn")]
        if not lateral:
            return dict(entries), []
        return {n: e for n, e in entries.items() if n not in lateral}, [
            warn(
                "axes_not_converted",
                where=name,
                expected="an angle of attack, to turn stability axes to body axes",
                found=f"none; left out: {', '.join(lateral)}",
                do="State alpha_deg in the file, or --alpha-deg.",
            )
        ]
    turned, lost = to_body_axes(entries, alpha)
    said = [
        note(
            "axes_converted",
            where=name,
            expected="rates and moments along body axes",
            found="along stability axes",
            do=f"Turned by its angle of attack, {np.degrees(alpha):.4g} deg.",
        )
    ]
    if lost:
        said.append(
            warn(
                "axes_not_converted",
                where=name,
                expected="both moments and both rates, to turn stability axes to body axes",
                found=f"one of them only; left out: {', '.join(lost)}",
                do="Give the other ones, or the values along body axes.",
            )
        )
    return turned, said


def _unit(old: Reference, new: Reference) -> float | None:
    """Their ratio, if all of S, b, c have it: the same aircraft in another unit."""
    k = old.b / new.b
    same = abs(old.c / new.c / k - 1.0) < _UNIT and abs(old.S / new.S / k**2 - 1.0) < _UNIT
    return k if same else None


def _scaled(
    entries: dict[str, Entry], column: Column, old: Reference, new: Reference
) -> tuple[dict[str, Entry], list[Message]]:
    apart = max(abs(old.S / new.S - 1.0), abs(old.b / new.b - 1.0), abs(old.c / new.c - 1.0))
    if apart < _SAME:
        return entries, []
    words = f"S {old.S:g}, b {old.b:g}, c {old.c:g}"
    aim = f"S {new.S:g} m2, b {new.b:g} m, c {new.c:g} m"
    k = _unit(old, new)
    if k is not None and column.kind in ("avl", "datcom") and abs(k - 1.0) > _UNIT:
        do = f"Taken as the same aircraft in a unit of {1.0 / k:.4g} m; nothing was converted."
        return entries, [note("other_unit", where=column.name, expected=aim, found=words, do=do)]
    do = "Coefficients and hats were converted."
    said = note("reference_converted", where=column.name, expected=aim, found=words, do=do)
    return to_reference(entries, old, new), [said]


def _moved(
    entries: dict[str, Entry], name: str, step: Array, reference: Reference, alpha: float
) -> tuple[dict[str, Entry], list[Message]]:
    if float(np.max(np.abs(step))) < _SAME * reference.c:
        return entries, []
    words = "({:.5g}, {:.5g}, {:.5g}) m".format(*step)
    if abs(step[1]) > _SAME * reference.b:
        raise refuse(
            "moment_point",
            where=name,
            expected="moments about a point in the plane of symmetry, as the first source's",
            found=f"one {words} from it",
            do="State the values about a point in that plane.",
        )
    moved, lost = to_point(entries, step, reference, alpha)
    said = [
        note(
            "moment_point_converted",
            where=name,
            expected="moments and rates about the first source's point",
            found=f"about one {words} from it, body axes",
            do="They were transferred.",
        )
    ]
    if lost:
        said.append(
            warn(
                "moment_point_not_converted",
                where=name,
                expected="the force's derivative beside each moment's, to transfer it",
                found=f"none; left out: {', '.join(lost)}",
                do="Give the derivatives of lift and side force as well.",
            )
        )
    return moved, said


def _taken(name: str, s: Stated) -> Message:
    if s.aft is None:
        found, do = "none stated", "State point = [x, y, z], m, body axes from the datum."
    else:
        found = "({:g}, {:g}, {:g}) in axes of its own, x aft".format(*s.aft)
        do = "--origin X,Y,Z (m, body axes from the datum) says where their origin is."
    return note(
        "moment_point_taken",
        where=name,
        expected="the point of its moments in the aircraft's axes",
        found=found,
        do=f"Taken to be the first source's point. {do}",
    )


def _force_axes(columns: Sequence[Column]) -> list[Message]:
    body = [c.name for c in columns if any(n.startswith(("CX_", "CZ_")) for n in c.entries)]
    wind = [c.name for c in columns if any(n.startswith(("CL_", "CD_")) for n in c.entries)]
    alone = [n for n in body if n not in wind]
    if not alone or not wind:
        return []
    return [
        warn(
            "force_axes_differ",
            where=", ".join(alone),
            expected=f"CD and CL, as in {', '.join(wind)}",
            found="CX and CZ",
            do="Their rows stand apart. Identify CD and CL as well to compare forces.",
        )
    ]
