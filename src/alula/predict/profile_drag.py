"""Profile drag as a sum of parts: wetted areas by skin friction, everything else by drag areas.

The sum of drag areas over the wing's is Pusztai 2018, appendix C.4. Friction, form factors and
their sum are USAF Datcom, sec. 4.1.5.1 and 4.2.3.1, and Raymer, Aircraft Design, ch. 12.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log10, sqrt

from alula.predict.handbook import Found, Range, found, positive

# Lift factor R_LS of Datcom 4.1.5.1 for unswept surfaces below Mach 0.25, read from its chart.
LIFTING_SURFACE = 1.07
# What the clean shape leaves out: gaps, leaks, rivets, antennas (Raymer ch. 12: 5 to 10 % for
# propeller aircraft). The middle, and as large an error.
LEAKS = 0.075


@dataclass(frozen=True)
class DragItem:
    """A part by its drag area. c_d: on its own frontal area `area`, m2."""

    name: str
    c_d: float
    area: float


@dataclass(frozen=True)
class WettedPart:
    """A part by its skin. wetted: m2. length: m, of the flow along it. form, interference: factors.

    laminar: share of the length with a laminar boundary layer.
    """

    name: str
    wetted: float
    length: float
    form: float
    interference: float = 1.0
    laminar: float = 0.1


def drag_area(items: Sequence[DragItem]) -> float:
    """Sum of c_d times area, m2."""
    return sum(item.c_d * item.area for item in items)


def drag_of_items(items: Sequence[DragItem], area: float) -> Found:
    """Drag coefficient of the items on the reference area, C_DF of Pusztai 2018, appendix C.4."""
    positive("drag of parts", reference_area=area)
    value = drag_area(items) / area
    return found(value, 0.25 * value, "drag areas; se 25 %, handbook values of parts, our judgment")


def friction(reynolds: float, mach: float = 0.0, laminar: float = 0.0) -> float:
    """Mean skin friction of a flat plate, laminar (Blasius) over the share `laminar` of it.

    Turbulent: Prandtl and Schlichting's 0.455/log10(Re)^2.58 with the Mach factor of Raymer ch. 12.
    """
    positive("skin friction", reynolds=reynolds)
    turbulent: float = 0.455 / log10(max(reynolds, 1e4)) ** 2.58 / (1.0 + 0.144 * mach**2) ** 0.65
    return laminar * 1.328 / sqrt(reynolds) + (1.0 - laminar) * turbulent


def surface_form(thickness: float, thickest: float = 0.3) -> float:
    """Form factor of a lifting surface (Datcom 4.1.5.1). thickest: its place, of the chord.

    Valid to a thickness of 0.21.
    """
    slope = 1.2 if thickest >= 0.30 else 2.0
    return (1.0 + slope * thickness + 100.0 * thickness**4) * LIFTING_SURFACE


def body_form(length: float, diameter: float) -> float:
    """Form factor of a body (Datcom 4.2.3.1): 1 + 60/f3 + 0.0025 f with its fineness f."""
    positive("body's form factor", length=length, diameter=diameter)
    f = length / diameter
    return 1.0 + 60.0 / f**3 + 0.0025 * f


def profile_drag(
    parts: Sequence[WettedPart],
    area: float,
    V: float,
    viscosity: float,
    mach: float = 0.0,
    items: Sequence[DragItem] = (),
) -> tuple[Found, dict[str, float]]:
    """CD at zero lift and its parts by name, on the reference area.

    V: m/s. viscosity: kinematic, m2/s.
    """
    positive("profile drag", reference_area=area, V=V, viscosity=viscosity)
    by_name: dict[str, float] = {}
    ranges = []
    for p in parts:
        reynolds = V * p.length / viscosity
        c_f = friction(reynolds, mach, p.laminar)
        by_name[p.name] = c_f * p.form * p.interference * p.wetted / area
        ranges.append(Range(f"Reynolds number of {p.name}", reynolds, 1.0e5, 1.0e9))
    skin = sum(by_name.values())
    by_name["gaps and leaks"] = LEAKS * skin
    for item in items:
        by_name[item.name] = item.c_d * item.area / area
    value = sum(by_name.values())
    se = ((0.10 * skin) ** 2 + (LEAKS * skin) ** 2 + (0.25 * drag_area(items) / area) ** 2) ** 0.5
    said = found(
        value,
        se,
        "skin friction with form factors (Datcom 4.1.5.1, 4.2.3.1; Raymer ch. 12); se 10 % of the "
        "skin, all of the leaks, 25 % of the parts by drag area, our judgment",
        ranges,
    )
    return said, by_name
