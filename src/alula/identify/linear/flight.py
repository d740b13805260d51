"""The linear equations of flight with aerodynamic derivatives as parameters.

Dittrich 2016, Eq. (2.78), (2.79) with errata: deviations from steady straight flight, stability
axes for lift and drag, body axes for the rest. What trim determines (total lift and drag) is a
number; every derivative that a formula names is a parameter, with the factor of each entry it
stands in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.linear.model import LinearModel, linear_model
from alula.identify.typical import constant_name
from alula.model import parse

LONGITUDINAL = ("V", "alpha", "q", "theta")
LATERAL = ("beta", "p", "r", "phi")


@dataclass(frozen=True)
class SteadyFlight:
    """The flight deviations count from, wings level: SI, rad. S, b, c: reference geometry.

    inertia: (3, 3) about the center of gravity, to which moments refer. thrust: N, along x; its
    line passes through the center of gravity.
    """

    V: float
    alpha: float
    theta: float
    rho: float
    mass: float
    inertia: Array
    S: float
    b: float
    c: float
    thrust: float = 0.0
    gravity: float = 9.80665


def linear_flight_model(
    flight: SteadyFlight,
    models: Mapping[str, str],
    *,
    controls: Sequence[str],
    outputs: Sequence[str] = (),
    trim: bool = True,
) -> LinearModel:
    """The linear model of the axis that `models` belongs to.

    models: formulas of CD CL Cm (states V alpha q theta) or of CY Cl Cn (beta p r phi), of first
    order. outputs: states or their derivatives ('qdot'), all states by default. trim: a constant in
    every row with aerodynamics, 'alpha_0', as deviations are never counted from exact trim; name
    them in `own` where maneuvers differ. Raises BadInput for a formula that is not linear.
    """
    lateral = bool({"CY", "Cl", "Cn"} & set(models))
    known = {"CY", "Cl", "Cn"} if lateral else {"CD", "CL", "Cm"}
    if not models or not set(models) <= known:
        raise refuse(
            "unknown_coefficient",
            where="linear flight model",
            expected="CD CL Cm, or CY Cl Cn",
            found=", ".join(models) or "none",
            do="Give the formulas of one axis.",
        )
    rows = (
        _lateral(flight, models, controls) if lateral else _longitudinal(flight, models, controls)
    )
    if trim:
        driven = ("beta", "p", "r") if lateral else ("V", "alpha", "q")
        rows = {s: f"{row} + {s}_0" if s in driven else row for s, row in rows.items()}
    return linear_model(rows, outputs or list(rows), controls)


def _longitudinal(
    f: SteadyFlight, models: Mapping[str, str], controls: Sequence[str]
) -> dict[str, str]:
    qS = 0.5 * f.rho * f.V**2 * f.S
    climb = f.theta - f.alpha
    g, m, V = f.gravity, f.mass, f.V
    sa, ca = np.sin(f.alpha), np.cos(f.alpha)
    CD = (f.thrust * ca - m * g * np.sin(climb)) / qS  # of steady flight
    CL = (m * g * np.cos(climb) - f.thrust * sa) / qS
    drag = _aero("CD", f, models, controls, f.c, -qS / m)
    lift = _aero("CL", f, models, controls, f.c, -qS / (m * V))
    pitch = _aero("Cm", f, models, controls, f.c, qS * f.c / f.inertia[1, 1])
    return {
        "V": _sum(
            (-2.0 * qS * CD / (m * V), "V"),
            (g * np.cos(climb) - f.thrust * sa / m, "alpha"),
            (-g * np.cos(climb), "theta"),
        )
        + drag,
        "alpha": _sum(
            (-2.0 * qS * CL / (m * V**2), "V"),
            (g / V * np.sin(climb) - f.thrust * ca / (m * V), "alpha"),
            (1.0, "q"),
            (-g / V * np.sin(climb), "theta"),
        )
        + lift,
        "q": ("0*q" + pitch),
        "theta": "q",
    }


def _lateral(f: SteadyFlight, models: Mapping[str, str], controls: Sequence[str]) -> dict[str, str]:
    qS = 0.5 * f.rho * f.V**2 * f.S
    inverse = np.linalg.inv(f.inertia)
    side = _aero("CY", f, models, controls, f.b, qS / (f.mass * f.V))
    turn = {}
    for state, i in (("p", 0), ("r", 2)):
        turn[state] = f"0*{state}" + "".join(
            _aero(c, f, models, controls, f.b, qS * f.b * float(inverse[i, j]))
            for c, j in (("Cl", 0), ("Cn", 2))
        )
    return {
        "beta": _sum(
            (np.sin(f.alpha), "p"),
            (-np.cos(f.alpha), "r"),
            (f.gravity / f.V * np.cos(f.theta), "phi"),
        )
        + side,
        "p": turn["p"],
        "r": turn["r"],
        "phi": _sum((1.0, "p"), (np.tan(f.theta), "r")),
    }


def _aero(
    coefficient: str,
    f: SteadyFlight,
    models: Mapping[str, str],
    controls: Sequence[str],
    length: float,
    factor: float,
) -> str:
    """Text of factor times the coefficient's deviation, each derivative a parameter."""
    if coefficient not in models:
        return ""
    hats = {"phat": "p", "qhat": "q", "rhat": "r"}
    out = ""
    for term in parse(models[coefficient]):
        name = term.name(coefficient)
        if name == constant_name(coefficient):
            continue  # of trim
        plain = len(term.factors) == 1 and term.factors[0].kind == "plain"
        variable = term.factors[0].variable if plain and term.factors[0].power == 1 else ""
        if variable not in ("alpha", "beta", *hats, *controls):
            raise refuse(
                "not_linear",
                where=f"linear flight model, {coefficient}",
                expected="terms of first order in "
                + ", ".join(("alpha", "beta", *hats, *controls)),
                found=term.formula,
                do="Leave it out, or use the output error of the nonlinear equations.",
            )
        scale = factor * (length / (2.0 * f.V) if variable in hats else 1.0)
        sign = "-" if scale < 0.0 else "+"
        out += f" {sign} {abs(float(scale))!r}*{name}*{hats.get(variable, variable)}"
    return out


def _sum(*terms: tuple[float, str]) -> str:
    """Text of numbers times states."""
    parts = [f"{'-' if v < 0.0 else '+'} {abs(float(v))!r}*{name}" for v, name in terms]
    return " ".join(parts)
