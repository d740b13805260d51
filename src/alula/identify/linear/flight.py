"""The linear equations of flight with aerodynamic derivatives as parameters.

Dittrich 2016, Eq. (2.78), (2.79) with errata: deviations from steady straight flight, stability
axes for lift and drag, body axes for the rest. What trim determines (total lift and drag) is a
number; every derivative that a formula names is a parameter, with the factor of each entry it
stands in. The same equations in total states and controls (`total`) have the constants of the
formulas as parameters too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.linear.model import LinearModel, linear_model
from alula.model import parse

LONGITUDINAL = ("V", "alpha", "q", "theta")
LATERAL = ("beta", "p", "r", "phi")
_ACTS_ON: Mapping[str, tuple[str, ...]] = {
    "CD": ("V",), "CL": ("alpha",), "Cm": ("q",), "CY": ("beta",), "Cl": ("p", "r"),
    "Cn": ("p", "r"),
}  # fmt: skip
_HATS = {"phat": "p", "qhat": "q", "rhat": "r"}
_Term = tuple[float, str | None, str | None]  # factor, parameter, variable


@dataclass(frozen=True)
class SteadyFlight:
    """The flight deviations count from, wings level: SI, rad. S, b, c: reference geometry.

    inertia: (3, 3) about the center of gravity. thrust, thrust_z: N, along body x and z;
    thrust_moment: N m about the center of gravity. arm: m, from the center of gravity to the point
    that the moment coefficients refer to.
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
    thrust_z: float = 0.0
    thrust_moment: tuple[float, float, float] = (0.0, 0.0, 0.0)
    arm: tuple[float, float, float] = (0.0, 0.0, 0.0)


def linear_flight_model(
    flight: SteadyFlight,
    models: Mapping[str, str],
    *,
    controls: Sequence[str],
    states: Sequence[str] = (),
    outputs: Sequence[str] = (),
    trim: bool = True,
    total: bool = False,
    tied: Mapping[str, tuple[str, float]] | None = None,
) -> LinearModel:
    """The linear model of the axis that `models` belongs to.

    models: formulas of CD CL Cm (states V alpha q theta) or of CY Cl Cn (beta p r phi), of first
    order. states: some of these, all by default; the others are inputs, as measured. outputs:
    states or their derivatives ('qdot'), all states by default. trim: a constant in every row with
    aerodynamics, 'alpha_0', as deviations are never counted from exact trim; name them in `own`
    where maneuvers differ. total: states and controls are not deviations but what they are, and the
    formulas' constants, 'CL_0', stand in the place of `trim`. tied: derivative by (another one,
    factor). Raises BadInput for a formula that is not linear.
    """
    lateral = bool({"CY", "Cl", "Cn"} & set(models))
    known = {"CY", "Cl", "Cn"} if lateral else {"CD", "CL", "Cm"}
    if not models or not set(models) <= known:
        raise refuse(
            "unknown_coefficient",
            where="linear flight model",
            expected="CD CL Cm, or CY Cl Cn",
            found=", ".join(models) or "none",
            do="Give the formulas of one axis; CD and CL in the place of CX and CZ.",
        )
    every = LATERAL if lateral else LONGITUDINAL
    strange = [s for s in states if s not in every]
    if strange:
        raise refuse(
            "unknown_state",
            where="linear flight model",
            expected="some of " + ", ".join(every),
            found=", ".join(strange),
            do="Name states of the axis that the formulas belong to.",
        )
    idle = [c for c in models if states and not set(states) & set(_ACTS_ON[c])]
    if idle:
        raise refuse(
            "no_state",
            where="linear flight model",
            expected="a state that each formula acts on",
            found=f"{', '.join(idle)} without {', '.join(_ACTS_ON[idle[0]])}",
            do="Add the state, or take the formula out.",
        )
    made = _Rows(flight, models, tuple(controls), total, tied or {})
    rows = made.lateral() if lateral else made.longitudinal()
    rows = {s: rows[s] for s in every if not states or s in states}
    if trim and not total:
        driven = ("beta", "p", "r") if lateral else ("V", "alpha", "q")
        rows = {s: f"{row} + {s}_0" if s in driven else row for s, row in rows.items()}
    inputs = [*controls, *(s for s in every if s not in rows)]
    return linear_model(rows, outputs or list(rows), inputs)


