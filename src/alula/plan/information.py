"""What a maneuver will tell of each parameter: standard errors before the flight.

Equation-error form. A coefficient is regressed on the motion, C = X theta + e; with white sensor
noise mapped to the coefficients the Fisher information is D = sum of X' S^-1 X (Klein and Morelli,
Aircraft System Identification, 2nd ed., 2016, Eq. 5.90 and Sec. 9.2; Dittrich 2016, Eq. 3.36). The
prediction is the covariance of the estimator that `alula identify` uses, ordinary least squares:
P X' S X P with P = (X' X)^-1. For forces S is diagonal, and this is the inverse of D. Moments need
the derivative of the measured rates; there S is the covariance of the local cubics' derivative.

Errors of the regressors come on top, times the a-priori derivatives: rates and controls with the
white noise of their sensors; airspeed and flow angles with what a smoother leaves of theirs. A
smoother's error has the spectrum S_w S_n / (S_w + S_n) (Wiener's filter; Papoulis, Probability,
Random Variables and Stochastic Processes, 1991, Eq. 14-9): of a random walk driven by the noise of
the inertial sensors, seen with the noise of the air data.

Assumed: the model is right, noise is white, and constant errors (bias, upwash) have been found.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic
from alula.flight import Motion
from alula.identify.coefficients import Reference, regressor_variables
from alula.identify.equation_error.identify import LONGITUDINAL, MOMENTS
from alula.identify.regression.least_squares import least_squares
from alula.identify.typical import typical_magnitude
from alula.model import AeroModel, regressors

NOTHING = 10.0  # typical magnitudes: a standard error beyond tells nothing (uncertainty.md)
WEAK = 0.5  # of the value
_MEMBER = 1e-6  # share of a direction without information above which a parameter belongs to it


@dataclass(frozen=True)
class Prediction:
    """The a-priori value of a parameter and the standard error that is to be expected.

    se is infinite where the maneuver does not move its regressor on its own; tied_to names what it
    then cannot be told from. verdict: 'told' (se under half of the value), 'weak', 'not told'.
    """

    name: str
    coefficient: str
    value: float
    se: float
    verdict: str
    tied_to: tuple[str, ...] = ()


@dataclass(frozen=True)
class Flown:
    """A maneuver flown by the a-priori model. aspect: which coefficients it serves."""

    motion: Motion
    mass: float
    inertia: Array


def predict(
    flights: Sequence[Flown],
    model: AeroModel,
    formulas: Mapping[str, str],
    sigma: Mapping[str, float],
) -> tuple[Prediction, ...]:
    """Standard errors of all parameters of `formulas` by all flights together.

    sigma: standard deviation per sample of ax ay az (m/s2), p q r (rad/s) and thrust (N). The
    constant term is common to the flights. Coefficients that no flight's aspect serves are left
    out, and constants that the model does not have.
    """
    out: list[Prediction] = []
    for coefficient, formula in formulas.items():
        aspect = "longitudinal" if coefficient in LONGITUDINAL else "lateral"
        serving = [f for f in flights if f.motion.maneuver.aspect in (aspect, "both")]
        if serving:
            out += _one(coefficient, formula, serving, model, sigma)
    return tuple(out)


def _one(
    coefficient: str,
    formula: str,
    flights: Sequence[Flown],
    model: AeroModel,
    sigma: Mapping[str, float],
) -> list[Prediction]:
    r = model.reference
    reference = Reference(r.S, r.b, r.c, model.reference_point)
    names: tuple[str, ...] = ()
    blocks = []
    for flown in flights:
        names, matrix = regressors(
            coefficient, formula, regressor_variables(flown.motion, reference)
        )
        cubic = LocalCubic(flown.motion.t)
        blocks.append(cubic.matched(matrix) if coefficient in MOMENTS else matrix)
    stack = np.vstack(blocks)
    fit = least_squares(stack, stack.sum(axis=1))
    covariance = np.zeros((len(names), len(names)))
    for flown, block in zip(flights, blocks, strict=True):
        gain = block @ fit.dispersion
        covariance += _of_coefficient(coefficient, gain, flown, reference, sigma)
        covariance += _of_regressors(coefficient, gain, flown, model, sigma)
    se = np.sqrt(np.diag(covariance))
    member = np.abs(fit.null) > _MEMBER
    out = []
    for i, name in enumerate(names):
        if name not in model.params:  # a constant that the model does not have: offsets go there
            continue
        lost = member[i] if member.size else np.zeros(0, dtype=bool)
        tied = tuple(
            other
            for j, other in enumerate(names)
            if j != i and lost.any() and member[j][lost].any()
        )
        value = model.params[name]
        error = float("inf") if lost.any() else float(se[i])
        out.append(
            Prediction(
                name, coefficient, value, error, verdict_of(coefficient, name, value, error), tied
            )
        )
    return out


def _of_coefficient(
    coefficient: str, gain: Array, flown: Flown, reference: Reference, sigma: Mapping[str, float]
) -> Array:
    """Covariance (k, k) that the noise in one flight's coefficient adds; gain: (n, k), of each
    sample's coefficient on each estimate.
    """
    m = flown.motion
    qS = 0.5 * m.rho * m.V**2 * reference.S
    total = np.zeros((gain.shape[1], gain.shape[1]))
    if coefficient in MOMENTS:
        axis = ("Cl", "Cm", "Cn").index(coefficient)
        length = reference.c if coefficient == "Cm" else reference.b
        cubic = LocalCubic(m.t)
        for j, rate in enumerate(("p", "q", "r")):
            weight = flown.inertia[axis, j] * sigma.get(rate, 0.0)
            if weight:
                # The derivative's weights are odd: their transpose is their negative.
                scaled = gain * (weight / (qS * length))[:, None]
                back = np.column_stack(
                    [cubic.derivative(np.ascontiguousarray(c)) for c in scaled.T]
                )
                total += back.T @ back
        return total
    sin, cos = np.sin(m.alpha), np.cos(m.alpha)
    one, none = np.ones_like(sin), np.zeros_like(sin)
    along = {  # of each force coefficient on ax, ay, az
        "CX": (one, none, none),
        "CY": (none, one, none),
        "CZ": (none, none, one),
        "CD": (-cos, none, -sin),
        "CL": (sin, none, -cos),
    }[coefficient]
    for part, name in zip(along, ("ax", "ay", "az"), strict=True):
        scaled = gain * (part * flown.mass * sigma.get(name, 0.0) / qS)[:, None]
        total += scaled.T @ scaled
    thrust = {"CX": one, "CD": -cos, "CL": sin}.get(coefficient)
    if thrust is not None:  # along x, as good as
        scaled = gain * (thrust * sigma.get("thrust", 0.0) / qS)[:, None]
        total += scaled.T @ scaled
    return total


def _of_regressors(
    coefficient: str, gain: Array, flown: Flown, model: AeroModel, sigma: Mapping[str, float]
) -> Array:
    """Covariance (k, k) that errors of what the coefficient is set against add."""
    m, r = flown.motion, model.reference
    variables = regressor_variables(m, Reference(r.S, r.b, r.c, model.reference_point))
    values = model.evaluate(variables)
    slope = {name: _slope(model, coefficient, variables, name) for name in variables}
    # Drag and lift turn with the angle of attack themselves.
    turned = {"CD": values.get("CL"), "CL": -values["CD"] if "CD" in values else None}
    alpha = slope["alpha"] - (0.0 if (own := turned.get(coefficient)) is None else own)
    dt, speed = m.dt, float(np.mean(m.V))
    walk = {
        "V": dt * sigma.get("ax", 0.0),
        "alpha": dt * np.hypot(sigma.get("az", 0.0) / speed, sigma.get("q", 0.0)),
        "beta": dt * np.hypot(sigma.get("ay", 0.0) / speed, sigma.get("r", 0.0)),
    }
    parts = [
        ("V", 2.0 * values[coefficient] / m.V),
        ("alpha", alpha),
        ("beta", slope["beta"]),
        ("p", slope["phat"] * r.b / (2.0 * m.V)),
        ("q", slope["qhat"] * r.c / (2.0 * m.V)),
        ("r", slope["rhat"] * r.b / (2.0 * m.V)),
        *((name, slope[name]) for name in m.controls if name in slope),
    ]
    cubic = LocalCubic(m.t) if coefficient in MOMENTS else None
    total = np.zeros((gain.shape[1], gain.shape[1]))
    for name, sensitivity in parts:
        noise = sigma.get(name, 0.0)
        if noise and np.any(sensitivity):
            even = gain if cubic is None else cubic.matched(gain)
            total += _spread(even * sensitivity[:, None], noise, walk.get(name))
    return total


def _spread(gain: Array, noise: float, walk: float | None) -> Array:
    """gain' S gain (k, k) for white noise, or what a smoother leaves of it (walk: per sample)."""
    if walk is None:
        return np.asarray(noise**2 * (gain.T @ gain))
    n = 2 * len(gain)  # zeros behind, so that the end does not meet the beginning
    spectrum = np.fft.fft(gain, n, axis=0)
    step = 4.0 * np.sin(np.pi * np.arange(n) / n) ** 2  # |1 - exp(-i w)|^2
    left = noise**2 * walk**2 / (walk**2 + noise**2 * step)
    return np.asarray((spectrum.conj().T @ (left[:, None] * spectrum)).real / n)


def _slope(model: AeroModel, coefficient: str, variables: Mapping[str, Array], name: str) -> Array:
    """Derivative (n,) of the a-priori coefficient with respect to one variable."""
    h = 1e-4  # rad, of variables whose curvature is of order one
    ends = [
        model.evaluate({**variables, name: variables[name] + sign * h})[coefficient]
        for sign in (1.0, -1.0)
    ]
    return np.asarray((ends[0] - ends[1]) / (2.0 * h))


def verdict_of(coefficient: str, name: str, value: float, se: float) -> str:
    """Whether a standard error that is expected tells the parameter: told, weak, not told."""
    typical = typical_magnitude(coefficient, name)
    if not np.isfinite(se) or (typical is not None and se > NOTHING * typical):
        return "not told"
    return "told" if se < WEAK * abs(value) else "weak"
