"""The shape from the aircraft file's [geometry], in SI and body axes."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft.blades import Blades
from alula.aircraft.frames import to_body
from alula.aircraft.geometry import (
    Airfoil,
    Body,
    ControlSurface,
    CrossSection,
    Geometry,
    LiftingSurface,
    Polar,
    Section,
)
from alula.aircraft.naca import naca_camber, naca_digits
from alula.aircraft.schema_geometry import (
    AirfoilTable,
    BodyTable,
    ControlSurfaceTable,
    GeometryTable,
    PolarTable,
    SurfaceTable,
)
from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, refuse
from alula.base.project_messages import expand

_COLUMNS = ("alpha_deg", "c_l", "c_d", "c_m")


def geometry(table: GeometryTable, turn: Array, path: Path) -> Geometry:
    """The geometry of [geometry]; turn: (3, 3) from the datum's frame to body axes.

    Raises BadInput for an airfoil that is nowhere stated and a polar that cannot be read. Whether
    the shape can be one is `geometry_check`'s business.
    """
    where = f"{path}, geometry"
    airfoils = {
        name: _airfoil(name, a, path, f"{where}.airfoils.{name}")
        for name, a in table.airfoils.items()
    }
    surfaces = tuple(_surface(s, turn) for s in table.surfaces)
    for surface in surfaces:
        for k, section in enumerate(surface.sections, 1):
            if section.airfoil not in airfoils:
                at = f"{where}.surfaces.{surface.name}.sections[{k}].airfoil"
                airfoils[section.airfoil] = _by_name(section.airfoil, airfoils, at)
    bodies = tuple(_body(b, turn) for b in table.bodies)
    blades = _blades(table.blades, f"{where}.blades")
    return Geometry(surfaces, bodies, airfoils, blades, table.drag_area)


def _blades(tables: Mapping[str, Mapping[str, Any]], where: str) -> dict[str, Blades]:
    """By the engine's name."""
    if not tables:
        return {}
    try:
        loader = import_module("alula.aircraft.load_blades").load_blades
    except ModuleNotFoundError:
        raise refuse(
            "not_built",
            where=where,
            expected="a version of Alula that reads propeller blades",
            found="one that does not",
            do="Leave [geometry.blades] out; CT and CP go under the engine.",
        ) from None
    return {name: loader(table, f"{where}.{name}") for name, table in tables.items()}


def _surface(table: SurfaceTable, turn: Array) -> LiftingSurface:
    sections = tuple(
        Section(to_body(s.position, turn), s.chord, float(np.radians(s.twist_deg)), s.airfoil)
        for s in table.sections
    )
    controls = tuple(_control(c) for c in table.controls)
    chordwise, spanwise = table.panels
    return LiftingSurface(
        table.name, table.role, sections, table.mirror, controls, (chordwise, spanwise)
    )


def _control(table: ControlSurfaceTable) -> ControlSurface:
    hinge = table.hinge if isinstance(table.hinge, list) else [table.hinge] * 2
    return ControlSurface(
        table.name, table.span[0], table.span[1], (hinge[0], hinge[1]), dict(table.gains),
        table.c_l_delta, table.c_m_delta,
    )  # fmt: skip


def _body(table: BodyTable, turn: Array) -> Body:
    return Body(
        table.name,
        tuple(CrossSection(to_body(s[:3], turn), s[3], s[4]) for s in table.stations),
    )


def _by_name(name: str, stated: Mapping[str, Airfoil], where: str) -> Airfoil:
    """A section that has no table of its own: its name must tell its shape."""
    digits = naca_digits(name)
    if digits is None:
        near = get_close_matches(name, stated, n=1, cutoff=0.6)
        raise refuse(
            "unknown_airfoil",
            where=where,
            expected="a NACA four-digit section ('NACA 2412') or a name of [geometry.airfoils]",
            found=f"'{name}'",
            do=f"Did you mean '{near[0]}'?" if near else f'Add [geometry.airfoils."{name}"].',
        )
    return Airfoil(name, digits[2], naca_camber(*digits[:2]))


