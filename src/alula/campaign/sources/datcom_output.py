"""Digital Datcom's output (for006, .out): static and dynamic derivatives, flaps.

USAF Stability and Control Digital Datcom, AFFDL-TR-79-3032, vol. I: tables over the angle of
attack, stability axes, per degree unless the heading says per radian; CLQ ... CLR are to qc/2V,
CLAD, CMAD to the rate of alpha c/2V, CLP ... to pb/2V, rb/2V, each per degree as well. CYB, CNB and
others that do not change with alpha stand in the first row only. 'NDM': no method.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees, isfinite, radians

import numpy as np

from alula.base.messages import Message, note
from alula.campaign.sources.stated import Stated, not_a_table
from alula.identify.compare import Entry
from alula.model import Reference

_NUMBER = re.compile(r"[-+]?(?:\d{1,40}\.?\d{0,40}|\.\d{1,40})(?:[EeDd][-+]?\d{1,3})?")
_STATIC = ("ALPHA", "CD", "CL", "CM", "CLA", "CMA")
_DYNAMIC = ("ALPHA", "CLQ", "CMQ")
_NAMES = {
    "CLA": "CL_alpha", "CMA": "Cm_alpha", "CYB": "CY_beta", "CNB": "Cn_beta", "CLB": "Cl_beta",
    "CLQ": "CL_q", "CMQ": "Cm_q", "CLAD": "CL_alphadot", "CMAD": "Cm_alphadot",
    "CLP": "Cl_p", "CYP": "CY_p", "CNP": "Cn_p", "CNR": "Cn_r", "CLR": "Cl_r",
}  # fmt: skip
_SMALL = 10.5  # deg, of deflection, within which a flap's effect is taken as a slope
_ROWS = 200


@dataclass(frozen=True)
class Table:
    """Columns over alpha, deg; NaN where a place is empty. radian: derivatives per radian."""

    title: str
    alpha: list[float]
    columns: Mapping[str, list[float]]
    radian: bool


def is_datcom(text: str) -> bool:
    """Whether Digital Datcom wrote this."""
    low = text[:200_000].upper()
    return ("DATCOM" in low or "DYNAMIC DERIVATIVES" in low) and "ALPHA" in low


def read_datcom(text: str, name: str, where: str, alpha: float = 0.0) -> Stated:
    """Derivatives at alpha (rad) of the last configuration in the file, by interpolation.

    Raises BadInput for a file without a table of derivatives.
    """
    lines = text.splitlines()
    static, dynamic = _last(lines, _STATIC), _last(lines, _DYNAMIC)
    if static is None:
        raise not_a_table(
            where, "a table headed ALPHA CD CL CM ... CLA CMA CYB CNB CLB", "none that can be read",
            "Run Digital Datcom with the whole configuration and give its output.",
        )  # fmt: skip
    said: list[Message] = []
    at = degrees(alpha)
    low, high = min(static.alpha), max(static.alpha)
    if not low <= at <= high:
        at = min(max(at, low), high)
    values: dict[str, float] = {}
    for table in (static, dynamic):
        if table is not None:
            values |= _derivatives(table, at)
    for coefficient, column in (("CL", "CL"), ("Cm", "CM"), ("CD", "CD")):
        values |= _tangent(static, coefficient, column, at, values)
    values |= _flaps(lines, said, where)
    values = {n: v for n, v in values.items() if isfinite(v)}
    if not values:
        raise not_a_table(where, "at least one derivative", "only empty places (NDM)")
    said.append(
        note(
            "datcom_table",
            where=where,
            expected="one configuration at one angle of attack",
            found=f"{static.title or 'its last table'}, read at {at:.3g} deg",
            do="Another angle: --alpha-deg.",
        )
    )
    reference, aft = _reference(lines)
    return Stated(
        name,
        "datcom",
        "Digital Datcom" + (f", {static.title.lower()}" if static.title else ""),
        {n: Entry(v) for n, v in values.items()},
        "stability",
        radians(at),
        reference,
        aft=aft,
        messages=tuple(said),
    )


def _last(lines: Sequence[str], wanted: Sequence[str]) -> Table | None:
    """The last table whose heading has these columns."""
    found = None
    for i, line in enumerate(lines):
        words = [(m.group(), m.start(), m.end()) for m in re.finditer(r"[A-Z/()]+", line)]
        names = [w for w, _, _ in words]
        if not set(wanted) <= set(names) or len(set(names)) < len(names):
            continue
        rows = _rows(lines[i + 1 : i + 1 + _ROWS], words)
        if rows:
            before = "\n".join(lines[max(0, i - 14) : i])
            columns = {n: [row[n] for row in rows] for n in names if n != "ALPHA"}
            angle = [row["ALPHA"] for row in rows]
            found = Table(_title(before), angle, columns, "PER RADIAN" in before.upper())
    return found


def _title(text: str) -> str:
    match = re.findall(r"([A-Z][A-Z -]{1,80} (?:CONFIGURATION|ALONE))", text)
    return match[-1].strip() if match else ""


def _rows(lines: Sequence[str], words: Sequence[tuple[str, int, int]]) -> list[dict[str, float]]:
    """Rows of numbers below a heading; each number goes to the column whose middle is nearest."""
    middle = {name: 0.5 * (a + b) for name, a, b in words}
    rows: list[dict[str, float]] = []
    for line in lines:
        body = line[1:] if line[:1] in "01" and line[1:2] in (" ", "") else line
        shift = len(line) - len(body)
        tokens = [(m.group(), m.start() + shift, m.end() + shift)
                  for m in re.finditer(r"\S+", body)]  # fmt: skip
        if not tokens:
            if rows:
                break
            continue
        row = dict.fromkeys(middle, float("nan"))
        for word, a, b in tokens:
            name = min(middle, key=lambda n: abs(middle[n] - 0.5 * (a + b)))
            if _NUMBER.fullmatch(word):
                row[name] = float(word.upper().replace("D", "E"))
        if not isfinite(row["ALPHA"]):
            break
        rows.append(row)
    steps = np.diff([r["ALPHA"] for r in rows])
    return rows if rows and bool(np.all(steps > 0.0)) else []


def _derivatives(table: Table, at: float) -> dict[str, float]:
    factor = 1.0 if table.radian else degrees(1.0)
    return {
        _NAMES[c]: factor * _interpolated(table.alpha, v, at)
        for c, v in table.columns.items()
        if c in _NAMES
    }


def _interpolated(alpha: Sequence[float], values: Sequence[float], at: float) -> float:
    """What stands in one row only holds for all."""
    good = [(a, v) for a, v in zip(alpha, values, strict=True) if isfinite(v)]
    if not good:
        return float("nan")
    return float(np.interp(at, [a for a, _ in good], [v for _, v in good]))


def _tangent(
    table: Table, coefficient: str, column: str, at: float, values: Mapping[str, float]
) -> dict[str, float]:
    """The coefficient at zero alpha on the tangent; for drag its slope as well."""
    alpha, v = np.array(table.alpha), np.array(table.columns[column])
    good = np.isfinite(v)
    if not good.any():
        return {}
    here = float(np.interp(at, alpha[good], v[good]))
    slope = values.get(f"{coefficient}_alpha")
    out = {}
    if slope is None and int(good.sum()) > 2:
        rate = np.gradient(v[good], np.radians(alpha[good]))
        slope = out[f"{coefficient}_alpha"] = float(np.interp(at, alpha[good], rate))
    if slope is not None and isfinite(slope):
        out[f"{coefficient}_0"] = here - slope * radians(at)
    return out


def _flaps(lines: Sequence[str], said: list[Message], where: str) -> dict[str, float]:
    """CL and Cm over the deflection: of a flap on the tail the elevator's, on the wing flaps'."""
    out: dict[str, float] = {}
    for i, line in enumerate(lines):
        if "DELTA" not in line or "D(CL)" not in line or "D(CM)" not in line:
            continue
        before = "\n".join(lines[max(0, i - 16) : i]).upper()
        where_on = re.findall(r"(TAIL|WING) {1,4}[A-Z -]{0,40}FLAP", before)
        rows = []
        for row in lines[i + 1 : i + 1 + _ROWS]:
            numbers = [float(x.upper().replace("D", "E")) for x in _NUMBER.findall(row)]
            if len(numbers) >= 3 and abs(numbers[0]) <= _SMALL:
                rows.append(numbers[:3])
            elif len(numbers) < 3 and row.strip() not in ("", "0"):
                break
        moved = np.array([r for r in rows if r[0] != 0.0])
        if not where_on or not len(moved) or not np.all(np.isfinite(moved)):
            continue
        control = "de" if where_on[-1] == "TAIL" else "df"
        delta = np.radians(moved[:, 0])
        for c, k in (("CL", 1), ("Cm", 2)):
            out[f"{c}_{control}"] = float(delta @ moved[:, k] / (delta @ delta))
        said.append(
            note(
                "datcom_flap",
                where=where,
                expected="a derivative to a control",
                found=f"{len(moved)} deflections up to {_SMALL:.0f} deg, taken as {control}",
                do="Nothing; their slope through zero is compared.",
            )
        )
    return out


def _reference(
    lines: Sequence[str],
) -> tuple[Reference | None, tuple[float, float, float] | None]:
    """Of the last 'REFERENCE DIMENSIONS': area, two lengths, two coordinates end the row."""
    for i in range(len(lines) - 1, -1, -1):
        if "REFERENCE DIMENSIONS" not in lines[i]:
            continue
        for row in lines[i + 1 : i + 8]:
            words = row[1:].split() if row[:1] in "01" else row.split()
            if len(words) < 6 or not all(_NUMBER.fullmatch(w) for w in words):
                continue
            S, c, b, x, z = (float(w.upper().replace("D", "E")) for w in words[-5:])
            if all(0.0 < v < 1e9 for v in (S, b, c)) and max(abs(x), abs(z)) < 1e9:
                return Reference(S, b, c), (x, 0.0, z)
    return None, None
