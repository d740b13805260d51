"""What a ready aircraft's file promises, by formulas of the tests' own: nothing of the core."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, fsolve

from alula.aircraft import Aircraft, ElectricMotor, PistonEngine, Propeller, load_aircraft
from alula.base.arrays import Array
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


@dataclass(frozen=True)
class Steady:
    """Level flight: speed m/s, alpha and elevator rad, thrust N along the body's x, density."""

    V: float
    alpha: float
    de: float
    T: float
    rho: float


def coefficients(model: AeroModel, values: dict[str, float]) -> dict[str, float]:
    """All coefficients at one point; variables not given are zero."""
    names = ("V", "alpha", "beta", "phat", "qhat", "rhat", "de", "da", "dr", "df", "dt", "mach")
    c = {
        k: float(x[0])
        for k, x in model.evaluate({n: np.array([values.get(n, 0.0)]) for n in names}).items()
    }
    if model.axes == "body":
        alpha = values.get("alpha", 0.0)
        c["CL"] = c["CX"] * np.sin(alpha) - c["CZ"] * np.cos(alpha)
        c["CD"] = -c["CX"] * np.cos(alpha) - c["CZ"] * np.sin(alpha)
    return c


def longitudinal_rates(
    aircraft: Aircraft, model: AeroModel, s: Steady, x: Array, de: float | None = None
) -> Array:
    """Rates of V, alpha, theta, q with the thrust held, moments about the center of gravity."""
    assert aircraft.mass is not None
    V, alpha, theta, q = x
    c = coefficients(
        model,
        {
            "V": V,
            "alpha": alpha,
            "qhat": q * aircraft.c / (2 * V),
            "de": s.de if de is None else de,
        },
    )
    pressure = 0.5 * s.rho * V**2 * aircraft.S
    m, gamma = aircraft.mass.mass, theta - alpha
    cg = aircraft.mass.cg
    arm = float(np.mean([e.position[2] for e in aircraft.engines])) - cg[2]
    Z = -pressure * (c["CL"] * np.cos(alpha) + c["CD"] * np.sin(alpha))
    X = pressure * (c["CL"] * np.sin(alpha) - c["CD"] * np.cos(alpha))
    r = model.reference_point - cg
    transfer = r[2] * X - r[0] * Z
    return np.array([
        (s.T * np.cos(alpha) - pressure * c["CD"]) / m - G * np.sin(gamma),
        q - (s.T * np.sin(alpha) + pressure * c["CL"]) / (m * V) + G * np.cos(gamma) / V,
        q,
        (pressure * aircraft.c * c["Cm"] + transfer + arm * s.T) / aircraft.mass.inertia[1, 1],
    ])  # fmt: skip


def level(aircraft: Aircraft, model: AeroModel, V: float, rho: float) -> Steady:
    """Level flight at V in air of density rho."""
    assert aircraft.mass is not None
    weight = aircraft.mass.mass * G

    def balance(z: Array) -> Array:
        s = Steady(V, float(z[0]), float(z[1]), float(z[2]) * weight, rho)
        return longitudinal_rates(aircraft, model, s, np.array([V, z[0], z[0], 0.0]))[[0, 1, 3]]

    z = fsolve(balance, [0.05, 0.0, 0.1], xtol=1e-12)
    assert np.max(np.abs(balance(z))) < 1e-8
    return Steady(V, float(z[0]), float(z[1]), float(z[2]) * weight, rho)


def longitudinal_modes(aircraft: Aircraft, model: AeroModel, s: Steady) -> Array:
    """Eigenvalues, 1/s, of V, alpha, theta, q about level flight, thrust and elevator held."""
    x = np.array([s.V, s.alpha, s.alpha, 0.0])
    h = 1e-5 * np.array([s.V, 1.0, 1.0, 1.0])
    columns = [
        (
            longitudinal_rates(aircraft, model, s, x + d)
            - longitudinal_rates(aircraft, model, s, x - d)
        )
        / (2.0 * d[i])
        for i, d in enumerate(np.diag(h))
    ]
    return np.linalg.eigvals(np.column_stack(columns))


def lateral_modes(aircraft: Aircraft, model: AeroModel, s: Steady) -> Array:
    """Eigenvalues, 1/s, of beta, p, r, phi about level flight."""
    assert aircraft.mass is not None
    m, J = aircraft.mass.mass, aircraft.mass.inertia
    pressure, span = 0.5 * s.rho * s.V**2 * aircraft.S, aircraft.b / (2.0 * s.V)
    p = model.params
    scale = {"beta": 1.0, "p": span, "r": span}
    Y = {k: pressure * p.get(f"CY_{k}", 0.0) * f / (m * s.V) for k, f in scale.items()}
    LN = np.array([
        [pressure * aircraft.b * p.get(f"{c}_{k}", 0.0) * f for k, f in scale.items()]
        for c in ("Cl", "Cn")
    ])  # fmt: skip
    turn = np.linalg.solve(J[np.ix_([0, 2], [0, 2])], LN)
    A = np.zeros((4, 4))
    A[0] = [
        Y["beta"], Y["p"] + np.sin(s.alpha), Y["r"] - np.cos(s.alpha),
        G * np.cos(s.alpha) / s.V,
    ]  # fmt: skip
    A[1, :3], A[2, :3] = turn
    A[3] = [0.0, 1.0, np.tan(s.alpha), 0.0]
    return np.linalg.eigvals(A)
