"""Three views of an aircraft as SVG: from above, from the left, from ahead, at one scale.

Colors are classes of the style sheet, so that they follow light, dark and paper; a file of its own
brings them along.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from alula.aircraft import Aircraft, Body
from alula.base.arrays import Array
from alula.report.html import Html, join, tag
from alula.report.view_shapes import control_corners, corners, lattice, outline

STYLE = (
    "svg.threeview{background:#fff;color:#1c2733}"
    ".threeview text{font:13px system-ui,sans-serif;fill:currentColor;stroke:#fff;stroke-width:3px;"
    "stroke-linejoin:round;paint-order:stroke}.threeview .leader{stroke:currentColor;fill:none}"
    ".threeview .body{fill:#e3e7ec;stroke:#59636e}.threeview .station{fill:none;stroke:#b9c1ca}"
    ".threeview .surface{fill:#f7f9fb;fill-opacity:.85;stroke:#1c2733}"
    ".threeview .panel{stroke:#9aa4af;stroke-width:.5;fill:none}"
    ".threeview .control{fill:#0b5cad;fill-opacity:.22;stroke:#0b5cad}"
    ".threeview .hinge{fill:none;stroke:#0b5cad;stroke-width:1.5;stroke-dasharray:5 3}"
    ".threeview .disk{fill:none;stroke:#a8400f;stroke-width:2}.threeview .engine{fill:#a8400f}"
    ".threeview .sensor{fill:#18703a}.threeview .ring{fill:#fff;stroke:#1c2733;stroke-width:1.2}"
    ".threeview .full{fill:#1c2733}.threeview .neutral{fill:#fff;stroke:#b3261e;stroke-width:2}"
    ".threeview .cross{stroke:#1c2733;stroke-width:1.5;fill:none}"
    ".threeview .scale{stroke:currentColor;stroke-width:1.5;fill:none}"
)
_WIDTH = 460.0  # of the widest view: a column of the report, and a phone's page without much loss
_PAD = 14.0
_FOOT = 34.0  # for the scale
# Screen right and screen down, each as a row over body axes x, y, z.
_AXES = {
    "from above": ((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0)),
    "from the left": ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "from ahead": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
}


@dataclass
class _View:
    """One projection: m to pixels, and where names stand already."""

    title: str
    axes: Array  # (2, 3)
    low: Array  # (2,) m, the corner at the upper left
    size: Array  # (2,) m
    scale: float  # pixels per m

    def at(self, points: Array) -> Array:
        """Points (..., 3) m in pixels (..., 2)."""
        return np.asarray((points @ self.axes.T - self.low) * self.scale + _PAD)

    @property
    def width(self) -> float:
        """Pixels; the same of all views, so that a narrow page shrinks them alike."""
        return _WIDTH

    @property
    def height(self) -> float:
        """Pixels, scale included."""
        return float(self.size[1]) * self.scale + 2 * _PAD + _FOOT


def views(aircraft: Aircraft, neutral_point: Array | None = None) -> list[tuple[str, Html]]:
    """(title, SVG) of each view; the aircraft must have a geometry.

    Drawn are bodies, surfaces with the lattice's panels, control surfaces with their hinges,
    propeller disks, sensors, the center of gravity, the moment reference and, where given, the
    neutral point (3,) m.
    """
    return [(v.title, _svg(aircraft, v, neutral_point)) for v in _planned(aircraft)]


def three_view(aircraft: Aircraft, neutral_point: Array | None = None) -> Html:
    """The three views in one SVG with its style, as a file of its own."""
    planned = _planned(aircraft)
    width = _WIDTH
    parts, y = [], 24.0
    for v in planned:
        parts.append(tag("text", v.title, x=f"{_PAD:g}", y=f"{y - 6:.1f}"))
        parts.append(
            tag("g", _drawn(aircraft, v, neutral_point), transform=f"translate(0 {y:.1f})")
        )
        y += v.height + 24.0
    label = f"{aircraft.name}, three views"
    return tag(
        "svg",
        tag("title", label),
        tag("style", Html(STYLE)),
        *parts,
        class_="threeview",
        xmlns="http://www.w3.org/2000/svg",
        width=f"{width:.0f}",
        height=f"{y:.0f}",
        viewBox=f"0 0 {width:.0f} {y:.0f}",
        role="img",
        aria_label=label,
    )


def _planned(aircraft: Aircraft) -> list[_View]:
    points = _extent(aircraft)
    boxes = []
    for title, axes in _AXES.items():
        seen = points @ np.array(axes).T
        low, high = seen.min(axis=0), seen.max(axis=0)
        boxes.append((title, np.array(axes), low, np.maximum(high - low, 1e-6)))
    widest = max(float(size[0]) for *_, size in boxes)
    scale = (_WIDTH - 2 * _PAD) / widest
    return [_View(title, axes, low, size, scale) for title, axes, low, size in boxes]


def _extent(aircraft: Aircraft) -> Array:
    """Everything that must be on the drawing, (n, 3)."""
    shape = aircraft.geometry
    assert shape is not None
    found = [c for s in shape.surfaces for side in _sides(s.mirror) for c in corners(s, side)]
    for body in shape.bodies:
        for s in body.sections:
            half = np.array([0.0, 0.5 * s.width, 0.5 * s.height])
            found.append(np.array([s.position - half, s.position + half]))
    for disk in _disks(aircraft):
        found.append(disk)
    found += [p[None, :] for p in aircraft.sensors.values()]
    if aircraft.mass is not None:
        found.append(aircraft.mass.cg[None, :])
    return np.concatenate(found)


def _sides(mirror: bool) -> tuple[float, ...]:
    return (1.0, -1.0) if mirror else (1.0,)


def _disks(aircraft: Aircraft) -> Iterator[Array]:
    """Each propeller's circle (61, 3), square to the x axis, or its point where none is known."""
    turn = np.linspace(0.0, 2.0 * np.pi, 61)
    for engine in aircraft.engines:
        propeller = getattr(engine.machine, "propeller", None)
        radius = 0.0 if propeller is None else 0.5 * propeller.diameter
        ring = np.column_stack([0.0 * turn, radius * np.cos(turn), radius * np.sin(turn)])
        yield engine.position + ring


