"""The core's Kalman filters with Rauch-Tung-Striebel smoother, over all maneuvers in a row.

At the start of each maneuver the motion begins anew, the unknowns carry on; so several maneuvers
estimate one set of unknowns. The filters themselves are the core's: core/include/alula/filters.
Source: van den Hoek 2017, Sec. 3; Dittrich 2016, Sec. 3.1.4; Rauch, Tung, Striebel 1965.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse, warn
from alula.core import core
from alula.reconstruct.filter_colour import lift, white
from alula.reconstruct.problem import Problem
from alula.reconstruct.solution import RecordSolution, Solution
from alula.reconstruct.tempering import MOST_PASSES, SETTLED, Start, nearer, restored
from alula.reconstruct.unknowns import WIND

# One filter: its header in core/include/alula/filters, its line in bindings/path.cpp, one here.
RUNS: Mapping[str, Callable[..., dict[str, Any]]] = {
    "ekf": core.path_ekf,
    "iekf": core.path_iekf,
    "ukf": core.path_ukf,
    "srukf": core.path_srukf,
}


def filter_forward(problem: Problem, method: str, picked: Array) -> tuple[Array, Array]:
    """The filter `method` of RUNS without smoother: states (m, k) and covariances (m, k, k).

    Given the readings so far, at samples `picked` (m,) of all records in a row. Raises BadInput as
    solve_filter does.
    """
    stated, used, _ = _settle(problem, method)
    out, _, _ = _run(problem, method, used, smooth=False)
    covariance = _unpack(out["covariance"][picked], out["x"].shape[1])
    return restored(out["x"][picked], covariance, problem.motion, used, stated)


def _settle(problem: Problem, method: str) -> tuple[Start, Start, bool]:
    """Stated start of the constants, the start near their estimates, and whether they settled.

    Where nothing multiplies, or the passes do not settle, both starts are the stated one.
    """
    names = [u.name for u in problem.unknowns]
    stated = Start(
        np.array([u.value for u in problem.unknowns]), np.array([u.prior for u in problem.unknowns])
    )
    multiply = np.array(  # of truth values, also where nothing is unknown
        [(u.name in WIND or u.name.startswith("k_")) and u.walk == 0.0 for u in problem.unknowns],
        dtype=bool,
    )
    if not any(name.startswith("k_") for name in names):
        return stated, stated, True
    used, last = stated, stated.mean
    for _ in range(MOST_PASSES):
        out, _, _ = _run(problem, method, used, smooth=False, keep=False)
        x, P = restored(out["x"][-1:], out["final_covariance"][None], problem.motion, used, stated)
        now = x[0, problem.motion :]
        se = np.sqrt(np.maximum(np.diagonal(P[0])[problem.motion :], 0.0))
        if not np.all((se > 0.0) & (se < 1.01 * stated.deviation)):
            break
        if np.all((np.abs(now - last) < SETTLED * se)[multiply]):
            return stated, used, True
        used, last = nearer(stated, now, se, multiply), now
    return stated, stated, False


def _run(
    problem: Problem,
    method: str,
    constants: Start,
    smooth: bool,
    keep: bool = True,
) -> tuple[dict[str, Any], list[int], Array]:
    """What the core hands back, the records' lengths and first samples.

    Raises BadInput where the filter loses its covariance.
    """
    if any(held is not None for held in problem.held):
        raise refuse(
            "given_needs_ml",
            where="reconstruct.given",
            expected='filter = "ml", which can take states as measured',
            found=f'filter = "{method}"',
            do="Take the entry out: a filter weighs these channels as sensors.",
        )
    lengths = [len(r.t) for r in problem.records]
    starts = np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(int)
    start = np.full(sum(lengths), -1, dtype=np.int32)
    start[starts] = np.arange(len(lengths))
    inputs = np.concatenate([r.inputs for r in problem.records])
    none = np.zeros(problem.motion)
    out = RUNS[method](
        problem.model(),
        np.concatenate([r.t for r in problem.records]),
        inputs,
        np.concatenate([r.readings for r in problem.records]),
        start,
        problem.initial,
        np.concatenate([none, constants.mean]),
        np.concatenate([none, constants.deviation]),
        smooth=smooth,
        keep_covariance=keep,
    )
    if out["done"] < len(inputs) or out["reached"] > 0:
        raise _lost(problem, lengths, out["done"] if out["done"] < len(inputs) else out["reached"])
    return out, lengths, starts


def solve_filter(problem: Problem, method: str) -> Solution:
    """The filter `method` of RUNS and its smoother. Raises BadInput where it is lost."""
    stated, used, settled = _settle(problem, method)
    out, lengths, starts = _run(problem, method, used, smooth=True)
    model = problem.model()
    inputs = np.concatenate([r.inputs for r in problem.records])
    n, motion = model.states, model.motion
    prior = stated.deviation
    x, covariance = restored(out["x"], _unpack(out["covariance"], n), motion, used, stated)
    walks = np.array([u.walk > 0.0 for u in problem.unknowns], dtype=bool)
    constants, constants_cov = _constants(problem, x, covariance, starts, lengths)
    final = np.sqrt(np.diagonal(constants_cov))
    raised = _lift(problem, out, starts, lengths, constants, final, prior, walks)
    constants_cov = constants_cov * np.outer(raised, raised)
    se = np.sqrt(np.maximum(np.diagonal(covariance, axis1=1, axis2=2), 0.0))
    fitted = core.path_readings(model, inputs, np.ascontiguousarray(x))
    se[:, motion:] *= raised
    doubt = _doubt(covariance, motion, raised)
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
    messages: list[Message] = []
    if not settled:
        messages.append(
            warn(
                "not_settled",
                where=f"filter {method}",
                expected=f"passes that agree within {SETTLED:g} standard errors",
                found=f"constants that still moved after {MOST_PASSES}",
                do="Free fewer unknowns, narrow their priors, or compare with filter 'ml'.",
            )
        )
    if out["unsettled"]:
        messages.append(
            warn(
                "update_not_converged",
                where=f"filter {method}",
                expected="updates that settle within the bound on passes",
                found=f"{out['unsettled']} of {len(inputs)} that still moved",
                do="State priors nearer to the start of the motion, or compare with another "
                "filter: those readings contradict what the filter knew.",
            )
        )
    if out["repairs"]:
        messages.append(
            warn(
                "covariance_repaired",
                where=f"filter {method}",
                expected="a covariance well inside the range of double precision",
                found=f"{out['repairs']} directions held up against rounding, or spreads beyond "
                "what the equations of motion can take",
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
        converged=not out["unsettled"],
        status="forward and backward over all samples"
        + (f"; {out['unsettled']} updates did not converge" if out["unsettled"] else ""),
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


def _lift(
    problem: Problem,
    out: dict[str, Any],
    starts: Array,
    lengths: list[int],
    constants: Array,
    se: Array,
    prior: Array,
    walks: np.ndarray,
) -> Array:
    """Factors on the constants' standard errors where the innovations are not white."""

    def split(run: dict[str, Any]) -> list[Array]:
        e = run["innovation"] / run["deviation"]
        return [e[a:b] for a, b in zip(starts, starts + lengths, strict=True)]

    if white(split(out)):
        return np.ones(len(se))

    def innovations(start: Start) -> list[Array]:
        return split(_run(problem, "ekf", start, smooth=False, keep=False)[0])

    return lift(innovations, constants, se, prior, np.flatnonzero(~walks).tolist())


def _doubt(covariance: Array, motion: int, raised: Array) -> Array:
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
    root = raised[:, None] * root
    gain = np.linalg.solve(constants, covariance[:, motion:, :])  # (n, constants, k)
    out: Array = np.einsum("cd,nck->dnk", root, gain)
    return out
