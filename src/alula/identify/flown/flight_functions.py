"""The equations of motion with any formulas, as Python functions of states, inputs and parameters.

Dittrich 2016, Eq. (2.61) to (2.66). They serve the first values of filter error and check the core,
which filters with exact slopes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.identify.flown.extended_filter_error import FunctionModel
from alula.identify.flown.measured_maneuver import STATES, MeasuredManeuver
from alula.identify.linear.record import LinearRecord
from alula.model import LIFT, parse

Ties = Mapping[str, tuple[str, float]]  # term by (another term, factor)
NO_TIES: Ties = MappingProxyType({})
_SIZE = {"V": 50.0}  # m/s; angles and rates have 0.1
_BODY = ("CX", "CY", "CZ", "Cl", "Cm", "Cn")


def places_of(
    names: Sequence[str], parameters: Sequence[str], tied: Ties
) -> tuple[list[int], Array]:
    """Of each term the parameter that gives its value, and the factor of it."""
    sources = [tied.get(n, (n, 1.0)) for n in names]
    return [parameters.index(s) for s, _ in sources], np.array([f for _, f in sources])


def flight_functions(
    m: MeasuredManeuver,
    models: Mapping[str, str],
    states: Sequence[str],
    outputs: Sequence[str],
    tied: Ties = NO_TIES,
) -> FunctionModel:
    """The maneuver's equations of motion as functions; inputs as `record_of` lays them out."""
    terms = [(c, t, t.name(c)) for c in _lift_first(models) for t in parse(models[c])]
    names = [n for _, _, n in terms if n not in tied]
    places, factors = places_of([n for _, _, n in terms], names, tied)
    at = _columns(m)
    stability = bool({"CL", "CD"} & set(models))
    inverse = np.linalg.inv(m.inertia)
    ref = m.reference

    def motion(x: Array, u: Array) -> dict[str, Array]:
        out = {n: u[..., at[n]] for n in STATES}
        out.update({n: x[..., i] for i, n in enumerate(states)})
        return out

    def aero(s: Mapping[str, Array], u: Array, p: Array) -> tuple[list[Array], list[Array]]:
        """Specific force and angular acceleration, three components each."""
        half = 0.5 / s["V"]
        known = {n: u[..., at[n]] for n in m.controls}
        known |= {
            "V": s["V"], "alpha": s["alpha"], "beta": s["beta"],
            "phat": s["p"] * ref.b * half, "qhat": s["q"] * ref.c * half,
            "rhat": s["r"] * ref.b * half, "mach": s["V"] / u[..., at["speed_of_sound"]],
        }  # fmt: skip
        C: dict[str, Array] = {}
        for j, (c, term, _) in enumerate(terms):
            if c != LIFT and LIFT in C:
                known[LIFT] = C[LIFT]
            share = p[..., places[j]] * factors[j] * term.values(known)
            C[c] = C[c] + share if c in C else share
        for c in m.coefficients:
            if c not in C:
                C[c] = u[..., at[f"measured {c}"]]
        if stability:
            cos, sin = np.cos(s["alpha"]), np.sin(s["alpha"])
            C["CX"] = -C["CD"] * cos + C["CL"] * sin
            C["CZ"] = -C["CD"] * sin - C["CL"] * cos
        qS = 0.5 * u[..., at["rho"]] * s["V"] ** 2 * ref.S
        arms = (ref.b, ref.c, ref.b)
        X, Y, Z = (qS * C[c] for c in _BODY[:3])
        L, M, N = (qS * length * C[c] for c, length in zip(_BODY[3:], arms, strict=True))
        thrust = [u[..., at["force"] + i] for i in range(6)]
        w = [s["p"], s["q"], s["r"]]
        spin = [sum(m.inertia[i, j] * w[j] for j in range(3)) for i in range(3)]
        moment = [
            part + own + lever - gyroscopic
            for part, own, lever, gyroscopic in zip(
                (L, M, N), thrust[3:], _cross(list(m.arm), (X, Y, Z)), _cross(w, spin), strict=True
            )
        ]
        turn = [sum(inverse[i, j] * moment[j] for j in range(3)) for i in range(3)]
        return [(f + pull) / m.mass for f, pull in zip((X, Y, Z), thrust[:3], strict=True)], turn

    def derivative(x: Array, u: Array, p: Array) -> Array:
        s = motion(x, u)
        a, turn = aero(s, u, p)
        ca, sa, cb, sb = (
            np.cos(s["alpha"]),
            np.sin(s["alpha"]),
            np.cos(s["beta"]),
            np.sin(s["beta"]),
        )
        ct, st = np.cos(s["theta"]), np.sin(s["theta"])
        cf, sf = np.cos(s["phi"]), np.sin(s["phi"])
        U, v, w = s["V"] * ca * cb, s["V"] * sb, s["V"] * sa * cb
        du = a[0] - m.gravity * st + s["r"] * v - s["q"] * w
        dv = a[1] + m.gravity * ct * sf + s["p"] * w - s["r"] * U
        dw = a[2] + m.gravity * ct * cf + s["q"] * U - s["p"] * v
        dV = (U * du + v * dv + w * dw) / s["V"]
        rate = {
            "V": dV,
            "alpha": (U * dw - w * du) / (U**2 + w**2),
            "beta": (dv - sb * dV) / np.hypot(U, w),
            "p": turn[0], "q": turn[1], "r": turn[2],
            "phi": s["p"] + st / ct * (s["q"] * sf + s["r"] * cf),
            "theta": s["q"] * cf - s["r"] * sf,
        }  # fmt: skip
        return np.stack(np.broadcast_arrays(*(rate[n] for n in states)), axis=-1)

    def output(x: Array, u: Array, p: Array) -> Array:
        s = motion(x, u)
        have: dict[str, Array] = dict(s)
        if any(y not in STATES for y in outputs):
            a, turn = aero(s, u, p)
            have |= {n: a[i] for i, n in enumerate(("ax", "ay", "az"))}
            have |= {n: turn[i] for i, n in enumerate(("pdot", "qdot", "rdot"))}
        lead = np.broadcast_shapes(x.shape[:-1], u.shape[:-1], p.shape[:-1])
        return np.stack([np.broadcast_to(have[y], lead) for y in outputs], axis=-1)

    return FunctionModel(
        states=tuple(states),
        outputs=tuple(outputs),
        parameters=tuple(names),
        derivative=derivative,
        output=output,
        size=tuple(_SIZE.get(s, 0.1) for s in states),
        belongs={n: c for c, _, n in terms if n not in tied},
        rows=dict.fromkeys(outputs, "equations of motion"),
    )


