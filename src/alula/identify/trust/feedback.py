"""Controls that follow the states: collinearity by feedback, named.

A pilot or a control law that holds de = k1 alpha + k2 q + ... makes the control's column a sum of
the states' columns. Then the data determine Cm_alpha + k1 Cm_de and the like, not the parts (Klein
and Morelli, Aircraft System Identification, 2006, section 5.2). Short of exact dependence the
estimates still exist, with standard errors that tell; this says where it comes from.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, warn
from alula.identify.result import Parameter

CONTROLS = ("de", "da", "dr", "df", "dt")
STATES = ("alpha", "beta", "phat", "qhat", "rhat")
FOLLOWS = 0.95  # share of a control's movement that the states explain: variances grow twentyfold


@dataclass(frozen=True)
class Feedback:
    """control = sum of gain * state + a constant in each maneuver. r2: how closely."""

    control: str
    gains: Mapping[str, float]
    r2: float

    @property
    def law(self) -> str:
        """The control law in words: 'de = 0.8 alpha + 1.2 qhat'."""
        parts = [f"{'-' if g < 0 else '+'} {abs(g):.3g} {name}" for name, g in self.gains.items()]
        return f"{self.control} = " + " ".join(parts).removeprefix("+ ")


def feedback(
    variables: Sequence[Mapping[str, Array]], names: Sequence[str]
) -> tuple[Feedback, ...]:
    """Every control among `names` that moves, as far as the states among `names` explain it.

    variables: by name, (n,) each; one mapping per maneuver.
    """
    states = [s for s in STATES if s in names and all(s in v for v in variables)]
    found: list[Feedback] = []
    if not states:
        return ()
    x = np.vstack([_centered(v, states) for v in variables])
    scale = np.linalg.norm(x, axis=0)
    moving = scale > 0.0
    x, states = x[:, moving], [s for s, m in zip(states, moving.tolist(), strict=True) if m]
    for control in CONTROLS:
        if control not in names or not all(control in v for v in variables) or not states:
            continue
        u = np.concatenate([_centered(v, [control])[:, 0] for v in variables])
        power = float(u @ u)
        level = sum(float(v[control] @ v[control]) for v in variables)
        if not power > 1e-20 * level or len(u) <= len(states):
            continue  # it stands still, which is told elsewhere
        gains = np.linalg.lstsq(x / scale[moving], u, rcond=1e-10)[0] / scale[moving]
        left = u - x @ gains
        r2 = 1.0 - float(left @ left) / power
        found.append(Feedback(control, dict(zip(states, gains.tolist(), strict=True)), r2))
    return tuple(found)


def warn_of_feedback(coefficient: str, found: Sequence[Feedback]) -> tuple[Message, ...]:
    """A warning for each control that follows the states."""
    return tuple(
        warn(
            "control_follows_states",
            where=f"{coefficient}, {item.control}",
            expected="a control that moves independently of the states",
            found=f"{item.law} explains {item.r2:.1%} of its movement (feedback or a slow input)",
            do="Derivatives of that control and of these states trade against each other: add an "
            "input on top of the feedback, or fly with it off.",
        )
        for item in found
        if item.r2 > FOLLOWS
    )


def distrusted(parameter: Parameter, found: Sequence[Feedback]) -> Parameter:
    """The parameter, 'weak' at best where its variable is part of a loop that explains a control.

    For states that are pulled to their measurements: whose noise breaks the collinearity, so that
    standard errors are small and estimates are off (by five of them in a simulated closed loop).
    """
    parts = set(parameter.name.removeprefix(f"{parameter.coefficient}_").split("_"))
    rates = {"p": "phat", "q": "qhat", "r": "rhat"}
    names = {rates.get(part, part) for part in parts}
    inside = any(names & {item.control, *item.gains} for item in found if item.r2 > FOLLOWS)
    return replace(parameter, verdict="weak") if inside and parameter.verdict == "ok" else parameter


def _centered(variables: Mapping[str, Array], names: Sequence[str]) -> Array:
    x = np.column_stack([variables[name] for name in names])
    out: Array = x - x.mean(axis=0)
    return out
