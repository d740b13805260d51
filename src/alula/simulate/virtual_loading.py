"""Loadings of a virtual flight test: the aircraft file with another center of gravity or mass."""

from __future__ import annotations

import json
import re
import tempfile
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from alula.aircraft import Aircraft, load_aircraft
from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.simulate.airframe import Airframe, airframe_of
from alula.simulate.virtual_plan import LoadingSpec, Plan

MODEL = "truth_model.toml"  # in the folder of a virtual flight test


@dataclass(frozen=True)
class Loading:
    """An aircraft as it is loaded. file, text: the aircraft file that says so; fuel_used: kg."""

    id: str
    aircraft: Aircraft
    fuel_used: float
    file: str
    text: str

    @cached_property
    def cg(self) -> Array:
        """The center of gravity, (3,) m from the datum."""
        return np.asarray(self.aircraft.mass_properties(np.array([self.fuel_used])).cg[0])

    @cached_property
    def airframes(self) -> dict[tuple[str, bool], Airframe]:
        """Those asked for so far: a hundred maneuvers share one."""
        return {}

    def airframe(self, engines: Literal["given", "modeled"], actuators: bool) -> Airframe:
        """What the equations of motion need; see `airframe_of`."""
        key = (engines, actuators)
        if key not in self.airframes:
            self.airframes[key] = airframe_of(
                self.aircraft, self.fuel_used, engines=engines, actuators=actuators
            )
        return self.airframes[key]


def loadings_of(plan: Plan) -> dict[str, Loading]:
    """The plan's loadings by id; a plan without any has one, '', as the aircraft file says.

    Raises BadInput where a changed aircraft file is not one any more, or where loadings differ in
    more than mass: their derivatives could not be shared.
    """
    out = {
        spec.id: _loading(plan, spec)
        for spec in plan.loadings or [LoadingSpec.model_construct(id="")]
    }
    first = next(iter(out.values())).aircraft
    for loading in out.values():
        one = loading.aircraft
        same = (one.S, one.b, one.c) == (first.S, first.b, first.c)
        if not (same and np.allclose(one.reference_point, first.reference_point, atol=1e-9)):
            raise refuse(
                "loading_geometry",
                where=f"{plan.path}: loadings, {loading.id}",
                expected="the same S, b, c and moment reference point in every loading",
                found=f"S {one.S:g}, b {one.b:g}, c {one.c:g}, point {one.reference_point}",
                do="State reference.point in the aircraft files; use cg_shift for another CG.",
            )
    return out


def _loading(plan: Plan, spec: LoadingSpec) -> Loading:
    id = spec.id
    path = spec.aircraft or plan.aircraft
    original = load_aircraft(path)
    text = path.read_text(encoding="utf-8-sig")
    name = path.name
    if spec.cg_shift is not None or spec.set:
        tree = tomllib.loads(text)
        _change(tree, original, spec, plan)
        name = f"{path.stem}_{re.sub(r'[^A-Za-z0-9_.+-]', '_', id)}.toml"
        text = f"# {path.name}, loading '{id}' of a virtual flight test.\n" + toml_text(tree)
    # The copy stands beside the model that flew, wherever the original has its own.
    text = re.sub(r"(?m)^aero[ \t]*=.*$", lambda _: f'aero = "{MODEL}"', text)
    return Loading(id, _read(text, name, plan, id), spec.fuel_used, name, text)


def _read(text: str, name: str, plan: Plan, id: str) -> Aircraft:
    """The aircraft of a file that is not written yet."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_text(text, encoding="utf-8")
        try:
            return load_aircraft(path)
        except BadInput as error:
            where = f"{plan.path}: loading '{id}', "
            raise BadInput(
                *(
                    type(m)(
                        m.code, m.level, where + m.where.replace(folder + "/", ""), m.expected,
                        m.found, m.do,
                    )
                    for m in error.messages
                )
            ) from None  # fmt: skip


def _change(tree: dict[str, Any], original: Aircraft, spec: LoadingSpec, plan: Plan) -> None:
    turn = np.array([1.0, 1.0, 1.0])
    if tree.get("datum", {}).get("frame") == "design":
        turn = np.array([-1.0, 1.0, -1.0])
    # Coefficients stay about one point, wherever the center of gravity goes.
    tree["reference"]["point"] = [float(x) for x in turn * original.reference_point]
    if spec.cg_shift is not None:
        if "mass" not in tree:
            raise refuse(
                "missing_mass",
                where=f"{plan.path}: loading '{spec.id}'",
                expected="[mass] in the aircraft file",
                found="none",
                do="State it, or leave cg_shift out.",
            )
        _shift(tree["mass"], turn * np.array(spec.cg_shift))
    for key, value in spec.set.items():
        *path, last = key.split(".")
        here: Any = tree
        for part in path:
            if isinstance(here, list):
                here = next((x for x in here if x.get("name") == part), None)
            else:
                here = here.get(part) if isinstance(here, dict) else None
        if not isinstance(here, dict) or last not in here:
            raise refuse(
                "unknown_key",
                where=f"{plan.path}: loading '{spec.id}', set",
                expected="dotted keys that stand in the aircraft file, lists by name",
                found=f"'{key}'",
                do="Mend its spelling; example: 'mass.persons.pilot.mass'.",
            )
        here[last] = value


def _shift(table: Any, shift: Any) -> None:
    """Move all mass by the same vector: the center of gravity goes along, inertia stays."""
    for key, value in table.items() if isinstance(table, dict) else ():
        if key in ("cg", "position", "center"):
            table[key] = [float(x) for x in np.array(value) + shift]
        elif isinstance(value, dict):
            _shift(value, shift)
        elif isinstance(value, list):
            for item in value:
                _shift(item, shift)


def toml_text(tree: Mapping[str, Any], prefix: str = "") -> str:
    """A tree of tables, lists of tables and plain values as TOML; comments are not kept."""
    plain = {k: v for k, v in tree.items() if not _is_table(v) and not _is_tables(v)}
    lines = [f"{_key(k)} = {toml_value(v)}" for k, v in plain.items()]
    for key, value in tree.items():
        name = prefix + _key(key)
        if _is_table(value):
            lines += ["", f"[{name}]", toml_text(value, name + ".").rstrip("\n")]
        elif _is_tables(value):
            for item in value:
                lines += ["", f"[[{name}]]", toml_text(item, name + ".").rstrip("\n")]
    return "\n".join(lines) + "\n"


def toml_value(value: Any) -> str:
    """A number, text, truth value, list or table in one line of TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        inside = ", ".join(f"{_key(k)} = {toml_value(v)}" for k, v in value.items())
        return f"{{{inside}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(toml_value(v) for v in value)}]"
    return repr(value)


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else toml_value(key)


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping)


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, Mapping) for v in value)
