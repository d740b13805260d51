"""Parameters of the momentum propeller from tests, by weighted least squares with error bars."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

import numpy as np
from scipy.interpolate import CubicSpline

from alula.aircraft.blades import Blades, MomentumParameters
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core
from alula.predict.propeller_curves import core_shape
from alula.predict.propeller_momentum import POWER, THRUST
from alula.predict.propeller_test import PropellerTest

Verdict = Literal["ok", "weak", "not_identifiable", "given"]
NAMES = ("c_l_alpha", "alpha_max", "c_d_alpha", "pitch")
UNITS = {"c_l_alpha": "1/rad", "alpha_max": "rad", "c_d_alpha": "1/rad^2", "pitch": "m"}
_LOWEST = {"c_l_alpha": 0.3, "alpha_max": 0.02, "c_d_alpha": 0.0}
_HIGHEST = {"c_l_alpha": 20.0, "alpha_max": np.pi / 2.0, "c_d_alpha": 100.0}
_POINTS = 90  # of the curve over J1; its splines are good to 1e-6 of the largest value


@dataclass(frozen=True)
class PropellerEstimate:
    """One parameter. se: standard error with coloured residuals, infinite where nothing is known.

    tied_to: the other parameters of the combination that the test leaves open. note: in words.
    """

    name: str
    value: float
    se: float
    unit: str
    verdict: Verdict
    tied_to: tuple[tuple[str, float], ...] = ()
    note: str = ""


@dataclass(frozen=True)
class PropellerFit:
    """What a test says of the momentum model.

    parameters: None where the test leaves values open that its own curves depend on.
    rms_CT, rms_CP: over the largest measured CT, CP. resid: (k, 2) model minus test.
    """

    estimates: tuple[PropellerEstimate, ...]
    parameters: MomentumParameters | None
    rms_CT: float
    rms_CP: float
    resid: Array
    test: PropellerTest
    status: str

    @property
    def identified(self) -> bool:
        """Whether every parameter is determined or given."""
        return all(e.verdict != "not_identifiable" for e in self.estimates)


def fit_propeller(
    blades: Blades, test: PropellerTest, given: Mapping[str, float] | None = None
) -> PropellerFit:
    """c_l_alpha, alpha_max, c_d_alpha and effective pitch by least squares on CT and CP.

    given: values that are held, by name, e.g. alpha_max and pitch where the test was static: it
    has two numbers, CT and CP (Pusztai 2018, B.2). CT and CP are weighted by their standard errors
    or, where those are not known, by their largest values. Several starts; the best one is kept.
    """
    from scipy.optimize import least_squares

    held = dict(given or {})
    free = [name for name in NAMES if name not in held]
    _check(blades, test, held, free)
    nominal = _nominal_pitch(blades)
    largest = np.array([np.max(np.abs(test.CT)), np.max(np.abs(test.CP))])
    known = test.se_CT is not None and test.se_CP is not None
    weight = 1.0 / (np.array([test.se_CT, test.se_CP], dtype=float) if known else largest)
    typical = {"c_l_alpha": 6.0, "alpha_max": 0.25, "c_d_alpha": 2.0, "pitch": nominal}
    low = np.array([0.2 * nominal if n == "pitch" else _LOWEST[n] for n in free])
    high = np.array([5.0 * nominal if n == "pitch" else _HIGHEST[n] for n in free])
    scale = np.array([typical[n] for n in free])

    def misfit(x: Array) -> Array:
        values = {**held, **dict(zip(free, scale * x, strict=True))}
        model = _model(blades, values, test.J)
        return np.asarray(((model - np.column_stack([test.CT, test.CP])) * weight).ravel())

    best: Any = None
    # The last start lets nothing stall: else a root that barely stalls could end the search.
    for alpha_max, stretch in product((0.12, 0.25, 0.5, 1.5), (1.0, 1.3)):
        start = {
            "c_l_alpha": 5.0, "alpha_max": alpha_max, "c_d_alpha": 1.0, "pitch": stretch * nominal
        }  # fmt: skip
        x0 = np.array([start[n] for n in free]) / scale
        if not np.all(np.isfinite(misfit(x0))):
            continue
        found = least_squares(misfit, x0, bounds=(low / scale, high / scale), x_scale=0.1)
        if found.status > 0 and (best is None or found.cost < best.cost):
            best = found
    if best is None:
        raise refuse(
            "propeller_not_fitted",
            where=blades.name,
            expected="a model near the test to start from",
            found="none among eight starts",
            do="Check units: J, CT, CP with n in revolutions per second, blades in m.",
        )
    values = {**held, **dict(zip(free, (float(v) for v in scale * best.x), strict=True))}
    resid = (best.fun.reshape(-1, 2) / weight)[:, :]
    rms = np.sqrt(np.mean(resid**2, axis=0)) / largest
    estimates, usable = _judge(blades, test, values, held, free, scale, best, known)
    final = {e.name: e.value for e in estimates}
    return PropellerFit(
        estimates,
        MomentumParameters(**final) if usable else None,
        float(rms[0]),
        float(rms[1]),
        frozen(resid),
        test,
        _status(estimates, usable),
    )


def _model(blades: Blades, values: Mapping[str, float], J: Array) -> Array:
    """CT and CP (k, 2) by splines over J1, continued smoothly into the windmill."""
    helix = values["pitch"] / blades.radius
    J1 = np.linspace(0.01, 1.6 * max(helix / (2.0 * np.pi), 0.1), _POINTS)
    out = np.zeros((_POINTS, 18))
    core.blade_integrals(core_shape(blades, values["pitch"]), values["alpha_max"], J1, out)
    parts = out.reshape(_POINTS, 6, 3)
    lift = values["c_l_alpha"]
    hub = blades.count * (
        lift * (values["alpha_max"] * parts[:, :, 0] + parts[:, :, 1])
        + values["c_d_alpha"] * parts[:, :, 2]
    )
    F, M = hub[:, 0], hub[:, 3]
    J0 = J1 - F / (2.0 * np.pi * J1)
    ratio = 1.0 / (1.0 - M * (2.0 * J1 - J0) / (np.pi * J1**2))
    at = np.pi * J0 * ratio
    static = np.flatnonzero((at[:-1] < 0.0) & (at[1:] >= 0.0))
    if not len(static):
        return np.full((len(J), 2), np.nan)
    begin = int(static[-1])
    falling = np.flatnonzero(np.diff(at[begin:]) <= 0.0)
    end = begin + int(falling[0]) + 1 if len(falling) else _POINTS
    if end - begin < 4:
        return np.full((len(J), 2), np.nan)
    square = ratio[begin:end] ** 2
    both = np.column_stack([THRUST * square * F[begin:end], -POWER * square * M[begin:end]])
    return np.asarray(CubicSpline(at[begin:end], both)(J))


def _judge(
    blades: Blades, test: PropellerTest, values: Mapping[str, float], held: Mapping[str, float],
    free: list[str], scale: Array, best: Any, known: bool,
) -> tuple[tuple[PropellerEstimate, ...], bool]:  # fmt: skip
    """Standard errors, verdicts, and whether the curves within the test's range can be used."""
    jacobian, misfit = best.jac, best.fun
    n, k = jacobian.shape
    variance = 1.0 if known else float(misfit @ misfit) / max(n - k, 1)
    information = jacobian.T @ jacobian
    # Directions (in typical values) whose own standard error exceeds the typical value.
    eigenvalue, vector = np.linalg.eigh(information)
    # A static test has two numbers only, and its scatter says nothing of a third.
    open_ = eigenvalue < np.maximum(variance, 1e-10 * eigenvalue[-1])
    inverse = np.where(open_, 0.0, 1.0 / np.where(open_, 1.0, eigenvalue))
    bread = (vector * inverse) @ vector.T
    covariance = np.maximum(
        np.diag(variance * bread), np.diag(bread @ _coloured(jacobian, misfit, test) @ bread)
    )
    if test.common_CP > 0.0:
        covariance = covariance + _common(test, jacobian, bread)
    se = np.sqrt(covariance) * scale
    met = _largest_alpha(blades, values, test)
    estimates, usable = [], True
    for name in NAMES:
        value = float(values[name])
        if name in held:
            estimates.append(PropellerEstimate(name, value, 0.0, UNITS[name], "given"))
            continue
        i = free.index(name)
        weak = [
            v for v, is_open in zip(vector.T, open_, strict=True) if is_open and abs(v[i]) > 0.1
        ]
        if not weak:
            verdict: Verdict = "weak" if se[i] > 0.5 * abs(value) else "ok"
            estimates.append(PropellerEstimate(name, value, float(se[i]), UNITS[name], verdict))
            continue
        others = tuple(
            (free[j], float(weak[0][j]))
            for j in range(len(free))
            if j != i and abs(weak[0][j]) > 0.1
        )
        note = ""
        if name == "alpha_max" and not others:
            # Nothing stalls: any larger value gives the same curves over the test's range.
            value = max(met, 1e-3)
            note = f"no section of this test goes beyond {np.degrees(met):.3g} deg: a lower bound"
        else:
            usable = False
        estimates.append(
            PropellerEstimate(
                name, value, float("inf"), UNITS[name], "not_identifiable", others, note
            )
        )
    return tuple(estimates), usable