@dataclass(frozen=True)
class _Rows:
    """Writes the rows' text."""

    flight: SteadyFlight
    models: Mapping[str, str]
    controls: tuple[str, ...]
    total: bool
    tied: Mapping[str, tuple[str, float]]

    def longitudinal(self) -> dict[str, str]:
        f = self.flight
        qS = 0.5 * f.rho * f.V**2 * f.S
        climb = f.theta - f.alpha
        g, m, V, Iyy = f.gravity, f.mass, f.V, f.inertia[1, 1]
        sa, ca = float(np.sin(f.alpha)), float(np.cos(f.alpha))
        pull, lift = f.thrust * ca + f.thrust_z * sa, f.thrust * sa - f.thrust_z * ca
        CD = (pull - m * g * np.sin(climb)) / qS  # of steady flight
        CL = (m * g * np.cos(climb) - lift) / qS
        CX, CZ = CL * sa - CD * ca, -CD * sa - CL * ca
        x, _, z = f.arm
        push = f.thrust_moment[1]
        Cm = -(z * CX - x * CZ + push / qS) / f.c
        k = qS / Iyy
        return {
            "V": _text(
                self._motion(
                    (-2.0 * qS * CD / (m * V), "V"),
                    (g * np.cos(climb) - lift / m, "alpha"),
                    (-g * np.cos(climb), "theta"),
                ),
                self._aero("CD", -qS / m, CD),
            ),
            "alpha": _text(
                self._motion(
                    (-2.0 * qS * CL / (m * V**2), "V"),
                    (g / V * np.sin(climb) - pull / (m * V), "alpha"),
                    (1.0, "q"),
                    (-g / V * np.sin(climb), "theta"),
                ),
                self._aero("CL", -qS / (m * V), CL),
            ),
            "q": _text(
                [(0.0, None, "q")],
                self._aero("Cm", k * f.c, Cm),
                # moments are about the reference point: arm x force
                self._aero("CD", k * (x * sa - z * ca), CD),
                self._aero("CL", k * (x * ca + z * sa), CL),
                self._motion((-k * (z * CZ + x * CX), "alpha"), (-2.0 * push / (V * Iyy), "V")),
            ),
            "theta": "q",
        }

    def lateral(self) -> dict[str, str]:
        f = self.flight
        qS = 0.5 * f.rho * f.V**2 * f.S
        inverse = np.linalg.inv(f.inertia)
        x, _, z = f.arm
        turn = {}
        for state, i in (("p", 0), ("r", 2)):
            roll, yaw = qS * float(inverse[i, 0]), qS * float(inverse[i, 2])
            turn[state] = _text(
                [(0.0, None, state)],
                self._aero("Cl", roll * f.b, -f.thrust_moment[0] / (qS * f.b)),
                self._aero("Cn", yaw * f.b, -f.thrust_moment[2] / (qS * f.b)),
                self._aero("CY", yaw * x - roll * z, 0.0),
            )
        return {
            "beta": _text(
                self._motion(
                    (np.sin(f.alpha), "p"),
                    (-np.cos(f.alpha), "r"),
                    (f.gravity / f.V * np.cos(f.theta), "phi"),
                ),
                self._aero("CY", qS / (f.mass * f.V), 0.0),
            ),
            "p": turn["p"],
            "r": turn["r"],
            "phi": _text(self._motion((1.0, "p"), (np.tan(f.theta), "r"))),
        }

    def _motion(self, *terms: tuple[float, str]) -> list[_Term]:
        """Numbers times states, counted from steady flight."""
        out: list[_Term] = [(float(k), None, name) for k, name in terms]
        if self.total:
            steady = {"V": self.flight.V, "alpha": self.flight.alpha, "theta": self.flight.theta}
            out.append((-sum(k * steady.get(s, 0.0) for k, _, s in out if s), None, None))
        return out

    def _aero(self, coefficient: str, factor: float, steady: float) -> list[_Term]:
        """Factor times the coefficient less its value in steady flight; derivatives by name."""
        if coefficient not in self.models or factor == 0.0:
            return []
        f = self.flight
        length = f.c if coefficient in ("CD", "CL", "Cm") else f.b
        out: list[_Term] = [(-factor * float(steady), None, None)] if self.total else []
        for term in parse(self.models[coefficient]):
            name = term.name(coefficient)
            name, share = self.tied.get(name, (name, 1.0))
            if not term.factors:
                if self.total:
                    out.append((factor * share, name, None))
                continue  # else of trim
            plain = len(term.factors) == 1 and term.factors[0].kind == "plain"
            variable = term.factors[0].variable if plain and term.factors[0].power == 1 else ""
            if variable not in ("alpha", "beta", *_HATS, *self.controls):
                raise refuse(
                    "not_linear",
                    where=f"linear flight model, {coefficient}",
                    expected="terms of first order in "
                    + ", ".join(("alpha", "beta", *_HATS, *self.controls)),
                    found=term.formula,
                    do="Leave it out, or use the output error of the nonlinear equations.",
                )
            scale = length / (2.0 * f.V) if variable in _HATS else 1.0
            out.append((factor * share * scale, name, _HATS.get(variable, variable)))
        return out


def _text(*parts: Sequence[_Term]) -> str:
    """Terms as `linear_model` reads them."""
    words = []
    for factor, parameter, variable in (term for part in parts for term in part):
        if factor == 0.0 and variable is None:
            continue
        names = [n for n in (parameter, variable) if n is not None]
        words.append("*".join([f"{'-' if factor < 0.0 else '+'} {abs(float(factor))!r}", *names]))
    return " ".join(words)
