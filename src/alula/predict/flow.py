"""The flight condition that derivatives are predicted for."""

from __future__ import annotations

import math
from dataclasses import dataclass

from alula.base.messages import refuse


@dataclass(frozen=True)
class Flow:
    """Airspeed and air. V: m/s. alpha: rad; None: from `lift`. lift: C_L; None: from the mass.

    density: kg/m3. viscosity: kinematic, m2/s (both at sea level by default). mach: of the flight.
    """

    V: float = 50.0
    alpha: float | None = None
    lift: float | None = None
    density: float = 1.225
    viscosity: float = 1.46e-5
    mach: float = 0.0

    def __post_init__(self) -> None:
        for name in ("V", "density", "viscosity"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise _bad(name, getattr(self, name), "above zero")
        if not 0.0 <= self.mach < 0.9:
            raise _bad("mach", self.mach, "from 0 to below 0.9 (attached subsonic flow)")
        if self.alpha is not None and not -0.35 <= self.alpha <= 0.35:
            raise _bad(
                "alpha",
                self.alpha,
                "within 0.35 rad (20 deg): these formulas are of attached flow",
                f"{self.alpha:.4g} rad ({math.degrees(self.alpha):.4g} deg)",
            )


def _bad(name: str, value: float, expected: str, found: str = "") -> Exception:
    return refuse(
        "impossible_condition",
        where=f"condition of the prediction, {name}",
        expected=expected,
        found=found or f"{value:g}",
        do="Correct the condition.",
    )
