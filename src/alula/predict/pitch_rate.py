"""Lift and pitching moment over the pitch rate q c/2V, of wing and tail.

The wing: thin-airfoil theory with the incidence at the three-quarter chord, and the sweep's term of
Toll and Queijo, NACA TN 1581, 1948 (Datcom 7.1.1.2). Toll and Queijo take the incidence at half
chord (1/2 + 2 x/c); the lattice agrees with three quarters (1 + 2 x/c). The tail: its arm.
"""

from __future__ import annotations

from math import cos, tan

from alula.predict.handbook import Found, Range, found, scaled


def wing(
    lift: Found, section: float, aspect: float, sweep_quarter: float, behind: float
) -> dict[str, Found]:
    """CL_q and Cm_q of the wing. lift: C_L_alpha. behind: chords, reference to quarter chord."""
    x, c = behind, cos(sweep_quarter)
    force = lift.value * (1.0 + 2.0 * x)
    swept = aspect**3 * tan(sweep_quarter) ** 2 / (24.0 * (aspect + 6.0 * c))
    couple = section * c * (swept + 0.125)
    ranges = (
        Range("aspect ratio", aspect, 2.0, 15.0),
        Range("quarter-chord sweep, rad", abs(sweep_quarter), 0.0, 0.8),
    )
    source = "wing in pitch: thin airfoil, sweep of NACA TN 1581"
    return {
        "CL_q": found(
            force, 0.15 * abs(force), f"{source}; se 15 % (8 % too much on a 45 deg wing)", ranges
        ),
        "Cm_q": found(
            -x * force - couple,
            0.15 * (abs(x * force) + couple),
            f"{source}; se 15 % (9 % too much on a 45 deg wing)",
            ranges,
        ),
    }


def tail(tail_lift: Found, arm: float, chord: float) -> dict[str, Found]:
    """CL_q and Cm_q of the tail. tail_lift: eta a_t S_t/S. arm: m behind the reference."""
    lift = scaled(tail_lift, 2.0 * arm / chord)
    return {"CL_q": lift, "Cm_q": scaled(lift, -arm / chord)}