def _airfoil(name: str, table: AirfoilTable, path: Path, where: str) -> Airfoil:
    digits = naca_digits(name if table.naca is None else f"NACA {table.naca}")
    if table.naca is not None and digits is None:
        raise refuse(
            "bad_airfoil",
            where=f"{where}.naca",
            expected="four digits of a NACA section, e.g. '2412' or '0009'",
            found=f"'{table.naca}'",
            do="State thickness and camber for sections of other families.",
        )
    thickness = table.thickness if digits is None else table.thickness or digits[2]
    if thickness is None:
        raise refuse(
            "bad_airfoil",
            where=where,
            expected="'naca' or 'thickness'",
            found="neither",
            do="State the thickness over the chord; without camber the section is symmetric.",
        )
    camber = None if digits is None else naca_camber(*digits[:2])
    if table.camber is not None:
        camber = _camber(table.camber, f"{where}.camber")
    alpha_0 = None if table.alpha_0_deg is None else float(np.radians(table.alpha_0_deg))
    polar = None if table.polar is None else _polar(table.polar, path, f"{where}.polar")
    return Airfoil(name, thickness, camber, table.c_l_alpha, alpha_0, polar)


def _camber(points: list[list[float]], where: str) -> Array:
    line = frozen(points)
    if (
        np.any(np.diff(line[:, 0]) <= 0.0)
        or np.any(np.abs(line[[0, -1]] - [[0.0, 0.0], [1.0, 0.0]]) > 1e-6)
        or np.any(np.abs(line[:, 1]) > 0.5)
    ):
        raise refuse(
            "bad_camber",
            where=where,
            expected="the mean line as [x/c, z/c], x/c increasing, from [0, 0] to [1, 0]",
            found=f"from {points[0]} to {points[-1]}, x/c "
            + ("increasing" if np.all(np.diff(line[:, 0]) > 0.0) else "not increasing"),
            do="Give the points in order over the chord, both edges included, divided by it.",
        )
    return line


def _polar(table: PolarTable, path: Path, where: str) -> Polar:
    if table.file is not None:
        where = expand(table.file, path, "geometry")
        alpha_deg, c_l, c_d, c_m = _read(Path(where))
    else:
        alpha_deg, c_l, c_d = (np.array(v) for v in (table.alpha_deg, table.c_l, table.c_d))
        c_m = np.zeros_like(c_l) if table.c_m is None else np.array(table.c_m)
    step = np.diff(alpha_deg)
    if np.any(step <= 0.0):
        k = int(np.argmax(step <= 0.0))
        raise refuse(
            "polar_order",
            where=where,
            expected="alpha_deg increasing from row to row",
            found=f"{alpha_deg[k + 1]:g} after {alpha_deg[k]:g} (values {k + 1} and {k + 2})",
            do="Sort the polar by the angle of attack, each angle once.",
        )
    return Polar(
        frozen(np.radians(alpha_deg)), frozen(c_l), frozen(c_d), frozen(c_m),
        table.reynolds, table.source,
    )  # fmt: skip


def _read(path: Path) -> tuple[Array, Array, Array, Array]:
    """The columns of a polar's CSV file; lines that begin with # are comments."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise refuse(
            "file_not_readable",
            where=str(path),
            expected="a CSV file with the header " + ",".join(_COLUMNS),
            found=getattr(error, "strerror", None) or str(error),
            do="Check the polar's path; it goes from the aircraft file's folder.",
        ) from None
    lines = [
        (k, line)
        for k, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    rows = list(csv.reader(io.StringIO("\n".join(line for _, line in lines))))
    header = [cell.strip() for cell in rows[0]] if rows else []
    if any(name not in header for name in _COLUMNS[:3]):
        raise refuse(
            "polar_columns",
            where=str(path),
            expected="the header " + ",".join(_COLUMNS) + " (c_m may be left out)",
            found=",".join(header)[:80] or "no line",
            do="Name the columns in the first line.",
        )
    values = [_row(row, header, f"{path}, line {k}") for (k, _), row in
              zip(lines[1:], rows[1:], strict=False)]  # fmt: skip
    if len(values) < 3:
        raise refuse(
            "polar_columns",
            where=str(path),
            expected="at least three angles of attack",
            found=f"{len(values)}",
            do="A polar needs enough angles to be interpolated.",
        )
    alpha_deg, c_l, c_d, c_m = np.array(values).T
    return alpha_deg, c_l, c_d, c_m


def _row(row: list[str], header: list[str], where: str) -> list[float]:
    out = []
    for name in _COLUMNS:
        if name not in header:
            out.append(0.0)
            continue
        cell = row[header.index(name)].strip() if header.index(name) < len(row) else ""
        try:
            value = float(cell)
        except ValueError:
            value = float("nan")
        if not np.isfinite(value):
            raise _not_finite(name, cell, where)
        out.append(value)
    return out


def _not_finite(name: str, cell: str, where: str) -> BadInput:
    return refuse(
        "polar_not_finite",
        where=where,
        expected=f"a finite number for {name}",
        found=f"'{cell}'",
        do="Remove the row; a solver writes such rows where it did not converge.",
    )
