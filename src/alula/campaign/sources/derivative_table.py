"""A table of derivatives that a person wrote: wind tunnel, report, other program; CSV or TOML.

CSV: lines '# key = value', then 'name,value,se' and rows. TOML: the keys, then [values]. `axes` and
`per` must be said; docs/methods/prediction.md has both.
"""

from __future__ import annotations

import csv
import io
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees, isfinite, nan, radians
from typing import Any

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput
from alula.campaign.sources.stated import Stated, not_a_table
from alula.identify.compare import Entry
from alula.model import Reference
from alula.predict.combine import PAIRS
from alula.predict.derivatives import PredictionAxes

SCHEMA = "alula.derivatives/1"
KEYS = ("schema", "name", "source", "axes", "per", "rates", "alpha_deg", "point", "S", "b", "c")
AXES: Mapping[str, PredictionAxes] = {"stability": "stability", "body": "model"}
# What a derivative to a rate is per: factors that make it one to pb/2V, qc/2V, rb/2V.
RATES = {"pb/2V": 1.0, "pb/V": 2.0, "pb/2V per deg": degrees(1.0)}
ANGLES = frozenset({"alpha", "beta", "de", "da", "dr", "df"})
_NAME = re.compile(r"C[DYLlmn]_[A-Za-z]\w{0,30}|C[DYLlmn]_0")
_SUMS = {f"{rate} {'+' if sign > 0.0 else '-'} {lag}": rate for rate, (lag, sign) in PAIRS.items()}


@dataclass(frozen=True)
class _Head:
    name: str
    source: str
    axes: PredictionAxes
    per_degree: bool
    rates: float
    alpha: float | None
    point: Array | None
    reference: Reference | None


def read_table(text: str, name: str, where: str) -> Stated:
    """The table in a file's text. Raises BadInput for what is not one, names the place."""
    if _is_toml(text):
        head, rows = _toml(text, name, where)
    else:
        head, rows = _csv(text, name, where)
    entries = {}
    for key, (value, se) in rows.items():
        if key not in _SUMS and not _NAME.fullmatch(key):
            raise _bad(
                where, "names such as CL_alpha, Cm_q, Cn_dr, 'Cm_q + Cm_alphadot'", f"'{key[:40]}'"
            )
        plain = _SUMS.get(key, key)  # the sum as flight shows it, under the rate's name
        if plain in entries:
            raise _bad(where, f"{plain} once, alone or as a sum", "both")
        factor = _factor(plain, head)
        entries[plain] = Entry(factor * value, abs(factor) * se, "sum" if plain != key else "")
    if not entries:
        raise _bad(where, "at least one derivative", "none")
    return Stated(
        head.name,
        "table",
        head.source,
        entries,
        head.axes,
        head.alpha,
        head.reference,
        head.point,
        se_is="as in its file" if any(isfinite(e.se) for e in entries.values()) else "",
    )


def _factor(name: str, head: _Head) -> float:
    label = name.partition("_")[2]
    if label in ("p", "q", "r", "alphadot", "betadot"):
        return head.rates
    if not head.per_degree:
        return 1.0
    return degrees(1.0) ** (2 if label == "alpha2" else int(label in ANGLES))


def _is_toml(text: str) -> bool:
    return f'"{SCHEMA}"' in text


def _toml(text: str, name: str, where: str) -> tuple[_Head, dict[str, tuple[float, float]]]:
    try:
        tree = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise _bad(where, "TOML", str(error)[:200] or type(error).__name__) from None
    values = tree.pop("values", None)
    if not isinstance(values, dict):
        raise _bad(where, "[values], one per line", repr(values)[:40])
    rows = {}
    for key, given in values.items():
        if isinstance(given, dict):
            if set(given) - {"value", "se"} or "value" not in given:
                raise _bad(where, f"{key} = {{value = ..., se = ...}}", repr(given)[:60])
            rows[key] = (_number(given["value"], where, key), _se(given.get("se"), where, key))
        else:
            rows[key] = (_number(given, where, key), nan)
    return _head(tree, name, where), rows


