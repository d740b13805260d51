"""The reconstruction's uncertainty carried into an estimate by filter error.

As `carried` does for output error. Readings one standard deviation off go through the filter at the
estimate; what that changes of its whitened innovations e moves the estimate by one Gauss-Newton
step, `(X'X)^-1 X' de`. X are the sensitivities of e; the information X'X has those of its products,
too, from which the noises are known. The products themselves are left out: e is as often above zero
as below, so that their change, e de, has no mean. de is half of the change between readings off to
either side: what both do alike has no direction.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array
from alula.identify.flown.carried import Shifts, has_values, with_steps
from alula.identify.flown.extended_filter_error import ExtendedFilter, extended_filter
from alula.identify.flown.filter_error import core_filter, flight_filters
from alula.identify.flown.flight_functions import NO_TIES, Ties
from alula.identify.flown.good_enough import good_enough
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.likelihood.innovations import InnovationLikelihood, whitened
from alula.identify.likelihood.named_search import prior_blocks
from alula.identify.likelihood.parameters import Prior
from alula.identify.result import Identification


def carried_by_filter(
    result: Identification,
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    shifts: Sequence[Shifts],
    *,
    states: Sequence[str],
    outputs: Sequence[str],
    noisy: Collection[str] | None = None,
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    tied: Ties = NO_TIES,
    common_constant: bool = True,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    scales: Mapping[str, float] | None = None,
) -> Identification:
    """The result of `identify_flight_filter_error` with the shifts of the readings, one for each
    direction, in its error bars; other arguments as they were there.

    A result in which some parameter has no value is returned as it is.
    """
    if not shifts or not has_values(result):
        return result
    learn = [m for m in maneuvers if not m.maneuver.held_out]
    given = flight_filters(
        learn, models, states, outputs, start, fixed, tied, common_constant=common_constant
    )
    problem = extended_filter(
        given.models, given.records, start=given.start, noisy=noisy, own=given.own, fixed=fixed
    )
    estimate = _estimate(result, problem, bounds or {})
    blocks = InnovationLikelihood(problem.run).blocks(estimate)
    if not blocks:
        return result
    shown = [p.name for p in result.parameters]
    kept = [problem.names.index(n) for n in shown]
    slopes = [b.sensitivity[:, kept] for b in blocks]
    each, k = len(blocks) // len(learn), len(outputs)
    score = np.zeros((len(kept), len(shifts)))
    for i, m in enumerate(learn):
        for s, shift in enumerate(shifts):
            off = shift.get(m.maneuver.id, {})
            if not off.keys() & set(m.outputs):
                continue
            up, down = (_innovations(problem, i, estimate, m, models, off, sign, tied)
                        for sign in (1.0, -1.0))  # fmt: skip
            if up is None or down is None:
                return result
            change = 0.5 * (up - down)
            for X, de in zip(slopes[i * each : i * each + k], change.T, strict=True):
                score[:, s] += X.T @ de
    slopes += [b.sensitivity for b in prior_blocks(shown, estimate[kept], priors or {})]
    information = np.sum([X.T @ X for X in slopes], axis=0)
    step = np.linalg.pinv(information, hermitian=True) @ score
    enough = good_enough(models, (p.name for p in result.parameters))
    return with_steps(result, step, {**enough, **(scales or {})}, problem.logarithmic)


def _estimate(
    result: Identification, problem: ExtendedFilter, bounds: Mapping[str, tuple[float, float]]
) -> Array:
    """The search's vector (k,) at the result; noises that it does not show are at their bound."""
    found = {p.name: p.value for p in result.parameters}
    out = problem.bounds(bounds)[0]
    for j, name in enumerate(problem.names):
        if name in found:
            out[j] = np.log(found[name]) if name in problem.logarithmic else found[name]
    return out


def _innovations(
    problem: ExtendedFilter,
    i: int,
    estimate: Array,
    m: MeasuredManeuver,
    models: Mapping[str, str],
    off: Mapping[str, Array],
    sign: float,
    tied: Ties,
) -> Array | None:
    """Whitened innovations (n, k) of a maneuver with its readings off; None where it diverges."""
    readings = {n: x + sign * off[n] if n in off else x for n, x in m.outputs.items()}
    run = core_filter(replace(m, outputs=readings), models, problem.models[i], tied)
    found = run(*problem.arguments(i, estimate[None, :]))
    return None if found is None else whitened(found.v[0], found.S[0])
