"""The wing in roll: damping, yaw and side force over p b/2V.

Damping and yaw by the lifting line (Pearson and Jones, NACA TR 635, 1938); yaw and side force of
sweep by Toll and Queijo, NACA TN 1581, 1948 (Datcom 7.1.2.1 to 7.1.2.3).
"""

from __future__ import annotations

from math import cos, tan

from alula.predict.handbook import Found, Range, found
from alula.predict.lifting_line import Load
from alula.predict.wing_line import WingLine


def damping(wing: WingLine) -> Found:
    """Cl_p of a mirrored surface on its own area and span, per its own p b/2V."""
    line = wing.line
    return wing.odd_found(line.roll(line.load(line.eta)), "Cl_p")


def yaw(wing: WingLine, base: Load, lift: float, behind: float) -> Found:
    """Cn_p: the right half's lift tilts forward, against the change of induced drag.

    base: the load at the flight's lift. lift: its coefficient. behind: chords, reference to quarter
    chord. The mean of the lifting line and Toll and Queijo's form.
    """
    line, a, s = wing.line, wing.shape.aspect, wing.shape.sweep_quarter
    rolling = line.load(line.eta)
    theory = line.tilted(base, line.eta) + line.yaw(base, rolling)
    c = cos(s)
    formula = (
        -lift / 6.0
        * (a + 6.0 * (a + c) * (behind * tan(s) / a + tan(s) ** 2 / 12.0)) / (a + 4.0 * c)
    )  # fmt: skip
    value = 0.5 * (theory + formula)
    return found(
        value,
        0.5 * abs(theory - formula) + 0.15 * abs(value) + 0.005,
        "mean of the lifting line and NACA TN 1581; se from their distance, 15 % and 0.005",
        (Range("quarter-chord sweep, rad", abs(s), 0.0, 0.8),),
    )


def side(wing: WingLine, lift: float) -> Found:
    """CY_p of sweep and of the tips' suction (NACA TN 1581)."""
    a, s = wing.shape.aspect, wing.shape.sweep_quarter
    c = cos(s)
    value = lift * ((a + c) / (a + 4.0 * c) * tan(s) + 1.0 / a)
    return found(value, 0.5 * abs(value) + 0.01, "NACA TN 1581; se 50 % and 0.01, our judgment")
