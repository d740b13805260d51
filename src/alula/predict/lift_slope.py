"""Lift-curve slope of a wing or tail, and of it with a body.

Polhamus's form: Lowry and Polhamus, NACA TN 3911, 1957, as taken up in USAF Datcom, sec. 4.1.3.2.
"""

from __future__ import annotations

from math import pi, sqrt, tan

from alula.predict.handbook import Found, Range, found, positive

# Where a section's slope is not known: 95 % of the thin airfoil's, since its boundary layer takes
# some of it (measured slopes of NACA sections lie between 0.9 and 1.0, Abbott and von Doenhoff).
SECTION = 0.95 * 2.0 * pi
SECTION_SE = 0.04  # of itself


def prandtl_glauert(mach: float) -> float:
    """sqrt(1 - M2)."""
    return sqrt(1.0 - mach**2)


def polhamus(aspect: float, section: float, sweep_half: float, mach: float = 0.0) -> Found:
    """C_L_alpha, 1/rad. section: c_l_alpha, incompressible. sweep_half: rad, of the half chord."""
    positive("lift-curve slope", aspect_ratio=aspect, c_l_alpha=section)
    beta2 = 1.0 - mach**2
    kappa = section / (2.0 * pi)
    root = sqrt((aspect / kappa) ** 2 * (beta2 + tan(sweep_half) ** 2) + 4.0)
    value = 2.0 * pi * aspect / (2.0 + root)
    return found(
        value,
        0.05 * value,
        "Lowry and Polhamus, NACA TN 3911 (Datcom 4.1.3.2); se 5 %, the form's scatter about "
        "lifting surfaces and tunnels, our judgment",
        (
            Range("aspect ratio", aspect, 1.0, 12.0),
            Range("Mach number", mach, 0.0, 0.7),
            Range("half-chord sweep, rad", abs(sweep_half), 0.0, 0.8),
        ),
    )


def helmbold(aspect: float, section: float = 2.0 * pi) -> float:
    """C_L_alpha, 1/rad, of an unswept wing of low aspect ratio (Helmbold 1942)."""
    x = section / (pi * aspect)
    return section / (sqrt(1.0 + x**2) + x)


def body_factor(diameter: float, span: float) -> Found:
    """Wing-body lift over the bare wing's (handbook form, Roskam, Airplane Design VI, sec. 8.2)."""
    x = diameter / span
    return found(
        1.0 + 0.025 * x - 0.25 * x**2,
        0.02,
        "body on wing, Roskam VI sec. 8.2; se 0.02, our judgment",
        (Range("body diameter over span", x, 0.0, 0.4),),
    )
