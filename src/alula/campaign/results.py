"""Sources of derivatives read from files, as columns of a comparison.

Results of `alula identify`, models, predictions, aircraft files (predicted on the spot), what AVL
and Digital Datcom wrote, tables.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.campaign.learned import seen_by
from alula.campaign.predict import Asked
from alula.campaign.sources.avl_output import is_avl, read_avl
from alula.campaign.sources.convert import Frame
from alula.campaign.sources.datcom_output import is_datcom, read_datcom
from alula.campaign.sources.derivative_table import read_table
from alula.campaign.sources.predicted import SCHEMA as PREDICTION
from alula.campaign.sources.predicted import from_aircraft, from_json
from alula.campaign.sources.stated import Stated
from alula.flight import Flight, Maneuver, SourceFile
from alula.identify import CoefficientData
from alula.identify.compare import Column, Entry
from alula.identify.equation_error.task import variables_of
from alula.identify.typical import constant_name
from alula.model import AeroModel, Reference, load_model, regressors

SCHEMA = "alula.identification/1"
SOURCES = (
    "files that `alula identify` or `predict` wrote (--json, --model), aircraft files, AVL's ST or "
    "SB output, Digital Datcom's, or tables"
)
LARGEST = 50_000_000  # bytes of a result
Predict = Callable[[CoefficientData], dict[str, Array]]


@dataclass(frozen=True)
class Source:
    """A file with its column. predict: its coefficients (n,) for one maneuver's variables.

    saw: 'yes', 'no' or 'unknown', whether it was estimated from samples of a maneuver. frame: what
    its coefficients refer to. stated: its own conventions, None for results and models.
    """

    file: SourceFile
    column: Column
    predict: Predict
    saw: Callable[[Maneuver, Flight], str]
    frame: Frame = field(default_factory=Frame)
    stated: Stated | None = None


def read_sources(
    path: Path, methods: Sequence[str] = (), asked: Asked | None = None, alpha: float | None = None
) -> list[Source]:
    """What a file holds; an aircraft file gives a source for each of the prediction's methods.

    asked: flight of those. alpha: rad, at which Datcom's table is read. Raises BadInput for a file
    that is no source.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise _not_a_result(path, f"{path.stat().st_size} bytes")
        raw = path.read_bytes()
    except OSError as error:
        raise refuse(
            "unreadable_file",
            where=str(path),
            expected="a source of derivatives",
            found=error.strerror or type(error).__name__,
            do=f"Name {SOURCES}.",
        ) from None
    sha256 = hashlib.sha256(raw).hexdigest()
    file = SourceFile(str(path), sha256, len(raw), len(raw), 0, 0)
    if raw.lstrip()[:1] == b"{":
        return [_result(path, raw, file)]
    text = raw.decode("utf-8", "replace")
    head = text[:4000]
    if "alula.aircraft/" in head:
        told = from_aircraft(str(path), methods, asked or Asked())
        return [_stated(s, replace(file, path=str(path)), m) for s, m in told]
    if "alula.model/" not in head:
        found = _other(text, path, alpha)
        if found is not None:
            return [_stated(found, file)]
    return [_model(load_model(path), path, file)]


def _other(text: str, path: Path, alpha: float | None) -> Stated | None:
    """Another program's output or a table; None where it looks like none."""
    if is_avl(text):
        return read_avl(text, path.stem, str(path))
    if "alula.derivatives/" in text[:4000] or path.suffix.lower() == ".csv":
        return read_table(text, path.stem, str(path))
    if is_datcom(text):
        return read_datcom(text, path.stem, str(path), alpha or 0.0)
    return None


def _stated(s: Stated, file: SourceFile, model: AeroModel | None = None) -> Source:
    formulas = {} if model is None else model.formulas
    column = Column(s.name, s.kind, s.method, s.entries, formulas, s.se_is)

    def predict(d: CoefficientData) -> dict[str, Array]:
        if model is None:
            return {}
        found = model.evaluate(dict(d.variables))
        return {c: found[c] for c in model.coefficients}

    return Source(file, column, predict, lambda m, flight: "no", Frame(s.reference, s.point), s)


def _model(model: AeroModel, path: Path, file: SourceFile) -> Source:
    errors = np.full(len(model.values), np.nan)
    if model.covariance is not None:
        errors = np.sqrt(np.diag(model.covariance))
    entries = {
        name: Entry(float(v), float(se), "assumed" if name in model.assumed else "")
        for name, v, se in zip(model.names, model.values, errors, strict=True)
    }
    method = model.provenance.get("method", "model file")
    column = Column(path.stem, "model", method, entries, model.formulas, "as in its file")

    def predict(d: CoefficientData) -> dict[str, Array]:
        found = model.evaluate(dict(d.variables))
        return {c: found[c] for c in model.coefficients}

    frame = Frame(model.reference, model.reference_point)
    return Source(file, column, predict, lambda m, flight: seen_by(model, m, flight), frame)


