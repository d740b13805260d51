"""Extended and unscented filter with Rauch-Tung-Striebel smoother, over all maneuvers in a row.

At the start of each maneuver the motion begins anew, the unknowns carry on; so several maneuvers
estimate one set of unknowns. The filters themselves are the core's: core/include/alula/filters.
Source: van den Hoek 2017, Sec. 3; Dittrich 2016, Sec. 3.1.4; Rauch, Tung, Striebel 1965.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse, warn
from alula.core import core
from alula.reconstruct.problem import Problem
from alula.reconstruct.solution import RecordSolution, Solution


def solve_ekf(problem: Problem) -> Solution:
    """The extended filter and its smoother. Raises BadInput where it loses its covariance."""
    return _solve(problem, "ekf")


def solve_ukf(problem: Problem) -> Solution:
    """The unscented filter and its smoother. Raises BadInput where it loses its covariance."""
    return _solve(problem, "ukf")


def _solve(problem: Problem, method: Literal["ekf", "ukf"]) -> Solution:
    if any(held is not None for held in problem.held):
        raise refuse(
            "given_needs_ml",
            where="reconstruct.given",
            expected='filter = "ml", which can take states as measured',
            found=f'filter = "{method}"',
            do="Take the entry out: a filter weighs these channels as sensors.",
        )
    model = problem.model()
    run = core.path_ekf if method == "ekf" else core.path_ukf
    lengths = [len(r.t) for r in problem.records]
    starts = np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(int)
    start = np.full(sum(lengths), -1, dtype=np.int32)
    start[starts] = np.arange(len(lengths))
    inputs = np.concatenate([r.inputs for r in problem.records])
    n, motion = model.states, model.motion
    prior = np.array([u.prior for u in problem.unknowns])
    out = run(
        model,
        np.concatenate([r.t for r in problem.records]),
        inputs,
        np.concatenate([r.readings for r in problem.records]),
        start,
        problem.initial,
        np.concatenate([np.zeros(motion), [u.value for u in problem.unknowns]]),
        np.concatenate([np.zeros(motion), prior]),
        smooth=True,
    )
    if out["done"] < len(inputs) or out["reached"] > 0:
        raise _lost(problem, lengths, out["done"] if out["done"] < len(inputs) else out["reached"])
    x, covariance = out["x"], _unpack(out["covariance"], n)
    constants, constants_cov = _constants(problem, x, covariance, starts, lengths)
    se = np.sqrt(np.maximum(np.diagonal(covariance, axis1=1, axis2=2), 0.0))
    fitted = core.path_readings(model, inputs, np.ascontiguousarray(x))
    doubt = _doubt(covariance, motion)
    records = [
        RecordSolution(
            states=x[a:b],
            states_se=se[a:b],
            fitted=fitted[a:b],
            innovation=out["innovation"][a:b],
            deviation=out["deviation"][a:b],
            start=x[a],
            doubt=doubt[:, a:b],
        )
        for a, b in zip(starts, starts + lengths, strict=True)
    ]
    walks = np.array([u.walk > 0.0 for u in problem.unknowns], dtype=bool)
    final = np.sqrt(np.diagonal(constants_cov))
    messages: list[Message] = []
    if out["repairs"]:
        messages.append(
            warn(
                "covariance_repaired",
                where=f"filter {method}",
                expected="a covariance well inside the range of double precision",
                found=f"{out['repairs']} directions held up against rounding",
                do="Some noise levels are many orders apart; check [reconstruct.sensors] and imu.",
            )
        )
    return Solution(
        records=tuple(records),
        constants=constants,
        covariance=constants_cov,
        informed=np.where(walks, 1.0 - np.minimum(final / prior, 1.0), 1.0 - final / prior),
        sigma=np.array([s.sigma for s in problem.sensors]),
        nis=float(np.sum(out["nis"])),
        readings=int(np.sum(np.isfinite(out["deviation"]))),
        converged=True,
        status="forward and backward over all samples",
        messages=tuple(messages),
    )


def _lost(problem: Problem, lengths: list[int], sample: int) -> BadInput:
    k = 0
    while k + 1 < len(lengths) and sample >= lengths[k]:
        sample -= lengths[k]
        k += 1
    record = problem.records[k]
    at = record.t[min(sample, len(record.t) - 1)]
    return refuse(
        "filter_diverged",
        where=f"maneuver {record.maneuver.id} at {at:.6g} s",
        expected="a covariance that stays positive and finite",
        found="one that is not",
        do="Check units, signs and noise levels; the log card shows each channel's range.",
    )


def _unpack(packed: Array, n: int) -> Array:
    full = np.empty((len(packed), n, n))
    i, j = np.triu_indices(n)
    full[:, i, j] = packed
    full[:, j, i] = packed
    return full


def _constants(
    problem: Problem, x: Array, covariance: Array, starts: Array, lengths: list[int]
) -> tuple[Array, Array]:
    """Mean of each unknown over the record, with the covariance at its middle."""
    middle = int(starts[0] + sum(lengths) // 2)
    return x[:, problem.motion :].mean(axis=0), covariance[
        middle, problem.motion :, problem.motion :
    ]


def _doubt(covariance: Array, motion: int) -> Array:
    """(d, n, k): the states' shift along each column of the unknowns' covariance factor.

    What is left of the motion's uncertainty when the unknowns are known is fresh noise at every
    instant, which the coefficients' own residuals show.
    """
    n, k = covariance.shape[:2]
    if k == motion:
        return np.zeros((0, n, k))
    constants = covariance[:, motion:, motion:]
    values, vectors = np.linalg.eigh(constants[n // 2])
    root = vectors * np.sqrt(np.maximum(values, 0.0))  # columns: one standard deviation each
    gain = np.linalg.solve(constants, covariance[:, motion:, :])  # (n, constants, k)
    out: Array = np.einsum("cd,nck->dnk", root, gain)
    return out
