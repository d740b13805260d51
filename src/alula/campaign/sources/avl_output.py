"""AVL's derivatives: files written by ST (stability axes) and SB (geometry axes).

AVL (Drela and Youngren) states derivatives to angles per rad, to rates per pb/2V, qc/2V, rb/2V,
to controls per degree (with a gain of 1). ST: forces, moments and rates along stability axes.
SB: to u, v, w over V, all along body axes; C_alpha = cos(alpha) C_w - sin(alpha) C_u,
C_beta = C_v, and lift and drag follow with the totals that stand above.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import cos, degrees, isfinite, radians, sin

from alula.base.messages import Message, note
from alula.campaign.sources.stated import Stated, not_a_table
from alula.identify.compare import Entry
from alula.model import Reference

_VALUE = re.compile(
    r"(?<![\w'/])([A-Za-z][\w'/]{0,20})\s{0,20}=\s{0,20}([-+]?(?:\d{1,40}\.?\d{0,40}|\.\d{1,40})(?:[EeDd][-+]?\d{1,3})?)"
    r"(?![\w.])"
)
_CONTROL = re.compile(r"(\S{1,40})\s{1,40}d0?(\d{1,2})(?=\s|$)")
_HEADS = ("Stability-axis derivatives", "Geometry-axis derivatives")
NAMES = {"elev": "de", "ail": "da", "rud": "dr", "flap": "df"}
_MOMENT = {"de": "Cm", "da": "Cl", "dr": "Cn"}


def is_avl(text: str) -> bool:
    """Whether AVL wrote this."""
    return any(h.lower() in text.lower() for h in _HEADS) or "Vortex Lattice Output" in text


def read_avl(text: str, name: str, where: str) -> Stated:
    """Derivatives of an .st or .sb file. Raises BadInput for a file without them."""
    head, kind, tail = _split(text, where)
    if "Geometric axis orientation" in head:
        raise not_a_table(
            where, "the standard axis orientation, X fwd, Z down", "X aft, Z up",
            "Switch AVL's axis orientation (OPER, option O) and write the file again.",
        )  # fmt: skip
    totals, found = _numbers(head), _numbers(tail)
    if not found:
        raise not_a_table(where, "derivatives such as 'CLa = 4.9'", "none below their heading")
    alpha = radians(totals["Alpha"]) if "Alpha" in totals else None
    controls = _controls(tail)
    if kind == "ST":
        values = _stability(found, controls)
    else:
        if alpha is None or not {"CXtot", "CZtot"} <= totals.keys():
            raise not_a_table(where, "Alpha, CXtot and CZtot above the derivatives", "some missing")
        values = _geometry(found, controls, alpha, totals)
    values, said = _signed(values, controls, where)
    values |= _at_zero(values, totals, controls, alpha)
    if not all(isfinite(v) for v in values.values()):
        raise not_a_table(where, "finite derivatives", "an overflow")
    return Stated(
        name,
        "avl",
        f"AVL, {kind}",
        {n: Entry(v) for n, v in values.items()},
        "stability" if kind == "ST" else "model",
        alpha,
        _reference(totals),
        aft=_aft(totals),
        messages=tuple(said),
    )


def _split(text: str, where: str) -> tuple[str, str, str]:
    low = text.lower()
    for heading, kind in zip(_HEADS, ("ST", "SB"), strict=True):
        at = low.find(heading.lower())
        if at >= 0:
            return text[:at], kind, text[at + len(heading) :]
    raise not_a_table(
        where, f"'{_HEADS[0]}...' or '{_HEADS[1]}...'", "neither",
        "Write the file in AVL with ST or SB, after OPER and X.",
    )  # fmt: skip


def _numbers(text: str) -> dict[str, float]:
    out: dict[str, float] = {}
    for key, number in _VALUE.findall(text):
        out.setdefault(key, float(number.upper().replace("D", "E")))
    return out


def _controls(tail: str) -> dict[int, str]:
    """Control by number as the headings name it: 'elevator d01' or 'elevator d1'."""
    out: dict[int, str] = {}
    for line in tail.splitlines():
        if "=" not in line and "|" not in line:
            for name, number in _CONTROL.findall(line):
                out.setdefault(int(number), name)
    return out


def _mine(name: str) -> str | None:
    """Alula's control for a name of AVL's."""
    return next((ours for start, ours in NAMES.items() if name.lower().startswith(start)), None)


def _stability(found: Mapping[str, float], controls: Mapping[int, str]) -> dict[str, float]:
    out = {}
    for key, value in found.items():
        plain = key.replace("'", "")
        match = re.fullmatch(r"(C[DYLlmn])([abpqr]|d0?(\d{1,2}))", plain)
        if match is None:
            continue
        label = {"a": "alpha", "b": "beta"}.get(match[2], match[2])
        if match[3]:
            mine = _mine(controls.get(int(match[3]), ""))
            if mine is None:
                continue
            label, value = mine, degrees(value)
        out[f"{match[1]}_{label}"] = value
    return _without_zeros(out)


def _geometry(
    found: Mapping[str, float],
    controls: Mapping[int, str],
    alpha: float,
    totals: Mapping[str, float],
) -> dict[str, float]:
    """To alpha, beta and rates, forces along stability axes, moments along body axes."""
    body: dict[str, dict[str, float]] = {}
    for key, value in found.items():
        match = re.fullmatch(r"(C[XYZlmn])([uvwpqr]|d0?(\d{1,2}))", key)
        if match is None:
            continue
        label = match[2]
        if match[3]:
            mine = _mine(controls.get(int(match[3]), ""))
            if mine is None:
                continue
            label, value = mine, degrees(value)
        body.setdefault(label, {})[match[1]] = value
    c, s = cos(alpha), sin(alpha)
    if {"u", "w"} <= body.keys():
        both = body["u"].keys() & body["w"].keys()
        body["alpha"] = {k: c * body["w"][k] - s * body["u"][k] for k in sorted(both)}
    if "v" in body:
        body["beta"] = body["v"]
    out = {}
    for label, row in body.items():
        if label in ("u", "v", "w"):
            continue
        if {"CX", "CZ"} <= row.keys():
            X, Z = row["CX"], row["CZ"]
            drag, lift = -X * c - Z * s, X * s - Z * c
            if label == "alpha":  # the axes turn with it
                X0, Z0 = totals["CXtot"], totals["CZtot"]
                drag += X0 * s - Z0 * c
                lift += X0 * c + Z0 * s
            out[f"CD_{label}"], out[f"CL_{label}"] = drag, lift
        out |= {f"{k}_{label}": v for k, v in row.items() if k not in ("CX", "CZ")}
    return _without_zeros(out)


def _without_zeros(values: dict[str, float]) -> dict[str, float]:
    """Without what symmetry makes zero: rounding would be compared with rounding."""
    along, aside = ("CD", "CL", "Cm"), ("CY", "Cl", "Cn")
    lateral = ("beta", "p", "r", "da", "dr")
    return {
        n: v
        for n, v in values.items()
        if (n.split("_")[0] in (aside if n.split("_")[1] in lateral else along)) or abs(v) > 1e-3
    }


def _signed(
    values: dict[str, float], controls: Mapping[int, str], where: str
) -> tuple[dict[str, float], list[Message]]:
    """A positive deflection gives a negative moment: a control of the other sense is turned."""
    said = []
    names = {_mine(n): n for n in controls.values()}
    rest = [n for n in controls.values() if _mine(n) is None]
    if controls:
        how = ", ".join(f"{name} as {mine}" for mine, name in names.items() if mine)
        left = f"; not compared: {', '.join(rest)}" if rest else ""
        said.append(
            note(
                "avl_controls",
                where=where,
                expected="controls in rad",
                found=f"{how or 'none of a known name'}, per degree with a gain of 1{left}",
                do="Name them elevator, aileron, rudder, flap.",
            )
        )
    for mine, coefficient in _MOMENT.items():
        if values.get(f"{coefficient}_{mine}", -1.0) > 0.0:
            values = {n: -v if n.endswith(f"_{mine}") else v for n, v in values.items()}
            said.append(
                note(
                    "control_sense",
                    where=f"{where}, {names.get(mine, mine)}",
                    expected=f"{coefficient}_{mine} below zero, Alula's notation",
                    found="above zero; the control's derivatives are turned",
                    do="Nothing, if its sense is the other one there.",
                )
            )
    return values, said


def _at_zero(
    values: Mapping[str, float],
    totals: Mapping[str, float],
    controls: Mapping[int, str],
    alpha: float | None,
) -> dict[str, float]:
    """CL_0 and Cm_0 (and CD_0 where its slope stands there): the tangent's at zero angles."""
    moving = any(abs(totals.get(k, 0.0)) > 1e-9 for k in ("pb/2V", "qc/2V", "rb/2V"))
    if alpha is None or moving:
        return {}
    at = {"alpha": alpha}
    for name in controls.values():
        mine = _mine(name)
        if mine in ("de", "df"):
            at[mine] = radians(totals.get(name, 0.0))
    out = {}
    for c in ("CL", "Cm", "CD"):
        if f"{c}tot" in totals and f"{c}_alpha" in values:
            out[f"{c}_0"] = totals[f"{c}tot"] - sum(
                values.get(f"{c}_{label}", 0.0) * angle for label, angle in at.items()
            )
    return out


def _reference(totals: Mapping[str, float]) -> Reference | None:
    found = [totals.get(k, 0.0) for k in ("Sref", "Bref", "Cref")]
    return Reference(*found) if all(0.0 < v < 1e9 for v in found) else None


def _aft(totals: Mapping[str, float]) -> tuple[float, float, float] | None:
    found = [totals.get(k) for k in ("Xref", "Yref", "Zref")]
    if any(v is None or abs(v) > 1e9 for v in found):
        return None
    x, y, z = (float(v) for v in found if v is not None)
    return x, y, z
