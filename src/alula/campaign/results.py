"""Results and models read back from their files, as columns of a comparison."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.campaign.learned import seen_by
from alula.flight import Flight, Maneuver, SourceFile
from alula.identify import CoefficientData
from alula.identify.compare import Column, Entry
from alula.identify.task import variables_of
from alula.identify.typical import constant_name
from alula.model import AeroModel, load_model, regressors

SCHEMA = "alula.identification/1"
LARGEST = 50_000_000  # bytes of a result
Predict = Callable[[CoefficientData], dict[str, Array]]


@dataclass(frozen=True)
class Source:
    """A file with its column. predict: its coefficients (n,) for one maneuver's variables.

    saw: 'yes', 'no' or 'unknown', whether it was estimated from samples of a maneuver.
    """

    file: SourceFile
    column: Column
    predict: Predict
    saw: Callable[[Maneuver, Flight], str]


def read_source(path: Path) -> Source:
    """A result as `identify --json` writes it, or a model file. Raises BadInput for others."""
    try:
        if path.stat().st_size > LARGEST:
            raise _not_a_result(path, f"{path.stat().st_size} bytes")
        raw = path.read_bytes()
    except OSError as error:
        raise refuse(
            "unreadable_file",
            where=str(path),
            expected="a result or model file",
            found=error.strerror or type(error).__name__,
            do="Name files that `alula identify --json` or `--model` wrote.",
        ) from None
    sha256 = hashlib.sha256(raw).hexdigest()
    file = SourceFile(str(path), sha256, len(raw), len(raw), 0, 0)
    if raw.lstrip()[:1] == b"{":
        return _result(path, raw, file)
    return _model(load_model(path), path, file)


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

    return Source(file, column, predict, lambda m, flight: seen_by(model, m, flight))


def _result(path: Path, raw: bytes, file: SourceFile) -> Source:
    try:
        tree = json.loads(raw, parse_constant=lambda _: None)
        if tree.get("schema") != SCHEMA:
            raise _not_a_result(path, f"schema {tree.get('schema')!r}")
        if tree.get("status") == "bad_input":
            raise _not_a_result(path, "one that ended in bad input: it holds no parameters")
        found = tree["result"]
        entries = {str(p["name"]): _entry(p) for p in found["parameters"]}
        formulas = {str(k): str(v) for k, v in found.get("formulas", {}).items()}
        method, status = str(found["method"]), str(found["status"])
        words = str(found.get("uncertainty", ""))
        hashes = {str(f["sha256"]) for f in tree.get("inputs", [])}
        learned = {str(id) for id in found.get("maneuvers", {}).get("learned", [])}
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

    return Source(file, column, _predictor(column), saw)


def _predictor(column: Column) -> Predict:
    values = {n: e.value for n, e in column.entries.items() if math.isfinite(e.value)}

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
        expected=f"JSON of schema {SCHEMA}, or a model file",
        found=found,
        do="Name files that `alula identify --json` or `--model` wrote.",
    )
