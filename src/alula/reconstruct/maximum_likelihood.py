"""Maximum-likelihood path reconstruction: constant unknowns and initial states by output error.

The kinematics are integrated open loop from each maneuver's initial state; initial states and
unknowns minimize the sum over the sensors of N ln(mean squared residual), which is the likelihood
with the measurement covariance estimated along (Dittrich 2016, Eq. (3.54) to (3.61), step sign as
the errata; Jategaonkar 2015, Ch. 10). Gauss-Newton with Levenberg-Marquardt damping; sensitivities
are exact (core: run_open_loop). Standard errors allow for coloured residuals and for the noise of
the inertial sensors, which the method itself takes as exact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.coloured import coloured_covariance
from alula.base.messages import Message, warn
from alula.core import core
from alula.reconstruct.input_noise import scatter_by_inputs
from alula.reconstruct.problem import Problem
from alula.reconstruct.record import Record
from alula.reconstruct.solution import RecordSolution, Solution

MAX_ITERATIONS = 60
SETTLED = 1e-4  # standard errors: what a step may still move any parameter
_LEAST_SIGMA = 1e-3  # of the stated noise: an exact fit must not make a sensor infinitely certain


@dataclass
class _Fit:
    """Residuals and Jacobians of one record at the present estimate."""

    motion: Array
    motion_jacobian: Array
    fitted: Array
    residual: Array  # (n, sensors), 0 where there is no reading
    jacobian: Array  # (n, sensors, states), 0 likewise
    valid: np.ndarray


class _Layout:
    """Where things stand in the parameter vector: unknowns, then each maneuver's initial motion."""

    def __init__(self, problem: Problem, estimate_initial: bool) -> None:
        self.motion, self.unknowns = problem.motion, len(problem.unknowns)
        self.maneuvers = len(problem.records) if estimate_initial else 0
        self.size = self.unknowns + self.maneuvers * self.motion

    def columns(self, maneuver: int) -> np.ndarray:
        """Parameters of the state (motion, unknowns) of a maneuver; -1: not a parameter."""
        first = self.unknowns + maneuver * self.motion
        motion = np.arange(first, first + self.motion)
        if not self.maneuvers:
            motion = np.full(self.motion, -1)
        return np.concatenate([motion, np.arange(self.unknowns)])


