"""Filter error for nonlinear models: the extended Kalman filter's innovations.

Jategaonkar 2006, ch. 5. The model is two Python functions, derivative and output, that take many
states at once; slopes by central differences, so this takes thirty times as long as formulas, which
the core filters. The covariance follows the flown estimate, P = Phi P Phi' + (Phi Q Phi' + Q) dt/2.
The initial state is estimated and has the process noise of one sample, Q dt, as any prediction has:
were it exact, it could meet a reading exactly, and the likelihood would grow without bound as that
sensor's noise goes to zero.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.likelihood.innovations import Innovations
from alula.identify.likelihood.optimizer import Algorithm
from alula.identify.likelihood.parameters import Prior
from alula.identify.linear.noise_search import (
    NoisyProblem,
    first_process_noises,
    first_sensor_noises,
    left_aside,
    search_noises,
    without_noises,
)
from alula.identify.linear.output_error import learned
from alula.identify.linear.record import LinearRecord, Unknowns
from alula.identify.linear.start import STARTS
from alula.identify.result import Identification

Function = Callable[[Array, Array, Array], Array]
# Values (m, j), initial states, noise intensities (m, s) and sensors' variances (m, k) to the
# innovations of one maneuver; None where the motion diverges.
Pass = Callable[[Array, Array, Array, Array], Innovations | None]
STEP = 1e-6  # of a state's size, for slopes
TERMS = 10  # of the exponential's series: 1e-8 where a sample is as long as the fastest mode


@dataclass(frozen=True)
class FunctionModel:
    """dx/dt = derivative(x, u, p), y = output(x, u, p), by name.

    Both take x (..., s), u (..., m), p (..., j) with leading axes that broadcast, and give (..., s)
    and (..., k). size: typical magnitude of each state. belongs: row of each parameter. filter: of
    one maneuver, where something faster than the functions does it.
    """

    states: tuple[str, ...]
    outputs: tuple[str, ...]
    parameters: tuple[str, ...]
    derivative: Function
    output: Function
    size: tuple[float, ...]
    belongs: Mapping[str, str] = field(default_factory=dict)
    rows: Mapping[str, str] = field(default_factory=dict)
    filter: Pass | None = None


def identify_extended_filter_error(
    models: FunctionModel | Sequence[FunctionModel],
    records: Sequence[LinearRecord],
    *,
    start: Mapping[str, float],
    noisy: Collection[str] | None = None,
    own: Collection[str] = (),
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
    method: str = "filter error, extended",
) -> Identification:
    """As `identify_filter_error`, for functions. models: one, or one for each record to learn from,
    with the same names (masses may differ). start: values of all parameters; of noises where known
    better than the outputs' roughness tells. Raises BadInput where one is missing.
    """
    problem = extended_filter(
        models, records, start=start, noisy=noisy, own=own, fixed=fixed, method=method
    )
    model = problem.models[0]
    return search_noises(
        method, problem, model.outputs, model.rows, problem.records, bounds or {}, priors or {},
        algorithm, scales or {}, truth or {}, left_aside(records),
    )  # fmt: skip


def extended_filter(
    models: FunctionModel | Sequence[FunctionModel],
    records: Sequence[LinearRecord],
    *,
    start: Mapping[str, float],
    noisy: Collection[str] | None = None,
    own: Collection[str] = (),
    fixed: Mapping[str, float] | None = None,
    method: str = "filter error, extended",
) -> ExtendedFilter:
    """The filters whose likelihood `identify_extended_filter_error` seeks; arguments as there."""
    learn = learned(records)
    each = [models] * len(learn) if isinstance(models, FunctionModel) else list(models)
    model = each[0]
    unknowns = Unknowns(model, learn, own, without_noises(fixed), initial=True)
    driven = tuple(model.states if noisy is None else noisy)
    missing = [p for p in model.parameters if p not in start and p not in (fixed or {})]
    if missing or not set(driven) <= set(model.states) or len(each) != len(learn):
        raise refuse(
            "no_start",
            where=method,
            expected="a first value for every parameter, states that exist, one model a record",
            found=", ".join(missing) or f"noisy {driven}, {len(each)} models",
            do="Give start values, equation error's for example.",
        )
    return ExtendedFilter(each, learn, unknowns, driven, fixed or {}, start)


class ExtendedFilter(NoisyProblem):
    """Extended filters."""

    def __init__(
        self,
        models: Sequence[FunctionModel],
        records: Sequence[LinearRecord],
        unknowns: Unknowns,
        noisy: Sequence[str],
        fixed: Mapping[str, float],
        start: Mapping[str, float],
    ) -> None:
        self.models = models
        model = models[0]
        theta = np.zeros(len(unknowns.free))
        for r in records:
            for s in model.states:
                name = f"{s}(0)[{r.id}]"
                if name in unknowns.free_names and s in model.outputs:
                    y = r.outputs[:, model.outputs.index(s)]
                    theta[unknowns.free_names.index(name)] = np.mean(y[np.isfinite(y)][:STARTS])
        known = {n: v for n, v in start.items() if n in model.parameters and n not in fixed}
        known |= {n: v for n, v in start.items() if "(0)" in n}
        theta = unknowns.vector(known, theta)
        sensors = first_sensor_noises(model.outputs, records)
        errors: dict[str, list[Array]] = {s: [] for s in model.states}
        for i, (m, r) in enumerate(zip(models, records, strict=True)):
            p = unknowns.of(i, theta)[0]
            x = np.column_stack(
                [
                    r.outputs[:, m.outputs.index(s)]
                    if s in m.outputs
                    else np.full(len(r.t), np.nan)
                    for s in m.states
                ]
            )
            full = np.where(np.isnan(x), 0.0, x)
            e = np.diff(x, axis=0) - r.dt * m.derivative(full, r.inputs, p)[:-1]
            for j, s in enumerate(m.states):
                errors[s].append(e[np.isfinite(e[:, j]), j] / r.dt**0.5)
        guess = {**sensors, **first_process_noises(errors, sensors, records[0].dt), **start}
        super().__init__(
            unknowns, records, model.states, noisy, model.outputs, theta, guess, fixed,
            model.belongs,
        )  # fmt: skip

    def filtered(
        self, maneuver: int, values: Array, x0: Array, intensity: Array, R: Array
    ) -> Innovations | None:
        """Innovations of a maneuver; None where a motion diverges."""
        model, record = self.models[maneuver], self.records[maneuver]
        run = model.filter or partial(function_filter, model, record)
        return run(values, x0, intensity, R)


def function_filter(
    model: FunctionModel, record: LinearRecord, values: Array, x0: Array, intensity: Array, R: Array
) -> Innovations | None:
    """The innovations of one maneuver by the model's functions; arguments as of `Pass`."""
    n, m, s, k = len(record.t), len(values), len(model.states), len(model.outputs)
    h = STEP * np.array(model.size)
    around = np.concatenate([np.zeros((1, s)), np.diag(h), -np.diag(h)])
    p = values[:, None, :]
    Q = intensity[:, :, None] * np.eye(s)
    noise = R[:, :, None] * np.eye(k)
    good = np.isfinite(record.outputs)
    z = np.where(good, record.outputs, 0.0)
    u, dt = record.inputs, record.dt
    v, y, S = np.empty((m, n, k)), np.empty((m, n, k)), np.empty((m, n, k, k))
    x, P = x0, dt * Q
    one = np.eye(k)
    # slopes at the inputs' middle, and how the rate changes from the first to the last
    ahead = np.concatenate([around, np.zeros((2, s))])
    for i in range(n):
        seen = model.output(x[:, None, :] + around, u[i], p)
        y[:, i] = seen[:, 0]
        C = np.swapaxes(seen[:, 1 : s + 1] - seen[:, s + 1 :], -1, -2) / (2.0 * h)
        C = C * good[i][:, None]
        v[:, i] = np.where(good[i], z[i] - y[:, i], 0.0)
        S[:, i] = C @ P @ np.swapaxes(C, -1, -2)
        S[:, i] += np.where(good[i][:, None] & good[i], noise, one)
        K = np.swapaxes(np.linalg.solve(S[:, i], C @ P), -1, -2)
        x = x + (K @ v[:, i, :, None])[:, :, 0]
        if not np.isfinite(x).all():
            return None
        P = P - K @ S[:, i] @ np.swapaxes(K, -1, -2)
        if i < n - 1:
            middle = np.broadcast_to(0.5 * (u[i] + u[i + 1]), (2 * s + 1, u.shape[1]))
            rate = model.derivative(
                x[:, None, :] + ahead, np.concatenate([middle, u[i : i + 2]]), p
            )
            A = np.swapaxes(rate[:, 1 : s + 1] - rate[:, s + 1 : -2], -1, -2) / (2.0 * h)
            phi, share, ramp = _exponentials(A * dt)
            rise = rate[:, -1] - rate[:, -2]
            x = x + dt * (share @ rate[:, 0, :, None] + ramp @ rise[:, :, None])[:, :, 0]
            P = phi @ (P + 0.5 * dt * Q) @ np.swapaxes(phi, -1, -2) + 0.5 * dt * Q
    return Innovations(v, S, y)


def _exponentials(A: Array) -> tuple[Array, Array, Array]:
    """exp(A), phi_1 = (exp(A) - 1) / A and (phi_1 - 1) / A - phi_1 / 2, (m, s, s), by series: a
    sample is short against the motion.

    x + dt phi_1(A dt) f(x) is the exponential Rosenbrock-Euler method (Hochbruck and Ostermann
    2010, with its term for what depends on time): exact where f is linear and inputs run straight
    between samples, of second order elsewhere, with one slope a sample.
    """
    one = np.eye(A.shape[-1])
    power, share = np.broadcast_to(one, A.shape), np.broadcast_to(one, A.shape).copy()
    ramp = np.zeros(A.shape)
    for k in range(2, TERMS + 1):
        power = power @ A / k
        share = share + power
        ramp = ramp + (1.0 / (k + 1) - 0.5) * power
    return one + A @ share, share, ramp
