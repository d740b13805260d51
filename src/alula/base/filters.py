"""The names of what reconstructs a flight path, for project file, command line and report.

What they do is registered in alula.reconstruct; a test holds the two together.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

FilterName = Literal["ekf", "iekf", "ukf", "srukf", "ml", "none"]

FILTERS: Mapping[str, str] = {
    "ekf": "extended Kalman filter and smoother",
    "iekf": "iterated extended Kalman filter and smoother",
    "ukf": "unscented Kalman filter and smoother",
    "srukf": "square-root unscented Kalman filter and smoother",
    "ml": "maximum likelihood, output error",
    "none": "motion as recorded",
}
