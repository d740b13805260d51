"""Wing and body in sideslip: dihedral, sweep, height of the wing, induced yaw.

Dihedral: the lifting line with the incidence +-beta times dihedral (Pearson and Jones, NACA TR 635,
1938). Sweep: simple sweep theory. Body: USAF Datcom, sec. 5.2.1.1 and 5.2.2.1. Yaw: Toll and
Queijo, NACA TN 1581, 1948 (Datcom 5.1.3.1).
"""

from __future__ import annotations

from math import cos, degrees, pi, sin, sqrt, tan

import numpy as np

from alula.predict.handbook import Found, Range, found, plus
from alula.predict.wing_line import WingLine


def dihedral_roll(wing: WingLine) -> Found:
    """Cl_beta of dihedral: sideslip from the right raises the right half's incidence."""
    line = wing.line
    alpha = np.sign(line.eta) * np.sin(wing.over_span(wing.shape.local_dihedral))
    if not np.any(alpha):
        return Found(0.0, 0.0, "")
    return wing.odd_found(line.roll(line.load(alpha)), "dihedral")


def sweep_roll(wing: WingLine, lift: float) -> Found:
    """Cl_beta of sweep at the lift coefficient `lift`, and of the unswept planform (in the se).

    Each half's lift goes with cos2 of its own sweep; the finite span takes A/(A + 4 cos) of it.
    """
    shape = wing.shape
    s, a = shape.sweep_quarter, shape.aspect
    arm = shape.station / shape.span
    share = a / (a + 4.0 * cos(s))
    value = -2.0 * lift * arm * tan(s) * share
    return found(
        value,
        sqrt((0.4 * value) ** 2 + (0.05 * lift) ** 2),
        "simple sweep theory, handbook form; se 40 %, and 0.05 C_L for the planform's own part",
        (Range("quarter-chord sweep, rad", abs(s), 0.0, 0.8),),
    )


def body_roll(wing: WingLine, height: float, diameter: float) -> Found:
    """Cl_beta of wing and body together (Datcom 5.2.2.1).

    height: m, of the wing's root above the body's center line. diameter: of the body, m. A high
    wing gains as much as 5 deg of dihedral give, a low one loses it.
    """
    shape = wing.shape
    b, root = shape.span, sqrt(shape.aspect)
    placed = -2.4 * root * height * diameter / b**2
    mean = degrees(float(np.average(shape.local_dihedral, weights=shape.local_chord)))
    wash = -0.0005 * degrees(1.0) * root * (diameter / b) ** 2 * mean
    value = placed + wash
    return found(
        value,
        0.3 * abs(placed) + 0.3 * abs(wash),
        "wing on body, Datcom 5.2.2.1; se 30 %, our judgment",
        (Range("body diameter over span", diameter / b, 0.0, 0.3),),
    )


def wing_side(wing: WingLine) -> Found:
    """CY_beta of a wing's dihedral (Datcom 5.1.1.1): -0.0001 a degree of it and of sideslip."""
    shape = wing.shape
    mean = degrees(float(np.average(np.abs(shape.local_dihedral), weights=shape.local_chord)))
    value = -0.0001 * degrees(1.0) * mean
    return found(value, 0.5 * value, "dihedral, Datcom 5.1.1.1; se 50 %, our judgment")


def wing_yaw(wing: WingLine, lift: float, behind: float) -> Found:
    """Cn_beta of induced drag (NACA TN 1581). behind: chords from reference to quarter chord."""
    a, s = wing.shape.aspect, wing.shape.sweep_quarter
    c = cos(s)
    swept = (
        tan(s) / (pi * a * (a + 4.0 * c))
        * (c - 0.5 * a - a**2 / (8.0 * c) + 6.0 * behind * sin(s) / a)
    )  # fmt: skip
    value = lift**2 * (1.0 / (4.0 * pi * a) - swept)
    return found(
        value,
        0.5 * abs(value) + 0.002,
        "NACA TN 1581 (Datcom 5.1.3.1); se 50 % and 0.002, our judgment",
        (Range("lift coefficient", lift, -0.2, 1.0),),
    )


def wing_roll(wing: WingLine, lift: float, height: float | None, diameter: float) -> Found:
    """Cl_beta of the wing with its body. height: None without a body."""
    parts = [dihedral_roll(wing), sweep_roll(wing, lift)]
    if height is not None:
        parts.append(body_roll(wing, height, diameter))
    return plus(*parts)
