"""Order of magnitude of derivatives, and their units.

The magnitudes are those of conventional airplanes, good to a factor of three (compare Nelson,
Flight Stability and Automatic Control, 1998, app. B). They serve one purpose: a standard error of
ten times such a value tells nothing about an airplane. A scale stated by the user goes first.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

_LIFT = {"alpha": 5.0, "q": 10.0, "de": 0.5, "df": 1.0}
_DRAG = {"alpha": 0.5, "q": 5.0, "de": 0.1, "df": 0.2}
TYPICAL: Mapping[str, Mapping[str, float]] = {
    "CZ": _LIFT,
    "CL": _LIFT,
    "CX": _DRAG,
    "CD": _DRAG,
    "Cm": {"alpha": 1.0, "q": 15.0, "de": 1.5, "df": 0.3},
    "CY": {"beta": 0.7, "p": 0.3, "r": 0.5, "da": 0.1, "dr": 0.3},
    "Cl": {"beta": 0.1, "p": 0.5, "r": 0.2, "da": 0.2, "dr": 0.03},
    "Cn": {"beta": 0.1, "p": 0.1, "r": 0.2, "da": 0.03, "dr": 0.1},
}

_ANGLES = ("alpha", "beta", "de", "da", "dr", "df", "p", "q", "r")
_TOKEN = re.compile(r"(abs)?(" + "|".join(sorted(_ANGLES, key=len, reverse=True)) + r")\^?(\d*)$")


def constant_name(coefficient: str) -> str:
    """Name of the constant term, 'Cm_0'."""
    return f"{coefficient}_0"


def flown_sum(name: str) -> str | None:
    """What flight yields under the name of a rate's derivative; None for other parameters.

    In flight alphadot goes along with q, and betadot against r, so that a model without a term in
    them holds the sums: 'Cm_q' is Cm_q + Cm_alphadot, 'Cn_r' is Cn_r - Cn_betadot (Etkin and Reid,
    Dynamics of Flight, 1996, ch. 5).
    """
    coefficient, _, rest = name.split("[")[0].partition("_")
    if rest == "q" and coefficient in ("CX", "CZ", "CD", "CL", "Cm"):
        return f"{coefficient}_q + {coefficient}_alphadot"
    if rest == "r" and coefficient in ("CY", "Cl", "Cn"):
        return f"{coefficient}_r - {coefficient}_betadot"
    return None


def typical_magnitude(coefficient: str, name: str) -> float | None:
    """Order of magnitude of the parameter `name`; None for constants and products."""
    return TYPICAL.get(coefficient, {}).get(name.removeprefix(f"{coefficient}_"))


def unit(coefficient: str, name: str) -> str:
    """Unit of a parameter of a non-dimensional coefficient: '1', '1/rad', '1/rad^2', ..., 's/m'.

    Rates count as radians (qhat = qc/2V). '' where the name's factors are not known.
    """
    radians = speeds = 0
    rest = name.split("[")[0].removeprefix(f"{coefficient}_")
    spline = re.match(r"\((\w+)[^)]*\)\^?\+?\^?(\d*)$", rest)
    tokens = [spline[1] + (spline[2] or "1")] if spline else rest.split("_")
    for token in tokens:
        angle = _TOKEN.match(token)
        speed = re.match(r"V\^?(\d*)$", token)
        if angle:
            radians += int(angle[3] or 1)
        elif speed:
            speeds += int(speed[1] or 1)
        elif not re.match(r"(0|dt|mach|CL)\^?\d*$", token):
            return ""
    parts = []
    if radians:
        parts.append("1/rad" if radians == 1 else f"1/rad^{radians}")
    if speeds:
        parts.append("s/m" if speeds == 1 else f"(s/m)^{speeds}")
    return " ".join(parts) or "1"
