"""A motion that is below the noise of every sensor: its likelihood has maxima that are noise.

Where nothing is excited, slow modes of other derivatives follow the noise a little better than the
right ones do. A search may end there, and the curvature at that place gives standard errors as if
it were the truth (by twenty of them off in simulated flights without input). Wherever the motion
does stand out of the noise of at least one sensor, the maximum that is found is that of the data.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from alula.base.messages import Message, warn
from alula.identify.result import Parameter

if TYPE_CHECKING:
    from alula.identify.likelihood.parameters import Fitted

# Modeled variation over residual, root mean squares. Flights without input have up to 0.25 in some
# output (a fitted motion follows the noise a little), maneuvers that tell derivatives 10 to 100.
MOVES = 1.0
_NOT_OF_MOTION = ("b_", "F_", "sigma_")  # biases and noises: a still flight tells them


def still(fitted: Sequence[Fitted]) -> bool:
    """Whether no output of any maneuver learned from moves beyond its residual."""
    learned = [f for f in fitted if not f.held_out]
    for f in learned:
        good = np.isfinite(f.measured)
        if good.any():
            left = float(np.sqrt(np.mean((f.measured - f.model)[good] ** 2)))
            if float(np.std(f.model[good])) > MOVES * left:
                return False
    return bool(learned)


def distrusted_if_still(
    parameters: Sequence[Parameter], fitted: Sequence[Fitted]
) -> tuple[tuple[Parameter, ...], tuple[Message, ...]]:
    """The parameters, those of the motion 'weak' at best where nothing moves, and a warning."""
    if not parameters or not still(fitted):
        return tuple(parameters), ()
    doubted = tuple(
        replace(p, verdict="weak")
        if p.verdict == "ok" and "(0)" not in p.name and not p.name.startswith(_NOT_OF_MOTION)
        else p
        for p in parameters
    )
    said = warn(
        "no_motion",
        where="maneuvers " + ", ".join(dict.fromkeys(f.maneuver for f in fitted if not f.held_out)),
        expected="a motion above the noise of at least one sensor",
        found="none: in every output the model moves less than its residual",
        do="Fly an input. Until then no derivative counts as resolved: values may follow noise.",
    )
    return doubted, (said,)
