"""Output error for linear models: the likelihood of measured outputs under white noise.

Dittrich 2016, Eq. (3.49) to (3.65). The model is sampled exactly; sensitivities follow from the
sampled model's own derivatives, all parameters at once. The noise covariance is diagonal and
estimated along, R = mean of v v' (Eq. (3.51)), which turns the cost into sum N/2 ln r_i (Eq.
(3.58)). Right where nothing but the inputs moves the aircraft: in turbulence use the filter error.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.likelihood.named_search import prior_blocks, search_named
from alula.identify.likelihood.optimizer import Algorithm, Likelihood, Minimum, Point, minimize
from alula.identify.likelihood.parameters import Fitted, Prior, Whitened, assembled
from alula.identify.linear.model import Hold, LinearModel, sample, sample_derivatives
from alula.identify.linear.record import LinearRecord, Unknowns
from alula.identify.linear.start import first_values
from alula.identify.result import Identification

HUGE = 1e12  # of a state or sensitivity: the model diverges
SMALLEST = 1e-24  # of an output's variance over its mean square: below it is rounding


def identify_linear_output_error(
    model: LinearModel,
    records: Sequence[LinearRecord],
    *,
    own: Collection[str] = (),
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    hold: Hold = "linear",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Parameters of `model` from outputs, over all maneuvers at once.

    own: constants that every maneuver has its own of (trim, biases); initial states always are.
    start: first values where regression's are not good enough. fixed: parameters held. bounds:
    lowest and highest. priors: what is known beforehand. Held-out maneuvers are predicted, with
    their own constants and initial states fitted. Raises BadInput for names that do not exist or no
    maneuver to learn from; a search that fails is a result whose status says why.
    """
    learn = learned(records)
    unknowns = Unknowns(model, learn, own, fixed or {}, initial=True)
    problem = OutputError(model, learn, unknowns, hold)
    found = search(problem.likelihood, model, learn, unknowns, start, bounds, priors, algorithm)
    shown = problem.fitted(found.value) if found.converged else []
    for record in records:
        if record.held_out and found.converged:
            shown += _predicted(model, record, unknowns, found.value, own, hold)
    blocks = problem.blocks(found.value) if found.information.any() else []
    blocks += prior_blocks(unknowns.free_names, found.value, priors or {})
    return assembled(
        "output error",
        unknowns.free_names,
        model.belongs,
        blocks,
        found,
        shown,
        model.rows,
        scales=scales,
        truth=truth,
    )


class OutputError:
    """The likelihood of several maneuvers' outputs."""

    def __init__(
        self, model: LinearModel, records: Sequence[LinearRecord], unknowns: Unknowns, hold: Hold
    ) -> None:
        self.model, self.records, self.unknowns, self.hold = model, records, unknowns, hold
        good = [np.isfinite(r.outputs) for r in records]
        self.count = sum(g.sum(axis=0) for g in good).astype(float)
        self.least = SMALLEST * np.array(
            [
                np.mean(np.concatenate([r.outputs[g[:, i], i] ** 2 for r, g in
                                        zip(records, good, strict=True)])) if self.count[i] else 1.0
                for i in range(len(model.outputs))
            ]
        )  # fmt: skip
        self.least = np.maximum(self.least, 1e-300)

    def likelihood(self, p: Array, derivatives: bool) -> Point | None:
        """Cost with R at its best for p, and gradient and information at that R."""
        parts = [self._residuals(i, p, derivatives) for i in range(len(self.records))]
        runs = [part for part in parts if part is not None]
        if len(runs) < len(parts):
            return None
        r = self._variances([v for v, _ in runs])
        cost = 0.5 * float(self.count @ np.log(r))
        if not derivatives:
            return Point(cost)
        return summed(cost, runs, r)

    def blocks(self, p: Array) -> list[Whitened]:
        """One block per output and maneuver, missing samples left out."""
        runs = [run for i in range(len(self.records)) if (run := self._residuals(i, p, True))]
        deviation = np.sqrt(self._variances([v for v, _ in runs]))
        out = []
        for record, (v, S) in zip(self.records, runs, strict=True):
            for i, size in enumerate(deviation):
                good = np.isfinite(record.outputs[:, i])
                if good.any():
                    out.append(Whitened(S[good, i] / size, v[good, i] / size))
        return out

    def fitted(self, p: Array) -> list[Fitted]:
        """Outputs measured and modeled."""
        out = []
        for i, record in enumerate(self.records):
            y = simulate(self.model, record, *self.unknowns.of(i, p), self.hold)[1]
            out += fitted_outputs(self.model, record, y)
        return out

    def _variances(self, residuals: Sequence[Array]) -> Array:
        """(k,) R of every output."""
        total = sum((np.sum(v**2, axis=0) for v in residuals), np.zeros(len(self.count)))
        out: Array = np.maximum(total / np.maximum(self.count, 1.0), self.least)
        return out

    def _residuals(self, i: int, p: Array, derivatives: bool) -> tuple[Array, Array] | None:
        """v (n, k), zero where nothing was measured, and dy/dp (n, k, free)."""
        record = self.records[i]
        values, x0 = self.unknowns.of(i, p)
        _, y, S = simulate(self.model, record, values, x0, self.hold, derivatives)
        if not np.isfinite(y).all() or np.abs(y).max(initial=0.0) > HUGE:
            return None
        gone = ~np.isfinite(record.outputs)
        v = np.where(gone, 0.0, record.outputs - y)
        if S is None:
            return v, np.zeros((0, 0, 0))
        if not np.isfinite(S).all() or np.abs(S).max(initial=0.0) > HUGE:
            return None
        S = self.unknowns.spread(i, S)
        S[gone] = 0.0
        return v, S