def _csv(text: str, name: str, where: str) -> tuple[_Head, dict[str, tuple[float, float]]]:
    tree: dict[str, Any] = {}
    body = []
    for line in text.splitlines():
        comment = re.match(r"\s{0,20}#\s{0,20}(\w{1,30})\s{0,20}=\s{0,20}(.{0,400})", line)
        if comment:
            tree[comment[1]] = _plain(comment[2].strip())
        elif line.strip() and not line.lstrip().startswith("#"):
            body.append(line)
    try:
        rows = list(csv.reader(io.StringIO("\n".join(body)), strict=True))
    except csv.Error as error:
        raise _bad(where, "comma-separated rows", str(error)) from None
    head = [c.strip() for c in rows[0]] if rows else []
    if head[:2] != ["name", "value"] or set(head[2:]) - {"se"}:
        raise _bad(
            where, "a heading 'name,value' or 'name,value,se'", ",".join(head)[:60] or "none"
        )
    out = {}
    for row in rows[1:]:
        if len(row) < 2 or len(row) > len(head):
            raise _bad(where, f"{len(head)} columns", ",".join(row)[:60])
        key, value = row[0].strip(), row[1].strip()
        if key in out:
            raise _bad(where, "each derivative once", f"'{key[:40]}' twice")
        if value in ("", "-"):
            continue
        se = row[2].strip() if len(row) > 2 else ""
        out[key] = (_number(_plain(value), where, key),
                    _se(_plain(se) if se not in ("", "-") else None, where, key))  # fmt: skip
    return _head(tree, name, where), out


def _plain(text: str) -> Any:
    """A number, three numbers, or the text without quotation marks."""
    words = text.strip("[]").replace(",", " ").split()
    try:
        numbers = [float(w) for w in words]
    except ValueError:
        return text.strip("\"'")
    return numbers[0] if len(numbers) == 1 else numbers


def _head(tree: Mapping[str, Any], name: str, where: str) -> _Head:
    unknown = [k for k in tree if k not in KEYS and k != "reference"]
    if unknown:
        raise _bad(where, f"the keys {', '.join(KEYS)}", f"'{unknown[0][:40]}'")
    if tree.get("schema", SCHEMA) != SCHEMA:
        raise _bad(where, f"schema {SCHEMA}", repr(tree["schema"])[:40])
    tree = dict(tree)
    inner = tree.pop("reference", None)
    if isinstance(inner, dict):
        tree = {**inner, **tree}
    axes = _one(tree, "axes", AXES, where)
    per = _one(tree, "per", {"rad": False, "deg": True}, where)
    rates = RATES["pb/2V"] if "rates" not in tree else _one(tree, "rates", RATES, where)
    sizes = [tree.get(k) for k in ("S", "b", "c")]
    reference = None
    if any(v is not None for v in sizes):
        S, b, c = (_number(v, where, k) for k, v in zip("Sbc", sizes, strict=True))
        if not min(S, b, c) > 0.0:
            raise _bad(where, "S, b and c above zero", f"{S:g}, {b:g}, {c:g}")
        reference = Reference(S, b, c)
    point = tree.get("point")
    if point is not None:
        if not isinstance(point, list) or len(point) != 3:
            raise _bad(where, "point = [x, y, z], m, body axes from the datum", repr(point)[:40])
        point = frozen(np.array([_number(v, where, "point") for v in point]))
    alpha = tree.get("alpha_deg")
    return _Head(
        str(tree.get("name", name))[:60],
        str(tree.get("source", "table"))[:120],
        axes,
        per,
        rates,
        None if alpha is None else radians(_number(alpha, where, "alpha_deg")),
        point,
        reference,
    )


def _one(tree: Mapping[str, Any], key: str, known: Mapping[str, Any], where: str) -> Any:
    given = tree.get(key)
    if not isinstance(given, str) or given not in known:
        words = " or ".join(f"'{k}'" for k in known)
        raise _bad(where, f"{key} = {words}", "none" if given is None else repr(given)[:40])
    return known[given]


def _number(given: Any, where: str, key: str) -> float:
    if isinstance(given, bool) or not isinstance(given, (int, float)):
        raise _bad(where, f"a number for {key[:40]}", repr(given)[:40])
    try:
        value = float(given)
    except OverflowError:
        value = nan
    if not isfinite(value):
        raise _bad(where, f"a finite number for {key[:40]}", repr(given)[:40])
    return value


def _se(given: Any, where: str, key: str) -> float:
    if given is None:
        return nan
    value = _number(given, where, f"the standard error of {key}")
    if value < 0.0:
        raise _bad(where, f"a standard error of {key[:40]} from zero on", f"{value:g}")
    return value


def _bad(where: str, expected: str, found: str) -> BadInput:
    do = "Say axes and per, then name, value and se: docs/methods/prediction.md, Tables."
    return not_a_table(where, expected, found, do)
