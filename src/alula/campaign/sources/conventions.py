"""Entries in one convention: axes of moments and rates, reference lengths, point of the moments.

Each is linear in the entries, whose errors count as independent. Where a derivative needs another
that the source lacks, it is left out, and its name is returned.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, hypot, sin

import numpy as np

from alula.base.arrays import Array
from alula.campaign.sources.stated import COEFFICIENTS
from alula.identify.compare import Entry
from alula.model import Reference
from alula.predict.axes import turn

Entries = Mapping[str, Entry]
Rows = dict[str, dict[str, float]]
_RATES = ("p", "r")


def to_body_axes(entries: Entries, alpha: float) -> tuple[dict[str, Entry], list[str]]:
    """Rates and moments from stability to body axes, by the angle of attack."""
    turning, lost = [], []
    for name in entries:
        coefficient, label = _parts(name)
        partners = _partners(coefficient, label)
        if not partners:
            continue
        if alpha == 0.0 or all(p in entries for p in partners):
            turning.append(name)
        else:
            lost.append(name)
    names, matrix = turn(turning, alpha)
    rows: Rows = {n: {n: 1.0} for n in entries if n not in turning and n not in lost}
    for i, name in enumerate(names):
        rows[name] = {turning[j]: float(w) for j, w in enumerate(matrix[i]) if w != 0.0}
    return _linear(rows, entries), lost


def _partners(coefficient: str, label: str) -> list[str]:
    """All that a lateral moment or a derivative to a lateral rate turns into and comes from."""
    moments = ("Cl", "Cn") if coefficient in ("Cl", "Cn") else (coefficient,)
    labels = _RATES if label in _RATES else (label,)
    found = [f"{c}_{x}" for c in moments for x in labels]
    return found if len(found) > 1 else []


def to_reference(entries: Entries, old: Reference, new: Reference) -> dict[str, Entry]:
    """Coefficients and hats on other S, b, c."""
    area = old.S / new.S
    length = {"Cl": old.b / new.b, "Cn": old.b / new.b, "Cm": old.c / new.c}
    hat = {"p": old.b / new.b, "r": old.b / new.b, "betadot": old.b / new.b,
           "q": old.c / new.c, "alphadot": old.c / new.c}  # fmt: skip
    rows: Rows = {}
    for name in entries:
        coefficient, label = _parts(name)
        factor = 1.0
        if coefficient in COEFFICIENTS:
            factor = area * length.get(coefficient, 1.0) * hat.get(label, 1.0)
        rows[name] = {name: factor}
    return _linear(rows, entries)


def to_point(
    entries: Entries, step: Array, reference: Reference, alpha: float
) -> tuple[dict[str, Entry], list[str]]:
    """Moments and rates about another point; body axes, the derivatives taken at alpha.

    step: (3,) m, from the new point to the old, its y zero. M_B = M_A + d x F; rotation about B
    moves A: v_A = v_B + w x d, by which the flow at A has another angle and another speed. Drag and
    coefficients at zero that are missing count as none. A missing derivative of the force leaves
    the moment's out.
    """
    dx, dz = float(step[0]), float(step[2])
    moved: Rows = {}
    lost = []
    for name in entries:
        coefficient, label = _parts(name)
        row = {name: 1.0}
        if coefficient == "Cm":
            force = _pitching(label, entries, alpha, dx, dz)
        elif coefficient in ("Cl", "Cn"):
            arm = dx if coefficient == "Cn" else -dz
            force = {f"CY_{label}": arm} if f"CY_{label}" in entries else None
        else:
            force = {}
        if force is None:
            lost.append(name)
            continue
        length = reference.c if coefficient == "Cm" else reference.b
        for key, weight in force.items():
            row[key] = row.get(key, 0.0) + weight / length
        moved[name] = row
    out = {n: dict(row) for n, row in moved.items()}
    for name in list(out):
        coefficient, label = _parts(name)
        if coefficient in COEFFICIENTS and label in ("p", "q", "r"):
            gained = _rotating(coefficient, label, moved, alpha, dx, dz, reference)
            if gained is None:
                del out[name]
                lost.append(name)
                continue
            for key, w in gained.items():
                out[name][key] = out[name].get(key, 0.0) + w
    return _linear(out, entries), lost


def _rotating(
    coefficient: str,
    label: str,
    moved: Rows,
    alpha: float,
    dx: float,
    dz: float,
    reference: Reference,
) -> dict[str, float] | None:
    """What a derivative to a rate gains as the rotation is about the new point; None: not known."""
    out: dict[str, float] = {}

    def add(name: str, weight: float) -> bool:
        for key, w in moved.get(name, {}).items():
            out[key] = out.get(key, 0.0) + weight * w
        return name in moved or weight == 0.0 or coefficient == "CD"

    if label != "q":
        arm = dx if label == "r" else -dz
        return out if add(f"{coefficient}_beta", arm * 2.0 / reference.b) else None
    angle = -(dx * cos(alpha) + dz * sin(alpha)) * 2.0 / reference.c
    speed = (dz * cos(alpha) - dx * sin(alpha)) * 2.0 / reference.c
    if not add(f"{coefficient}_alpha", angle):
        return None

    def whole(name: str, weight: float) -> None:
        add(f"{name}_0", weight)
        add(f"{name}_alpha", weight * alpha)

    whole(coefficient, 2.0 * speed)  # with the square of speed
    # Lift and drag stay along the new point's stream, the slopes turn with the angle.
    if coefficient == "CL":
        whole("CD", angle)
    if coefficient == "CD":
        whole("CL", -angle)
    return out


def _pitching(
    label: str, entries: Entries, alpha: float, dx: float, dz: float
) -> dict[str, float] | None:
    """Weights of lift and drag in c times what a derivative of Cm gains: dz FX - dx FZ."""
    if f"CL_{label}" not in entries:
        return None
    c, s = cos(alpha), sin(alpha)
    # FX = CL s - CD c, FZ = -CL c - CD s: weights of CL and of CD in dz FX - dx FZ.
    lift, drag = dz * s + dx * c, -dz * c + dx * s
    row = {f"CL_{label}": lift, f"CD_{label}": drag}
    if label in ("alpha", "0"):
        # The axes turn with alpha: what lift and drag themselves add, CL = CL_0 + CL_alpha alpha.
        turned = {"CL": dz * c - dx * s, "CD": dz * s + dx * c}
        sign = 1.0 if label == "alpha" else -alpha
        for force, weight in turned.items():
            for name, share in ((f"{force}_0", 1.0), (f"{force}_alpha", alpha)):
                row[name] = row.get(name, 0.0) + sign * weight * share
    return {n: w for n, w in row.items() if n in entries and w != 0.0}


def _linear(rows: Rows, entries: Entries) -> dict[str, Entry]:
    out = {}
    for name, row in rows.items():
        own = entries.get(name) or next(iter(entries[n] for n in row))
        value = sum(w * entries[n].value for n, w in row.items())
        if row == {name: 1.0}:
            out[name] = own
            continue
        # What is small beside the entry and states no error adds none.
        se = [w * entries[n].se for n, w in row.items() if np.isfinite(entries[n].se)]
        known = bool(se) and bool(np.isfinite(own.se))
        out[name] = Entry(value, hypot(*se) if known else np.nan, own.verdict, own.unit)
    return out


def _parts(name: str) -> tuple[str, str]:
    coefficient, _, label = name.partition("_")
    return coefficient, label
