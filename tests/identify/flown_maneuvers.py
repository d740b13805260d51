"""Maneuvers flown by equations of motion of their own: body-axes velocities, finer steps.

Written apart from the core, which integrates airspeed and flow angles, so that the two check one
another. Coefficients are body-axes ones.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from alula.flight import Maneuver
from alula.identify import Reference
from alula.identify.flown.measured_maneuver import MeasuredManeuver

S, SPAN, CHORD, MASS, RHO, G = 11.85, 9.0, 1.21, 600.0, 1.112, 9.80665
INERTIA = np.array([[1200.0, 0.0, -90.0], [0.0, 1100.0, 0.0], [-90.0, 0.0, 2100.0]])
INVERSE = np.linalg.inv(INERTIA)
DT, FINE = 0.02, 3  # s; steps a sample
ARM = np.array([0.05, 0.0, -0.02])  # from the center of gravity to the moments' reference point
TRUTH = {
    "CX_0": -0.03, "CX_alpha": 0.15, "CX_alpha2": 2.5,
    "CZ_0": -0.25, "CZ_alpha": -5.0, "CZ_q": -6.0, "CZ_de": -0.4,
    "Cm_0": 0.03, "Cm_alpha": -0.8, "Cm_q": -12.0, "Cm_de": -1.1,
    "CY_beta": -0.7, "CY_dr": 0.2,
    "Cl_beta": -0.08, "Cl_p": -0.5, "Cl_r": 0.15, "Cl_da": -0.2, "Cl_dr": 0.01,
    "Cn_beta": 0.09, "Cn_p": -0.05, "Cn_r": -0.15, "Cn_da": 0.01, "Cn_dr": -0.09,
}  # fmt: skip
LONGITUDINAL = {
    "CX": "1 + alpha + alpha^2",
    "CZ": "1 + alpha + qhat + de",
    "Cm": "1 + alpha + qhat + de",
}
LATERAL = {
    "CY": "beta + dr",
    "Cl": "beta + phat + rhat + da + dr",
    "Cn": "beta + phat + rhat + da + dr",
}
SIGMA = {
    "V": 0.1, "alpha": 0.002, "beta": 0.002, "p": 0.004, "q": 0.004, "r": 0.004, "phi": 0.002,
    "theta": 0.002, "ax": 0.05, "ay": 0.05, "az": 0.1, "pdot": 0.05, "qdot": 0.05, "rdot": 0.05,
}  # fmt: skip


def names(models: dict[str, str]) -> dict[str, float]:
    """The truth of the terms of these coefficients."""
    return {n: v for n, v in TRUTH.items() if n.split("_")[0] in models}


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


@cache
def _parts(name: str) -> list[str]:
    return name.split("_")


def _coefficients(c: dict[str, float], x: np.ndarray, u: dict[str, float]) -> dict[str, float]:
    V = np.linalg.norm(x[:3])
    alpha, beta = np.arctan2(x[2], x[0]), np.arcsin(x[1] / V)
    ph, qh, rh = x[3] * SPAN / (2 * V), x[4] * CHORD / (2 * V), x[5] * SPAN / (2 * V)
    value = {
        "0": 1.0, "alpha": alpha, "alpha2": alpha**2, "beta": beta, "p": ph, "q": qh, "r": rh, **u
    }  # fmt: skip
    out = dict.fromkeys(("CX", "CY", "CZ", "Cl", "Cm", "Cn"), 0.0)
    for name, v in c.items():
        coefficient, term = _parts(name)
        out[coefficient] += v * value[term]
    return out


def _forces(
    c: dict[str, float], x: np.ndarray, u: dict[str, float], thrust: float
) -> tuple[np.ndarray, np.ndarray]:
    """Specific force and angular acceleration."""
    C = _coefficients(c, x, u)
    pressure = 0.5 * RHO * float(x[:3] @ x[:3]) * S
    aero = pressure * np.array([C["CX"], C["CY"], C["CZ"]])
    moment = pressure * np.array([SPAN * C["Cl"], CHORD * C["Cm"], SPAN * C["Cn"]])
    moment = moment + _cross(ARM, aero)
    w = x[3:6]
    acceleration = INVERSE @ (moment - _cross(w, INERTIA @ w))
    return (aero + np.array([thrust, 0.0, 0.0])) / MASS, acceleration


Flight = tuple[np.ndarray, dict[str, np.ndarray], np.ndarray, np.ndarray]
_FLOWN: dict[tuple[object, ...], Flight] = {}


def _flight(
    given: dict[str, np.ndarray], c: dict[str, float], theta0: float, feedback: float
) -> Flight:
    """States (n, 8), controls, specific forces and angular accelerations (n, 3).

    Without noise: integrated once for all seeds, which takes longer than what is tested with it.
    """
    key = (*(v.tobytes() for v in given.values()), *c.items(), theta0, feedback)
    if key not in _FLOWN:
        _FLOWN[key] = _integrated(given, c, theta0, feedback)
    x, drive, f, acceleration = _FLOWN[key]
    return x.copy(), {k: v.copy() for k, v in drive.items()}, f.copy(), acceleration.copy()


def _integrated(
    given: dict[str, np.ndarray], c: dict[str, float], theta0: float, feedback: float
) -> Flight:
    n = len(given["de"])
    x = np.empty((n, 8))
    V0, alpha0 = 45.0, 0.05
    x[0] = [V0 * np.cos(alpha0), 0.0, V0 * np.sin(alpha0), 0.0, 0.0, 0.0, 0.0, theta0]
    drive = {k: v.copy() for k, v in given.items()}

    def rate(y: np.ndarray, u: dict[str, float]) -> np.ndarray:
        f, acceleration = _forces(c, y, u, 700.0)
        phi, theta = y[6], y[7]
        gravity = G * np.array(
            [-np.sin(theta), np.cos(theta) * np.sin(phi), np.cos(theta) * np.cos(phi)]
        )
        p, q, r = y[3:6]
        return np.concatenate(
            [
                f + gravity - _cross(y[3:6], y[:3]),
                acceleration,
                [
                    p + np.tan(theta) * (q * np.sin(phi) + r * np.cos(phi)),
                    q * np.cos(phi) - r * np.sin(phi),
                ],
            ]
        )

    for k in range(n - 1):
        if feedback:
            drive["de"][k + 1] = given["de"][k + 1] + feedback * (x[k, 7] - theta0) + 0.3 * x[k, 4]
        a = {n: float(drive[n][k]) for n in drive}
        slope = {n: (float(drive[n][k + 1]) - a[n]) / FINE for n in drive}
        y, h = x[k], DT / FINE
        for part in range(FINE):
            u = [{n: a[n] + slope[n] * (part + at) for n in a} for at in (0.0, 0.5, 1.0)]
            k1 = rate(y, u[0])
            k2 = rate(y + 0.5 * h * k1, u[1])
            k3 = rate(y + 0.5 * h * k2, u[1])
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(y + h * k3, u[2]))
        x[k + 1] = y
    both = [_forces(c, x[k], {m: drive[m][k] for m in drive}, 700.0) for k in range(n)]
    return x, drive, np.array([b[0] for b in both]), np.array([b[1] for b in both])


def flown(
    controls: Callable[[np.ndarray], dict[str, np.ndarray]],
    *,
    seconds: float = 20.0,
    id: str = "one",
    seed: int | None = None,
    truth: dict[str, float] | None = None,
    theta0: float = 0.05,
    feedback: float = 0.0,
    held_out: bool = False,
) -> MeasuredManeuver:
    """A maneuver at 50 Hz, noisy where a seed is given. controls(t) gives de da dr (n,).

    feedback: elevator per pitch angle about theta0, of a pilot who holds an unstable aircraft.
    """
    t = np.arange(0.0, seconds + 1e-9, DT)
    c = TRUTH if truth is None else truth
    given = {k: np.zeros_like(t) for k in ("de", "da", "dr")} | controls(t)
    x, drive, f, acceleration = _flight(given, c, theta0, feedback)
    V = np.linalg.norm(x[:, :3], axis=1)
    exact = {
        "V": V, "alpha": np.arctan2(x[:, 2], x[:, 0]), "beta": np.arcsin(x[:, 1] / V),
        "p": x[:, 3], "q": x[:, 4], "r": x[:, 5], "phi": x[:, 6], "theta": x[:, 7],
        "ax": f[:, 0], "ay": f[:, 1], "az": f[:, 2],
        "pdot": acceleration[:, 0], "qdot": acceleration[:, 1], "rdot": acceleration[:, 2],
    }  # fmt: skip
    noise = np.random.default_rng(seed)
    outputs = {
        n: v + (0.0 if seed is None else SIGMA[n] * noise.standard_normal(len(t)))
        for n, v in exact.items()
    }
    n = len(t)
    force = np.zeros((n, 3))
    force[:, 0] = 700.0
    return MeasuredManeuver(
        maneuver=Maneuver(id, "log", "test", 0.0, seconds, held_out=held_out),
        t=t,
        outputs=outputs,
        motion={k: exact[k] for k in ("V", "alpha", "beta", "p", "q", "r", "phi", "theta")},
        controls=drive,
        rho=np.full(n, RHO),
        reference=Reference(S, SPAN, CHORD, np.zeros(3)),
        mass=MASS,
        inertia=INERTIA,
        speed_of_sound=np.full(n, 340.0),
        force=force,
        moment=np.zeros((n, 3)),
        arm=ARM,
    )


def pitch_3211(t: np.ndarray) -> dict[str, np.ndarray]:
    """Elevator 3-2-1-1 and later a slow wave, rad."""
    de = np.zeros_like(t)
    for begin, end, sign in ((1, 1.9, 1), (1.9, 2.5, -1), (2.5, 2.8, 1), (2.8, 3.1, -1)):
        de[(t >= begin) & (t < end)] = 0.04 * sign
    return {"de": -0.01 + de + (t > 8) * 0.01 * np.sin(np.pi * t)}


def every_axis(t: np.ndarray) -> dict[str, np.ndarray]:
    """All three controls, one after another and together."""
    out = pitch_3211(t)
    out["da"] = 0.03 * np.sin(1.3 * t) * (t > 2) + 0.02 * np.sign(np.sin(2.9 * t)) * (t > 9)
    out["dr"] = 0.05 * ((t > 4) & (t < 5)) - 0.05 * ((t > 5) & (t < 6)) + 0.02 * np.sin(2.1 * t)
    return out
