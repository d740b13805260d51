"""The aircraft's shape: three views, and what follows from the sections."""

from __future__ import annotations

import math

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.identify.result import Identification
from alula.predict.body_shape import BodyShape
from alula.predict.planform import exposed_area, planform, tail_volume, wetted_area
from alula.report.html import Html, join, table, tag
from alula.report.numbers import MISSING, number
from alula.report.three_view import views


def geometry(aircraft: Aircraft, neutral_point: tuple[Array, str] | None = None) -> Html:
    """Drawing and tables. neutral_point: (3,) m with the words that say where it comes from."""
    shape = aircraft.geometry
    assert shape is not None
    point = None if neutral_point is None else neutral_point[0]
    assumed = [key for key in aircraft.assumed if key.split(".")[0] == "geometry"]
    said = [
        "Marks: quartered circle, center of gravity at zero fuel used; cross, moment reference; "
        "triangles, sensors; dots, engines; shaded, control surfaces behind their dashed hinges; "
        "thin lines, panels of the lattice."
    ]
    if neutral_point is not None and point is not None:
        behind = float(aircraft.reference_point[0] - point[0]) / aircraft.c
        where = "behind" if behind >= 0.0 else "ahead of"
        said.append(
            f"Diamond: neutral point with fixed controls, {number(100.0 * abs(behind), 3)} % of c "
            f"{where} the moment reference, {neutral_point[1]}."
        )
    if assumed:
        parts = "" if "geometry" in assumed else " in " + ", ".join(assumed)
        said.append(f"The shape is assumed, not measured{parts}.")
    figures = (
        tag("figure", tag("figcaption", f"{aircraft.name}, {title}"), drawing)
        for title, drawing in views(aircraft, point)
    )
    return join(
        [
            *(tag("p", words, class_="note") for words in said),
            tag("div", *figures, class_="grid"),
            _surfaces(aircraft),
            _bodies(aircraft) if shape.bodies else None,
        ]
    )


def identified_neutral_point(
    aircraft: Aircraft, identification: Identification | None
) -> tuple[Array, str] | None:
    """The neutral point by identified Cm_alpha and CL_alpha (or CZ_alpha), None without them.

    x_NP = x_ref + c Cm_alpha/CL_alpha, x forward; with CZ_alpha the drag in it is left out.
    """
    if identification is None:
        return None
    found = {p.name: p.value for p in identification.parameters if p.verdict == "ok"}
    slope = found.get("CL_alpha", -found.get("CZ_alpha", math.nan))
    moment = found.get("Cm_alpha", math.nan)
    if not (math.isfinite(moment) and math.isfinite(slope) and slope > 0.0):
        return None
    shift = np.array([aircraft.c * moment / slope, 0.0, 0.0])
    name = "CL_alpha" if "CL_alpha" in found else "CZ_alpha"
    return aircraft.reference_point + shift, f"by the identified Cm_alpha and {name}"


def _surfaces(aircraft: Aircraft) -> Html:
    shape = aircraft.geometry
    assert shape is not None
    rows = []
    for surface in shape.surfaces:
        p = planform(surface)
        volume = MISSING
        if surface.role in ("tailplane", "fin"):
            length = aircraft.c if surface.role == "tailplane" else aircraft.b
            volume = number(tail_volume(p, aircraft.reference_point, aircraft.S, length), 3)
        rows.append(
            [
                tag("code", surface.name),
                surface.role,
                number(p.area, 4),
                number(exposed_area(surface, shape.bodies), 4),
                number(wetted_area(surface, shape), 4),
                number(p.span, 4),
                number(p.aspect, 3),
                number(p.taper, 3),
                number(p.chord, 4),
                number(math.degrees(p.sweep_quarter), 3),
                number(math.degrees(p.dihedral), 3),
                volume,
                ", ".join(dict.fromkeys(s.airfoil for s in surface.sections)),
                ", ".join(c.name for c in surface.controls) or MISSING,
            ]
        )
    return table(
        "Lifting surfaces, in their own plane. Span and aspect ratio of a fin are those of the "
        "mirrored wing; tail volumes are about the moment reference.",
        ["Surface", "Role", "Area, m²", "Exposed, m²", "Wetted, m²", "Span, m", "Aspect ratio",
         "Taper", "Mean chord, m", "Sweep of c/4, deg", "Dihedral, deg", "Tail volume",
         "Airfoil", "Controls"],
        rows,
        numeric=range(2, 12),
        class_="dense",
    )  # fmt: skip


def _bodies(aircraft: Aircraft) -> Html:
    shape = aircraft.geometry
    assert shape is not None
    rows = []
    for body in shape.bodies:
        s = BodyShape(body)
        rows.append(
            [
                tag("code", body.name),
                len(body.sections),
                number(s.length, 4),
                number(float(s.width.max()), 3),
                number(float(s.height.max()), 3),
                number(s.volume, 4),
                number(s.wetted_area, 4),
            ]
        )
    return table(
        "Bodies, by elliptic cross-sections.",
        ["Body", "Sections", "Length, m", "Width, m", "Height, m", "Volume, m³", "Wetted, m²"],
        rows,
        numeric=range(1, 7),
    )