def _cross(a: Sequence[Array], b: Sequence[Array]) -> list[Array]:
    """Cross product of components; NumPy's own costs more than all the rest at these sizes."""
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def _lift_first(models: Mapping[str, str]) -> list[str]:
    return sorted(models, key=lambda c: c != LIFT)


def _columns(m: MeasuredManeuver) -> dict[str, int]:
    names = [*STATES, *m.controls, *(f"measured {c}" for c in m.coefficients)]
    names += ["rho", "speed_of_sound", "force"]
    return {n: i for i, n in enumerate(names)}


def record_of(m: MeasuredManeuver, outputs: Sequence[str]) -> LinearRecord:
    """The maneuver as columns: states as measured, controls, coefficients, air, engines."""
    missing = [y for y in outputs if y not in m.outputs]
    if missing:
        raise refuse(
            "missing_output",
            where=f"maneuver {m.maneuver.id}",
            expected=", ".join(outputs),
            found="no " + ", ".join(missing),
            do="Take outputs that were measured.",
        )
    columns = [m.motion[n] for n in STATES] + list(m.controls.values())
    columns += [*m.coefficients.values(), m.rho, m.speed_of_sound, *m.force.T, *m.moment.T]
    return LinearRecord(
        id=m.maneuver.id,
        t=m.t,
        inputs=frozen(np.column_stack(columns)),
        outputs=frozen(np.column_stack([m.outputs[y] for y in outputs])),
        held_out=m.maneuver.held_out,
    )
