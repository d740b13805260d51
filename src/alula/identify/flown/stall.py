"""Kirchhoff parameters of a stall: abruptness, angle, and time constants of separation.

Output error with the point of separation X as state and the measured angle of attack as input:
tau1 dX/dt = X0(alpha - tau2 dalpha/dt) - X, X0 = (1 - tanh(a1 (alpha - alpha_star)))/2 (Goman and
Khrabrov, J. Aircraft 31, 1994, Eq. (6); Fischenberg, AIAA 95-3438; van den Hoek 2017, Sec. 2).
The lift of the attached flow CL_0 + CL_alpha alpha is multiplied by ((1 + sqrt X)/2)^2; drag and
moment gain CD_X (1 - X), Cm_X (1 - X). The angle of attack goes in as reconstructed: its error is
not the model's. Sensitivities are central differences.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.local_cubic import LocalCubic
from alula.base.messages import refuse, warn
from alula.identify.coefficients import CoefficientData
from alula.identify.likelihood.optimizer import Minimum, Point, minimize
from alula.identify.likelihood.parameters import Fitted, Whitened, assembled
from alula.identify.result import Identification, Parameter
from alula.identify.typical import unit
from alula.model import parse

NAMES = ("a1", "alpha_star", "tau1", "tau2")
UNITS = ("1/rad", "rad", "s", "s")
LOW = (1.0, 0.0, 1e-3, 0.0)  # 1/rad, rad, s, s
HIGH = (200.0, 1.5, 5.0, 5.0)
FIRST = (20.0, 0.0, 0.2, 0.1)
STARTS = 12  # stall angles tried, of which the best two are searched from
EVEN = 0.1  # of the interval, by which steps may differ
TOLD = 0.5  # standard error over value, from which on the flight does not tell a stall parameter
ALONE = ("CL", "CD", "Cm")


def separation(
    t: Array, alpha: Array, alphadot: Array, a1: float, alpha_star: float, tau1: float, tau2: float
) -> Array:
    """X (n,) at times t (n,) of even spacing, steady at the start; angles rad.

    Exact for an X0 that is linear between samples.
    """
    from scipy.signal import lfilter  # slow to import, for stalls only

    steady = 0.5 * (1.0 - np.tanh(a1 * (alpha - tau2 * alphadot - alpha_star)))
    h = (t[-1] - t[0]) / (len(t) - 1)
    decay = np.exp(-h / tau1)
    slope = tau1 / h * (1.0 - decay)
    behind = lfilter([1.0 - slope, slope - decay], [1.0, -decay], steady - steady[0])
    return np.asarray(steady[0] + behind)


class _Stall:
    """The likelihood: residuals of all coefficients over all maneuvers, variances estimated."""

    def __init__(
        self,
        data: Sequence[CoefficientData],
        models: Mapping[str, str],
        fixed: Mapping[str, float],
    ) -> None:
        self.data, self.models = data, models
        self.free = [i for i, n in enumerate(NAMES) if n not in fixed]
        self.known = np.array([fixed.get(n, np.nan) for n in NAMES])
        self.names = [NAMES[i] for i in self.free]
        self.columns: dict[str, list[int]] = {}
        for c, formula in models.items():
            own = [t.name(c) for t in parse(formula)] + ([] if c == "CL" else [f"{c}_X"])
            self.columns[c] = list(range(len(self.names), len(self.names) + len(own)))
            self.names += own
        self.matrices = [
            {c: np.column_stack([np.broadcast_to(t.values(d.variables), d.t.shape)
                                 for t in parse(f)]) for c, f in models.items()}
            for d in data
        ]  # fmt: skip
        cubics = [LocalCubic(d.t) for d in data]
        self.alpha = [c.matched(d.variables["alpha"][:, None])[:, 0] for c, d in
                      zip(cubics, data, strict=True)]  # fmt: skip
        self.alphadot = [c.derivative(d.variables["alpha"]) for c, d in
                         zip(cubics, data, strict=True)]  # fmt: skip
        lift = [t.name("CL") for t in parse(models["CL"])]
        self.attached = np.array([n in ("CL_0", "CL_alpha") for n in lift])

    def stall(self, theta: Array) -> Array:
        """All four stall parameters."""
        out = self.known.copy()
        out[self.free] = theta[: len(self.free)]
        return out

    def basis(self, stall: Array, i: int) -> dict[str, Array]:
        """Columns (n, k) of each coefficient's own parameters, in which the model is linear."""
        d = self.data[i]
        X = np.clip(separation(d.t, self.alpha[i], self.alphadot[i], *map(float, stall)), 1e-9, 1.0)
        factor = (0.5 * (1.0 + np.sqrt(X))) ** 2
        out = {}
        for c, matrix in self.matrices[i].items():
            if c == "CL":
                out[c] = np.where(self.attached, matrix * factor[:, None], matrix)
            else:
                out[c] = np.column_stack([matrix, 1.0 - X])
        return out

    def linear(self, stall: Array) -> Array:
        """All parameters (k,) with the coefficients' own ones by least squares."""
        free = stall[self.free]
        theta = np.concatenate([free, np.zeros(len(self.names) - len(free))])
        bases = [self.basis(self.stall(theta), i) for i in range(len(self.data))]
        for c, columns in self.columns.items():
            matrix = np.vstack([b[c] for b in bases])
            y = np.concatenate([d.coefficients[c] for d in self.data])
            theta[columns] = np.linalg.lstsq(matrix, y, rcond=1e-10)[0]
        return theta

    def model(self, theta: Array, i: int) -> dict[str, Array]:
        """Coefficients (n,) of one maneuver."""
        return {c: b @ theta[self.columns[c]] for c, b in self.basis(self.stall(theta), i).items()}

    def errors(self, theta: Array) -> dict[str, list[Array]]:
        """Measured minus model, by coefficient and maneuver."""
        models = [self.model(theta, i) for i in range(len(self.data))]
        return {
            c: [d.coefficients[c] - m[c] for d, m in zip(self.data, models, strict=True)]
            for c in self.models
        }

    def slopes(self, theta: Array, i: int) -> dict[str, Array]:
        """Sensitivities (n, k) of each coefficient of one maneuver."""
        basis = self.basis(self.stall(theta), i)
        out = {c: np.zeros((len(self.data[i].t), len(theta))) for c in self.models}
        for c, columns in self.columns.items():
            out[c][:, columns] = basis[c]
        for j in range(len(self.free)):
            h = 1e-5 * max(abs(theta[j]), 0.01)
            up, down = theta.copy(), theta.copy()
            up[j], down[j] = theta[j] + h, theta[j] - h
            above, below = self.model(up, i), self.model(down, i)
            for c in self.models:
                out[c][:, j] = (above[c] - below[c]) / (2.0 * h)
        return out

    def variance(self, theta: Array) -> dict[str, float]:
        """R of each coefficient."""
        return {
            c: max(float(np.mean(np.concatenate(e) ** 2)), 1e-20)
            for c, e in self.errors(theta).items()
        }

    def __call__(self, theta: Array, derivatives: bool) -> Point | None:
        errors = self.errors(theta)
        if not all(np.isfinite(v).all() for e in errors.values() for v in e):
            return None
        r = {c: max(float(np.mean(np.concatenate(e) ** 2)), 1e-20) for c, e in errors.items()}
        n = sum(len(d.t) for d in self.data)
        cost = 0.5 * n * sum(float(np.log(v)) for v in r.values())
        if not derivatives:
            return Point(cost)
        gradient, information = np.zeros(len(theta)), np.zeros((len(theta), len(theta)))
        for i in range(len(self.data)):
            for c, s in self.slopes(theta, i).items():
                gradient -= s.T @ errors[c][i] / r[c]
                information += s.T @ s / r[c]
        return Point(cost, gradient, information)


