"""Aerodynamic coefficients from motion (Dittrich 2016, Eq. (3.46), (3.47); van den Hoek 2017,
Eq. (22) to (27)).

Body axes. Force is mass times specific force; moment is J dw/dt + w x J w with the full inertia
tensor; engine thrust and its moment are subtracted. Moments are then moved from the center of
gravity to one reference point, so that maneuvers at different loadings share derivatives. The
angular momentum of rotors and the change of inertia by fuel burn are not in these equations.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.local_cubic import LocalCubic
from alula.base.messages import Message, note, refuse
from alula.flight import Maneuver, Motion

BODY_COEFFICIENTS = ("CX", "CY", "CZ", "Cl", "Cm", "Cn")
STABILITY_COEFFICIENTS = ("CD", "CL")


@dataclass(frozen=True)
class Reference:
    """Reference area S m2, full span b m, chord c m, and the moment reference point (3,) m."""

    S: float
    b: float
    c: float
    point: Array


@dataclass(frozen=True)
class Thrust:
    """One engine's thrust (n,) N at `position` (3,) m along the unit vector `direction` (3,).

    relative_se: relative standard error of the thrust, 0 where it is not known.
    """

    position: Array
    direction: Array
    force: Array
    relative_se: float = 0.0


@dataclass(frozen=True)
class Perturbed:
    """Coefficients and regressors had one source of uncertainty been a standard deviation off.

    source: names that one direction, 'thrust' or 'reconstruction 3'. Maneuvers whose perturbations
    carry the same name are perturbed together, because they share the cause.
    """

    source: str
    coefficients: Mapping[str, Array]
    variables: Mapping[str, Array]


@dataclass(frozen=True)
class CoefficientData:
    """What identification works on, for one maneuver: arrays (n,) on one even time base.

    coefficients: by name. variables: the regressors' base variables by name, SI and radians.
    labels: what a coefficient includes beyond aerodynamics ('including thrust').
    cubic: the smoothing in the moment coefficients, which their regressors must share.
    """

    maneuver: Maneuver
    t: Array
    coefficients: Mapping[str, Array]
    variables: Mapping[str, Array]
    perturbed: tuple[Perturbed, ...] = ()
    cubic: LocalCubic | None = None
    labels: Mapping[str, str] | None = None
    messages: tuple[Message, ...] = ()


def regressor_variables(motion: Motion, reference: Reference) -> dict[str, Array]:
    """alpha, beta, phat qhat rhat (pb/2V, qc/2V, rb/2V), the controls, V and mach, each (n,).

    A variable that was recorded under its own name goes before the computed one. The Mach number
    takes the standard atmosphere's temperature at `h` (ISO 2533), which the motion does not carry.
    """
    computed = {
        "alpha": motion.alpha,
        "beta": motion.beta,
        "phat": motion.p * reference.b / (2.0 * motion.V),
        "qhat": motion.q * reference.c / (2.0 * motion.V),
        "rhat": motion.r * reference.b / (2.0 * motion.V),
        "V": motion.V,
        "mach": motion.V
        / np.sqrt(1.4 * 287.05287 * np.maximum(288.15 - 0.0065 * motion.h, 216.65)),
        **motion.controls,
    }
    return {name: frozen(motion.recorded.get(name, values)) for name, values in computed.items()}


def body_coefficients(
    motion: Motion,
    reference: Reference,
    mass: Array,
    cg: Array,
    inertia: Array,
    thrust: Sequence[Thrust],
    cubic: LocalCubic | None = None,
) -> dict[str, Array]:
    """CX CY CZ Cl Cm Cn and CD CL, each (n,), thrust removed.

    cubic: what smoothed the angular accelerations; the rest of the moments passes the same filter.
    mass: (n,) kg. cg: (n, 3) m. inertia: (n, 3, 3) kg m2 about the CG, products of inertia with
    their minus signs. CD, CL are in stability axes (turned by alpha alone).
    """
    omega = np.column_stack([motion.p, motion.q, motion.r])
    omega_dot = np.column_stack([motion.pdot, motion.qdot, motion.rdot])
    force = mass[:, None] * np.column_stack([motion.ax, motion.ay, motion.az])
    momentum = np.einsum("nij,nj->ni", inertia, omega)
    inertial = np.einsum("nij,nj->ni", inertia, omega_dot)
    moment = np.cross(omega, momentum)
    for engine in thrust:
        pull = engine.force[:, None] * engine.direction
        force = force - pull
        moment = moment - np.cross(engine.position - cg, pull)
    moment = moment + np.cross(cg - reference.point, force)
    pressure_area = 0.5 * motion.rho * motion.V**2 * reference.S
    cf = force / pressure_area[:, None]
    cm = moment / pressure_area[:, None]
    cm = (cm if cubic is None else cubic.matched(cm)) + inertial / pressure_area[:, None]
    sin, cos = np.sin(motion.alpha), np.cos(motion.alpha)
    return {
        "CX": cf[:, 0],
        "CY": cf[:, 1],
        "CZ": cf[:, 2],
        "Cl": cm[:, 0] / reference.b,
        "Cm": cm[:, 1] / reference.c,
        "Cn": cm[:, 2] / reference.b,
        "CD": -cf[:, 0] * cos - cf[:, 2] * sin,
        "CL": cf[:, 0] * sin - cf[:, 2] * cos,
    }


def coefficients_from_motion(
    motion: Motion,
    reference: Reference,
    *,
    mass: Array,
    cg: Array,
    inertia: Array,
    thrust: Sequence[Thrust] = (),
    perturbed: Sequence[Motion] = (),
    shared: bool = True,
) -> CoefficientData:
    """The coefficients of one maneuver, with every way in which they are uncertain.

    mass (n,) or (1,) kg, cg (n, 3) m, inertia (n, 3, 3) kg m2: along the motion. perturbed: the
    motions that reconstruction would have given, one per independent direction of its uncertainty.
    shared: direction i of this maneuver is direction i of the others too (constants common to all
    maneuvers); False where each maneuver was reconstructed on its own. Raises BadInput where a
    length does not fit, a number is not finite, or the airspeed is not positive.
    """
    _check(motion, mass, cg, inertia, thrust)
    cubic = LocalCubic(motion.t, motion.window_s) if motion.window_s > 0.0 else None
    nominal = body_coefficients(motion, reference, mass, cg, inertia, thrust, cubic)
    variables = regressor_variables(motion, reference)
    ways = [
        Perturbed(
            source=f"reconstruction {i}" + ("" if shared else f" [{motion.maneuver.id}]"),
            coefficients=body_coefficients(other, reference, mass, cg, inertia, thrust, cubic),
            variables=regressor_variables(other, reference),
        )
        for i, other in enumerate(perturbed)
    ]
    for i, engine in enumerate(thrust):
        if engine.relative_se > 0.0:
            off = list(thrust)
            off[i] = replace(engine, force=engine.force * (1.0 + engine.relative_se))
            changed = body_coefficients(motion, reference, mass, cg, inertia, off, cubic)
            ways.append(Perturbed(f"thrust {i + 1}", changed, variables))
    return CoefficientData(
        maneuver=motion.maneuver,
        t=motion.t,
        coefficients={name: frozen(values) for name, values in nominal.items()},
        variables=variables,
        perturbed=tuple(ways),
        cubic=cubic,
        labels={} if thrust else dict.fromkeys(("CX", "CZ", "CD", "CL", "Cm"), "including thrust"),
        messages=() if thrust else (_no_thrust(motion.maneuver),),
    )


def coefficients_as_recorded(motion: Motion, reference: Reference) -> CoefficientData:
    """The coefficients that the log itself carries, with the motion's regressors.

    Raises BadInput where the log carries none.
    """
    known = {
        name: frozen(motion.recorded[name])
        for name in (*BODY_COEFFICIENTS, *STABILITY_COEFFICIENTS)
        if name in motion.recorded
    }
    if not known:
        raise refuse(
            "no_recorded_coefficients",
            where=f"maneuver {motion.maneuver.id}",
            expected="at least one of " + ", ".join((*BODY_COEFFICIENTS, *STABILITY_COEFFICIENTS)),
            found=", ".join(sorted(motion.recorded)) or "no recorded coefficients",
            do='Map them in [channels], or compute them: coefficients_from = "motion".',
        )
    return CoefficientData(motion.maneuver, motion.t, known, regressor_variables(motion, reference))


def _no_thrust(maneuver: Maneuver) -> Message:
    return note(
        "including_thrust",
        where=f"maneuver {maneuver.id}",
        expected="the thrust of each engine",
        found="none",
        do="CX, CZ, CD, CL and Cm include thrust; state [[engines]] in the aircraft file and map "
        "their channels to have it removed.",
    )


def _check(
    motion: Motion, mass: Array, cg: Array, inertia: Array, thrust: Sequence[Thrust]
) -> None:
    n = len(motion.t)
    where = f"maneuver {motion.maneuver.id}"
    arrays: Iterable[tuple[str, Array, tuple[int, ...]]] = (
        ("mass", mass, ()),
        ("cg", cg, (3,)),
        ("inertia", inertia, (3, 3)),
        *((f"thrust {i + 1}", engine.force, ()) for i, engine in enumerate(thrust)),
    )
    for name, values, tail in arrays:
        if values.shape not in ((n, *tail), (1, *tail)):
            raise refuse(
                "wrong_length",
                where=f"{where}, {name}",
                expected=f"shape {(n, *tail)}",
                found=f"shape {values.shape}",
                do="Give one value per sample of the motion.",
            )
        _finite(where, name, values)
    for item in fields(motion):
        values = getattr(motion, item.name)
        if isinstance(values, np.ndarray) and item.name not in ("psi", "fuel_used", "thrust"):
            _finite(where, item.name, values)
    if not (motion.V > 0.0).all():
        raise refuse(
            "airspeed_not_positive",
            where=f"{where}, V",
            expected="airspeed above zero throughout",
            found=f"{motion.V.min():.3g} m/s",
            do="Choose a window in flight, or correct the unit or zero of V.",
        )


def _finite(where: str, name: str, values: Array) -> None:
    bad = int(np.sum(~np.isfinite(values)))
    if bad:
        raise refuse(
            "not_finite",
            where=f"{where}, {name}",
            expected="finite numbers at every sample",
            found=f"{bad} of {values.size} are NaN or infinite",
            do="Choose a window without invalid samples, or map another channel.",
        )
