"""Time skew between channels: how late each sensor's clock is against the inertial sensor's.

A reading that is late by tau differs from the reconstruction by -tau times the rate of change of
what it measures. The residuals of the open loop are therefore regressed on that rate, beside the
constants that the reconstruction estimates anyway; the error bar allows for coloured residuals.
Klein and Morelli, Aircraft System Identification, AIAA 2006, Sec. 10.2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.coloured import coloured_covariance
from alula.core import core
from alula.reconstruct.problem import Problem
from alula.reconstruct.solution import Solution


@dataclass(frozen=True)
class Skew:
    """delay_s: the channel's sample was true that long before its stamp. se: its error."""

    channel: str
    delay_s: float
    se: float

    @property
    def significant(self) -> bool:
        """Beyond three standard errors."""
        return abs(self.delay_s) > 3.0 * self.se


def time_skews(problem: Problem, solution: Solution) -> tuple[Skew, ...]:
    """The delay of every sensor that changes enough to tell; linear, so good for small delays."""
    out = []
    model = problem.model(list(solution.sigma))
    loops = [
        core.path_open_loop(model, r.t, r.inputs, np.ascontiguousarray(s.start), held)
        for r, s, held in zip(problem.records, solution.records, problem.held, strict=True)
    ]
    for i, sensor in enumerate(problem.sensors):
        blocks: list[tuple[Array, Array]] = []
        for record, loop in zip(problem.records, loops, strict=True):
            residual = record.readings[:, i] - loop["readings"][:, i]
            if sensor.kind in ("phi", "psi"):
                residual -= 2.0 * np.pi * np.round(residual / (2.0 * np.pi))
            valid = np.isfinite(residual)
            if valid.sum() < 20:
                continue
            rate = -np.gradient(loop["readings"][:, i], record.t)[valid]
            J = loop["readings_jacobian"][valid, i, :]
            others = J[:, np.ptp(J, axis=0) > 0.0]
            blocks.append((np.column_stack([rate, np.ones(valid.sum()), others]), residual[valid]))
        skew = _regress(sensor.channel, blocks)
        if skew is not None:
            out.append(skew)
    return tuple(out)


def _regress(channel: str, blocks: Sequence[tuple[Array, Array]]) -> Skew | None:
    """Delay common to all maneuvers; everything else is each maneuver's own and projected out."""
    projected = []
    for X, y in blocks:
        if np.ptp(X[:, 0]) == 0.0:
            continue
        rest = X[:, 1:] / np.maximum(np.linalg.norm(X[:, 1:], axis=0), 1e-300)
        basis, singular, _ = np.linalg.svd(rest, full_matrices=False)
        basis = basis[:, singular > 1e-9 * singular[0]]
        rate = X[:, 0] - basis @ (basis.T @ X[:, 0])
        # A rate that the unknowns imitate tells nothing of the clock.
        if np.linalg.norm(rate) > 0.05 * np.linalg.norm(X[:, 0] - X[:, 0].mean()):
            projected.append((rate[:, None], y - basis @ (basis.T @ y)))
    if not projected:
        return None
    information = sum(float(x[:, 0] @ x[:, 0]) for x, _ in projected)
    delay = sum(float(x[:, 0] @ y) for x, y in projected) / information
    residuals = [(x, y - delay * x[:, 0]) for x, y in projected]
    coloured = coloured_covariance(residuals, np.array([[1.0 / information]])).corrected
    return Skew(channel, delay, float(np.sqrt(coloured[0, 0])))
