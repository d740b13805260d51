"""A short-period maneuver in turbulence, written apart from the equations that are tested."""

from __future__ import annotations

import numpy as np

from alula.flight import Maneuver
from alula.identify import Reference
from alula.identify.flown.measured_maneuver import STATES, MeasuredManeuver

DT = 0.04
TRUE = {
    "CZ_0": -0.45,
    "CZ_alpha": -5.5,
    "Cm_0": 0.02,
    "Cm_alpha": -1.2,
    "Cm_q": -25.0,
    "Cm_de": -1.5,
}
FORMULAS = {"CZ": "1 + alpha", "Cm": "1 + alpha + qhat + de"}


def short_period(seed, n=200):
    """Alpha and q of a light airplane in turbulence, by Euler's rule at 20 steps a sample and
    equations written out here: 60 m/s, S 16 m2, c 1.5 m, 1100 kg, Iyy 1800 kg m2.
    """
    rng = np.random.default_rng(seed)
    t = DT * np.arange(n)
    de = 0.03 * np.sign(np.sin(2.0 * np.pi * t / 2.5)) * (t > 1.0) + 0.005
    V, qS, m, Iyy, g = 60.0, 0.5 * 1.2 * 60.0**2 * 16.0, 1100.0, 1800.0, 9.80665
    alpha, q = np.empty(n), np.empty(n)
    az = np.empty(n)
    a, w = 0.012, 0.0
    v, fine = TRUE, DT / 20
    for i in range(n):
        alpha[i], q[i] = a, w
        az[i] = qS * (v["CZ_0"] + v["CZ_alpha"] * a) / m
        for k in range(20):
            d = de[i] + (de[min(i + 1, n - 1)] - de[i]) * (k + 0.5) / 20
            CZ = v["CZ_0"] + v["CZ_alpha"] * a
            Cm = v["Cm_0"] + v["Cm_alpha"] * a + v["Cm_q"] * w * 1.5 / (2 * V) + v["Cm_de"] * d
            # theta = 0 and CX = 0 as 'measured'
            rate = w + (np.cos(a) * (qS * CZ / m + g)) / V
            a += fine * rate + 0.01 * fine**0.5 * rng.standard_normal()
            w += fine * qS * 1.5 * Cm / Iyy + 0.05 * fine**0.5 * rng.standard_normal()
    zero = np.zeros(n)
    noisy = {
        "alpha": alpha + 0.002 * rng.standard_normal(n),
        "q": q + 0.004 * rng.standard_normal(n),
        "az": az + 0.2 * rng.standard_normal(n),
    }
    motion = dict.fromkeys(STATES, zero) | {"V": np.full(n, V)}
    motion |= {k: noisy[k] for k in ("alpha", "q")}
    return MeasuredManeuver(
        maneuver=Maneuver("gusty", "log", "3211", 0.0, t[-1], "longitudinal"),
        t=t,
        outputs=noisy,
        motion=motion,
        controls={"de": de},
        rho=np.full(n, 1.2),
        reference=Reference(16.0, 11.0, 1.5, np.zeros(3)),
        mass=m,
        inertia=np.diag([1500.0, Iyy, 3000.0]),
        speed_of_sound=np.full(n, 340.0),
        force=np.zeros((n, 3)),
        moment=np.zeros((n, 3)),
        arm=np.zeros(3),
        coefficients=dict.fromkeys(("CX", "CY", "CZ", "Cl", "Cm", "Cn"), zero),
    )
