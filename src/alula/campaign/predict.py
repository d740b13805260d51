"""Derivatives from the aircraft file's shape, by one method or by all that agree on the whole."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import degrees, hypot, radians
from typing import Any

import numpy as np

from alula.aircraft import Aircraft, load_aircraft
from alula.aircraft.geometry import Geometry
from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse, warn
from alula.core import core
from alula.model import Reference
from alula.predict.axes import along
from alula.predict.combine import FLOOR, SIZE, combine
from alula.predict.derivatives import Derivatives
from alula.predict.flow import Flow
from alula.predict.lattice_and_bodies import lattice_and_bodies
from alula.predict.lattice_result import LatticeResult
from alula.predict.mesh_study import FACTORS, MeshStudy, mesh_study
from alula.predict.prediction import Prediction
from alula.predict.semi_empirical import semi_empirical
from alula.predict.slender_body import slender_bodies
from alula.predict.strip_derivatives import strip_derivatives
from alula.predict.to_model import to_model
from alula.predict.vortex_lattice import Wake, vortex_lattice

METHODS = ("combined", "lattice", "semi", "bodies", "strip")
V = 50.0  # m/s, where the file has no envelope
STUDIED = 2500  # panels of the finest mesh up to which a mesh study costs less than a second
_UNSETTLED = 0.5  # of the value, beyond which the mesh's error is warned of
_OF_LIFT = ("CY_p", "Cl_r", "Cn_p", "Cn_da")  # as in `lattice_and_bodies`
_DIHEDRAL_OF_LIFT = 0.05  # of CL: what sweep and tips add to Cl_beta, as in the handbook's error


@dataclass(frozen=True)
class Asked:
    """What is predicted, and where. V: m/s, None: middle of the envelope. h: m. alpha: rad, None:
    of level flight. mach: None: of V and h. panels: (chordwise, spanwise) by surface. study: of the
    mesh; None: where it is cheap.
    """

    method: str = "combined"
    V: float | None = None
    h: float = 0.0
    alpha: float | None = None
    mach: float | None = None
    panels: Mapping[str, tuple[int, int]] | None = None
    wake: Wake | None = None
    study: bool | None = None


def run_prediction(
    aircraft: Aircraft | str, asked: Asked, progress: Callable[[str], None] = lambda _: None
) -> Prediction:
    """Predict; raises BadInput for an unknown method, a file without shape, an impossible flight.

    'combined' is lattice with bodies and handbook formulas, weighted by their errors.
    """
    plane = load_aircraft(aircraft) if isinstance(aircraft, str) else aircraft
    if asked.method not in METHODS:
        raise refuse(
            "unknown_method", where="--method", expected=f"one of {', '.join(METHODS)}",
            found=f"'{asked.method}'", do="Choose one of these.",
        )  # fmt: skip
    shape = _shape(plane)
    flow = _flow(plane, asked)
    said = _outside(plane, asked)
    wing = shape.surface("wing")
    handbook: Derivatives | None = None
    if wing is not None and asked.method in ("combined", "semi", "strip"):
        handbook = semi_empirical(plane, flow)
    alpha = _alpha(asked, handbook)
    study, lattice = None, None
    if asked.method in ("combined", "lattice"):
        progress("solving the vortex lattice")
        at = 0.0 if asked.method == "combined" else alpha
        study, lattice = _lattice(plane, shape, flow, asked, at)
        said += lattice.messages[1:]  # the first states the conventions, which the command prints
        lattice = lattice.with_messages(lattice.messages[:1])
    loads = lattice
    if lattice is not None and lattice.alpha != alpha:
        loads, more = _loads(plane, shape, flow, asked, alpha)
        said += more
    parts = _parts(plane, asked, lattice, study, handbook, alpha, flow)
    whole = combine(parts) if asked.method == "combined" else along(parts[0], "stability")
    model = None
    if "CL_alpha" in whole.values and asked.method != "bodies":
        reference = Reference(plane.S, plane.b, plane.c)
        name = f"{plane.name}, predicted ({asked.method})"
        warned = tuple(str(m) for m in said if m.level == "warning")
        noted = replace(whole, notes=(*whole.notes, *warned))
        model = to_model(noted, reference, plane.reference_point, name=name)
    neutral, se = _neutral(plane, whole)
    return Prediction(
        plane, asked.method, asked.h, flow, alpha, whole, tuple(parts), model,
        lattice, study, loads, neutral, se, tuple(said),
    )  # fmt: skip


def _outside(plane: Aircraft, asked: Asked) -> list[Message]:
    """A warning where the aircraft does not fly at the speed or the height asked for."""
    out = []
    for name, unit in (("V", "m/s"), ("h", "m")):
        value, limits = getattr(asked, name), getattr(plane.envelope, name)
        if value is not None and limits is not None and not limits[0] <= value <= limits[1]:
            out.append(
                warn(
                    "outside_envelope",
                    where=f"--{name}",
                    expected=f"{limits[0]:.4g} to {limits[1]:.4g} {unit}, the aircraft file's "
                    "envelope",
                    found=f"{value:.4g} {unit}",
                    do="Nothing, if it is meant so; --V is in m/s, --h in m.",
                )
            )
    return out


def _shape(plane: Aircraft) -> Geometry:
    if plane.geometry is None:
        raise refuse(
            "missing_geometry",
            where=plane.path,
            expected="[[geometry.surfaces]] with a wing, and [[geometry.bodies]] if it has any",
            found="no [geometry]",
            do='Add a surface with name, role = "wing", mirror = true and at least two sections '
            "(position, chord, airfoil): docs/aircraft_file.md, Geometry; aircraft/sportstar.toml "
            "is an example.",
        )
    return plane.geometry


def _flow(plane: Aircraft, asked: Asked) -> Flow:
    """The air at h by the standard atmosphere; Mach number of V unless it is given."""
    if not -2000.0 <= asked.h <= 30000.0:
        raise refuse(
            "impossible_condition", where="--h", expected="a height from -2000 to 30000 m",
            found=f"{asked.h:g}", do="Correct it.",
        )  # fmt: skip
    air = np.empty((1, 4))
    core.standard_atmosphere(np.array([asked.h]), air)
    T, _, density, sound = map(float, air[0])
    speed, range_ = asked.V, plane.envelope.V
    if speed is None:
        speed = V if range_ is None else 0.5 * (range_[0] + range_[1])
    # Sutherland's law, ISO 2533.
    viscosity = 1.458e-6 * T**1.5 / (T + 110.4) / density
    mach = speed / sound if asked.mach is None else asked.mach
    return Flow(speed, asked.alpha, None, density, viscosity, mach)


def _alpha(asked: Asked, handbook: Derivatives | None) -> float:
    """The angle asked for, else level flight's; a lattice or bodies alone are taken at zero."""
    if asked.alpha is not None:
        return asked.alpha
    if handbook is not None:
        return radians(float(handbook.conditions["alpha_deg"]))
    return 0.0


