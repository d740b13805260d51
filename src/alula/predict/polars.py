"""Section polars for strip theory: from a table, from neuralfoil, or from slope and thickness.

Attached flow and the beginning of stall come from the source; all further angles from the flat
plate (`alula.predict.full_circle`).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alula.aircraft.geometry import Airfoil, Polar
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse

# What is assumed of a section of which only slope and thickness are known: the largest lift of
# symmetric sections at Reynolds numbers of 1e5 to 1e6 (NACA 0006 to 0015: 0.8 to 1.2), its stall
# over 4 deg, drag of a turbulent boundary layer on both sides with a form factor.
_MOST_LIFT = (0.70, 3.0)  # c_l_max = 0.70 + 3 t/c
_LEAST_DRAG = (0.012, 0.02)  # c_d0 = 0.012 + 0.02 t/c
_LIFT_DRAG = 0.008  # over c_l^2
_ROUNDING = float(np.radians(1.0))
_SLOPE_RANGE = float(np.radians(4.0))  # about zero lift, over which a table's slope is taken


def section_polar(airfoil: Airfoil, where: str) -> Polar:
    """The polar of a section: its table, with lift scaled to the stated `c_l_alpha`, else assumed.

    Raises BadInput at `where` for numbers that are not finite or angles that do not increase.
    """
    if airfoil.polar is None:
        return _assumed(airfoil)
    polar = airfoil.polar
    check_polar(polar, where)
    if airfoil.c_l_alpha is None:
        return polar
    factor = airfoil.c_l_alpha / lift_slope(polar)
    return replace(
        polar,
        c_l=frozen(factor * polar.c_l),
        source=f"{polar.source}; lift times {factor:.3f} for the stated slope",
    )


def check_polar(polar: Polar, where: str) -> None:
    """Raise BadInput unless all numbers are finite, of one length and over increasing angles that
    reach at least 5 deg to either side of zero.
    """
    columns = {"alpha": polar.alpha, "c_l": polar.c_l, "c_d": polar.c_d, "c_m": polar.c_m}
    for name, column in columns.items():
        bad = np.flatnonzero(~np.isfinite(column))
        if len(bad) or len(column) != len(polar.alpha):
            raise refuse(
                "polar_not_finite",
                where=f"{where}.{name}",
                expected=f"{len(polar.alpha)} finite numbers",
                found=f"{column[bad[0]]} in place {bad[0] + 1}" if len(bad) else f"{len(column)}",
                do="Remove the angles at which the solver did not converge.",
            )
    alpha = polar.alpha
    reach = np.radians(5.0)
    if len(alpha) < 3 or np.any(np.diff(alpha) <= 0.0) or alpha[0] > -reach or alpha[-1] < reach:
        span = (
            f"{np.degrees(alpha[0]):g} to {np.degrees(alpha[-1]):g} deg" if len(alpha) else "none"
        )
        raise refuse(
            "polar_range",
            where=where,
            expected="increasing angles of attack from -5 deg or less to 5 deg or more",
            found=f"{len(alpha)} angles, {span}",
            do="Give the polar of both signs of lift; a symmetric section's mirrored.",
        )


def lift_slope(polar: Polar) -> float:
    """c_l_alpha, 1/rad: straight line through the lift within 4 deg of zero lift."""
    zero = zero_lift(polar)
    at = np.linspace(zero - _SLOPE_RANGE, zero + _SLOPE_RANGE, 17)
    return float(np.polyfit(at, np.interp(at, polar.alpha, polar.c_l), 1)[0])


def zero_lift(polar: Polar) -> float:
    """The angle of no lift nearest to zero, rad."""
    signs = np.flatnonzero(np.diff(np.sign(polar.c_l)) != 0.0)
    if len(signs) == 0:
        return 0.0
    roots = [
        float(np.interp(0.0, polar.c_l[i : i + 2], polar.alpha[i : i + 2]))
        for i in signs
        if polar.c_l[i + 1] > polar.c_l[i]
    ]
    return min(roots, key=abs, default=0.0)


def neuralfoil_polar(
    thickness: float, camber: Array | None, reynolds: float, *, transition: float = 0.05
) -> Polar:
    """A section's polar by neuralfoil (Sharpe 2025), a network trained on XFOIL.

    thickness: over the chord, distributed as the NACA four-digit sections'. camber: (k, 2) mean
    line or None. transition: x/c of the trip on both sides; 0.05 stands for the turbulent flow of
    rough and vibrating model wings. Raises BadInput where the extra is not installed or what comes
    back is not finite. Angles with a stated confidence under 0.3 are left out.
    """
    try:
        import neuralfoil
    except ImportError:
        raise refuse(
            "missing_extra",
            where="airfoil polar",
            expected="the package neuralfoil, or a polar in [geometry.airfoils]",
            found="neither",
            do="Install it: pip install 'alula[polars]'.",
        ) from None
    degrees = np.arange(-20.0, 20.01, 1.0)
    out = neuralfoil.get_aero_from_coordinates(
        _coordinates(thickness, camber),
        alpha=degrees,
        Re=reynolds,
        xtr_upper=transition,
        xtr_lower=transition,
    )
    keep = np.asarray(out["analysis_confidence"]) > 0.3
    polar = Polar(
        frozen(np.radians(degrees[keep])),
        frozen(np.asarray(out["CL"], dtype=np.float64)[keep]),
        frozen(np.asarray(out["CD"], dtype=np.float64)[keep]),
        frozen(np.asarray(out["CM"], dtype=np.float64)[keep]),
        reynolds,
        f"neuralfoil {getattr(neuralfoil, '__version__', '')}, tripped at {transition:g} c".strip(),
    )
    check_polar(polar, "neuralfoil")
    return polar


def _coordinates(thickness: float, camber: Array | None) -> Array:
    """Contour (k, 2) from the trailing edge over the top: NACA Report 460's thickness, closed."""
    x = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 80)))
    y = 5.0 * thickness * (
        0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4
    )  # fmt: skip
    z = np.zeros_like(x) if camber is None else np.interp(x, camber[:, 0], camber[:, 1])
    upper, lower = np.column_stack([x, z + y]), np.column_stack([x, z - y])
    return np.vstack([upper[::-1], lower[1:]])


def _assumed(airfoil: Airfoil) -> Polar:
    slope = 0.95 * 2.0 * np.pi if airfoil.c_l_alpha is None else airfoil.c_l_alpha
    zero = 0.0 if airfoil.alpha_0 is None else airfoil.alpha_0
    t = airfoil.thickness
    most = _MOST_LIFT[0] + _MOST_LIFT[1] * min(t, 0.18)
    stall = most / slope
    alpha = np.radians(np.arange(-20.0, 20.01, 0.5))
    line = alpha - zero
    size = np.abs(line)
    # Straight, then flat, with a rounded corner.
    over = _ROUNDING * np.logaddexp(0.0, (size - stall) / _ROUNDING)
    under = _ROUNDING * np.logaddexp(0.0, -stall / _ROUNDING)
    c_l = np.sign(line) * slope * (size - over + under)
    c_d = _LEAST_DRAG[0] + _LEAST_DRAG[1] * t + _LIFT_DRAG * c_l**2
    c_d = c_d + np.where(size > stall, 2.0 * np.sin(size) * np.sin(size - stall), 0.0)
    source = f"assumed: slope {slope:.3g}/rad, largest lift {most:.2f} by thickness {t:.3f}"
    return Polar(
        frozen(alpha), frozen(c_l), frozen(c_d), frozen(np.zeros_like(alpha)), None, source
    )