def _svg(aircraft: Aircraft, view: _View, neutral_point: Array | None) -> Html:
    label = f"{aircraft.name} {view.title}"
    return tag(
        "svg",
        tag("title", label),
        _drawn(aircraft, view, neutral_point),
        class_="threeview",
        width=f"{view.width:.0f}",
        height=f"{view.height:.0f}",
        viewBox=f"0 0 {view.width:.0f} {view.height:.0f}",
        role="img",
        aria_label=label,
    )


def _drawn(aircraft: Aircraft, view: _View, neutral_point: Array | None) -> Html:
    shape = aircraft.geometry
    assert shape is not None
    parts: list[Html] = []
    bodies = [_body(view, body) for body in shape.bodies]
    ahead = view.title == "from ahead"
    surfaces: list[Html] = []
    for surface in shape.surfaces:
        for side in _sides(surface.mirror):
            for quad in corners(surface, side, shape.airfoils if ahead else None):
                surfaces.append(_path(view, [quad], "surface", closed=True))
            if ahead:  # a hinge seen along the chord says nothing
                continue
            surfaces.append(_path(view, lattice(surface, side), "panel"))
            for control in surface.controls:
                quad = control_corners(surface, control, side)
                moved = _path(view, [quad], "control", closed=True)
                surfaces += [moved, _path(view, [quad[:2]], "hinge")]
    # Seen from above and the left the wing hides the fuselage's side; from ahead it is behind.
    parts += [*surfaces, *bodies] if ahead else [*bodies, *surfaces]
    for disk in _disks(aircraft):
        parts.append(_path(view, [disk], "disk", closed=True))
    parts += _marks(aircraft, view, neutral_point)
    parts.append(_scale(view))
    return join(parts)


def _body(view: _View, body: Body) -> Html:
    skin, stations = outline(body, view.title)
    return join([
        *(_path(view, [s], "body", closed=True) for s in skin),
        _path(view, stations, "station", closed=view.title == "from ahead"),
    ])  # fmt: skip


