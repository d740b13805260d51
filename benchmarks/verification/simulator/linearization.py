"""Linearization of the SportStar: against differences, against closed forms, and how long it takes.

The differences are of rates written down here a second time, from the plant's rates to those of V,
alpha, beta and the Euler angles; the closed forms are Dittrich 2016, Eq. (2.79), corrected.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.core import core
from alula.model import AeroModel, load_model
from alula.simulate import Airframe, Condition, airframe_of, linearize, trim
from alula.simulate.airframe import core_model
from alula.simulate.coordinates import plant_state
from alula.simulate.plant import further_states, plant_rates
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft"
G = 9.80665


def linearization(quick: bool) -> tuple[str, bool]:
    """Worst deviations relative to 1 + |entry|, and the median time of one linearization."""
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    model = load_model(AIRCRAFT / "sportstar_aero.toml")
    frame = airframe_of(aircraft, engines="modeled", actuators=True)
    plant = core_model(frame, model)
    worst = 0.0
    conditions = [Condition(45.0, 1000.0), Condition(40.0, 500.0, "turn", bank=0.5)]
    for condition in conditions[: 1 if quick else 2]:
        steady = trim(frame, model, condition, limits=aircraft.control_limits)
        state = np.array(steady.state)
        for i, name in enumerate(further_states(plant)):
            if name.startswith("X"):
                state[13 + i] = (
                    0.6  # at 1 the flow cannot be more attached: no two-sided difference
                )
        tumbling = state + np.pad([0.4, -0.3, 0.5], (10, len(state) - 13))  # rad/s: far from steady
        for point in (state, tumbling):
            worst = max(worst, _against_differences(plant, point, steady.inputs))
    closed = _against_closed_forms(airframe_of(aircraft), model)
    steady = trim(frame, model, conditions[0], limits=aircraft.control_limits)
    took = []
    for _ in range(50 if quick else 500):
        start = time.perf_counter()
        linearize(plant, steady.state, steady.inputs)
        took.append(time.perf_counter() - start)
    middle = 1e3 * float(np.median(took))
    text = (
        f"{worst:.1e} against central differences, {closed:.1e} against Eq. (2.79), "
        f"{middle:.2f} ms with {len(steady.state)} states"
    )
    return text, worst < 1e-7 and closed < 1e-7 and middle < 1.0


def _against_differences(plant: Any, state: Array, inputs: dict[str, float]) -> float:
    found = linearize(plant, state, inputs)
    n = len(found.states)
    z0 = np.concatenate([found.x0, found.u0])
    columns = []
    for i, value in enumerate(z0):
        e = np.zeros(len(z0))
        e[i] = h = 1e-3 * max(abs(value), 1.0)
        wide, narrow = (
            (_rates(plant, z0 + k * e, n) - _rates(plant, z0 - k * e, n)) / (2 * k * h)
            for k in (2, 1)
        )
        columns.append((4 * narrow - wide) / 3)  # the next order as well: h^4
    near = np.array(columns).T
    exact = np.hstack([found.A, found.B])
    return float(np.max(np.abs(exact - near) / (1.0 + np.abs(exact))))


def _rates(plant: Any, z: Array, n: int) -> Array:
    """Rates of V, alpha, beta, p q r, phi theta psi, place, h and what follows; still air."""
    x = plant_state(z[:n], np.zeros(3))
    f, _ = plant_rates(plant, x, z[n:])
    (p, q, r), (phi, theta) = z[3:6], z[6:8]
    u, du = x[7:10], f[7:10]
    V, plane = np.linalg.norm(u), u[0] ** 2 + u[2] ** 2
    V_dot = u @ du / V
    turning = q * np.sin(phi) + r * np.cos(phi)
    return np.concatenate([
        [V_dot, (u[0] * du[2] - u[2] * du[0]) / plane,
         (du[1] - u[1] * V_dot / V) / np.sqrt(plane)],
        f[10:13],
        [p + np.tan(theta) * turning, q * np.cos(phi) - r * np.sin(phi), turning / np.cos(theta)],
        [f[0], f[1], -f[2]],
        f[13:],
    ])  # fmt: skip


def _against_closed_forms(frame: Airframe, model: AeroModel) -> float:
    """Eq. (2.79a) to (2.79q) corrected: L_V has no pitch rate term, L_alpha has - F cos(alpha).

    Attached flow, thrust through the center of gravity; values of the model's own derivatives, read
    by differences of the coefficients at this point, so that the drag rise is in them.
    """
    through = Airframe(mass=frame.mass, inertia=frame.inertia, cg=frame.cg)
    plant = core_model(through, model, stall=False)
    steady = trim(through, model, Condition(45.0, 1000.0))
    found = linearize(plant, steady.state[:13], steady.inputs).longitudinal()
    V, a, F, theta = 45.0, steady.alpha, steady.thrust, steady.theta
    air = np.empty((1, 4))
    core.standard_atmosphere(np.array([1000.0]), air)
    rho, m, Iyy = air[0, 2], frame.mass, frame.inertia[1, 1]
    S, c = model.reference.S, model.reference.c
    names = ("V", "alpha", "beta", "phat", "qhat", "rhat", "de", "da", "dr", "df", "dt", "mach")
    at = {**dict.fromkeys(names, np.zeros(1)), "V": np.array([V]), "alpha": np.array([a]),
          "de": np.array([steady.controls["de"]])}  # fmt: skip
    C = {k: float(v[0]) for k, v in model.evaluate(at).items()}

    def slope(name: str, variable: str) -> float:
        h = 1e-5  # the coefficients are polynomials of low order here: 1e-10
        up, down = ({**at, variable: at[variable] + s * h} for s in (1, -1))
        return float((model.evaluate(up)[name] - model.evaluate(down)[name])[0]) / (2 * h)

    # moments about the center of gravity, from those about the reference point
    x, _, z = (model.reference_point - frame.cg) / c
    sine, cosine = np.sin(a), np.cos(a)

    def lever(CD: float, CL: float) -> float:
        """z CX - x CZ over the chord: what drag and lift add to Cm."""
        return float(z * (CL * sine - CD * cosine) + x * (CL * cosine + CD * sine))

    CD_a, CL_a = slope("CD", "alpha"), slope("CL", "alpha")
    CD_q, CL_q = slope("CD", "qhat"), slope("CL", "qhat")
    # body axes turn under lift and drag as alpha changes: CL' + CD and CD' - CL in their places
    Cm = C["Cm"] + lever(C["CD"], C["CL"])
    Cm_a = slope("Cm", "alpha") + lever(CD_a - C["CL"], CL_a + C["CD"])
    Cm_q = slope("Cm", "qhat") + lever(CD_q, CL_q)
    gamma = theta - a
    by_hand = np.array([
        [-rho * V * S / m * C["CD"],
         -rho * V**2 * S / (2 * m) * CD_a - F / m * sine + G * np.cos(gamma),
         -rho * V * S * c / (4 * m) * CD_q, -G * np.cos(gamma)],
        [F * sine / (m * V**2) - rho * S / (2 * m) * C["CL"] - G / V**2 * np.cos(gamma),
         G / V * np.sin(gamma) - rho * V * S / (2 * m) * CL_a - F * cosine / (m * V),
         1.0 - rho * S * c / (4 * m) * CL_q, -G / V * np.sin(gamma)],
        [rho * V * S * c / Iyy * Cm, rho * V**2 * S * c / (2 * Iyy) * Cm_a,
         rho * V * S * c**2 / (4 * Iyy) * Cm_q, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ])  # fmt: skip
    return float(np.max(np.abs(found.A - by_hand) / (1.0 + np.abs(by_hand))))
