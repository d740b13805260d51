"""Flights for the tests of identification: recordings of Twin Otter and ATTAS, and made ones."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy import signal
from scipy.io import loadmat

from alula.base.arrays import Array
from alula.flight import Maneuver, Motion
from alula.identify import CoefficientData, Reference, Thrust, coefficients_from_motion
from data import data

DEG = np.pi / 180.0
N, DT = 600, 0.02  # samples and interval (s) of the made maneuvers
ATTAS = Reference(S=64.0, b=21.5, c=3.159, point=np.zeros(3))


def twin_otter(kind: str = "longitudinal") -> CoefficientData:
    """Run 018 as recorded: CZ, Cm, alpha, qhat (already q c/2V), de."""
    f = loadmat(data("twin_otter", "totter_lon_020213f1_018.mat"))["fdata"]
    return CoefficientData(
        maneuver=Maneuver("run018", "018", "3211", 0.0, 8.0, kind),
        t=f[:, 0],
        coefficients={"CZ": f[:, 62], "Cm": f[:, 64]},
        variables={"alpha": f[:, 3] * DEG, "qhat": f[:, 71], "de": f[:, 13] * DEG},
    )


def attas_motion(name: str, aspect: str) -> tuple[Motion, Array]:
    """One maneuver, corrected by the published biases; thrust (n, 2) left and right, N.

    The flow angles and airspeed are moved from the boom to the CG, the specific force from the
    accelerometers to the CG (columns 2 to 4 are at the accelerometers, whatever their names say).
    """
    f = loadmat(data("attas", f"fAttas{name}.mat"))[f"fAttas{name}"].astype(float)
    rates = f[:, 6:9] * DEG - [1.02555e-3, 3.40891e-3, 9.96192e-4]
    rates_dot = f[:, 16:19] * DEG
    force = f[:, 1:4] - [6.76242e-3, -1.50664e-3, 8.39892e-2]
    arm = np.array([-1.010, 0.886, 0.103])
    force = force - np.cross(rates_dot, arm) - np.cross(rates, np.cross(rates, arm))
    alpha, beta, V = f[:, 12] * DEG, f[:, 13] * DEG, f[:, 14]
    local = V[:, None] * np.column_stack(
        [np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)]
    )
    u, v, w = (local - np.cross(rates, [13.080, -0.010, -0.027])).T
    V = np.sqrt(u**2 + v**2 + w**2)
    motion = Motion(
        Maneuver(name, name, "", 0.0, 25.0, aspect),
        f[:, 0], V, np.arctan2(w, u), np.arcsin(v / V),
        *rates.T, *rates_dot.T, *force.T, *(f[:, 9:12] * DEG).T,
        h=f[:, 15] * 0.3048,
        rho=f[:, 33],
        controls={
            "de": f[:, 21] * DEG,
            "da": (f[:, 28] - f[:, 27]) / 2.0 * DEG,
            "dr": f[:, 29] * DEG,
        },
    )  # fmt: skip
    return motion, f[:, 36:38]


def attas(name: str, aspect: str) -> CoefficientData:
    """Coefficients of one ATTAS maneuver, thrust removed."""
    motion, thrust = attas_motion(name, aspect)
    n = len(motion.t)
    inertia = np.array([[133367.0, 0, -11442.0], [0, 252687.0, 0], [-11442.0, 0, 359593.0]])
    return coefficients_from_motion(
        motion,
        ATTAS,
        mass=np.full(n, 17631.0),
        cg=np.zeros((n, 3)),
        inertia=np.tile(inertia, (n, 1, 1)),
        thrust=[
            Thrust(np.array([-1.343, side * 2.990, -0.652]), np.array([1.0, 0, 0]), pull)
            for side, pull in zip((-1.0, 1.0), thrust.T, strict=True)
        ],
    )


def window(
    item: CoefficientData, start: float, end: float, held_out: bool = False
) -> CoefficientData:
    """The part of a maneuver from `start` to `end`, s after its beginning."""
    keep = (item.t - item.t[0] >= start) & (item.t - item.t[0] < end)
    return replace(
        item,
        maneuver=replace(
            item.maneuver, id=f"{item.maneuver.id} {start:g}-{end:g}", held_out=held_out
        ),
        t=item.t[keep],
        coefficients={k: v[keep] for k, v in item.coefficients.items()},
        variables={k: v[keep] for k, v in item.variables.items()},
    )


def short_period(n: int, dt: float) -> Array:
    """Constant, angle of attack, pitch rate and elevator of a 3-2-1-1 (a lightly damped mode)."""
    t = np.arange(n) * dt
    edges = [1.0, 2.5, 3.5, 4.0, 4.5]
    de = sum((-1) ** k * ((t >= a) & (t < b)) for k, (a, b) in enumerate(pairwise(edges)))
    a = np.array([[-1.2, 1.0], [-6.25, -1.8]])
    system = signal.StateSpace(a, [[0.0], [-5.0]], np.eye(2), np.zeros((2, 1)))
    x = signal.lsim(system, de.astype(float), t)[1]
    return np.column_stack([np.ones(n), x, de])


def maneuver(name: str = "m1", seed: int = 0, **replaced: Array) -> CoefficientData:
    """Cm = -1.2 alpha - 20 qhat - 1.5 de with white noise; `replaced` overrides variables."""
    rng = np.random.default_rng(seed)
    _, alpha, q, de = short_period(N, DT).T * 0.05
    variables = {"alpha": alpha + 0.05, "qhat": 0.02 * q, "de": de - 0.02}
    variables |= {"da": np.zeros(N), "beta": np.zeros(N), "df": np.zeros(N)} | replaced
    cm = -1.2 * variables["alpha"] - 20.0 * variables["qhat"] - 1.5 * variables["de"]
    cm = cm + 1e-3 * rng.standard_normal(N)
    return CoefficientData(
        Maneuver(name, "log", "3211", 0.0, 12.0), np.arange(N) * DT, {"Cm": cm}, variables
    )