def _coloured(jacobian: Array, misfit: Array, test: PropellerTest) -> Array:
    """Covariance of the gradient where residuals of one run and coefficient are alike.

    Bartlett's weights over half of each run, in order of J: model error is smooth in J.
    """
    k = jacobian.shape[1]
    total = np.zeros((k, k))
    runs = np.array(test.run)
    for name in sorted(set(test.run)):
        rows = np.flatnonzero(runs == name)
        rows = rows[np.argsort(test.J[rows], kind="stable")]
        reach = max(1, len(rows) // 2)
        for coefficient in (0, 1):
            score = jacobian[2 * rows + coefficient] * misfit[2 * rows + coefficient, None]
            total += score.T @ score
            for lag in range(1, reach):
                both = score[lag:].T @ score[:-lag]
                total += (1.0 - lag / reach) * (both + both.T)
    return total


def _common(test: PropellerTest, jacobian: Array, bread: Array) -> Array:
    """Variance from an error that all CP share in proportion: it shifts every estimate."""
    largest = float(np.max(np.abs(test.CP)))
    change = np.zeros(len(jacobian))
    change[1::2] = test.common_CP * test.CP / (largest if test.se_CP is None else test.se_CP)
    return np.asarray((bread @ (jacobian.T @ change)) ** 2)


def _largest_alpha(blades: Blades, values: Mapping[str, float], test: PropellerTest) -> float:
    """rad: the largest angle of attack on the blades over the test, by the fitted model."""
    out = np.zeros((1, 10))
    core.momentum_disk(
        core_shape(blades, values["pitch"]), values["c_l_alpha"], values["alpha_max"],
        values["c_d_alpha"], np.array([float(test.J.min())]), out,
    )  # fmt: skip
    r = np.linspace(max(blades.hub_radius / blades.radius, 1e-3), 1.0, 200)
    helix = values["pitch"] / (2.0 * np.pi * blades.radius)
    return float(np.max(np.arctan2(helix, r) - np.arctan2(out[0, 1], r)))


def _nominal_pitch(blades: Blades) -> float:
    """m: the geometric pitch, where it is not one number that at three quarters of the radius."""
    if blades.helix is not None:
        return blades.helix
    r = 0.75 * blades.radius
    return float(2.0 * np.pi * r * np.tan(np.interp(r, blades.r, blades.pitch)))


def _check(blades: Blades, test: PropellerTest, held: Mapping[str, float], free: list[str]) -> None:
    unknown = [name for name in held if name not in NAMES]
    bad = [name for name, value in held.items() if not np.isfinite(value) or value < 0.0]
    if unknown or bad or not free:
        raise refuse(
            "bad_fit_options",
            where=blades.name,
            expected="finite values of some of " + ", ".join(NAMES),
            found="all of them" if not free else ", ".join(f"'{n}'" for n in [*unknown, *bad]),
            do="Leave at least one to be found.",
        )
    if not _nominal_pitch(blades) > 0.0:
        raise refuse(
            "no_pitch",
            where=blades.name,
            expected="blades whose angle at three quarters of the radius is above zero",
            found=f"a pitch of {_nominal_pitch(blades):.4g} m",
            do="Check the angles' sign and unit.",
        )


def _status(estimates: tuple[PropellerEstimate, ...], usable: bool) -> str:
    lost = [e for e in estimates if e.verdict == "not_identifiable"]
    if not lost:
        return "all parameters determined"
    if usable:
        return "; ".join(f"{e.name}: {e.note}" for e in lost)
    names = ", ".join(e.name for e in lost)
    return f"the test does not determine {names}: give some of them, or measure at several J"
