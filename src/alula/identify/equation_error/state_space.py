"""Linear state equations x' = A x + B u by regression of the states' derivatives.

Dittrich 2016, Eq. (3.36) to (3.45). Derivatives of V, alpha, beta, theta and phi follow from
specific force and rates by the kinematics (Eq. (2.61) and (2.62)), which is more exact than
differentiating them; those of p, q, r come with the motion. Deviations count from each maneuver's
own trim: every maneuver has its own constant. Where angular accelerations were smoothed, all else
passes the same filter, or A and B would come out too small.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.local_cubic import LocalCubic
from alula.base.messages import Message, note, refuse
from alula.flight import Motion
from alula.identify.regression.regress import Block, Weighting, regress
from alula.identify.result import Parameter
from alula.identify.trust.verdict import assess

Axis = Literal["longitudinal", "lateral"]
STATES: Mapping[Axis, tuple[str, ...]] = {
    "longitudinal": ("V", "alpha", "theta", "q"),
    "lateral": ("beta", "p", "r", "phi"),
}
INPUTS: Mapping[Axis, tuple[str, ...]] = {"longitudinal": ("de",), "lateral": ("da", "dr")}
_RATES = ("p", "q", "r")


@dataclass(frozen=True)
class StateSpace:
    """x' = A x + B u with x, u the deviations from trim, SI and radians.

    A: (k, k), B: (k, m), A_se and B_se their standard errors (coloured residuals); NaN where the
    data do not determine an entry. parameters: the same with verdicts, named 'A_alpha_q' (row,
    column). r2: by state, of its derivative.
    """

    axis: Axis
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    A: Array
    B: Array
    A_se: Array
    B_se: Array
    parameters: tuple[Parameter, ...]
    r2: Mapping[str, float]
    messages: tuple[Message, ...]

    def summary(self) -> str:
        """A and B row by row with standard errors, as plain text."""
        lines = [f"{self.axis} state equations, SI and rad", "=" * 72]
        columns = [*(f"A_{{}}_{x}" for x in self.states), *(f"B_{{}}_{u}" for u in self.inputs)]
        by_name = {p.name: p for p in self.parameters}
        for state in self.states:
            lines.append(f"d{state}/dt{'':<8}R2 {self.r2[state]:.4f}")
            for p in (by_name[c.format(state)] for c in columns):
                words = p.verdict.replace("_", " ")
                lines.append(f"  {p.name:<18}{p.value:>12.5g} ± {p.se:<10.2g}{p.unit:<10}{words}")
        lines += ["=" * 72, "se: coloured residuals; the reconstruction's uncertainty is not in it"]
        return "\n".join(lines)


def state_derivatives(motion: Motion, gravity: float = 9.80665) -> dict[str, Array]:
    """Derivatives (n,) of V alpha beta p q r phi theta, in still air or steady wind."""
    u = motion.V * np.cos(motion.alpha) * np.cos(motion.beta)
    v = motion.V * np.sin(motion.beta)
    w = motion.V * np.sin(motion.alpha) * np.cos(motion.beta)
    p, q, r, phi, theta = motion.p, motion.q, motion.r, motion.phi, motion.theta
    du = motion.ax - gravity * np.sin(theta) + r * v - q * w
    dv = motion.ay + gravity * np.cos(theta) * np.sin(phi) + p * w - r * u
    dw = motion.az + gravity * np.cos(theta) * np.cos(phi) + q * u - p * v
    dV = (u * du + v * dv + w * dw) / motion.V
    return {
        "V": dV,
        "alpha": (u * dw - w * du) / (u**2 + w**2),
        "beta": (dv - np.sin(motion.beta) * dV) / np.hypot(u, w),
        "p": motion.pdot,
        "q": motion.qdot,
        "r": motion.rdot,
        "phi": p + np.tan(theta) * (q * np.sin(phi) + r * np.cos(phi)),
        "theta": q * np.cos(phi) - r * np.sin(phi),
    }


def identify_state_space(
    motions: Sequence[Motion],
    axis: Axis,
    *,
    inputs: Sequence[str] | None = None,
    gravity: float = 9.80665,
    weighting: Weighting = "residual",
) -> StateSpace:
    """A and B of the longitudinal (V alpha theta q) or lateral (beta p r phi) motion.

    motions: one per maneuver; those held out are left aside. inputs: names of controls; None takes
    those of the axis that every motion has. Raises BadInput where there is no such control or no
    motion, or too few samples.
    """
    aside = [m.maneuver.id for m in motions if m.maneuver.held_out]
    motions = [m for m in motions if not m.maneuver.held_out]
    if not motions:
        raise refuse(
            "no_maneuver",
            where=f"{axis} state equations",
            expected="at least one maneuver that is not held out",
            found=", ".join(aside) or "none",
            do=f"Name a maneuver with aspect = '{axis}'.",
        )
    wanted = INPUTS[axis] if inputs is None else tuple(inputs)
    has = [u for u in wanted if all(u in m.controls for m in motions)]
    if not has or (inputs is not None and len(has) < len(wanted)):
        raise refuse(
            "missing_control",
            where=f"{axis} state equations",
            expected="controls " + ", ".join(wanted),
            found=", ".join(motions[0].controls) or "none",
            do="Map the control surfaces in [channels].",
        )
    states = STATES[axis]
    matrices = [_regressors(m, states, has) for m in motions]
    derivatives = [_matched_derivatives(m, gravity) for m in motions]
    constants = [f"[{m.maneuver.id}]" for m in motions]
    parameters: list[Parameter] = []
    messages: list[Message] = []
    if aside:
        messages.append(
            note(
                "held_out",
                where=", ".join(aside),
                expected="maneuvers to learn from",
                found="maneuvers that are held out: they were left aside",
                do="Nothing; judge the matrices on them.",
            )
        )
    r2: dict[str, float] = {}
    for state in states:
        blocks = [
            Block(_with_constant(x, i, len(motions)), d[state])
            for i, (x, d) in enumerate(zip(matrices, derivatives, strict=True))
        ]
        names = [
            *(f"{state}_0{c}" for c in constants),
            *(f"A_{state}_{x}" for x in states),
            *(f"B_{state}_{u}" for u in has),
        ]
        fit = regress(names, blocks, weighting)
        zero = np.zeros((len(names), len(names)))
        units = {n: _unit(state, n.rsplit("_", 1)[1]) for n in names}
        assessed, remarks = assess(f"d{state}/dt", fit, zero, {}, {}, units)
        parameters += assessed[len(constants) :]
        messages += remarks
        total = sum(float(np.sum((b.measured - b.measured.mean()) ** 2)) for b in blocks)
        left = sum(float(v @ v) for v in fit.residuals)
        r2[state] = 1.0 - left / total if total > 0.0 else np.nan
    shape = (len(states), len(states) + len(has))
    value = np.array([p.value for p in parameters]).reshape(shape)
    se = np.array([p.se for p in parameters]).reshape(shape)
    k = len(states)
    return StateSpace(
        axis=axis,
        states=states,
        inputs=tuple(has),
        A=frozen(value[:, :k]),
        B=frozen(value[:, k:]),
        A_se=frozen(se[:, :k]),
        B_se=frozen(se[:, k:]),
        parameters=tuple(parameters),
        r2=r2,
        messages=tuple(messages),
    )


def _regressors(motion: Motion, states: Sequence[str], inputs: Sequence[str]) -> Array:
    columns = [getattr(motion, s) for s in states] + [motion.controls[u] for u in inputs]
    matrix = np.column_stack(columns)
    return LocalCubic(motion.t, motion.window_s).matched(matrix) if motion.window_s else matrix


def _matched_derivatives(motion: Motion, gravity: float) -> dict[str, Array]:
    """Derivatives that have all passed the filter of the angular accelerations, if they did."""
    exact = state_derivatives(motion, gravity)
    if not motion.window_s:
        return exact
    cubic = LocalCubic(motion.t, motion.window_s)
    return {name: x if name in _RATES else cubic.matched(x) for name, x in exact.items()}


def _with_constant(matrix: Array, index: int, count: int) -> Array:
    own = np.zeros((len(matrix), count))
    own[:, index] = 1.0
    return np.hstack([own, matrix])


def _unit(row: str, column: str) -> str:
    """Unit of d(row)/dt over column; of a constant, whose column starts with 0, of the row's."""
    above = "m/s2" if row == "V" else "rad/s2" if row in _RATES else "rad/s"
    if column.startswith("0"):
        return above
    below = "m/s" if column == "V" else "rad/s" if column in _RATES else "rad"
    simple = {
        ("m/s2", "m/s"): "1/s",
        ("rad/s", "rad"): "1/s",
        ("rad/s2", "rad/s"): "1/s",
        ("rad/s2", "rad"): "1/s2",
        ("rad/s", "rad/s"): "1",
    }
    return simple.get((above, below), f"{above}/({below})")
