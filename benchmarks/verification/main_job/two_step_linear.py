"""The filter's NEES beside that of an exactly linear filter under the same noise.

The average normalized estimation error squared (NEES; Bar-Shalom, Li, Kirubarajan 2001, Sec. 5.4)
of 100 runs scatters by 0.02 of the freedom from block to block of seeds, since the errors of
constants persist over a recording. So it tells an overconfident filter only where that is off by
more. A Kalman filter of the model linearized about the truth makes no error of linearization: its
covariance is right by construction, whatever the seeds happen to give. Fed with each seed's own
noise (common random numbers) it shares nearly all of the scatter, and the difference shows what
linearizing about estimates costs: to a few 1e-4 of the freedom.

The linear filter tracks the deviation d from a nominal run, in which motion, wind and biases are
the truth and upwash and sidewash are none (their draws are what it has to find):

    d_i = F_i d_(i-1) + dt/2 (G_(i-1) n_(i-1) + G_i n_i)      z_i - h(nominal_i) = H_i d_i + v_i

with the noise n of the inertial sensors, v of the others, and the Jacobians at the nominal run.
Its covariance takes Q = dt^2 G diag(sigma^2) G' a step, as Alula does; the noise as simulated
belongs half to either neighbor, which moves the expected ratio from 1 by 5e-5.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from alula.base.arrays import Array
from alula.core import core
from alula.flight import Maneuver
from alula.reconstruct.input_noise import input_gain
from alula.reconstruct.problem import Problem, make_problem
from verification.main_job import two_step

SETTLED = 10.0  # s, from which on NEES counts, as in two_step.judge


@dataclass(frozen=True)
class Paired:
    """Mean NEES over the freedom, of the linear filter and of Alula; mean difference over the
    seeds, Alula minus linear, and its standard error; share of the times at which the average NEES
    of each lies within its 95 % bounds.
    """

    linear: float
    alula: float
    difference: float
    error: float
    linear_inside: float
    alula_inside: float


@dataclass(frozen=True)
class Linearized:
    """The nominal run: t (n,) s; states (n, k), inputs (n, 6) and readings (n, s) as ideal sensors
    would show them; Jacobians `forward` (n - 1, k, k), `gain` (n, k, 6), `seen` (n, s, k).
    """

    t: Array
    states: Array
    inputs: Array
    readings: Array
    forward: Array
    gain: Array
    seen: Array


def _problem(path: Path, seed: int, every: int, end: float) -> tuple[Problem, two_step.Truth]:
    """The problem Alula's filter is given by this seed, and the truth."""
    flight, truth = two_step.make_flight(path, seed, every)
    maneuver = Maneuver(flight.id, flight.id, "", 0.0, end)
    spec = two_step.make_spec(flight.id)
    return make_problem({flight.id: flight}, [maneuver], two_step.citation(), spec), truth


def linearize(problem: Problem, truth: two_step.Truth) -> Linearized:
    """Linear model of `problem` about the truth without upwash, exact Jacobians by the core."""
    t, motion = problem.records[0].t, problem.motion
    n, k = len(t), len(problem.names)
    if not np.array_equal(t, truth.t[:n]):
        raise ValueError("the record's samples are not those of the truth")
    states = np.empty((n, k))
    states[:, :motion] = truth.motion[:n]
    for i, unknown in enumerate(problem.unknowns):
        upwash = unknown.name.startswith("k_")
        states[:, motion + i] = 0.0 if upwash else truth.constants[unknown.name]
    inputs = np.ascontiguousarray(truth.inputs[:n] + two_step.IMU_BIAS)
    model = problem.model()
    forward = np.tile(np.eye(k), (n - 1, 1, 1))
    seen = np.empty((n, len(problem.sensors), k))
    for i in range(n):
        step = slice(i, min(i + 2, n))
        loop = core.path_open_loop(model, t[step], inputs[step], states[i], None, jacobian=True)
        seen[i] = loop["readings_jacobian"][0]
        if i < n - 1:
            forward[i, :motion] = loop["motion_jacobian"][1]
    gain = np.zeros((n, k, 6))
    gain[:, :motion] = input_gain(truth.motion[:n])
    readings = core.path_readings(model, inputs, states)
    return Linearized(t, states, inputs, readings, forward, gain, seen)