def _marks(aircraft: Aircraft, view: _View, neutral_point: Array | None) -> Iterator[Html]:
    """Engines, sensors, moment reference, neutral point and center of gravity, with their names."""
    names: list[tuple[float, float, str]] = []
    for engine in aircraft.engines:
        x, y = map(float, view.at(engine.position))
        yield tag("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r="3.5", class_="engine")
        names.append((x, y, engine.name))
    for name, position in aircraft.sensors.items():
        x, y = map(float, view.at(position))
        yield tag("path", d=f"M{x:.1f} {y - 5:.1f}l4.5 8h-9Z", class_="sensor")
        names.append((x, y, name))
    x, y = map(float, view.at(aircraft.reference_point))
    yield tag("path", d=f"M{x - 9:.1f} {y:.1f}h18M{x:.1f} {y - 9:.1f}v18", class_="cross")
    cg = None if aircraft.mass is None else view.at(aircraft.mass.cg)
    if cg is None or float(np.hypot(*(cg - (x, y)))) > 9.0:
        names.append((x, y, "reference"))
    if cg is not None:
        x, y = map(float, cg)
        yield tag("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r="6", class_="ring")
        quarters = f"M{x:.1f} {y:.1f}v-6a6 6 0 0 1 6 6ZM{x:.1f} {y:.1f}v6a6 6 0 0 1-6-6Z"
        yield tag("path", d=quarters, class_="full")
        names.append((x, y, "CG"))
    if neutral_point is not None:
        x, y = map(float, view.at(neutral_point))
        yield tag("path", d=f"M{x:.1f} {y - 6:.1f}l5 6-5 6-5-6Z", class_="neutral")
        names.append((x, y, "NP"))
    taken = [(x - 6.0, y - 6.0, x + 6.0, y + 6.0) for x, y, _ in names]
    for x, y, name in names:
        yield _named(view, x, y, name if len(name) <= 18 else name[:17] + "…", taken)


def _named(
    view: _View, x: float, y: float, name: str, taken: list[tuple[float, float, float, float]]
) -> Html:
    """A name beside its mark where neither mark nor other name stands, else led there by a line."""
    wide, high = 7.4 * len(name) + 2.0, 13.0
    places = [(x + 11.0, y), (x - 11.0 - wide, y)]
    for far in (18.0, 32.0, 46.0, 60.0, 74.0):
        for up in (-far, far):
            places += [(x + 6.0 + 0.4 * far, y + up), (x - 6.0 - 0.4 * far - wide, y + up)]
    floor = view.height - _FOOT + 4.0

    def free(place: tuple[float, float]) -> bool:
        a, b, c, d = place[0], place[1] - 0.5 * high, place[0] + wide, place[1] + 0.5 * high
        if a < 0.0 or c > view.width or b < 0.0 or d > floor:
            return False
        return all(c <= p or r <= a or d <= q or s <= b for p, q, r, s in taken)

    left, middle = next((p for p in places if free(p)), places[0])
    taken.append((left, middle - 0.5 * high, left + wide, middle + 0.5 * high))
    line: Html | str = ""
    if abs(middle - y) > 1.0:
        end = left - 1.0 if left > x else left + wide + 1.0
        line = tag("path", d=f"M{x:.1f} {y:.1f}L{end:.1f} {middle:.1f}", class_="leader")
    right = left + wide < x
    text = tag(
        "text", name, x=f"{left + (wide if right else 0.0):.1f}", y=f"{middle + 4.5:.1f}",
        text_anchor="end" if right else "start",
    )  # fmt: skip
    return join([line, text])


def _scale(view: _View) -> Html:
    """A bar of a round length, a sixth to a third of the widest view."""
    third = (_WIDTH - 2 * _PAD) / view.scale / 3.0
    power = 10.0 ** math.floor(math.log10(third))
    length = max(k * power for k in (1.0, 2.0, 5.0) if k * power <= third)
    x, y, long = _PAD, view.height - 12.0, length * view.scale
    d = f"M{x:.1f} {y - 4:.1f}v8m0-4h{long:.1f}m0-4v8"
    return join([
        tag("path", d=d, class_="scale"),
        tag("text", f"{length:g} m", x=f"{x + long + 7:.1f}", y=f"{y + 4.5:.1f}"),
    ])  # fmt: skip


def _path(view: _View, lines: Sequence[Array], class_: str, *, closed: bool = False) -> Html:
    """Lines of points (n, 3) m as one path."""
    text = ""
    for line in lines:
        xy = view.at(np.asarray(line))
        text += "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in xy) + ("Z" if closed else "")
    return tag("path", d=text, class_=class_) if text else Html("")
