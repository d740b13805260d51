"""Oswald factor e of the induced drag C_L2/(pi A e), by several published forms.

The lifting line's 1/(1 + delta) is of the wing alone, without friction (Glauert 1926; Pusztai 2018,
appendix C, takes its delta from a chart of Dubs). The others fit whole aircraft, whose profile drag
also grows with lift; they lie well below it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, degrees, exp, sqrt

from alula.predict.handbook import Found, Range, found
from alula.predict.lifting_line import Correction, correction, lifting_line
from alula.predict.trapezoid import Trapezoid

# Zero-lift drag rising with lift, by kind of aircraft (Nita and Scholz 2012, Table of k_e,D0).
NITA_PROFILE = {"jet": 0.873, "business_jet": 0.864, "turboprop": 0.804, "light": 0.804}


def lifting_line_factor(wing: Trapezoid, section: float) -> Found:
    """e of the wing alone. section: c_l_alpha, 1/rad."""
    shape = _line(wing, section)
    return found(
        1.0 / (1.0 + shape.delta),
        0.005,
        "Glauert's lifting line, wing alone; se 0.005, of the straight line that stands for it",
        (Range("aspect ratio", wing.aspect, 3.0, 40.0),),
    )


def lift_correction(wing: Trapezoid, section: float) -> float:
    """k = C_L_alpha/c_l_alpha of the wing by the lifting line (Pusztai 2018, appendix C)."""
    return _line(wing, section).slope / section


def effective_aspect(wing: Trapezoid, section: float) -> float:
    """Aspect ratio of the elliptic wing with the same induced drag, A/(1 + delta)."""
    return wing.aspect / (1.0 + _line(wing, section).delta)


def raymer(aspect: float, sweep_leading: float = 0.0) -> Found:
    """e of the aircraft (Raymer, Aircraft Design, ch. 12, straight and swept form).

    sweep_leading: rad. Between no sweep and 30 deg the two forms are joined by a straight line.
    """
    base = 1.0 - 0.045 * aspect**0.68
    straight = 1.78 * base - 0.64
    limit = 0.5236
    sweep = abs(sweep_leading)
    swept = 4.61 * base * cos(max(sweep, limit)) ** 0.15 - 3.1
    share = min(sweep / limit, 1.0)
    return found(
        (1.0 - share) * straight + share * swept,
        0.05,
        "Raymer ch. 12; se 0.05, our judgment of a fit to aircraft",
        (Range("aspect ratio", aspect, 3.0, 15.0),),
    )


def nita_scholz(
    aspect: float,
    taper: float,
    sweep_quarter: float = 0.0,
    body_ratio: float = 0.0,
    kind: str = "light",
) -> Found:
    """e of the aircraft (Nita and Scholz, Estimating the Oswald Factor, DLRK 2012).

    sweep_quarter: rad. body_ratio: body width over span. Low speed.
    """
    sweep = degrees(sweep_quarter)
    x = taper - (-0.357 + 0.45 * exp(-0.0375 * abs(sweep)))
    f = 0.0524 * x**4 - 0.15 * x**3 + 0.1659 * x**2 - 0.0706 * x + 0.0119
    theory = 1.0 / (1.0 + f * aspect)
    return found(
        theory * (1.0 - 2.0 * body_ratio**2) * NITA_PROFILE[kind],
        0.05,
        "Nita and Scholz 2012; se 0.05, of the order of its stated scatter",
        (
            Range("aspect ratio", aspect, 3.0, 20.0),
            Range("body width over span", body_ratio, 0.0, 0.25),
            Range("quarter-chord sweep, deg", abs(sweep), 0.0, 40.0),
        ),
    )


def aircraft_factor(forms: Sequence[Found]) -> Found:
    """The mean of several forms; se: their own mean error and their spread, added as squares."""
    n = len(forms)
    mean = sum(f.value for f in forms) / n
    own = sum(f.se for f in forms) / n
    spread = sqrt(sum((f.value - mean) ** 2 for f in forms) / max(n - 1, 1))
    notes = tuple(note for f in forms for note in f.notes)
    names = ", ".join(f"{f.source.split(';')[0]} {f.value:.3f}" for f in forms)
    return Found(
        mean, sqrt(own**2 + spread**2), f"mean of {names}; se from own error and spread", notes
    )


def _line(wing: Trapezoid, section: float) -> Correction:
    line = lifting_line(
        lambda eta: wing.root + (wing.tip - wing.root) * eta, wing.span, wing.area, section
    )
    return correction(line, section)
