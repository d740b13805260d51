"""Blade-element momentum theory with Prandtl's tip loss: any propeller with polars (Ning 2014)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from alula.aircraft.blades import BladePolar, Blades
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.predict.propeller_curves import (
    REGIMES,
    PropellerCurves,
    advance_ratios,
    core_shape,
    outside,
)

METHOD = "blade elements and momentum rings (Ning 2014)"
Rule = Literal["smooth", "stations"]


def blade_element(
    blades: Blades,
    J: Sequence[float] | Array | float,
    rpm: float,
    *,
    density: float = 1.225,
    viscosity: float = 1.789e-5,
    sound: float = 340.3,
    tip_loss: bool = True,
    hub_loss: bool = False,
    swirl: bool = True,
    rule: Rule = "smooth",
) -> PropellerCurves:
    """CT and CP at advance ratios J and one speed of revolution.

    rule: 'smooth' integrates between the stations by Gauss's rule; 'stations' sums the loads at
    evenly spaced stations times their distance, as some codes do. Raises BadInput for blades
    without polars, polars that are not finite, reverse flow and the windmill: no number there.
    """
    if not (np.isfinite(rpm) and rpm > 0.0):
        raise outside("standing", 0.0, blades.name)
    values = advance_ratios(J, blades.name)
    n = rpm / 60.0
    thrust, torque = blade_element_loads(
        blades, n * blades.diameter * values, np.full(len(values), 2.0 * np.pi * n),
        density=density, viscosity=viscosity, sound=sound, tip_loss=tip_loss, hub_loss=hub_loss,
        swirl=swirl, rule=rule,
    )  # fmt: skip
    scale = density * n**2 * blades.diameter**4
    return PropellerCurves(
        f"{METHOD}, {rpm:g} rpm",
        frozen(values),
        frozen(thrust / scale),
        frozen(2.0 * np.pi * torque / (scale * blades.diameter)),
    )


def blade_element_loads(
    blades: Blades,
    V: Sequence[float] | Array,
    omega: Sequence[float] | Array,
    *,
    density: float = 1.225,
    viscosity: float = 1.789e-5,
    sound: float = 340.3,
    tip_loss: bool = True,
    hub_loss: bool = False,
    swirl: bool = True,
    rule: Rule = "smooth",
) -> tuple[Array, Array]:
    """Thrust N and shaft torque N m, (k,) each, at axial speeds V m/s and shaft speeds rad/s."""
    V = np.ascontiguousarray(V, dtype=np.float64)
    omega = np.ascontiguousarray(omega, dtype=np.float64)
    out = np.zeros((len(V), 3))
    shape, polars = core_shape(blades), _polars(blades)
    rest = (density, viscosity, sound, tip_loss, hub_loss, swirl, _evenly(blades, rule))
    core.blade_element_loads(shape, polars, V, omega, *rest, out)
    for v, w, row in zip(V, omega, out, strict=True):
        regime = REGIMES[int(row[2])]
        if regime == "inside" and row[0] < 0.0:
            # Behind the windmill the drag of stalled blades may ask for power again.
            slower = np.zeros((40, 3))
            core.blade_element_loads(
                shape, polars, np.linspace(0.0, v, 40), np.full(40, w), *rest, slower
            )
            regime = "inside" if np.all(slower[:, 1] > 0.0) else "windmill"
        if regime != "inside":
            J = float(np.pi * v / (w * blades.radius)) if w > 0.0 else 0.0
            raise outside(regime, J, blades.name)
    return frozen(out[:, 0]), frozen(out[:, 1])


def blade_element_windmill(blades: Blades, rpm: float, J_most: float = 6.0) -> float:
    """The advance ratio at which the air begins to drive the shaft at this speed, to 1e-4."""
    n = rpm / 60.0
    shape, polars = core_shape(blades), _polars(blades)

    def torque(J: float) -> float:
        out = np.zeros((1, 3))
        core.blade_element_loads(
            shape, polars, np.array([n * blades.diameter * J]), np.array([2.0 * np.pi * n]), 1.225,
            1.789e-5, 340.3, True, False, True, False, out,
        )  # fmt: skip
        return float(out[0, 1]) if int(out[0, 2]) != REGIMES.index("unsolved") else float("nan")

    grid = np.linspace(0.0, J_most, 61)
    before = 0.0
    for J in grid:
        here = torque(J)
        if not here > 0.0:
            if J == 0.0 or not np.isfinite(here):
                return float(before)
            return float(brentq(torque, before, J, xtol=1e-4)) - 1e-4
        before = J
    return float(J_most)


def _polars(blades: Blades) -> list[tuple[Array, Array, Array, Array]]:
    if not blades.polars:
        raise refuse(
            "no_blade_polar",
            where=blades.name,
            expected="a polar of the blades' sections",
            found="none",
            do="State [blades.polar], or use the momentum model with fitted parameters.",
        )
    return [_numbers(p, blades.name) for p in blades.polars]


def _numbers(p: BladePolar, where: str) -> tuple[Array, Array, Array, Array]:
    numbers = np.array(
        [p.c_l_0, p.c_l_alpha, p.c_l_min, p.c_l_max, p.c_d_0, p.c_d_2_upper, p.c_d_2_lower,
         p.c_l_cd0, p.c_d_stalled, p.reynolds, p.reynolds_power, float(p.mach_corrected)]
    )  # fmt: skip
    table = tuple(np.zeros(0) for _ in range(3)) if p.table is None else p.table
    alpha, c_l, c_d = (np.ascontiguousarray(t, dtype=np.float64) for t in table)
    if not all(np.all(np.isfinite(x)) for x in (numbers, alpha, c_l, c_d)):
        raise refuse(
            "bad_polar",
            where=where,
            expected="a finite polar of the blades' sections",
            found="values that are not finite",
            do="Remove or mend them.",
        )
    return numbers, alpha, c_l, c_d


def _evenly(blades: Blades, rule: Rule) -> bool:
    if rule == "smooth":
        return False
    steps = np.diff(blades.r)
    if np.ptp(steps) > 1e-6 * blades.radius:
        raise refuse(
            "uneven_stations",
            where=blades.name,
            expected="evenly spaced stations for the rule 'stations'",
            found=f"distances from {steps.min():.4g} to {steps.max():.4g} m",
            do="Use the rule 'smooth', the default.",
        )
    return True