def _lattice(
    plane: Aircraft, shape: Geometry, flow: Flow, asked: Asked, alpha: float
) -> tuple[MeshStudy | None, LatticeResult]:
    """At zero angle the wake is held: nothing is loaded but by camber and twist."""
    reference = Reference(plane.S, plane.b, plane.c)
    wake: Wake = asked.wake or ("held" if asked.method == "combined" else "turning")
    options: dict[str, Any] = {
        "alpha": alpha,
        "mach": flow.mach,
        "wake": wake,
        "panels": asked.panels,
    }
    result = vortex_lattice(shape, reference, plane.reference_point, **options)
    finest = result.panels.count * max(FACTORS) ** 2
    if asked.study or (asked.study is None and finest <= STUDIED):
        study = mesh_study(shape, reference, plane.reference_point, **options)
        return study, study.result.with_messages((*study.result.messages, *_coarse(study)))
    return None, result


def _coarse(study: MeshStudy) -> list[Message]:
    """A warning of derivatives that this mesh, and finer ones, do not settle."""
    lost = [
        f"{n} {v[0]:.3g} +- {study.error[n]:.2g}"
        for n, v in study.values.items()
        if study.error[n] > max(_UNSETTLED * abs(float(v[0])), FLOOR * SIZE.get(n, 0.0))
        and n in SIZE
    ]
    if not lost:
        return []
    return [
        warn(
            "mesh_not_converged",
            where="vortex_lattice, mesh study",
            expected=f"an error of the mesh below {_UNSETTLED:.0%} of the value",
            found=", ".join(lost),
            do="The error is in their standard deviation. Let the strips of wing and tailplane "
            "fall together (--panels), or move one of them out of the other's wake.",
        )
    ]


