"""Motor speed, current and battery of an electric drive from throttle and a speed sensor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from alula.aircraft.propulsion import ElectricMotor
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.navigate.samples import TAKEN


@dataclass(frozen=True)
class PowerTrainState:
    """Over t (n,): omega rad/s with se_omega, acceleration rad/s2, motor_current and current (of
    the battery) A, charge drawn A s, voltage at rest V, left 0 to 1. counts: samples by verdict.
    """

    omega: Array
    acceleration: Array
    se_omega: Array
    motor_current: Array
    current: Array
    charge: Array
    voltage: Array
    left: Array
    counts: Mapping[str, int]


def power_train(
    motor: ElectricMotor,
    t: Array,
    throttle: Array,
    speed: Array,
    *,
    jerk: float = 2000.0,
    decay: float = 0.3,
    sigma: float = 5.0,
) -> PowerTrainState:
    """Pusztai 2018, Eq. (3.41) to (3.43), with a filter of the speed before them.

    throttle (n,) duty 0 to 1, speed (n,) rad/s, NaN where the sensor has no sample, sigma its
    noise. jerk: rad/s2 per root s, decay: s, of the acceleration between samples.
    """
    columns = [np.ascontiguousarray(a, dtype=np.float64) for a in (t, throttle, speed)]
    if len({len(c) for c in columns}) != 1 or not (jerk > 0.0 and decay > 0.0 and sigma > 0.0):
        raise refuse(
            "power_train",
            where="power train",
            expected="t, throttle and speed of one length; jerk, decay, sigma above zero",
            found=f"lengths {[len(c) for c in columns]}, {jerk:g}, {decay:g}, {sigma:g}",
            do="Correct them.",
        )
    out = np.empty((len(columns[0]), 9))
    stamps, duty, read = columns
    core.power_train(_constants(motor), np.array([jerk, decay, sigma]), stamps, duty, read, out)
    taken = out[:, 8].astype(int)
    counts = {name: int(np.sum(taken == k)) for k, name in enumerate(TAKEN) if np.any(taken == k)}
    parts = [frozen(c) for c in out.T[:8]]
    return PowerTrainState(
        omega=parts[0], acceleration=parts[1], se_omega=parts[2], motor_current=parts[3],
        current=parts[4], charge=parts[5], voltage=parts[6], left=parts[7], counts=counts,
    )  # fmt: skip


def _constants(motor: ElectricMotor) -> Array:
    """The core's motor: speeds per volt, torque per ampere, currents, resistances in one."""
    resistance = motor.R_motor + motor.R_esc + motor.R_battery
    return np.array(
        [motor.k_V, motor.k_T, motor.I_0, resistance, motor.U_full, motor.U_empty, motor.capacity,
         motor.I_max, motor.I_regen]
    )  # fmt: skip
