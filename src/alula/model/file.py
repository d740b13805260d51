"""The file of an aerodynamic model, `alula.model/1`: TOML that a person can read and write."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from alula.base.arrays import Array, frozen
from alula.base.files import write_whole
from alula.base.messages import refuse
from alula.base.project_messages import read_toml, validated
from alula.model.aero_model import AeroModel, Reference, aero_model
from alula.model.lookup import LookupTable, lookup_table
from alula.model.stall import Stall

SCHEMA = "alula.model/1"


class ReferenceTable(BaseModel):
    """Reference geometry of the coefficients."""

    model_config = ConfigDict(extra="forbid")
    S: float = Field(gt=0.0, description="Reference area, m2")
    b: float = Field(gt=0.0, description="Full span, m")
    c: float = Field(gt=0.0, description="Reference chord, m")


class TableTable(BaseModel):
    """A lookup table; see `alula.model.lookup_table`."""

    model_config = ConfigDict(extra="forbid")
    axes: dict[str, list[float]] = Field(description="Breakpoints by variable, first axis first")
    values: list[Any] = Field(description="Nested, the last axis innermost")
    interpolation: Literal["linear", "cubic"] = "linear"
    outside: Literal["hold", "line"] = "hold"


class StallTable(BaseModel):
    """Separation of the flow; see `alula.model.Stall`."""

    model_config = ConfigDict(extra="forbid")
    a1: float = Field(description="Abruptness, 1/rad")
    alpha_star: float = Field(description="Where half is separated, rad")
    tau1: float = Field(description="Lag of the separation point, s")
    tau2: float = Field(description="Delay by the rate of alpha, s")
    CL_alpha: float = Field(description="Slope of the attached lift, 1/rad")
    alpha_0: float = Field(description="Angle of no lift, rad")
    CD_X: float = 0.0
    Cm_X: float = 0.0
    y_station: float = Field(default=0.0, description="m; above 0: each wing on its own")
    alpha_star_difference: float = Field(default=0.0, description="Right less left, rad")


class ModelFile(BaseModel):
    """The file as it is written; `load_model` makes an AeroModel of it."""

    model_config = ConfigDict(extra="forbid", populate_by_name=True)
    schema_: Literal["alula.model/1"] = Field(alias="schema")
    name: str
    axes: Literal["body", "stability"] = "body"
    reference: ReferenceTable
    reference_point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    assumed: list[str] = Field(default_factory=list, description="Names of assumed parameters")
    models: dict[str, str] = Field(description="One formula per coefficient")
    values: dict[str, float] = Field(description="One value per term")
    covariance: list[list[float]] | None = Field(
        default=None, description="In the order of [values]"
    )
    validity: dict[str, tuple[float, float]] = Field(default_factory=dict)
    provenance: dict[str, str] = Field(default_factory=dict)
    tables: dict[str, TableTable] = Field(default_factory=dict)
    stall: StallTable | None = None


def load_model(path: Path | str) -> AeroModel:
    """The model in a file; raises BadInput naming file, key, expected and found."""
    path = Path(path)
    text, tree, _ = read_toml(path)
    file = validated(ModelFile, tree, path, text)
    return aero_model(
        file.name,
        file.models,
        file.values,
        Reference(file.reference.S, file.reference.b, file.reference.c),
        axes=file.axes,
        covariance=_matrix(path, file.covariance),
        reference_point=frozen(file.reference_point),
        validity=file.validity,
        assumed=tuple(file.assumed),
        provenance=file.provenance,
        tables={
            name: lookup_table(
                t.axes, t.values, t.interpolation, t.outside, where=f"{path}, tables.{name}"
            )
            for name, t in file.tables.items()
        },
        stall=None if file.stall is None else Stall(**file.stall.model_dump()),
    )


def save_model(model: AeroModel, path: Path | str) -> None:
    """Write the model, whole or not at all; `load_model` gives back equal values to the bit."""
    write_whole(Path(path), model_text(model))


def model_text(model: AeroModel) -> str:
    """The model as the text of its file."""
    r = model.reference
    lines = [
        f"schema = {_text(SCHEMA)}",
        f"name = {_text(model.name)}",
        f"axes = {_text(model.axes)}",
        f"reference = {{ S = {r.S!r}, b = {r.b!r}, c = {r.c!r} }}  # m2, m, m",
        f"reference_point = {_row(model.reference_point)}  # m, datum frame",
    ]
    if model.assumed:
        lines.append(f"assumed = [{', '.join(_text(n) for n in model.assumed)}]")
    if model.covariance is not None:
        rows = "".join(f"  {_row(row)},\n" for row in model.covariance)
        lines.append(f"covariance = [  # in the order of [values]\n{rows}]")
    lines += ["", "[models]", *(f"{c} = {_text(f)}" for c, f in model.formulas.items())]
    lines += ["", "[values]", *(f"{_text(n)} = {v!r}" for n, v in model.params.items())]
    if model.validity:
        lines += ["", "[validity]", *(f"{_text(n)} = {_row(v)}" for n, v in model.validity.items())]
    if model.provenance:
        lines += ["", "[provenance]"]
        lines += [f"{_text(k)} = {_text(v)}" for k, v in model.provenance.items()]
    if model.stall is not None:
        lines += ["", "[stall]  # rad, s, m"]
        lines += [f"{f.name} = {getattr(model.stall, f.name)!r}" for f in fields(model.stall)]
    for name, table in model.tables.items():
        lines += ["", f"[tables.{_text(name)}]", *_table_lines(table)]
    return "\n".join(lines) + "\n"


def _table_lines(table: LookupTable) -> list[str]:
    axes = zip(table.variables, table.breakpoints, strict=True)
    return [
        f"axes = {{ {', '.join(f'{n} = {_row(b)}' for n, b in axes)} }}",
        f"interpolation = {_text(table.interpolation)}",
        f"outside = {_text(table.outside)}",
        f"values = {_nested(table.values)}",
    ]


def _nested(values: Array) -> str:
    if values.ndim == 1:
        return _row(values)
    return "[\n" + "".join(f"  {_nested(v)},\n" for v in values) + "]"


def _text(text: str) -> str:
    # A JSON string is a TOML basic string, but for DEL, which TOML wants escaped, and for escaped
    # surrogates, which it does not know.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _row(values: Any) -> str:
    return f"[{', '.join(repr(float(v)) for v in values)}]"


def _matrix(path: Path, rows: list[list[float]] | None) -> Any:
    if rows is None:
        return None
    if any(len(row) != len(rows) for row in rows):
        raise refuse(
            "model_covariance",
            where=f"{path}, covariance",
            expected=f"{len(rows)} rows of {len(rows)} numbers",
            found=f"rows of {', '.join(str(len(row)) for row in rows)}",
            do="Give a square matrix in the order of [values], or leave it out.",
        )
    return np.array(rows)