def _loads(
    plane: Aircraft, shape: Geometry, flow: Flow, asked: Asked, alpha: float
) -> tuple[LatticeResult | None, list[Message]]:
    """The lattice in flight's angle of attack, for its loads only; None where it has none."""
    reference = Reference(plane.S, plane.b, plane.c)
    options: dict[str, Any] = {"alpha": alpha, "mach": flow.mach, "panels": asked.panels}
    try:
        found = vortex_lattice(shape, reference, plane.reference_point, wake="held", **options)
    except BadInput as error:
        return None, [replace(m, level="warning") for m in error.messages]
    return found, [m for m in found.messages if m.code == "induced_drag_apart"]


def _parts(
    plane: Aircraft,
    asked: Asked,
    lattice: LatticeResult | None,
    study: MeshStudy | None,
    handbook: Derivatives | None,
    alpha: float,
    flow: Flow,
) -> list[Derivatives]:
    error = None if study is None else study.error
    if asked.method == "combined":
        assert lattice is not None
        whole = lattice_and_bodies(plane, lattice.as_derivatives(error))
        if handbook is None:
            return [whole]
        return [at_angle(whole, alpha, float(handbook.conditions["C_L"])), handbook]
    if asked.method == "lattice":
        assert lattice is not None
        return [lattice.as_derivatives(error)]
    if asked.method == "bodies":
        return [slender_bodies(plane)]
    if asked.method == "strip":
        return [strip_derivatives(plane, alpha, flow.V)]
    return [semi_empirical(plane, flow) if handbook is None else handbook]


def at_angle(unloaded: Derivatives, alpha: float, lift: float) -> Derivatives:
    """A lattice without load, solved at zero angle of attack, as the aircraft at `alpha` has it.

    Its shape turns with the body: its lateral derivatives along body axes are those of any small
    angle but for what lift adds, and are turned to stability axes by `alpha`. What is proportional
    to lift stays left out, also where the turn makes a part of it; what lift adds to Cl_beta goes
    into its error.
    """
    conditions = {
        **unloaded.conditions,
        "alpha_deg": f"{degrees(alpha):.6g}",
        "lattice": f"at {unloaded.conditions.get('alpha_deg', '0')} deg, turned with the body",
    }
    turned = along(replace(unloaded, conditions=conditions, axes="model"), "stability")
    values = {n: e for n, e in turned.values.items() if n not in _OF_LIFT}
    if "Cl_beta" in values:
        e = values["Cl_beta"]
        se = hypot(e.se, _DIHEDRAL_OF_LIFT * lift)
        words = f"{e.source}; se with {_DIHEDRAL_OF_LIFT:g} C_L for what lift adds"
        values["Cl_beta"] = replace(e, se=se, source=words)
    return replace(turned, values=values)


def _neutral(plane: Aircraft, whole: Derivatives) -> tuple[Array | None, float]:
    """x_NP = x_ref + c Cm_alpha/CL_alpha, with fixed controls; errors as if independent."""
    slope, moment = whole.values.get("CL_alpha"), whole.values.get("Cm_alpha")
    if slope is None or moment is None or slope.value <= 0.0:
        return None, float("nan")
    ratio = moment.value / slope.value
    point = plane.reference_point + np.array([plane.c * ratio, 0.0, 0.0])
    se = plane.c * hypot(moment.se, ratio * slope.se) / slope.value
    return point, se
