"""Filter error for the equations of motion with any formulas of the model grammar.

The rigid-body equations (Dittrich 2016, Eq. (2.61) to (2.66)), filtered in the core with exact
slopes; the same equations as Python functions serve the first values, and check the core. What is
not a state is taken as measured, and so are coefficients without a formula. Turbulence enters as
white process noise of the states named.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.identify.flown.core_maneuver import formula_model, in_core
from alula.identify.flown.extended_filter_error import (
    FunctionModel,
    Pass,
    identify_extended_filter_error,
)
from alula.identify.flown.measured_maneuver import OUTPUTS, STATES, MeasuredManeuver
from alula.identify.flown.start import start_values
from alula.identify.likelihood.innovations import Innovations
from alula.identify.likelihood.optimizer import Algorithm
from alula.identify.likelihood.parameters import Prior
from alula.identify.linear.record import LinearRecord
from alula.identify.result import Identification
from alula.identify.typical import constant_name
from alula.model import LIFT, parse, reference_scales

_SIZE = {"V": 50.0}  # m/s; angles and rates have 0.1
_BODY = ("CX", "CY", "CZ", "Cl", "Cm", "Cn")
STATES_OF: Mapping[str, tuple[str, ...]] = {
    "longitudinal": ("alpha", "q"),
    "lateral": ("beta", "p", "r"),
}


def identify_flight_filter_error(
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    *,
    states: Sequence[str],
    outputs: Sequence[str],
    noisy: Collection[str] | None = None,
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    common_constant: bool = True,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Derivatives and process noise from outputs in turbulence.

    models: formula by coefficient, body or stability axes. states: of V alpha beta p q r phi theta;
    `STATES_OF` has sets that suffice for short maneuvers. outputs: what the filter is corrected by.
    start: values of terms and noises ('F_alpha', 'sigma_q'); terms by equation error else. Other
    arguments as `identify_extended_filter_error`. Raises BadInput for names that do not exist.
    """
    wrong = [s for s in states if s not in STATES] + [y for y in outputs if y not in OUTPUTS]
    if wrong or not states or not outputs or not models:
        raise refuse(
            "unknown_option",
            where="filter error",
            expected=f"models, states of {', '.join(STATES)}, outputs of {', '.join(OUTPUTS)}",
            found=", ".join(wrong) or "none",
            do="Name them.",
        )
    learn = [m for m in maneuvers if not m.maneuver.held_out]
    first = start_values(learn, models, {**(start or {}), **(fixed or {})}) if learn else {}
    enough = {n: v for c, text in models.items() for n, v in reference_scales(c, text).items()}
    records = [_record(m, outputs) for m in maneuvers]
    functions = [flight_functions(m, models, states, outputs) for m in learn]
    flown = [
        replace(f, filter=core_filter(m, models, f)) for m, f in zip(learn, functions, strict=True)
    ]
    constants = [constant_name(c) for c in models]
    return identify_extended_filter_error(
        flown,
        records,
        start=first,
        noisy=noisy,
        own=() if common_constant else [c for c in constants if c in flown[0].parameters],
        fixed=fixed,
        bounds=bounds,
        priors=priors,
        algorithm=algorithm,
        scales={**enough, **(scales or {})},
        truth=truth,
        method="filter error",
    )


def core_filter(m: MeasuredManeuver, models: Mapping[str, str], functions: FunctionModel) -> Pass:
    """The core's extended filter over the maneuver; what it takes as `functions` has it."""
    names, states = functions.parameters, functions.states
    model = formula_model(models, dict.fromkeys(names, 0.0), m.reference)
    fit = in_core(m, model, states, functions.outputs)
    terms = [names.index(n) for n in model.names]
    places = [STATES.index(s) for s in states]

    def run(values: Array, x0: Array, intensity: Array, R: Array) -> Innovations | None:
        eight = np.zeros((2, len(values), len(STATES)))
        eight[0, :, places], eight[1, :, places] = x0.T, intensity.T
        whole, v, S, y = fit.innovations(np.ascontiguousarray(values[:, terms]), *eight, R)
        return Innovations(v, S, y) if whole else None

    return run


def flight_functions(
    m: MeasuredManeuver, models: Mapping[str, str], states: Sequence[str], outputs: Sequence[str]
) -> FunctionModel:
    """The maneuver's equations of motion as functions; inputs as `_record` lays them out."""
    terms = [(c, t, t.name(c)) for c in _lift_first(models) for t in parse(models[c])]
    names = [n for _, _, n in terms]
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
            share = p[..., j] * term.values(known)
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
        belongs={n: c for c, _, n in terms},
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


def _record(m: MeasuredManeuver, outputs: Sequence[str]) -> LinearRecord:
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
