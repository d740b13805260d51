"""Downwash of the wing at the tail, its gradient, and the wake's loss of dynamic pressure.

Two independent forms: the USAF Datcom's, fitted to tunnels, and the horseshoe vortex, derived.
"""

from __future__ import annotations

from math import cos, hypot, pi, sqrt

from alula.predict.handbook import Found, Range, found, positive


def datcom(
    aspect: float,
    taper: float,
    sweep_quarter: float,
    span: float,
    arm: float,
    height: float = 0.0,
    slope_ratio: float = 1.0,
) -> Found:
    """d epsilon/d alpha at the tail (USAF Datcom, sec. 4.4.1, for tails narrower than wings).

    arm: m, from the quarter point of the wing's mean chord to the tail's. height: m, of the tail
    above the wing's root chord (its sign does not matter). slope_ratio: C_L_alpha at this Mach
    number over that at low speed.
    """
    positive("downwash", aspect_ratio=aspect, span=span, arm=arm, taper=taper)
    k_aspect = 1.0 / aspect - 1.0 / (1.0 + aspect**1.7)
    k_taper = (10.0 - 3.0 * taper) / 7.0
    k_place = (1.0 - abs(height) / span) / (2.0 * arm / span) ** (1.0 / 3.0)
    value = 4.44 * (k_aspect * k_taper * k_place * sqrt(cos(sweep_quarter))) ** 1.19 * slope_ratio
    return found(
        value,
        0.10 * value,
        "Datcom 4.4.1; se 10 %, our judgment of its scatter about tunnel tests",
        (
            Range("aspect ratio", aspect, 2.0, 12.0),
            Range("2 arm/span", 2.0 * arm / span, 0.5, 2.0),
            Range("height over span", abs(height) / span, 0.0, 0.4),
        ),
    )


def horseshoe(
    lift_slope: float, aspect: float, span: float, arm: float, height: float = 0.0
) -> Found:
    """d epsilon/d alpha of one horseshoe vortex whose legs have rolled up, by Biot and Savart.

    The legs are pi/4 of the span apart, as the impulse of the elliptic load demands (Glauert 1926,
    ch. XII), and leave the bound vortex at the quarter chord straight back; far behind, the
    gradient tends to 16/pi3 C_L_alpha/A; with a negative arm it is the upwash ahead. arm, height:
    m, as in `datcom`. lift_slope: the wing's, 1/rad.
    """
    positive("downwash", aspect_ratio=aspect, span=span, lift_slope=lift_slope)
    s = pi * span / 8.0
    r2 = s**2 + height**2
    # Circulation over V and C_L: 2 S/(pi b); over 4 pi it multiplies what the three legs induce.
    circulation = 2.0 * span / (aspect * pi)
    bound = 2.0 * s * arm / ((arm**2 + height**2) * sqrt(arm**2 + r2))
    legs = 2.0 * s / r2 * (1.0 + arm / sqrt(arm**2 + r2))
    value = lift_slope * circulation / (4.0 * pi) * (bound + legs)
    return found(
        value,
        0.10 * value,
        "horseshoe vortex of span pi b/4; se 10 %, the effect of how far the sheet has rolled up",
        (
            Range("aspect ratio", aspect, 3.0, 20.0),
            Range("2 arm/span", 2.0 * arm / span, 0.5, 3.0),
        ),
    )


def gradient(forms: tuple[Found, ...]) -> Found:
    """The mean of the forms; se: the mean of their own and half their distance, as squares."""
    values = [f.value for f in forms]
    mean = sum(values) / len(values)
    half = 0.5 * (max(values) - min(values))
    own = sum(f.se for f in forms) / len(forms)
    names = ", ".join(f"{f.source.split(';')[0]} {f.value:.3f}" for f in forms)
    notes = tuple(n for f in forms for n in f.notes)
    return Found(mean, hypot(own, half), f"mean of {names}; se from own error and distance", notes)


def pressure_ratio(profile_drag: float, behind: float, above: float) -> Found:
    """Dynamic pressure at the tail over the free stream's, in the wing's wake.

    profile_drag: of the wing at the root. behind: chords from the trailing edge to the tail's
    quarter chord. above: chords from the wake's center. Silverstein, Katzoff and Bullivant, NACA TR
    651, 1939 (Datcom 4.4.1): half width 0.68 sqrt(c_d (x + 0.15)), loss 2.42 sqrt(c_d)/(x + 0.3).
    """
    positive("wake", profile_drag=profile_drag, behind=behind)
    half = 0.68 * sqrt(profile_drag * (behind + 0.15))
    loss = 2.42 * sqrt(profile_drag) / (behind + 0.3)
    share = cos(0.5 * pi * above / half) ** 2 if abs(above) < half else 0.0
    # A tail of finite thickness is seldom in the middle alone, and body and propeller disturb it.
    return found(
        1.0 - loss * share,
        0.05,
        "wake of NACA TR 651; se 0.05 for body and slipstream, our judgment",
        (Range("chords behind the wing", behind, 0.5, 6.0),),
    )
