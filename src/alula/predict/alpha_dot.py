"""Derivatives to alpha-dot: the wing's downwash reaches the tail later by arm/V.

The lag of downwash: Cowley and Glauert, ARC R&M 718, 1921; USAF Datcom, sec. 7.4.4. The wing's own
part (added mass) is left out; it is small for straight wings of moderate aspect ratio.
"""

from __future__ import annotations

from alula.predict.handbook import Found, plus, scaled, times


def tail_rates(tail_lift: Found, arm: float, chord: float, downwash: Found) -> dict[str, Found]:
    """CL_alphadot and Cm_alphadot per alphadot c/2V.

    tail_lift: the tail's lift slope on the wing's area, eta a_t S_t/S, 1/rad. arm: m, behind the
    moment reference; downwash: d epsilon/d alpha there. The lag counts from the wing's quarter
    chord, which lies by the reference within the accuracy of the form.
    """
    lag = scaled(times(tail_lift, downwash), 2.0 * arm / chord)
    own = Found(0.0, 0.1 * abs(lag.value), "lag of downwash (Datcom 7.4.4), wing's part in the se")
    lift = plus(lag, own)
    return {"CL_alphadot": lift, "Cm_alphadot": scaled(lift, -arm / chord)}
