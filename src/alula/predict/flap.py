"""Effectiveness of a plain flap: thin-airfoil theory, its loss by friction and low aspect ratio.

Glauert, ARC R&M 1095, 1927: with cos(theta) = 1 - 2 x_hinge the flap turns the zero-lift line by
1 - (theta - sin(theta))/pi per radian and adds the moment -sin(theta) (1 - cos(theta))/2 about the
quarter chord.
"""

from __future__ import annotations

from math import acos, cos, pi, sin

from alula.base.messages import refuse
from alula.predict.handbook import Found, Range, found


def _theta(hinge: float) -> float:
    if not 0.0 < hinge < 1.0:
        raise refuse(
            "hinge_outside",
            where="control surface",
            expected="a hinge between the leading and the trailing edge, 0 to 1 of the chord",
            found=f"{hinge:g}",
            do="Correct `hinge` in the aircraft file.",
        )
    return acos(1.0 - 2.0 * hinge)


def turning(hinge: float) -> float:
    """alpha_delta of thin-airfoil theory, incidence over deflection. hinge: of the chord."""
    theta = _theta(hinge)
    return 1.0 - (theta - sin(theta)) / pi


def moment(hinge: float) -> float:
    """c_m_delta about the quarter chord, 1/rad, of thin-airfoil theory."""
    theta = _theta(hinge)
    return -0.5 * sin(theta) * (1.0 - cos(theta))


def friction_loss(slope: float) -> Found:
    """Flap lift over the theory's. slope: the section's c_l_alpha.

    Handbook form: friction costs a flap, which lies in the thick boundary layer, 1.4 times the
    share it costs the section; coefficient from the trend of the chart of Datcom 6.1.1.1.
    """
    ratio = slope / (2.0 * pi)
    return found(
        min(1.0 - 1.4 * (1.0 - ratio), 1.0),
        0.07,
        "flap theory of Glauert, R&M 1095, with a handbook loss by friction; se 0.07, the charts' "
        "spread over flap sizes",
        (Range("c_l_alpha over 2 pi", ratio, 0.7, 1.05),),
    )


def low_aspect(theory: float, aspect: float) -> float:
    """alpha_delta of the wing over the section's `theory`.

    Handbook form: 1 far out, and 1/alpha_delta for the slender wing, whose lift only the trailing
    edge's direction determines; between them the trend of the chart of Datcom 6.1.4.1.
    """
    slender: float = 1.0 / (1.0 + 1.9 * aspect**1.2)
    return 1.0 + (1.0 / theory - 1.0) * slender
