"""The whole ARM-Hawk by strip theory: static stability, and what full propwash does at low speed.

Pusztai 2018, 2.2.3 and C.5: stable up to 20 deg of angle of attack; flaps change the pitching
moment; propwash acts strongly on lift; roll and yaw by propwash are intense, most at full throttle
far below the stall speed. His curves are figures only, so signs and trends are what is compared.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np

from alula.aircraft import Aircraft, ElectricMotor, load_aircraft
from alula.base.arrays import Array
from alula.predict.strip_model import StripModel, strip_model
from verification.places import ROOT

FILE = ROOT / "aircraft" / "armhawk.toml"
DOWNWASH = 0.48  # Pusztai 2018, C.1
HIS_LIMIT = 20.0  # deg, Figure C.8
DENSITY = 1.225


def stable_up_to(strips: StripModel) -> float:
    """The angle of attack, deg, at which Cm first stops falling; elevator at zero."""
    alpha = np.radians(np.arange(-5.0, 40.0, 0.25))
    rising = np.flatnonzero(np.diff(strips.evaluate({"alpha": alpha})["Cm"]) >= 0.0)
    return float(np.degrees(alpha[rising[0]])) if len(rising) else 40.0


def tail_stall(strips: StripModel, limit: float) -> float:
    """The section angle, deg, of the tail's largest lift within `limit` deg."""
    tail = next(s for s in strips.surfaces if s.name == "tailplane")
    alpha, c_l = tail.table_alpha, tail.table[0]
    near = (alpha > 0.0) & (alpha < np.radians(limit))
    return float(np.degrees(alpha[near][np.argmax(c_l[near])]))


def full_wash(aircraft: Aircraft, V: float) -> float:
    """(U_i - u_0)/V at full throttle in steady turning, battery half full: motor torque by
    Pusztai's (2.29), thrust and torque by the propeller's curves."""
    motor = next(e.machine for e in aircraft.engines if isinstance(e.machine, ElectricMotor))
    p = motor.propeller
    voltage = 0.5 * (motor.U_full + motor.U_empty)
    resistance = motor.R_motor + motor.R_esc + motor.R_battery
    n = np.linspace(30.0, 200.0, 5000)
    J = V / (n * p.diameter)
    current = np.minimum((voltage - 2.0 * np.pi * n / motor.k_V) / resistance, motor.I_max)
    shaft = motor.k_T * (current - motor.I_0)
    load = np.interp(J, p.J, p.CP) * DENSITY * n**2 * p.diameter**5 / (2.0 * np.pi)
    at = int(np.argmin(np.abs(shaft - load)))
    thrust = np.interp(J[at], p.J, p.CT) * DENSITY * n[at] ** 2 * p.diameter**4
    square = V**2 + 2.0 * thrust / (DENSITY * np.pi * (0.5 * p.diameter) ** 2)
    return float(np.sqrt(square) / V - 1.0)


def armhawk_aircraft(quick: bool) -> tuple[str, bool]:
    """The row: what was found, and whether it is as it must be."""
    aircraft = load_aircraft(FILE)
    strips = _strips(aircraft, "lift")
    by_angle = _strips(aircraft, "angle")
    limit, his_law = stable_up_to(strips), stable_up_to(by_angle)
    stall = tail_stall(strips, 14.0)
    # Where the tail's own angle reaches its largest lift, by his law: alpha (1 - g) - g i_W.
    asked = (stall + DOWNWASH * 1.0) / (1.0 - DOWNWASH)
    stable = limit >= stall and abs(his_law - asked) < 1.5
    speeds = (10.0, 15.0, 25.0)
    washes = [full_wash(aircraft, V) for V in speeds]
    alpha = np.radians(6.0)
    parts = _trends(strips, alpha, washes)
    good = stable and all(ok for _, ok in parts)
    text = (
        f"stable up to {limit:.1f} deg with downwash that follows the wing's lift, to "
        f"{his_law:.1f} deg with his, by angle of attack (his figure: {HIS_LIMIT:.0f} deg; the "
        f"tail's largest lift, at {stall:.1f} deg of its own, asks for {asked:.1f}); "
        + "; ".join(words for words, _ in parts)
    )
    return text, good


def _strips(aircraft: Aircraft, by: Literal["lift", "angle"]) -> StripModel:
    return strip_model(aircraft, downwash=DOWNWASH, downwash_by=by)


def _trends(strips: StripModel, alpha: float, washes: list[float]) -> list[tuple[str, bool]]:
    def at(**variables: object) -> Mapping[str, Array]:
        given = {k: np.atleast_1d(np.asarray(v, dtype=np.float64)) for k, v in variables.items()}
        return strips.evaluate({"alpha": np.array([alpha]), **given})

    wash = np.array([*washes, 0.0])
    C = at(wash=wash)
    roll, yaw, lift = C["Cl"], C["Cn"], C["CL"]
    calm = np.array([0.0])
    full = washes[0]
    # C.7, C.8: flaps; elevator 2 deg up. C.9: aileron full left, C.10: rudder full right.
    flaps = at(df=np.radians(30.0))
    up = at(de=-np.radians(2.0))
    left, right = at(da=np.radians(25.0)), at(dr=-np.radians(40.0 / 2.0))
    base = at(wash=calm)
    p, b = np.array([-0.05, 0.05]), np.radians([-3.0, 3.0])

    def slope(x: Array, name: str, c: str, w: float) -> float:
        y = at(**{name: x}, wash=np.full(2, w))[c]
        return float((y[1] - y[0]) / (x[1] - x[0]))

    damping = (slope(p, "phat", "Cl", 0.0), slope(p, "phat", "Cl", full))
    vane = (slope(b, "beta", "Cn", 0.0), slope(b, "beta", "Cn", full))
    authority = 0.1 * abs(float(left["Cl"][0] - base["Cl"][0]))
    return [
        (
            f"full throttle at 10, 15, 25 m/s (U_i/u_0 {', '.join(f'{1 + w:.2f}' for w in washes)})"
            f": Cl {', '.join(f'{x:+.4f}' for x in roll[:3])} to the right, Cn "
            f"{', '.join(f'{x:+.4f}' for x in yaw[:3])} to the left, both growing toward low speed",
            bool(
                np.all(roll[:3] > 0.0)
                and np.all(yaw[:3] < 0.0)
                and np.all(np.diff(roll) < 0.0)
                and np.all(np.diff(yaw) > 0.0)
                and roll[0] > authority  # 'intense'
                and roll[2] > 0.0
            ),
        ),
        (
            f"CL at 6 deg {lift[3]:.2f}, with it {lift[0]:.2f}, with flaps {flaps['CL'][0]:.2f}",
            bool(lift[0] > lift[3] and flaps["CL"][0] > lift[3]),
        ),
        (
            f"Cm by 2 deg of elevator up {up['Cm'][0] - base['Cm'][0]:+.3f}, by flaps "
            f"{flaps['Cm'][0] - base['Cm'][0]:+.3f}",
            bool(up["Cm"][0] > base["Cm"][0] and flaps["Cm"][0] != base["Cm"][0]),
        ),
        (
            f"Cl_p {damping[0]:.2f}, with it {damping[1]:.2f}; aileron left rolls left",
            bool(max(damping) < 0.0 and left["Cl"][0] < base["Cl"][0]),
        ),
        (
            f"Cn_beta {vane[0]:.2f}, with it {vane[1]:.2f}; rudder right yaws right",
            bool(0.0 < vane[0] < vane[1] and right["Cn"][0] > base["Cn"][0]),
        ),
    ]


if __name__ == "__main__":
    print(*armhawk_aircraft(False))
