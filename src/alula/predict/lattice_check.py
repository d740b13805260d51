"""What the vortex lattice cannot take, and what it takes with a warning."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from difflib import get_close_matches

import numpy as np

from alula.aircraft.geometry import Geometry
from alula.aircraft.geometry_check import shape_errors
from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, note, refuse, warn
from alula.core import host as compiled
from alula.model import Reference
from alula.predict.panels import CONTROLS, Panels

MACH_SAID, MACH_LIMIT = 0.6, 0.8  # Prandtl-Glauert is for flow without shocks
ALPHA_SAID, ALPHA_LIMIT = np.radians(15.0), np.radians(45.0)  # attached flow
# Of a strip's width: a wake that near spoils the strip; its turning spoils derivatives; singular.
_NEAR, _NEAR_TURNING, _IN = 0.05, 0.25, 1e-4


def check_shape(geometry: Geometry) -> None:
    """Raises BadInput for what is no lattice, each thing named."""
    if not geometry.surfaces:
        raise refuse(
            "no_surfaces",
            where="geometry.surfaces",
            expected="at least one lifting surface",
            found="none",
            do="Describe the wing by its sections.",
        )
    for s in geometry.surfaces:
        where = f"geometry.surfaces.{s.name}"
        if len(s.sections) < 2:
            raise _wrong("sections", where, "at least two sections", str(len(s.sections)))
        numbers = np.concatenate([[*x.position, x.chord, x.twist] for x in s.sections])
        hinges = [x for c in s.controls for x in (c.start, c.end, *c.hinge, *c.gains.values())]
        if not (np.all(np.isfinite(numbers)) and np.all(np.isfinite(hinges))):
            raise _wrong("non_finite", where, "finite positions, chords, twists and hinges", "nan")
        for x in s.sections:
            airfoil = geometry.airfoils.get(x.airfoil)
            if airfoil is None:
                known = ", ".join(geometry.airfoils) or "none"
                raise _wrong("unknown_airfoil", where, f"an airfoil of: {known}", f"'{x.airfoil}'")
            _check_airfoil(airfoil.camber, airfoil.alpha_0, f"geometry.airfoils.{x.airfoil}")
        for a, b in zip(s.sections, s.sections[1:], strict=False):
            if min(a.chord, b.chord) < 0.0 or a.chord + b.chord <= 0.0:
                raise _wrong("zero_area", where, "positive chords", f"{a.chord:g}, {b.chord:g} m")
    names = [s.name for s in geometry.surfaces]
    if len(set(names)) < len(names):
        raise _wrong("surface_names", "geometry.surfaces", "a name of its own each", str(names))
    errors = shape_errors(geometry, "geometry")
    if errors:
        raise BadInput(*errors)


def _check_airfoil(camber: Array | None, alpha_0: float | None, where: str) -> None:
    if alpha_0 is not None and not np.isfinite(alpha_0):
        raise _wrong("non_finite", where, "a finite alpha_0", str(alpha_0))
    if camber is None:
        return
    good = camber.ndim == 2 and camber.shape[1:] == (2,) and len(camber) >= 2
    if not good or not np.all(np.isfinite(camber)) or np.any(np.diff(camber[:, 0]) <= 0.0):
        raise _wrong("camber", where, "finite points (k, 2), x/c increasing", "others")


def check_condition(
    reference: Reference, point: Array, numbers: Mapping[str, float]
) -> tuple[Message, ...]:
    """Warnings of a condition at the border; raises BadInput beyond it. numbers: by name."""
    for name, value in {**vars(reference), **numbers}.items():
        if not np.isfinite(value):
            raise _wrong("non_finite", f"vortex_lattice, {name}", "a finite number", str(value))
    if min(reference.S, reference.b, reference.c) <= 0.0:
        raise _wrong("reference", "vortex_lattice, reference", "positive S, b, c", str(reference))
    if point.shape != (3,) or not np.all(np.isfinite(point)):
        raise _wrong("reference_point", "vortex_lattice, point", "three finite numbers", str(point))
    mach = numbers["mach"]
    if not 0.0 <= mach < MACH_LIMIT:
        raise refuse(
            "mach_range",
            where="vortex_lattice, mach",
            expected=f"0 to below {MACH_LIMIT:g}: Prandtl-Glauert's rule knows no shocks",
            found=f"{mach:g}",
            do="Predict at a lower Mach number; above it no thin-surface method of Alula holds.",
        )
    said = []
    if mach > MACH_SAID:
        said.append(
            warn(
                "mach_border",
                where="vortex_lattice, mach",
                expected=f"at most {MACH_SAID:g}",
                found=f"{mach:g}",
                do="Distrust the values where the wing is near its critical Mach number.",
            )
        )
    for name in ("alpha", "beta"):
        angle = abs(numbers[name])
        if angle > ALPHA_LIMIT:
            raise refuse(
                "angle_range",
                where=f"vortex_lattice, {name}",
                expected=f"at most {np.degrees(ALPHA_LIMIT):g} deg: attached flow",
                found=f"{np.degrees(angle):.4g} deg",
                do="Give angles in rad; use strip theory beyond the stall.",
            )
        if angle > ALPHA_SAID:
            said.append(
                warn(
                    "angle_border",
                    where=f"vortex_lattice, {name}",
                    expected=f"at most {np.degrees(ALPHA_SAID):g} deg, flow attached everywhere",
                    found=f"{np.degrees(angle):.4g} deg",
                    do="Distrust the values near the stall: the lattice knows no separation.",
                )
            )
    return tuple(said)


def check_mesh(geometry: Geometry, mesh: Mapping[str, tuple[int, int]]) -> None:
    """Raises BadInput for a mesh of unknown surfaces, without panels, or of too many."""
    names = [s.name for s in geometry.surfaces]
    for name, (m, s) in mesh.items():
        if name not in names:
            expected = "surfaces of the geometry: " + ", ".join(names)
            near = get_close_matches(name.lower(), [n.lower() for n in names], n=1)
            meant = [n for n in names if n.lower() in near]
            do = f"Did you mean '{meant[0]}'?" if meant else "Correct it."
            raise _wrong("unknown_surface", "vortex_lattice, panels", expected, f"'{name}'", do)
        if min(m, s) < 1:
            expected = "at least 1 panel along the chord and the span"
            raise _wrong("panels", f"vortex_lattice, panels.{name}", expected, f"({m}, {s})")
    count = sum(
        mesh[s.name][0] * mesh[s.name][1] * (2 if s.mirror else 1) for s in geometry.surfaces
    )
    if count > compiled.LATTICE_PANELS:
        raise refuse(
            "too_many_panels",
            where="vortex_lattice, panels",
            expected=f"at most {compiled.LATTICE_PANELS} (a matrix of 1.8 GB)",
            found=f"{count}",
            do="Use a coarser mesh; a mesh study shows what the finer one would change.",
        )


def check_deflections(deflections: Mapping[str, float]) -> None:
    """Raises BadInput for a control that is none, or an angle that is none."""
    for name, value in deflections.items():
        if name not in CONTROLS:
            expected = "controls by name: " + ", ".join(CONTROLS)
            raise _wrong("unknown_control", "vortex_lattice, deflections", expected, f"'{name}'")
        if not abs(value) <= ALPHA_LIMIT:
            expected = f"at most {np.degrees(ALPHA_LIMIT):g} deg, in rad"
            raise _wrong(
                "deflection", f"vortex_lattice, deflections.{name}", expected, f"{value} rad"
            )


def wakes_near(panels: Panels, stream: Array, core: float, *, turning: bool) -> tuple[Message, ...]:
    """A warning for each pair of surfaces of which one's wake runs into the other's panels.

    stream: (3, 3), the wind axes in body axes (rows: along the stream, right, up). turning: the
    derivatives have the wake's turning, which counts where something is loaded. Raises BadInput
    where a control point lies in a trailing leg: its velocity is infinite without a core.
    """
    if core > 0.0:
        return ()
    ends = np.concatenate([panels.strip_first, panels.strip_last]) @ stream.T
    points = panels.strip_control @ stream.T
    of = np.concatenate([panels.strip_surface, panels.strip_surface])
    apart = np.hypot(points[:, None, 1] - ends[None, :, 1], points[:, None, 2] - ends[None, :, 2])
    other = (panels.strip_surface[:, None] != of) & (points[:, None, 0] > ends[None, :, 0])
    near = np.where(other, apart / panels.strip_width[:, None], np.inf)
    loaded = bool(np.any(np.abs(panels.normal @ stream[0]) > 1e-9))
    return tuple(_wake_messages(panels, near, of, _NEAR_TURNING if turning and loaded else _NEAR))


def _wake_messages(panels: Panels, near: Array, of: Array, allowed: float) -> Iterator[Message]:
    if near.min() >= allowed:
        return
    for i, name in enumerate(panels.surfaces):
        for j, source in enumerate(panels.surfaces):
            pair = near[np.ix_(panels.strip_surface == i, of == j)]
            least = float(pair.min()) if pair.size else np.inf
            if least >= allowed:
                continue
            say = {
                "where": f"vortex_lattice, surfaces '{source}' and '{name}'",
                "expected": f"trailing legs of '{source}' at least {allowed:g} of a strip's width "
                f"from the control points of '{name}'",
                "found": f"{least:.2g} of it",
                "do": "Change the number of strips so that those of the two surfaces fall "
                "together, hold the wake, or ask for a vortex core between surfaces.",
            }
            if least < _IN:
                raise refuse("wake_in_panel", **say)
            yield warn("wake_near_panel", **say)


def assumed_zero_lift(geometry: Geometry) -> tuple[Message, ...]:
    """A note for airfoils whose mean line is not known but whose angle of zero lift is."""
    used = {x.airfoil for s in geometry.surfaces for x in s.sections}
    flat = [
        name
        for name in sorted(used)
        if geometry.airfoils[name].camber is None and geometry.airfoils[name].alpha_0
    ]
    if not flat:
        return ()
    return (
        note(
            "camber_by_zero_lift",
            where="geometry.airfoils: " + ", ".join(flat),
            expected="the mean line",
            found="the angle of zero lift only, taken as a twist of the whole section",
            do="Give the camber for the moment of the section itself, Cm_0.",
        ),
    )


def _wrong(code: str, where: str, expected: str, found: str, do: str = "Correct it.") -> BadInput:
    return refuse(code, where=where, expected=expected, found=found, do=do)