def simulate(
    model: LinearModel,
    record: LinearRecord,
    values: Array,
    x0: Array,
    hold: Hold,
    derivatives: bool = False,
) -> tuple[Array, Array, Array | None]:
    """States (n, s), outputs (n, k) and, if asked for, dy/d(values, x0) (n, k, j + s)."""
    m = model.at(values)
    step = sample(m, record.dt, hold)
    w = record.drive
    n, s, j = len(w), len(x0), len(values)
    push = w[:-1] @ step.now.T + w[1:] @ step.next.T
    x = np.empty((n, s))
    x[0] = x0
    with np.errstate(over="ignore", invalid="ignore"):
        for i in range(n - 1):
            x[i + 1] = step.phi @ x[i] + push[i]
        y = x @ m.C.T + w @ m.D.T
        if not derivatives or not np.isfinite(x).all():
            return x, y, None
        d = sample_derivatives(m, model.slopes, record.dt, hold)
        force = np.zeros((n - 1, s, j + s))
        force[:, :, :j] = (
            np.einsum("jab,ib->iaj", d.phi, x[:-1], optimize=True)
            + np.einsum("jam,im->iaj", d.now, w[:-1], optimize=True)
            + np.einsum("jam,im->iaj", d.next, w[1:], optimize=True)
        )
        X = np.zeros((n, s, j + s))
        X[0, :, j:] = np.eye(s)
        for i in range(n - 1):
            X[i + 1] = step.phi @ X[i] + force[i]
        S = np.einsum("ka,iaj->ikj", m.C, X)
        S[:, :, :j] += np.einsum("jka,ia->ikj", model.slopes.C, x, optimize=True)
        S[:, :, :j] += np.einsum("jkm,im->ikj", model.slopes.D, w, optimize=True)
    return x, y, S


def search(
    likelihood: Likelihood,
    model: LinearModel,
    records: Sequence[LinearRecord],
    unknowns: Unknowns,
    start: Mapping[str, float] | None,
    bounds: Mapping[str, tuple[float, float]] | None,
    priors: Mapping[str, Prior] | None,
    algorithm: Algorithm,
) -> Minimum:
    """The search from regression's first values, `start` in their place where given."""
    first = unknowns.vector(start or {}, first_values(model, records, unknowns))
    return search_named(likelihood, first, unknowns.vector, bounds, priors, algorithm)


def summed(cost: float, runs: Sequence[tuple[Array, Array]], r: Array) -> Point:
    """The cost with its slopes. runs: residuals (n, m) and sensitivities (n, m, k). r: (m,)."""
    k = runs[0][1].shape[-1]
    gradient, information = np.zeros(k), np.zeros((k, k))
    for v, S in runs:
        weighted = S / r[:, None]
        gradient -= np.einsum("nik,ni->k", weighted, v)
        information += np.tensordot(weighted, S, axes=([0, 1], [0, 1]))
    return Point(cost, gradient, information)


def learned(records: Sequence[LinearRecord]) -> list[LinearRecord]:
    """The maneuvers to learn from; refuses where there is none or names repeat."""
    learn = [r for r in records if not r.held_out]
    if not learn or len({r.id for r in records}) < len(records):
        raise refuse(
            "no_maneuver",
            where="records",
            expected="at least one maneuver that is not held out, each with its own id",
            found=", ".join(r.id for r in records) or "none",
            do="Give one, or take `held_out` away.",
        )
    return learn


def fitted_outputs(model: LinearModel, record: LinearRecord, y: Array) -> list[Fitted]:
    """Measured and modeled outputs of one record."""
    return [
        Fitted(name, record.id, record.t, record.outputs[:, i], y[:, i], record.held_out)
        for i, name in enumerate(model.outputs)
    ]


def _predicted(
    model: LinearModel,
    record: LinearRecord,
    unknowns: Unknowns,
    value: Array,
    own: Collection[str],
    hold: Hold,
) -> list[Fitted]:
    """A held-out maneuver under the derivatives found, its own constants and start fitted."""
    everything = dict(zip(unknowns.names, unknowns.all(value), strict=True))
    shared = {n: everything[n] for n in model.parameters if n in everything and n not in own}
    mine = Unknowns(model, [record], own, shared, initial=True)
    problem = OutputError(model, [record], mine, hold)
    found = minimize(problem.likelihood, first_values(model, [record], mine))
    return problem.fitted(found.value)