def solve_ml(problem: Problem, estimate_initial: bool = True) -> Solution:
    """Constants and initial states of all maneuvers at once; the covariance of what is found."""
    layout = _Layout(problem, estimate_initial)
    model = problem.model()
    prior = np.array([u.prior for u in problem.unknowns])
    mean = np.array([u.value for u in problem.unknowns])
    p = np.concatenate([mean, problem.initial[: layout.maneuvers, : problem.motion].ravel()])
    stated = np.array([s.sigma for s in problem.sensors])

    def evaluate(p: Array) -> tuple[list[_Fit], Array, float]:
        fits = [
            _evaluate(problem, model, k, _state(problem, layout, p, k))
            for k in range(len(problem.records))
        ]
        sigma = _noise(fits, stated)
        counts = sum(f.valid.sum(axis=0) for f in fits)
        cost = float(np.sum(counts * np.log(sigma)))
        cost += 0.5 * float(np.sum(((p[: layout.unknowns] - mean) / prior) ** 2))
        return fits, sigma, cost if np.isfinite(cost) else np.inf

    fits, sigma, cost = evaluate(p)
    damping, iterations, converged = 1e-3, 0, False
    while iterations < MAX_ITERATIONS and not converged:
        iterations += 1
        information, gradient = _normal(layout, fits, sigma)
        information[range(layout.unknowns), range(layout.unknowns)] += prior**-2.0
        gradient[: layout.unknowns] -= (p[: layout.unknowns] - mean) / prior**2
        scale = np.sqrt(np.maximum(np.diagonal(information), 1e-300))
        unit = information / np.outer(scale, scale)
        while True:
            step = np.linalg.lstsq(unit + damping * np.eye(len(unit)), gradient / scale, rcond=None)
            change = step[0] / scale
            trial_fits, trial_sigma, trial_cost = evaluate(p + change)
            if trial_cost <= cost + 1e-9 * abs(cost) or damping > 1e8:
                break
            damping *= 10.0
        se = np.sqrt(np.maximum(np.diagonal(np.linalg.pinv(unit)), 0.0)) / scale
        if damping > 1e8:
            break
        moved = float(np.max(np.abs(change) / np.maximum(se, 1e-300), initial=0.0))
        noise_moved = float(np.max(np.abs(trial_sigma / sigma - 1.0)))
        p, fits, sigma, cost = p + change, trial_fits, trial_sigma, trial_cost
        damping = max(damping / 10.0, 1e-12)
        converged = moved < SETTLED * 10.0 and noise_moved < SETTLED

    information, _ = _normal(layout, fits, sigma)
    information[range(layout.unknowns), range(layout.unknowns)] += prior**-2.0
    scale = np.sqrt(np.maximum(np.diagonal(information), 1e-300))
    dispersion = np.linalg.pinv(information / np.outer(scale, scale)) / np.outer(scale, scale)
    white = np.sqrt(np.maximum(np.diagonal(dispersion)[: layout.unknowns], 0.0))
    inputs = dispersion @ _by_inputs(problem, layout, fits, sigma) @ dispersion
    stated = np.zeros(layout.size)
    stated[: layout.unknowns] = prior**-2.0
    believed = (dispersion * stated) @ dispersion
    covariance = _coloured(layout, fits, sigma, dispersion, inputs, believed)
    status, messages = _verdict(converged, iterations)
    return Solution(
        records=tuple(
            _record(problem, layout, record, fit, covariance, _state(problem, layout, p, k), k)
            for k, (record, fit) in enumerate(zip(problem.records, fits, strict=True))
        ),
        constants=p[: layout.unknowns],
        covariance=covariance[: layout.unknowns, : layout.unknowns],
        informed=1.0 - np.minimum(white / prior, 1.0),
        sigma=sigma,
        nis=float("nan"),
        readings=int(sum(int(f.valid.sum()) for f in fits)),
        converged=converged,
        status=status,
        messages=tuple(messages),
    )


def _verdict(converged: bool, iterations: int) -> tuple[str, list[Message]]:
    if converged:
        return f"converged after {iterations} iterations", []
    message = warn(
        "not_converged",
        where="reconstruction, filter 'ml'",
        expected=f"steps below {SETTLED * 10:g} standard errors",
        found=f"larger ones after {iterations} iterations",
        do="Check units and signs on the log card, free fewer unknowns, or take filter 'ekf'.",
    )
    return "not converged; " + message.do, [message]


def _state(problem: Problem, layout: _Layout, p: Array, k: int) -> Array:
    """Initial motion and unknowns of maneuver k."""
    if not layout.maneuvers:
        return np.concatenate([problem.initial[k, : problem.motion], p[: layout.unknowns]])
    state: Array = p[layout.columns(k)]
    return state


def _evaluate(problem: Problem, model: core.PathModel, k: int, state: Array) -> _Fit:
    record = problem.records[k]
    out = core.path_open_loop(model, record.t, record.inputs, state, problem.held[k])
    residual = record.readings - out["readings"]
    for i, sensor in enumerate(problem.sensors):
        if sensor.kind in ("phi", "psi"):
            residual[:, i] -= 2.0 * np.pi * np.round(residual[:, i] / (2.0 * np.pi))
    valid = np.isfinite(residual)
    return _Fit(
        motion=out["motion"],
        motion_jacobian=out["motion_jacobian"],
        fitted=out["readings"],
        residual=np.where(valid, residual, 0.0),
        jacobian=np.where(valid[:, :, None], out["readings_jacobian"], 0.0),
        valid=valid,
    )


