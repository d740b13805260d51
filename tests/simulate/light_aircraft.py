"""A light aircraft for tests of trim, linearization and modes, in one file that nobody else edits.

Longitudinal values of the size of Dittrich 2016, Tables 4.4 and 4.5; thrust through the center of
gravity along the body axis unless a test moves it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from alula.model import AeroModel, Reference, aero_model
from alula.simulate import Airframe

FORMULAS = {
    "CD": "1 + alpha + qhat + de",
    "CL": "1 + alpha + qhat + de",
    "Cm": "1 + alpha + qhat + de",
    "CY": "beta + phat + rhat + dr",
    "Cl": "beta + phat + rhat + da + dr",
    "Cn": "beta + phat + rhat + da + dr",
}
VALUES = {
    "CD_0": 0.051, "CD_alpha": 0.69, "CD_q": 0.3, "CD_de": 0.05,
    "CL_0": 0.488, "CL_alpha": 5.07, "CL_q": 7.0, "CL_de": 0.473,
    "Cm_0": -0.1025, "Cm_alpha": -0.428, "Cm_q": -25.4, "Cm_de": -2.08,
    "CY_beta": -0.55, "CY_p": -0.10, "CY_r": 0.30, "CY_dr": 0.18,
    "Cl_beta": -0.085, "Cl_p": -0.47, "Cl_r": 0.13, "Cl_da": -0.22, "Cl_dr": 0.015,
    "Cn_beta": 0.080, "Cn_p": -0.060, "Cn_r": -0.11, "Cn_da": 0.020, "Cn_dr": -0.080,
}  # fmt: skip
REFERENCE = Reference(10.6, 8.65, 1.25)
MASS, IYY = 560.0, 723.0


def light(**changed: float) -> AeroModel:
    """The model, some of its values changed."""
    return aero_model("light", FORMULAS, {**VALUES, **changed}, REFERENCE, axes="stability")


def airframe(**changed: Any) -> Airframe:
    """The airframe, some of its fields changed."""
    inertia = np.array([[655.0, 0.0, -30.0], [0.0, IYY, 0.0], [-30.0, 0.0, 1139.0]])
    return Airframe(**{"mass": MASS, "inertia": inertia, **changed})