def _result(path: Path, raw: bytes, file: SourceFile) -> Source:
    try:
        tree = json.loads(raw, parse_constant=lambda _: None)
        if tree.get("schema") == PREDICTION and tree.get("status") == "ok":
            told, model = from_json(tree, path.stem, str(path))
            return _stated(told, file, model)
        if tree.get("schema") != SCHEMA:
            raise _not_a_result(path, f"schema {tree.get('schema')!r:.60}")
        if tree.get("status") == "bad_input":
            raise _not_a_result(path, "one that ended in bad input: it holds no parameters")
        found = tree["result"]
        entries = {str(p["name"]): _entry(p) for p in found["parameters"]}
        formulas = {str(k): str(v) for k, v in found.get("formulas", {}).items()}
        method, status = str(found["method"]), str(found["status"])
        if method == "stall":  # its formulas are the attached flow's alone
            formulas = {}
        held = _held(found, entries)
        words = str(found.get("uncertainty", ""))
        hashes = {str(f["sha256"]) for f in tree.get("inputs", [])}
        learned = {str(id) for id in found.get("maneuvers", {}).get("learned", [])}
        frame = _frame(found)
    except BadInput:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        words = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise _not_a_result(path, words[:200]) from None
    column = Column(path.stem, "identification", method, entries, formulas, words, status)

    def saw(m: Maneuver, flight: Flight) -> str:
        if not any(f.sha256 in hashes for f in flight.files):
            return "no"
        return "yes" if m.id in learned else "no"

    return Source(file, column, _predictor(column, held), saw, frame)


def _frame(found: Mapping[str, Any]) -> Frame:
    """Reference and point of a result; results of before they were written have none."""
    r, point = found.get("reference"), found.get("reference_point")
    if r is None or point is None:
        return Frame()
    x, y, z = (float(v) for v in point)
    S, b, c = (float(r[k]) for k in "Sbc")
    if not (min(S, b, c) > 0.0 and all(map(math.isfinite, (S, b, c, x, y, z)))):
        raise ValueError("reference")
    return Frame(Reference(S, b, c), np.array([x, y, z]))


def _held(found: Mapping[str, Any], entries: Mapping[str, Entry]) -> dict[str, float]:
    """Values of the terms that were not estimated: fixed, or tied to others."""
    out = {str(n): float(v) for n, v in found.get("fixed", {}).items()}
    for n, tie in found.get("tied", {}).items():
        of = str(tie["name"])
        value = out[of] if of in out else entries[of].value
        out[str(n)] = float(tie["factor"]) * value
    return out


def _predictor(column: Column, held: Mapping[str, float]) -> Predict:
    every = {n: e.value for n, e in column.entries.items()} | dict(held)
    values = {n: v for n, v in every.items() if math.isfinite(v)}

    def predict(d: CoefficientData) -> dict[str, Array]:
        out = {}
        for coefficient, formula in column.formulas.items():
            names, matrix = regressors(coefficient, formula, variables_of(d))
            terms = [n for n in names if n != constant_name(coefficient)]
            if all(n in values for n in terms):
                out[coefficient] = np.asarray(
                    sum((values[n] * matrix[:, names.index(n)] for n in terms), 0.0 * d.t)
                )
        return out

    return predict


def _entry(p: Mapping[str, Any]) -> Entry:
    def number(x: Any) -> float:
        if x is None:
            return math.nan
        if isinstance(x, bool) or not isinstance(x, (int, float)):
            raise ValueError(f"{p.get('name')}: not a number: {x!r:.40}")
        return float(x)

    return Entry(
        number(p["value"]), number(p.get("se")), str(p.get("verdict", "")), str(p.get("unit", ""))
    )


def named(sources: Sequence[Source]) -> tuple[Source, ...]:
    """Each with a name of its own: the file's, with its folder or a number where these repeat."""
    names = [s.column.name for s in sources]
    if len(set(names)) < len(names):
        names = [
            f"{Path(s.file.path).parent.name}/{n}" if names.count(n) > 1 else n
            for s, n in zip(sources, names, strict=True)
        ]
    out = []
    for i, (s, n) in enumerate(zip(sources, names, strict=True)):
        own = n if names.count(n) == 1 else f"{n}#{i + 1}"
        out.append(replace(s, column=replace(s.column, name=own)))
    return tuple(out)


def _not_a_result(path: Path, found: str) -> BadInput:
    return refuse(
        "not_a_result",
        where=str(path),
        expected=f"JSON of schema {SCHEMA} or {PREDICTION}, or a model file",
        found=found,
        do=f"Name {SOURCES}.",
    )