def _noise(fits: list[_Fit], stated: Array) -> Array:
    """Each sensor's standard deviation by its residuals. Dittrich 2016, Eq. (3.51)."""
    squares = np.sum([np.sum(f.residual**2, axis=0) for f in fits], axis=0)
    counts = np.maximum(np.sum([f.valid.sum(axis=0) for f in fits], axis=0), 1)
    out: Array = np.maximum(np.sqrt(squares / counts), _LEAST_SIGMA * stated)
    return out


def _normal(layout: _Layout, fits: list[_Fit], sigma: Array) -> tuple[Array, Array]:
    """Information matrix and gradient. Dittrich 2016, Eq. (3.61), (3.64)."""
    information, gradient = np.zeros((layout.size, layout.size)), np.zeros(layout.size)
    for k, fit in enumerate(fits):
        columns = layout.columns(k)
        used = columns >= 0
        at = columns[used]
        J = (fit.jacobian / sigma[None, :, None]).reshape(-1, len(columns))[:, used]
        information[np.ix_(at, at)] += J.T @ J
        gradient[at] += J.T @ (fit.residual / sigma).ravel()
    return information, gradient


def _by_inputs(problem: Problem, layout: _Layout, fits: list[_Fit], sigma: Array) -> Array:
    """Covariance of the gradient that the inertial sensors' noise causes."""
    total, m = np.zeros((layout.size, layout.size)), problem.motion
    for k, (record, fit) in enumerate(zip(problem.records, fits, strict=True)):
        columns = layout.columns(k)
        used = columns >= 0
        J = fit.jacobian / sigma[None, :, None]
        weighted = J[:, :, used].swapaxes(1, 2) @ J[:, :, :m]
        own = scatter_by_inputs(
            record.t, fit.motion, fit.motion_jacobian[:, :, :m], weighted, problem.imu_sigma
        )
        total[np.ix_(columns[used], columns[used])] += own
    return total


def _coloured(
    layout: _Layout,
    fits: list[_Fit],
    sigma: Array,
    dispersion: Array,
    inputs: Array,
    believed: Array,
) -> Array:
    """Covariance with coloured residuals, sensor by sensor and maneuver by maneuver.

    inputs: covariance that the inertial sensors' noise causes; believed: that the prior leaves.
    """
    blocks = []
    for k, fit in enumerate(fits):
        columns = layout.columns(k)
        used = columns >= 0
        for i in range(len(sigma)):
            whole = np.zeros((len(fit.residual), layout.size))
            whole[:, columns[used]] = fit.jacobian[:, i, used] / sigma[i]
            blocks.append((whole, fit.residual[:, i] / sigma[i]))
    coloured = coloured_covariance(blocks, dispersion).covariance + believed
    # Never more certain than white noise of that size and the inertial sensors' noise allow.
    least = np.diagonal(dispersion) + np.diagonal(inputs)
    lift = np.sqrt(np.maximum(least / np.diagonal(coloured), 1.0))
    return np.asarray(coloured * np.outer(lift, lift))


def _record(
    problem: Problem,
    layout: _Layout,
    record: Record,
    fit: _Fit,
    covariance: Array,
    state: Array,
    k: int,
) -> RecordSolution:
    n, motion = len(record.t), problem.motion
    constants = np.broadcast_to(state[motion:], (n, layout.unknowns))
    jacobian = np.zeros((n, motion + layout.unknowns, layout.size))  # states by parameters
    columns = layout.columns(k)
    used = columns >= 0
    jacobian[:, :motion, columns[used]] = fit.motion_jacobian[:, :, used]
    jacobian[:, motion:, : layout.unknowns] = np.eye(layout.unknowns)
    values, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    shifts = jacobian @ root  # (n, k, directions)
    nothing = np.full_like(fit.residual, np.nan)
    return RecordSolution(
        states=np.column_stack([fit.motion, constants]),
        states_se=np.sqrt(np.sum(shifts**2, axis=2)),
        fitted=fit.fitted,
        innovation=nothing,
        deviation=nothing,
        start=state,
        doubt=np.moveaxis(shifts, 2, 0),
    )
