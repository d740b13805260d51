"""Derivatives, span loads and induced drag of thin lifting surfaces by a vortex lattice.

Horseshoe vortices with trailing legs along the stream, no flow through the panels at three
quarters of their chord; Katz and Plotkin 2001, Sec. 12.3. The numbers are made in
core/host/include/alula/host/vortex_lattice.hpp: one factorization, exact derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np

from alula.aircraft.geometry import Geometry
from alula.base.arrays import Array, frozen
from alula.base.messages import Message, note, refuse, warn
from alula.core import host as compiled
from alula.model import Reference
from alula.predict.half_panels import Spacing
from alula.predict.lattice_axes import MOTIONS
from alula.predict.lattice_check import (
    assumed_zero_lift,
    check_condition,
    check_deflections,
    check_mesh,
    check_shape,
    wakes_near,
)
from alula.predict.lattice_result import LatticeResult, SpanLoad
from alula.predict.panels import Panels, make_panels

Wake = Literal["turning", "held"]
SPACINGS: tuple[Spacing, ...] = ("uniform", "cosine")
WAKES: tuple[Wake, ...] = ("turning", "held")
_DRAGS_APART = 0.2  # of the induced drag: near field and far field then contradict each other
_LIFTING = 0.1  # CL from which on the Oswald factor is that of the condition's own load


def vortex_lattice(
    geometry: Geometry,
    reference: Reference,
    point: Array,
    *,
    alpha: float = 0.0,
    beta: float = 0.0,
    mach: float = 0.0,
    deflections: Mapping[str, float] | None = None,
    panels: Mapping[str, tuple[int, int]] | None = None,
    spacing: Spacing = "uniform",
    core: float | None = None,
    wake: Wake = "turning",
    symmetry: bool = True,
) -> LatticeResult:
    """Loads at one condition and their derivatives to alpha, beta, p, q, r and every control.

    point: (3,) m, body axes from the datum: moments and rotations are about it. alpha, beta: rad.
    mach: by Prandtl-Glauert, below 0.8. deflections: rad, by control ('de', 'da', 'dr', 'df'),
    where derivatives are taken; zero where absent. panels: (chordwise, spanwise of the half) by
    surface, in place of the geometry's own; at most core.LATTICE_PANELS panels in all. spacing:
    of the panels along chord and span, 'uniform' or 'cosine'. core: m, radius of a vortex core
    between different surfaces; None: none. wake: 'turning' with alpha and beta, so that derivatives
    are those of whole solutions; 'held' where it is, as other codes differentiate: smoother where
    the wake of a loaded wing passes close to a tail. symmetry: False solves both halves even where
    one would do. Raises BadInput for a shape, mesh or condition that the method cannot take.
    """
    moved = dict(deflections or {})
    point = np.asarray(point, dtype=np.float64)
    numbers = {"alpha": alpha, "beta": beta, "mach": mach, "core": core or 0.0}
    said = [*check_condition(reference, point, numbers)]
    check_shape(geometry)
    check_deflections(moved)
    mesh = {s.name: s.panels for s in geometry.surfaces}
    mesh.update({name: (int(m), int(s)) for name, (m, s) in (panels or {}).items()})
    check_mesh(geometry, mesh)
    if spacing not in SPACINGS or wake not in WAKES or numbers["core"] < 0.0:
        raise refuse(
            "lattice_option",
            where="vortex_lattice, spacing, wake and core",
            expected=f"spacing one of {SPACINGS}, wake of {WAKES}, core a radius in m or None",
            found=f"{spacing!r}, {wake!r}, {core!r}",
            do="Correct it.",
        )
    on_plane = abs(point[1]) <= 1e-9 * reference.b
    lattice = make_panels(
        geometry, mesh, spacing, moved, symmetric=symmetry and beta == 0.0 and on_plane
    )
    # Looked at again: the pieces between sections and controls may ask for more strips.
    check_mesh(geometry, lattice.mesh)
    said += _finer(mesh, lattice.mesh)
    said += wakes_near(lattice, _stream(alpha, beta), numbers["core"], turning=wake == "turning")
    sizes = np.array([reference.S, reference.b, reference.c])
    found = compiled.vortex_lattice(
        lattice, alpha, beta, mach, np.zeros(3), point, sizes, numbers["core"], wake == "turning"
    )
    coefficients, derivatives = found["coefficients"][0], found["derivatives"].T
    if not (np.all(np.isfinite(coefficients)) and np.all(np.isfinite(derivatives))):
        raise refuse(
            "lattice_singular",
            where="vortex_lattice",
            expected="a lattice with one solution",
            found="a singular system: panels in one another, or a wake through a control point",
            do="Look for surfaces that touch along a line, or change the numbers of strips.",
        )
    said += assumed_zero_lift(geometry)
    result = _result(
        lattice, reference, point, numbers, moved, (spacing, wake), found, coefficients, derivatives
    )
    said += _drags(result)
    return result.with_messages((_conventions(result), *said))


def _stream(alpha: float, beta: float) -> Array:
    """The wind axes in body axes: rows along the stream, to the right, up."""
    ca, sa, cb, sb = np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta)
    return np.array([[-ca * cb, -sb, -sa * cb], [-ca * sb, cb, -sa * sb], [sa, 0.0, -ca]])


def _result(
    lattice: Panels,
    reference: Reference,
    point: Array,
    numbers: Mapping[str, float],
    deflections: Mapping[str, float],
    options: tuple[str, str],
    found: Mapping[str, Array],
    coefficients: Array,
    derivatives: Array,
) -> LatticeResult:
    alpha = numbers["alpha"]
    lift = coefficients[0] * np.sin(alpha) - coefficients[2] * np.cos(alpha)
    drag = found["wake_drag"]  # of the condition's circulation, and of that due to alpha
    own = abs(lift) >= _LIFTING
    if own:
        ideal, made = lift**2, float(drag[0, 0])
    else:
        ideal, made = float(_lift_rate(coefficients, derivatives, alpha)) ** 2, float(drag[1, 1])
    slope = derivatives[2, 0]
    neutral = point.copy()
    neutral[0] = point[0] - reference.c * derivatives[4, 0] / slope if slope else np.nan
    return LatticeResult(
        reference=reference,
        point=frozen(point),
        alpha=alpha,
        beta=numbers["beta"],
        mach=numbers["mach"],
        core=numbers["core"],
        deflections=dict(deflections),
        spacing=options[0],
        wake=options[1],
        columns=(*MOTIONS, *lattice.controls),
        body_coefficients=frozen(coefficients),
        body_derivatives=frozen(derivatives),
        induced_drag=float(drag[0, 0]),
        oswald=ideal * reference.S / (np.pi * reference.b**2 * made) if made > 0.0 else np.nan,
        oswald_of="the condition's load" if own else "the load due to alpha",
        neutral_point=frozen(neutral),
        symmetric=lattice.right > 0,
        panels=lattice,
        circulation=frozen(found["circulation"][0]),
        circulation_rates=frozen(found["circulation_rates"]),
        force=frozen(found["force"]),
        span_loads=_span_loads(lattice, found),
        messages=(),
    )


def _lift_rate(coefficients: Array, derivatives: Array, alpha: float) -> float:
    """Lift of the circulation due to alpha alone: CL_alpha."""
    c, s = np.cos(alpha), np.sin(alpha)
    cx, cz = coefficients[[0, 2]]
    return float(derivatives[0, 0] * s - derivatives[2, 0] * c + cx * c + cz * s)


def _span_loads(lattice: Panels, found: Mapping[str, Array]) -> tuple[SpanLoad, ...]:
    """The strips of each surface from its left (or lower) to its right (or upper) tip."""
    circulation, wash = found["strip_circulation"][0], found["strip_wash"][0]
    loads = []
    for k, name in enumerate(lattice.surfaces):
        strips = np.flatnonzero(lattice.strip_surface == k)
        middle = lattice.strip_middle[strips]
        wide = np.ptp(middle[:, 1]) >= np.ptp(middle[:, 2])
        strips = strips[np.argsort(middle[:, 1] if wide else -middle[:, 2], kind="stable")]
        chord = lattice.strip_chord[strips]
        loads.append(
            SpanLoad(
                surface=name,
                position=frozen(lattice.strip_middle[strips]),
                chord=frozen(chord),
                width=frozen(lattice.strip_width[strips]),
                circulation=frozen(circulation[strips]),
                c_l=frozen(2.0 * circulation[strips] / chord),
                induced_angle=frozen(-0.5 * wash[strips]),
            )
        )
    return tuple(loads)


def _finer(
    asked: Mapping[str, tuple[int, int]], made: Mapping[str, tuple[int, int]]
) -> list[Message]:
    return [
        note(
            "more_strips",
            where=f"vortex_lattice, panels.{name}",
            expected=f"{asked[name][1]} strips",
            found=f"{mesh[1]}, one for each piece between sections and ends of controls",
            do="Nothing, or ask for more strips so that their widths even out.",
        )
        for name, mesh in made.items()
        if mesh[1] != asked[name][1]
    ]


def _drags(result: LatticeResult) -> list[Message]:
    model = result.coefficients("model")
    near, far = model["CD"], result.induced_drag
    if abs(model["CL"]) < _LIFTING or abs(near - far) <= _DRAGS_APART * abs(far):
        return []
    return [
        warn(
            "induced_drag_apart",
            where="vortex_lattice, induced drag",
            expected=f"near field and far field within {100 * _DRAGS_APART:g} %",
            found=f"CD {near:.5f} by the forces on the panels, {far:.5f} in the Trefftz plane",
            do="Use more panels along chord and span; take the value of the Trefftz plane.",
        )
    ]


def _conventions(result: LatticeResult) -> Message:
    r = result.reference
    x, y, z = result.point
    return note(
        "lattice_conventions",
        where="vortex_lattice",
        expected="values that are compared in the same conventions",
        found=f"S {r.S:g} m2, b {r.b:g} m, c {r.c:g} m; moments and rotations about "
        f"({x:.6g}, {y:.6g}, {z:.6g}) m, body axes from the datum; phat = p b/2V, qhat = q c/2V, "
        "rhat = r b/2V; 'stability': forces, moments and rates along stability axes, 'model': "
        "CD, CY, CL with moments and rates along body axes, 'body': all along body axes; angles "
        "and deflections per rad unless a name ends in _per_deg; positive deflections are trailing "
        f"edge down (da: right half; dr: left); wake along the stream, {result.wake} as alpha and "
        f"beta change; {'one half solved' if result.symmetric else 'both halves solved'}; "
        + (f"vortex core of {result.core:g} m between surfaces" if result.core else "no core"),
        do="Convert other sources' values before comparing.",
    )
