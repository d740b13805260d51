"""Unsteady stall by the separation point of the flow over the wing (Kirchhoff)."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from alula.base.messages import refuse


@dataclass(frozen=True)
class Stall:
    """What the flow's separation takes from the attached model (Goman and Khrabrov 1994).

    The separation point X is 1 where the flow is attached and 0 where it has left the whole chord;
    steady X0 = (1 - tanh(a1 (alpha - alpha_star)))/2, and
    tau1 dX/dt = X0(alpha - tau2 dalpha/dt) - X. The terms of the model are those of the attached
    flow; the stall adds CL_alpha (alpha - alpha_0) (((1 + sqrt X)/2)^2 - 1) to CL,
    CD_X (1 - X) to CD, Cm_X (1 - X) to Cm.

    a1: abruptness, 1/rad. alpha_star: where half is separated, rad. tau1, tau2: s. CL_alpha: 1/rad
    and alpha_0: rad, of the attached lift. y_station: m from the plane of symmetry; above 0 each
    wing has its own X, with the angle of attack there (roll rate), and a wing that drops.
    alpha_star_difference: right less left, rad.
    """

    a1: float
    alpha_star: float
    tau1: float
    tau2: float
    CL_alpha: float
    alpha_0: float
    CD_X: float = 0.0
    Cm_X: float = 0.0
    y_station: float = 0.0
    alpha_star_difference: float = 0.0

    @property
    def split(self) -> bool:
        """Whether left and right wing stall on their own."""
        return self.y_station > 0.0


STALL_KEYS = tuple(f.name for f in fields(Stall))


def check_stall(stall: Stall, where: str) -> None:
    """Raise BadInput unless the stall's values are finite and possible."""
    values = {name: getattr(stall, name) for name in STALL_KEYS}
    wrong = [n for n, v in values.items() if not np.isfinite(v)]
    wrong += [n for n in ("a1", "alpha_star", "tau1") if not values[n] > 0.0]
    wrong += [n for n in ("tau2", "y_station") if values[n] < 0.0]
    if not stall.split and stall.alpha_star_difference != 0.0:
        wrong.append("alpha_star_difference")
    if wrong:
        raise refuse(
            "stall_values",
            where=f"{where}, stall",
            expected="finite values; a1, alpha_star and tau1 above zero, tau2 and y_station not "
            "below; a difference of the wings only with y_station",
            found=", ".join(f"{n} = {values[n]!r}" for n in dict.fromkeys(wrong)),
            do="Correct [stall], or leave it out.",
        )
