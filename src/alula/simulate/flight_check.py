"""What a simulated flight says of itself: its step, and the model's range of validity."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn
from alula.flight import Motion
from alula.model import AeroModel

# RK4 is stable up to |lambda| dt of 2.6 to 2.8 (Hairer, Norsett and Wanner, Solving Ordinary
# Differential Equations I, section IV.2); at 0.5 a mode's amplitude errs by 2e-4 a radian.
UNSTABLE, COARSE = 2.5, 0.5


def check_step(A: Array, dt: float) -> tuple[Message, ...]:
    """Whether RK4 steps of dt (s) follow the fastest mode of the linear model A (n, n).

    Raises BadInput, with the step to use, where they cannot; a warning where they are coarse.
    """
    if not np.isfinite(A).all():  # at rest in the air nothing is linear
        return ()
    fastest = float(np.max(np.abs(np.linalg.eigvals(A)), initial=0.0))
    found = f"{dt:g} s for a mode of {fastest:.3g} rad/s"
    if fastest * dt > UNSTABLE:
        raise refuse(
            "step_too_large",
            where="simulation",
            expected=f"steps of {COARSE / fastest:.2g} s or less",
            found=found,
            do="Raise `substeps` or sample more often; in a plan, lower `step`.",
        )
    if fastest * dt > COARSE:
        return (
            warn(
                "coarse_step",
                where="simulation",
                expected=f"steps of {COARSE / fastest:.2g} s or less",
                found=found,
                do="Where this mode matters raise `substeps`; in a plan, lower `step`.",
            ),
        )
    return ()


def outside_validity(model: AeroModel, motion: Motion, mach: Array) -> tuple[Message, ...]:
    """One warning for each variable that left the range its values were found in, the worst value.

    Angles are said in degrees.
    """
    r = model.reference
    half = 0.5 / np.maximum(motion.V, 1e-3)
    variables = {
        **motion.controls,
        "V": motion.V,
        "alpha": motion.alpha,
        "beta": motion.beta,
        "phat": motion.p * r.b * half,
        "qhat": motion.q * r.c * half,
        "rhat": motion.r * r.b * half,
        "mach": mach,
    }
    angles = {"alpha", "beta", "de", "da", "dr", "df"}
    messages = []
    for name, (low, high) in model.validity.items():
        if name not in variables:
            continue
        x = variables[name]
        beyond = np.maximum(low - x, x - high)
        worst = int(np.argmax(beyond))
        if not beyond[worst] > 1e-9 * max(abs(low), abs(high)):
            continue
        k, unit = (np.degrees(1.0), " deg") if name in angles else (1.0, "")
        first = motion.t[int(np.argmax(beyond > 0.0))]
        messages.append(
            warn(
                "outside_validity",
                where=f"aerodynamic model '{model.name}', {name}",
                expected=f"{low * k:.4g} to {high * k:.4g}{unit}",
                found=f"{x[worst] * k:.4g}{unit} at t = {motion.t[worst]:.4g} s, "
                f"outside since t = {first:.4g} s",
                do="Take what the model says there as a guess; fly gentler or widen the model.",
            )
        )
    return tuple(messages)
