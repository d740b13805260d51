"""How long the steps of an input last: its energy goes where the aircraft answers.

Marchand, "Untersuchung der Bestimmbarkeit von Flugzeugderivativen aus Flugversuchen", DFVLR 1977;
Jategaonkar, Flight Vehicle System Identification, 2nd ed., 2015, Chap. 2: step lengths follow from
the natural frequency of the mode that is to be excited. Of steps of length d, a doublet's energy
spectrum, 16 sin(w d / 2)^4 / w^2, has its peak where tan(x) = 2 x, x = w d / 2: w d = 2.33. That of
a 3-2-1-1 is flat within a factor of two from w d = 0.28 to 2.65; the mode is put at 1.6, into its
upper part, since what is known of the mode before the test may be wrong either way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.messages import refuse
from alula.simulate.modes import Mode

DOUBLET = 2.3311  # rad, frequency times step length
STEPS_3211 = 1.6
ROLL = 3.0  # roll time constants: the roll rate has reached 95 % of what it will
SHORTEST, LONGEST = 0.1, 5.0  # s, that a pilot or a servo can make of a step
# The mode that each control excites most, and what stands in where it has another form.
MODES: Mapping[str, tuple[str, ...]] = {
    "de": ("short_period", "third_oscillation"),
    "da": ("roll", "roll_spiral"),
    "dr": ("dutch_roll",),
}


@dataclass(frozen=True)
class Timing:
    """Length of a step (3-2-1-1: of the unit), s, and the mode it is for: name and rad/s.

    settles: s after which what was excited has gone to a tenth, or as far as a maneuver waits.
    """

    width: float
    mode: str
    frequency: float
    settles: float


def timing(control: str, kind: str, modes: Sequence[Mode]) -> Timing:
    """The step length of an input on `control` by the a-priori modes.

    kind: 'pulse', 'doublet', '3211' or 'bank_to_bank'. Of a mode that has fallen apart into two
    aperiodic ones the frequency is the root of their product, as in its characteristic polynomial.
    Raises BadInput where the modes lack the one that this control excites.
    """
    family = next(
        (f for f in MODES.get(control, ()) if any(m.family == f for m in modes)),
        None,
    )
    if family is None:
        raise refuse(
            "no_mode",
            where=f"step length of {control}",
            expected=f"one of the modes {', '.join(MODES.get(control, ())) or '(none known)'}",
            found=", ".join(m.name for m in modes) or "none",
            do="State the widths in the plan yourself.",
        )
    own = [m.eigenvalue for m in modes if m.family == family]
    frequency = float(np.exp(np.mean(np.log(np.abs(own)))))
    decay = -max(root.real for root in own)
    factor = {"pulse": DOUBLET, "doublet": DOUBLET, "3211": STEPS_3211}.get(kind, ROLL)
    return Timing(
        width=float(np.clip(factor / frequency, SHORTEST, LONGEST)),
        mode=family,
        frequency=frequency,
        settles=float(np.clip(np.log(10.0) / decay, 1.0, 8.0)) if decay > 0.0 else 8.0,
    )
