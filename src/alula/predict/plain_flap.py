"""What a plain flap adds to a section's lift and moment, by thin airfoil theory or as stated."""

from __future__ import annotations

from math import acos, pi, sin

from alula.aircraft.geometry import ControlSurface


def thin_flap(hinge: float) -> tuple[float, float]:
    """c_l_delta and c_m_delta (quarter chord), 1/rad, of a hinge at this fraction of the chord.

    Glauert, The Elements of Aerofoil and Airscrew Theory, 1926, ch. X: with hinge =
    (1 - cos theta)/2 they are 2 (pi - theta + sin theta) and -sin theta (1 - cos theta)/2.
    """
    theta = acos(1.0 - 2.0 * hinge)
    return 2.0 * (pi - theta + sin(theta)), -0.5 * sin(theta) * (1.0 - (1.0 - 2.0 * hinge))


def flap_constants(control: ControlSurface, hinge: float, c_l_alpha: float) -> tuple[float, float]:
    """c_l_delta and c_m_delta of a control: as stated, else the thin airfoil's, the lift less what
    the section's slope falls behind 2 pi.
    """
    lift, moment = thin_flap(hinge)
    lift *= c_l_alpha / (2.0 * pi)
    return (
        lift if control.c_l_delta is None else control.c_l_delta,
        moment if control.c_m_delta is None else control.c_m_delta,
    )