def identify_stall(
    data: Sequence[CoefficientData],
    models: Mapping[str, str],
    *,
    fixed: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """a1 (1/rad), alpha_star (rad), tau1 and tau2 (s) with the derivatives of the attached flow.

    data: maneuvers through the stall, sampled evenly, alpha against the air without noise to speak
    of (reconstructed); those held out are predicted, not learned from. models: formulas of the
    attached flow, CL with 1 and alpha, and any of CD, Cm. fixed: values of stall parameters that
    are known. A stall parameter whose standard error is over half of its value reads
    not_identifiable. Raises BadInput where CL has no such formula, a maneuver lacks what is asked
    for or is unevenly sampled, and for values of `fixed` that are not possible.
    """
    known = dict(fixed or {})
    lift = [t.name("CL") for t in parse(models["CL"])] if "CL" in models else []
    lacking = [c for d in data for c in models if c not in d.coefficients]
    if not {"CL_0", "CL_alpha"} <= set(lift) or set(models) - set(ALONE) or lacking or not data:
        raise refuse(
            "stall_model",
            where="stall",
            expected="maneuvers with CL, its formula with 1 and alpha, and none but CD and Cm more",
            found=f"formulas of {', '.join(models) or 'nothing'}, {len(data)} maneuvers; missing: "
            f"{', '.join(dict.fromkeys(lacking)) or 'nothing'}",
            do="State CL of the attached flow, and give maneuvers through the stall.",
        )
    _check(data, known)
    learn = [d for d in data if not d.maneuver.held_out]
    problem = _Stall(learn, models, known)
    found = _searched(problem)
    fitted, blocks = [], []
    if found.converged:
        r = problem.variance(found.value)
        held = [d for d in data if d.maneuver.held_out]
        unseen = _Stall(held, models, known)
        for i, d in enumerate(held):
            fitted += [
                Fitted(c, d.maneuver.id, d.t, d.coefficients[c], y, True)
                for c, y in unseen.model(found.value, i).items()
            ]
        for i, d in enumerate(learn):
            model, slopes = problem.model(found.value, i), problem.slopes(found.value, i)
            for c in models:
                measured = d.coefficients[c]
                fitted.append(Fitted(c, d.maneuver.id, d.t, measured, model[c], False))
                scale = np.sqrt(r[c])
                blocks.append(Whitened(slopes[c] / scale, (measured - model[c]) / scale))
    belongs = {
        n: c for c, cols in problem.columns.items() for n in (problem.names[k] for k in cols)
    }
    result = assembled(
        "stall", problem.names, {**dict.fromkeys(NAMES, "stall"), **belongs}, blocks, found,
        fitted, dict(models), truth=truth,
    )  # fmt: skip
    told = _told(result)
    own = dict(zip(NAMES, UNITS, strict=True))
    named = (replace(p, unit=own.get(p.name) or _unit(p)) for p in told.parameters)
    return replace(told, parameters=tuple(named), fixed=known)


def _unit(p: Parameter) -> str:
    return "1" if p.name.endswith("_X") else unit(p.coefficient, p.name)


def _check(data: Sequence[CoefficientData], fixed: Mapping[str, float]) -> None:
    """Refuse what the search cannot take."""
    wrong = [
        f"{n} = {v:g}" for n, v in fixed.items()
        if n not in NAMES or not LOW[NAMES.index(n)] <= v <= HIGH[NAMES.index(n)]
    ]  # fmt: skip
    if wrong:
        limits = zip(NAMES, LOW, HIGH, strict=True)
        raise refuse(
            "bad_option",
            where="stall, fixed",
            expected=", ".join(f"{n} from {low:g} to {high:g}" for n, low, high in limits),
            found=", ".join(wrong),
            do="Correct it: 1/rad, rad, s, s.",
        )
    if all(d.maneuver.held_out for d in data):
        raise refuse(
            "no_maneuver",
            where="stall",
            expected="a maneuver that is not held out",
            found=", ".join(d.maneuver.id for d in data),
            do="Take `held_out` away from one.",
        )
    for d in data:
        steps = np.diff(d.t)
        if len(steps) < 20 or np.ptp(steps) > EVEN * float(np.mean(steps)):
            raise refuse(
                "uneven_time",
                where=f"stall, maneuver {d.maneuver.id}",
                expected="20 samples or more, evenly spaced",
                found=f"{len(d.t)}, steps of {steps.min(initial=np.inf):.4g} to "
                f"{steps.max(initial=0.0):.4g} s",
                do="Choose a window without gaps.",
            )


def _searched(problem: _Stall) -> Minimum:
    """The best of searches from several stall angles: the cost has a valley for each."""
    lowest = min(float(a.min()) for a in problem.alpha)
    top = max(float(a.max()) for a in problem.alpha)
    others = len(problem.names) - len(problem.free)
    low = np.concatenate([np.array(LOW)[problem.free], np.full(others, -np.inf)])
    high = np.concatenate([np.array(HIGH)[problem.free], np.full(others, np.inf)])
    best: Minimum | None = None
    starts = [
        problem.linear(
            np.where(np.isnan(problem.known), [FIRST[0], star, *FIRST[2:]], problem.known)
        )
        for star in lowest + np.linspace(0.1, 1.0, STARTS) * (top - lowest)
    ]
    costs = [point.cost if (point := problem(s, False)) else np.inf for s in starts]
    for start in (starts[i] for i in np.argsort(costs)[:2].tolist()):
        found = minimize(
            problem, start, algorithm="levenberg_marquardt", lower=low, upper=high, close=1e-2
        )
        if best is None or (found.converged, -found.cost) > (best.converged, -best.cost):
            best = found
    assert best is not None
    return best


def _told(result: Identification) -> Identification:
    """Stall parameters that the flight cannot tell lose their value."""
    nan, said, parameters = float("nan"), [], []
    covariance = np.array(result.covariance)
    for i, p in enumerate(result.parameters):
        if p.name in NAMES and p.verdict != "not_identifiable" and not p.se < TOLD * abs(p.value):
            said.append(
                warn(
                    "not_identifiable",
                    where=f"stall, {p.name}",
                    expected="stalls that move with it, quick ones for time constants",
                    found=f"{p.value:.3g} with a standard error of {p.se:.3g}",
                    do="Fly dynamic stalls beside quasi-steady ones, or state it: fixed.",
                )
            )
            covariance[i, :] = covariance[:, i] = nan
            p = replace(p, value=nan, se=nan, se_white=nan, ci95=(nan, nan),
                        verdict="not_identifiable")  # fmt: skip
        parameters.append(p)
    if not said:
        return result
    return replace(
        result,
        parameters=tuple(parameters),
        covariance=frozen(covariance),
        messages=(*result.messages, *said),
        status=result.status.split(";")[0] + "; not identifiable: "
        + ", ".join(p.name for p in parameters if p.verdict == "not_identifiable"),
    )  # fmt: skip
