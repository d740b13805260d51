"""Sources of the flow angles: how they agree, and their time histories one below the other."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from alula.airdata.angles import Compared, Kind
from alula.report.angle_picture import angle_picture, axes_of
from alula.report.html import Html, join, table, tag
from alula.report.numbers import MISSING, number
from alula.report.pictures import mark

TITLES: dict[Kind, str] = {"alpha": "Angle of attack", "beta": "Sideslip"}
HEADS = ("Source", "From", "Observed", "Stated σ, °", "Against", "rms, °", "Bias, °", "rms of z",
         "Monitor")  # fmt: skip
Z = ("z: difference over the root of both stated variances, 1 where these are right. Not "
     "observable: a stated σ above 2.5°, or the method says so.")  # fmt: skip
KEY = ("Blue: the source, band ± 2 σ. Gray line: the vote. Gray ground: not observable. Dashed: "
       "taken out by the monitor.")  # fmt: skip


def angles_section(compared: Mapping[Kind, Compared]) -> Html:
    """Table and pictures of each angle."""
    return join(_of(kind, one) for kind, one in compared.items())


def _of(kind: Kind, found: Compared) -> Html:
    data = found.as_dict()
    rows = [
        [
            r["name"], r["how"], f"{100.0 * r['observed']:.0f} %", _shown(r["sigma_deg"]),
            r["against"] or MISSING, _shown(r["rms_deg"]), _shown(r["bias_deg"]),
            _shown(r["normalized_rms"]), _verdict(found, r["name"]),
        ]
        for r in data["sources"]
    ]  # fmt: skip
    rows += [
        [r["name"], r["reason"], *(MISSING for _ in range(6)), mark("caution", "not there")]
        for r in data["absent"]
    ]
    caption = (
        f"{TITLES[kind]} at the center of gravity, {data['samples']} times from "
        f"{data['start']:.6g} to {data['end']:.6g} s"
    )
    axes = axes_of(found)
    drawn = [name for name, s in found.sources.items() if s.reported.any()]
    return join(
        [
            tag("h3", TITLES[kind]),
            table(caption, HEADS, rows, numeric=[2, 3, 5, 6, 7], class_="dense whole sources"),
            tag("p", Z, class_="note"),
            *(angle_picture(found, name, axes) for name in drawn),
            tag("p", KEY, class_="note") if drawn else "",
        ]
    )


def _verdict(found: Compared, name: str) -> Html:
    faults = [n for n in found.named if n.source == name]
    source = found.sources[name]
    if faults:
        words = ", ".join(f"{n.reason} at {n.t:.6g} s" for n in faults[:3])
        return mark("bad", words + (f" and {len(faults) - 3} more" if len(faults) > 3 else ""))
    if not source.reported.any():
        return mark("caution", "never observable")
    if not source.votes:
        return mark("good", "shown only")
    alone = found.voted is not None and not np.any(found.voted.used > 1)
    return mark("caution", "alone") if alone else mark("good", "agrees")


def _shown(x: float) -> str:
    return number(x, 2) if np.isfinite(x) else MISSING
