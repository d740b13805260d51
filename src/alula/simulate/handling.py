"""Handling qualities: the modes of a flight against what specifications ask of them.

Only what the linear model with fixed controls tells is judged; the rest reads 'not judged', and
says why. The specifications are in `military` and `certification`, with their editions.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from alula.base.messages import refuse
from alula.simulate.certification import certification
from alula.simulate.linearize import LinearModel
from alula.simulate.military import CATEGORIES, CLASSES, military
from alula.simulate.modes import Mode
from alula.simulate.requirement import Judgment

_GRAVITY = 9.80665  # m/s2: load factors are in standard g


def load_factor_per_alpha(linear: LinearModel, V: float) -> float | None:
    """n/alpha, 1/rad: steady normal acceleration per angle of attack at constant speed V (m/s).

    By an elevator step in the motion of alpha and q alone, as MIL-F-8785C, 6.2.6, defines it;
    without an elevator by the lift alone. None where there is no such steady state.
    """
    pair = linear.part(("alpha", "q"), ("de",) if "de" in linear.inputs else ())
    A, B = np.asarray(pair.A), np.asarray(pair.B)
    # det and trace are 1/s2 and 1/s; below these there is no steady state to speak of
    if B.shape[1] == 0 or abs(B[1, 0]) < 1e-9:
        return float(-V / _GRAVITY * A[0, 0]) if abs(A[0, 1]) > 1e-9 else None
    if abs(np.linalg.det(A)) < 1e-9:
        return None
    alpha, q = np.linalg.solve(A, -B[:, 0])
    return float(V * q / (_GRAVITY * alpha)) if abs(alpha) > 1e-9 else None


def judge(
    modes: Sequence[Mode],
    linear: LinearModel,
    V: float,
    h: float,
    *,
    aircraft_class: str = "I",
    category: str = "B",
    not_straight: str = "",
) -> tuple[Judgment, ...]:
    """Every requirement on the modes of a linear model at airspeed V (m/s) and height h (m).

    aircraft_class: I light, II medium (land-based), III large, IV maneuverable; category: A rapid
    maneuvering, B gradual, C terminal flight phases. not_straight: why the point is no steady
    straight flight, if it is none; then nothing is judged. Raises BadInput for an unknown class or
    category.
    """
    asked = (("class", aircraft_class, CLASSES), ("category", category, CATEGORIES))
    for name, value, known in asked:
        if value not in known:
            raise refuse(
                f"unknown_{name}",
                where=f"handling qualities, {name}",
                expected=f"one of {', '.join(known)}",
                found=f"'{value}'",
                do="Use the classes and flight phase categories of MIL-F-8785C.",
            )
    n_alpha = load_factor_per_alpha(linear, V)
    found = [*military(modes, n_alpha, aircraft_class, category), *certification(modes, h)]
    return tuple(j.unjudged(not_straight) if not_straight else j for j in found)
