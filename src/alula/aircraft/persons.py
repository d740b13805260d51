"""The inertia of a person from height and weight.

Source: Santschi, DuBois and Omoto 1963, Moments of Inertia and Centers of Gravity of the Living
Human Body, AMRL-TDR-63-36: 66 men on a compound pendulum, 75.5 kg and 1.763 m on the average,
pendulum good to 2 to 8 %. The mean moments are scaled by m h^2, as bodies of one shape have them.
Persons differ in shape: standing moments of three men known singly are missed by up to 9 %.
Products of inertia, of which a sitting body has a little, are left out. Against the whole of an
aircraft what matters most is the person's mass and place.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from alula.base.arrays import Array, frozen

Posture = Literal["sitting", "standing"]

MEAN_MASS = 75.5  # kg, 166.4 lb
MEAN_HEIGHT = 1.763  # m, 69.4 in
_LB_IN_S2 = 0.1129848  # kg m2
# About the body's own CG: forward, sideways and along the trunk. lb in s2.
_MOMENTS: dict[Posture, tuple[float, float, float]] = {
    "sitting": (61.1, 66.6, 33.5),
    "standing": (115.0, 103.0, 11.3),
}


def person_inertia(mass: float, height: float, posture: Posture = "sitting") -> Array:
    """Inertia (3, 3) kg m2 of a person about the own CG; axes of the aircraft, trunk along z.

    mass: kg; height: m, standing. Santschi et al. 1963, means scaled by m h^2.
    """
    scale = mass * height**2 / (MEAN_MASS * MEAN_HEIGHT**2)
    return frozen(np.diag(_MOMENTS[posture]) * (_LB_IN_S2 * scale))
