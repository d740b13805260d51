"""Whether a shape can be one, and what the predictors cannot take: each thing said by its name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np

from alula.aircraft.geometry import Body, ControlSurface, Geometry, LiftingSurface
from alula.aircraft.overlap import overlap
from alula.aircraft.schema import AircraftFile
from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse, warn

MOVED = ("de", "da", "dr", "df")  # controls that surfaces follow; a throttle moves none
# Of the chord: nearer surfaces have vortices in each other's panels.
_TOGETHER = 1e-3
_THIN = 1e-6  # of the chord: a strip of less width has no area


def check_geometry(shape: Geometry, file: AircraftFile, path: Path) -> tuple[Message, ...]:
    """What was noticed; raises BadInput with a message for each thing that cannot be."""
    where = f"{path}, geometry"
    errors = shape_errors(shape, where)
    engines = [engine.name for engine in file.engines]
    for name in shape.blades:
        if name not in engines:
            errors.append(
                _error(
                    "unknown_engine",
                    f"{where}.blades.{name}",
                    "the name of an engine: " + (", ".join(engines) or "the file has none"),
                    f"'{name}'",
                    "Name the table after the engine whose propeller it is.",
                )
            )
    if errors:
        raise BadInput(*errors)
    return (*_unmoved(shape, file, where), *_reference(shape, file, where))


def shape_errors(shape: Geometry, where: str) -> list[Message]:
    """A message for each thing that no shape can be: sections, controls, bodies, overlaps."""
    errors: list[Message] = []
    for surface in shape.surfaces:
        errors += _sections(surface, f"{where}.surfaces.{surface.name}")
        for control in surface.controls:
            errors += _control(control, f"{where}.surfaces.{surface.name}.controls.{control.name}")
        errors += _spans(surface, f"{where}.surfaces.{surface.name}.controls")
    for body in shape.bodies:
        errors += _body(body, f"{where}.bodies.{body.name}")
    if not errors:  # overlaps of a surface that is none would only repeat what was said
        errors += _together(shape.surfaces, f"{where}.surfaces")
    return errors


def _error(code: str, where: str, expected: str, found: str, do: str) -> Message:
    return refuse(code, where=where, expected=expected, found=found, do=do).messages[0]


def _sections(surface: LiftingSurface, where: str) -> Iterator[Message]:
    steps = np.diff(surface.arc())
    for k, (step, section) in enumerate(zip(steps, surface.sections[1:], strict=True), 2):
        if step <= _THIN * section.chord:
            yield _error(
                "zero_area",
                f"{where}.sections[{k}]",
                f"another place across the flow (y or z) than section {k - 1}",
                f"{step:.3g} m from it: the strip between them has no area",
                "Move or remove one of the two sections.",
            )
    y = [float(s.position[1]) for s in surface.sections]
    if surface.mirror and min(y) < -_THIN * surface.sections[0].chord:
        yield _error(
            "crossing_sections",
            f"{where}.sections",
            "y of 0 or more where mirror = true adds the left half",
            f"y = {min(y):g}: the two halves cross",
            "Describe the right half only, or set mirror = false.",
        )
    elif surface.mirror and max(y) < _THIN * surface.sections[0].chord:
        yield _error(
            "coincident_surfaces",
            where,
            "a surface off the plane of symmetry where mirror = true",
            f"'{surface.name}' and its own mirror image in one place",
            "Set mirror = false for a single fin.",
        )
    x = [float(s.position[0]) - 0.5 * s.chord for s in surface.sections]
    sweep = np.max(np.abs(np.diff(x)) / np.maximum(steps, 1e-12))
    if sweep > np.tan(np.radians(80.0)) and np.all(steps > 1e-6):
        yield _error(
            "crossing_sections",
            f"{where}.sections",
            "sections side by side across the flow, swept by less than 80 deg",
            f"{np.degrees(np.arctan(sweep)):.1f} deg between two sections",
            "Check x, y, z and the datum's frame: y is across, x along the fuselage.",
        )


def _control(control: ControlSurface, where: str) -> Iterator[Message]:
    for hinge in dict.fromkeys(control.hinge):
        if not 0.0 <= hinge < 1.0:
            yield _error(
                "hinge_outside",
                f"{where}.hinge",
                "a fraction of the chord from 0 (all of it moves) to below 1",
                f"{hinge:g}",
                "Give the hinge as x/c from the leading edge, not in m or percent.",
            )
    if not 0.0 <= control.start < control.end <= 1.0:
        yield _error(
            "control_span",
            f"{where}.span",
            "[from, to] with 0 <= from < to <= 1, fractions of the span between first and last "
            "section",
            f"[{control.start:g}, {control.end:g}]",
            "Give fractions of the (half) span, not m.",
        )
    for name, gain in control.gains.items():
        if name not in MOVED:
            yield _error(
                "unknown_control",
                f"{where}.gains",
                "controls by name: " + ", ".join(MOVED),
                f"'{name}'",
                "Name the control of docs/notation.md that moves this surface.",
            )
        elif gain == 0.0:
            yield _error(
                "control_without_surface",
                f"{where}.gains.{name}",
                "a gain other than 0",
                "0: the control does not move this surface",
                "Remove the entry or give its gearing.",
            )


def _spans(surface: LiftingSurface, where: str) -> Iterator[Message]:
    for one, other in combinations(surface.controls, 2):
        if max(one.start, other.start) < min(one.end, other.end) - 1e-9:
            yield _error(
                "overlapping_controls",
                where,
                "control surfaces side by side on one span",
                f"'{one.name}' ({one.start:g} to {one.end:g}) and '{other.name}' "
                f"({other.start:g} to {other.end:g})",
                "Correct the spans; a surface that follows two controls has two gains.",
            )


def _body(body: Body, where: str) -> Iterator[Message]:
    x = np.array([s.position[0] for s in body.sections])
    forward = np.diff(x) >= 0.0
    if np.any(forward):
        k = int(np.argmax(forward))
        backwards = bool(np.all(forward))
        yield _error(
            "body_order",
            f"{where}.stations[{k + 2}]",
            "stations from nose to tail, each behind the one before",
            "all from tail to nose" if backwards else f"one {x[k + 1] - x[k]:.4g} m ahead of it",
            "Sort the stations"
            + (", or correct the datum's frame: body axes point forward." if backwards else "."),
        )
    sizes = np.array([[s.width, s.height] for s in body.sections])
    wrong = np.any(sizes < 0.0, axis=1) | (np.arange(len(x)) % (len(x) - 1) != 0) & np.any(
        sizes <= 0.0, axis=1
    )
    if np.any(wrong):
        k = int(np.argmax(wrong))
        yield _error(
            "zero_area",
            f"{where}.stations[{k + 1}]",
            "a positive width and height (0 at nose and tail only)",
            f"{sizes[k, 0]:g} and {sizes[k, 1]:g} m",
            "Correct the cross-section.",
        )


def strips(surface: LiftingSurface, side: float = 1.0) -> list[Array]:
    """Each strip between two sections as its corners (4, 3); side -1: of the mirror image."""
    edges = []
    for s in surface.sections:
        front = s.position * np.array([1.0, side, 1.0])
        edges.append((front, front - [s.chord, 0.0, 0.0]))
    return [np.array([a[0], b[0], b[1], a[1]]) for a, b in pairwise(edges)]


def _together(surfaces: Sequence[LiftingSurface], where: str) -> Iterator[Message]:
    halves = [(s, side, strips(s, side)) for s in surfaces for side in _sides(s)]
    said: set[frozenset[str]] = set()
    for (one, side, a), (other, side_b, b) in combinations(halves, 2):
        names = frozenset((one.name, other.name))
        near = _TOGETHER * min(s.chord for s in (*one.sections, *other.sections))
        if names in said or not any(overlap(p, q, near) for p in a for q in b):
            continue
        said.add(names)
        if one is other:
            found = f"'{one.name}' and its own mirror image in one place"
        else:
            halves_named = f" ({_half(side)} and {_half(side_b)} half)" if side != side_b else ""
            found = f"'{one.name}' and '{other.name}'{halves_named} in one place"
        yield _error(
            "coincident_surfaces",
            where,
            "surfaces apart from each other, or side by side",
            found,
            "Join them to one surface with more sections, or correct a position.",
        )
    for surface, side, own in halves:
        if side < 0.0:
            continue
        near = _TOGETHER * min(s.chord for s in surface.sections)
        for (i, p), (j, q) in combinations(enumerate(own, 1), 2):
            if overlap(p, q, near):
                yield _error(
                    "crossing_sections",
                    f"{where}.{surface.name}.sections",
                    "sections in order from root to tip",
                    f"the strip from section {j} to {j + 1} lies over that from {i} to {i + 1}",
                    "Put the sections in order along the span.",
                )


def _sides(surface: LiftingSurface) -> tuple[float, ...]:
    return (1.0, -1.0) if surface.mirror else (1.0,)


def _half(side: float) -> str:
    return "right" if side > 0.0 else "left"


def _unmoved(shape: Geometry, file: AircraftFile, where: str) -> Iterator[Message]:
    moved = {name for s in shape.surfaces for c in s.controls for name in c.gains}
    for name in file.controls:
        if name in MOVED and name not in moved:
            yield warn(
                "control_without_surface",
                where=f"{where}.surfaces",
                expected=f"a control surface that follows '{name}' of [controls]",
                found="none",
                do=f"Add it under the surface's controls with gains = {{{name} = 1.0}}; until then "
                f"the derivatives to {name} are not predicted.",
            )


def _reference(shape: Geometry, file: AircraftFile, where: str) -> Iterator[Message]:
    """The wing's area and span beside [reference], where they differ by more than definitions."""
    wing = shape.surface("wing")
    if wing is None or not wing.mirror:
        return
    area = 2.0 * sum(
        step * 0.5 * (a.chord + b.chord)
        for step, a, b in zip(np.diff(wing.arc()), wing.sections, wing.sections[1:], strict=False)
    )
    span = 2.0 * max(float(s.position[1]) for s in wing.sections)
    pairs = (("b", span, file.reference.b, 0.03), ("S", float(area), file.reference.S, 0.15))
    for key, got, stated, allowed in pairs:
        if abs(got / stated - 1.0) > allowed:  # S: fillets, the part inside the fuselage
            yield warn(
                "geometry_reference",
                where=f"{where}.surfaces.{wing.name}",
                expected=f"{key} = {stated:g}, as in [reference]",
                found=f"{got:.4g} from the sections",
                do="Correct the one or the other; coefficients refer to [reference].",
            )
