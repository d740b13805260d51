"""What a ready aircraft's file promises in steady flight, by formulas of the tests' own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, fsolve

from alula.aircraft import Aircraft, ElectricMotor, PistonEngine, Propeller, load_aircraft
from alula.model import AeroModel, load_model

FOLDER = Path(__file__).parents[2] / "aircraft"
G = 9.80665


def ready(name: str) -> tuple[Aircraft, AeroModel]:
    """The aircraft of a file and the model that it names."""
    aircraft = load_aircraft(FOLDER / f"{name}.toml")
    assert aircraft.aero is not None
    return aircraft, load_model(aircraft.aero)


def lift(model: AeroModel, alpha: float, de: float) -> float:
    """CL of steady flight with the stall of the model, wings alike."""
    variables = {n: np.zeros(1) for n in ("V", "beta", "phat", "qhat", "rhat", "da", "dr", "mach")}
    c = model.evaluate({**variables, "alpha": np.array([alpha]), "de": np.array([de])})
    s = model.stall
    assert s is not None
    X = 0.5 * (1.0 - np.tanh(s.a1 * (alpha - s.alpha_star)))
    lost = s.CL_alpha * (alpha - s.alpha_0) * (1.0 - ((1.0 + np.sqrt(X)) / 2.0) ** 2)
    return float(c["CL"][0]) - float(lost)


def elevator(model: AeroModel, alpha: float) -> float:
    """The elevator, rad, that balances the pitching moment about the reference point."""
    p, s = model.params, model.stall
    assert s is not None
    X = 0.5 * (1.0 - np.tanh(s.a1 * (alpha - s.alpha_star)))
    return float(-(p["Cm_0"] + p["Cm_alpha"] * alpha + s.Cm_X * (1.0 - X)) / p["Cm_de"])


def stall_speed(aircraft: Aircraft, model: AeroModel, rho: float = 1.225) -> float:
    """Lowest airspeed, m/s, of trimmed flight with the load factor one and no thrust."""
    assert aircraft.mass is not None
    alphas = np.linspace(0.0, 0.45, 901)
    best = max(lift(model, a, elevator(model, a)) for a in alphas)
    return float(np.sqrt(aircraft.mass.mass * G / (0.5 * rho * aircraft.S * best)))


def propeller_at(p: Propeller, J: float) -> tuple[float, float]:
    """CT and CP; outside the table along its end's slope."""
    out = []
    for y in (p.CT, p.CP):
        curve = PchipInterpolator(p.J, y)
        inside = min(max(J, p.J[0]), p.J[-1])
        out.append(float(curve(inside) + curve(inside, 1) * (J - inside)))
    return out[0], out[1]


def full_throttle(
    engine: PistonEngine | ElectricMotor, V: float, rho: float
) -> tuple[float, float]:
    """Thrust, N, and propeller speed, rad/s, where the torques balance at full throttle."""
    p = engine.propeller

    def loads(omega: float) -> tuple[float, float]:
        n = omega / (2.0 * np.pi)
        CT, CP = propeller_at(p, V / (n * p.diameter))
        return CT * rho * n**2 * p.diameter**4, CP * rho * n**2 * p.diameter**5 / (2.0 * np.pi)

    def surplus(omega: float) -> float:
        if isinstance(engine, PistonEngine):
            sigma = rho / 1.225
            share = sigma - (1.0 - sigma) / 7.55  # Gagg and Ferrar
            crank = omega * engine.reduction
            torque = engine.reduction * (
                share * float(PchipInterpolator(engine.omega, engine.torque)(crank))
            )
        else:
            R = engine.R_battery + engine.R_esc + engine.R_motor
            current = min((engine.U_full - omega / engine.k_V) / R, engine.I_max)
            torque = engine.k_T * (current - engine.I_0)
        return torque - loads(omega)[1]

    if isinstance(engine, PistonEngine):
        low, high = 0.15 * engine.omega[-1] / engine.reduction, engine.omega[-1] / engine.reduction
    else:
        low, high = 0.05 * engine.k_V * engine.U_full, engine.k_V * engine.U_full
    omega = float(brentq(surplus, low, high))
    return loads(omega)[0], omega


_ = fsolve