def linear_nees(
    path: Path, seeds: Sequence[int], picked: Sequence[int], every: int = 1, end: float = 120.0
) -> tuple[Array, int]:
    """NEES (seeds, m) of the linear filter at the m samples `picked`, and its freedom.

    Starts at Alula's first estimate; what the data do not tell is left out by the rule of
    `two_step.run`.
    """
    problem, truth = _problem(path, seeds[0], every, end)
    model = linearize(problem, truth)
    motion, (n, k) = problem.motion, model.states.shape
    noise = np.empty((n, 6, len(seeds)))  # of the inertial sensors
    residual = np.empty((n, len(problem.sensors), len(seeds)))
    d, true = np.empty((k, len(seeds))), np.zeros((k, len(seeds)))
    for s, seed in enumerate(seeds):
        own, drawn = _problem(path, seed, every, end)
        noise[:, :, s] = own.records[0].inputs - model.inputs
        residual[:, :, s] = own.records[0].readings - model.readings
        d[:motion, s], d[motion:, s] = own.initial[0, :motion], [u.value for u in own.unknowns]
        d[:, s] -= model.states[0]
        for i, unknown in enumerate(own.unknowns):
            if unknown.name.startswith("k_"):
                true[motion + i, s] = drawn.constants[unknown.name]
    prior = np.array([u.prior for u in problem.unknowns])
    P = np.diag(np.concatenate([problem.initial[0, motion:], prior]) ** 2)
    R = np.array([sensor.sigma for sensor in problem.sensors]) ** 2
    errors, covariances = [], []
    wanted = set(picked)
    for i in range(n):
        if i:
            F, G, dt = model.forward[i - 1], model.gain, model.t[i] - model.t[i - 1]
            Q = dt**2 * (G[i - 1] * problem.imu_sigma**2) @ G[i - 1].T
            P = F @ P @ F.T + Q
            d = F @ d + 0.5 * dt * (G[i - 1] @ noise[i - 1] + G[i] @ noise[i])
        H = model.seen[i]
        K = np.linalg.solve(H @ P @ H.T + np.diag(R), H @ P).T
        left = np.eye(k) - K @ H
        P = left @ P @ left.T + (K * R) @ K.T  # Joseph's form
        d = d + K @ (residual[i] - H @ d)
        if i in wanted:
            errors.append(d - true)
            covariances.append(P)
    told = np.sqrt(np.diagonal(covariances[-1]))[motion:] < 0.5 * prior
    keep = np.flatnonzero(np.concatenate([np.ones(motion, bool), told]))
    error = np.array(errors)[:, keep]
    weighed = np.linalg.solve(np.array(covariances)[:, keep[:, None], keep], error)
    return np.einsum("mks,mks->sm", error, weighed), len(keep)


def paired_nees(
    path: Path, seeds: Iterable[int], filter_: str = "ekf", every: int = 1, end: float = 120.0
) -> Paired:
    """Alula's filter and the linear one on one recording, over the same seeds, two or more."""
    seeds = tuple(seeds)
    runs = [two_step.run(path, seed, filter_, every, end) for seed in seeds]
    times, freedom = runs[0].times, np.array([run.freedom for run in runs])
    picked = np.rint(times / (every * two_step.DT)).astype(int).tolist()
    linear, linear_freedom = linear_nees(path, seeds, picked, every, end)
    late = times > SETTLED
    linear, alula = linear[:, late], np.array([run.nees for run in runs])[:, late]
    by_seed = alula.mean(axis=1) / freedom - linear.mean(axis=1) / linear_freedom
    return Paired(
        float(linear.mean() / linear_freedom),
        float(np.mean(alula.mean(axis=1) / freedom)),
        float(by_seed.mean()),
        float(by_seed.std(ddof=1) / np.sqrt(len(seeds))),
        two_step.share_inside(linear.sum(axis=0), linear_freedom * len(seeds)),
        two_step.share_inside(alula.sum(axis=0), int(freedom.sum())),
    )


def paired_table(
    folder: Path,
    seeds: Iterable[int] = range(100),
    recordings: Iterable[str] = two_step.RECORDINGS,
    every: int = 1,
    workers: int = 2,
) -> dict[str, Paired]:
    """`paired_nees` of every recording in `folder`, side by side; the full table takes minutes."""
    seeds = tuple(seeds)
    with ProcessPoolExecutor(workers) as pool:
        jobs = {
            name: pool.submit(paired_nees, folder / f"{name}.mat", seeds, every=every)
            for name in recordings
        }
        return {name: job.result() for name, job in jobs.items()}
