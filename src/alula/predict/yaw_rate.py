"""The wing in yaw: roll and yaw over r b/2V, as one half advances and the other recedes.

Pearson and Jones, NACA TR 635, 1938, by the lifting line; the profile drag's part by strips. The
curvature of the wake is left out.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.predict.handbook import Found, found
from alula.predict.lifting_line import Load
from alula.predict.wing_line import WingLine


def _yawing(wing: WingLine, incidence: Array) -> Load:
    """The change of circulation: the section's u alpha changes by -rhat eta alpha."""
    return wing.line.load(-wing.line.eta * incidence)


def roll(wing: WingLine, base: Load, incidence: Array) -> Found:
    """Cl_r. incidence: (k,) rad from zero lift at the line's stations, of the load `base`."""
    line = wing.line
    change = line.roll(_yawing(wing, incidence)) + line.slowed(base, -line.eta)
    return wing.odd_found(change, "Cl_r", se=0.10)


def yaw(wing: WingLine, base: Load, incidence: Array, profile: float) -> Found:
    """Cn_r of the wing. profile: its profile drag coefficient, on its area."""
    line = wing.line
    induced = line.yaw(base, _yawing(wing, incidence))
    chord = wing.shape.chord(np.abs(line.eta))
    weights = chord * np.sin(line.theta)
    # Drag of each strip goes with (1 - 2 rhat eta), at the arm eta/2 of the span.
    strips = -float((weights * line.eta**2).sum() / weights.sum()) * profile
    value = induced + strips
    return found(
        value,
        0.3 * (abs(induced) + abs(strips)),
        "induced yaw by the lifting line and strips of profile drag; se 30 %, our judgment",
    )
