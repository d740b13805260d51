"""Fuselage in sideslip: side force and yawing moment. In pitch see `body_carry_over`.

Munk, NACA TR 184, 1924; USAF Datcom, sec. 5.2.1.1; Raymer ch. 16.
"""

from __future__ import annotations

import numpy as np

from alula.predict.body_shape import BodyShape
from alula.predict.handbook import Found, Range, found
from alula.predict.slender_body import apparent_mass_factor


def side_force(body: BodyShape, wing_height: float, depth: float, area: float) -> Found:
    """CY_beta of the body with a wing (Datcom 5.2.1.1): -2 K_i S_0/S.

    wing_height: m, of the wing's root above the body's center. depth: m, of the body there. S_0:
    the cross-section where the flow ceases to follow, at 0.378 + 0.527 of the station where the
    section falls off fastest. K_i: 1 in mid-height, 1.85 on top, 1.5 below (chart's ends).
    """
    s = np.linspace(0.0, body.length, 401)
    steepest = float(s[int(np.argmin(np.gradient(body.area(s))))] / body.length)
    s0 = float(body.area(np.array([(0.378 + 0.527 * steepest) * body.length]))[0])
    place = float(np.clip(wing_height / (0.5 * depth), -1.0, 1.0)) if depth > 0.0 else 0.0
    k = 1.0 + (0.85 * place if place > 0.0 else -0.5 * place)
    value = -2.0 * k * s0 / area
    return found(value, 0.4 * value, "Datcom 5.2.1.1; se 40 %, our judgment")


def yawing(body: BodyShape, area: float, span: float) -> Found:
    """Cn_beta of the body: Munk's 2 V (k2 - k1) and Raymer's 1.3 V depth/width, their mean.

    Slender flow overturns the body as in pitch, and no wing turns the flow.
    """
    munk = -2.0 * apparent_mass_factor(body.length / body.diameter) * body.volume / (area * span)
    depth = float(body.height.max() / body.width.max())
    raymer = -1.3 * body.volume / (area * span) * depth
    value = 0.5 * (munk + raymer)
    return found(
        value,
        float(np.hypot(0.5 * (munk - raymer), 0.25 * value)),
        "mean of Munk, NACA TR 184, and Raymer ch. 16; se from their distance and 25 %",
        (Range("fineness of the body", body.length / body.diameter, 4.0, 20.0),),
    )
