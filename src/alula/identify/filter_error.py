"""Filter error for linear models: output error that knows of turbulence.

dx = (A x + B u + b) dt + F dw, z = C x + D u + d + e: white process noise of intensity F (diagonal,
per square root of a second) enters the states, white measurement noise of standard deviation sigma
each output. A Kalman filter predicts every sample from those before; its innovations are white if
the parameters are right (Maine and Iliff 1981; Jategaonkar 2006, ch. 5). F and sigma are estimated
along with all else, on a logarithmic scale. The gain is that of the steady state (Riccati), or
varies with time from an initial state that is exact because it is estimated; the latter also
bridges missing samples.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from scipy.linalg import expm

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, note, refuse
from alula.identify.innovations import InnovationLikelihood, Innovations
from alula.identify.likelihood import Prior, Whitened, assembled
from alula.identify.linear_model import LinearModel, process_covariance, sample
from alula.identify.linear_output_error import fitted_outputs, learned, prior_blocks
from alula.identify.linear_record import LinearRecord, Unknowns
from alula.identify.linear_start import first_values, measured_states, white_noise
from alula.identify.optimizer import Algorithm, Likelihood, Minimum, minimize, with_prior
from alula.identify.result import Identification, Parameter
from alula.identify.riccati import steady_covariance

Gain = Literal["auto", "steady", "varying"]
QUIET = 1e-4  # of an output's standard deviation: least first value of its noise
LOWEST, HIGHEST = 1e-3, 1e4  # of a noise's first value: bounds of the search


def identify_filter_error(
    model: LinearModel,
    records: Sequence[LinearRecord],
    *,
    noisy: Collection[str] | None = None,
    gain: Gain = "auto",
    own: Collection[str] = (),
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Parameters of `model`, intensity of its process noise and deviation of its sensors' noise.

    noisy: the states that process noise drives, all by default. gain: 'steady', 'varying', or
    'auto', which varies only where samples are missing. own, start, fixed, bounds, priors: as in
    `identify_linear_output_error`; noises are named 'F_p' (per sqrt(s)) and 'sigma_ay'. The series
    of the result are predictions one sample ahead. Raises BadInput as the output error does.
    """
    learn = learned(records)
    unknowns = Unknowns(model, learn, own, _without_noise(fixed), initial=True)
    driven = tuple(model.states if noisy is None else noisy)
    strange = [s for s in driven if s not in model.states]
    if strange or gain not in ("auto", "steady", "varying"):
        raise refuse(
            "unknown_option",
            where="filter error",
            expected=f"noisy states among {', '.join(model.states)}; gain auto, steady or varying",
            found=", ".join(strange) or repr(gain),
            do="Correct it.",
        )
    problem = FilterError(model, learn, unknowns, driven, gain, fixed or {}, start or {})
    likelihood = InnovationLikelihood(problem.run)
    names: Sequence[str] = problem.names
    first = problem.first
    low, high = problem.bounds(bounds or {})
    search: Likelihood = likelihood
    if priors:
        zero = np.zeros(len(unknowns.free))
        pad = np.zeros(len(names) - len(zero))
        mean = unknowns.vector({n: p.mean for n, p in priors.items()}, zero)
        weight = unknowns.vector({n: 1.0 / p.se**2 for n, p in priors.items()}, zero)
        search = with_prior(search, np.append(mean, pad), np.diag(np.append(weight, pad)))
    found = minimize(search, first, algorithm=algorithm, lower=low, upper=high)
    blocks = likelihood.blocks(found.value) if found.information.any() else []
    blocks += prior_blocks(names, found.value, priors or {})
    shown = []
    if found.converged:
        runs = problem.run(found.value[None, :]) or []
        for record, r in zip(learn, runs, strict=True):
            shown += fitted_outputs(model, record, r.y[0])
    names, found, blocks, said = _without_silent(names, problem.logarithmic, found, blocks)
    result = assembled(
        "filter error", names, {**model.belongs, **problem.belongs}, blocks, found, shown,
        model.rows, scales=scales, truth={n: np.log(v) if n in problem.logarithmic else v
                                         for n, v in (truth or {}).items()},
        messages=said,
    )  # fmt: skip
    return natural_scale(result, problem.logarithmic)


class FilterError:
    """A bank of Kalman filters, one per parameter vector, over several maneuvers."""

    def __init__(
        self,
        model: LinearModel,
        records: Sequence[LinearRecord],
        unknowns: Unknowns,
        noisy: Sequence[str],
        gain: Gain,
        fixed: Mapping[str, float],
        start: Mapping[str, float],
    ) -> None:
        self.model, self.records, self.unknowns = model, records, unknowns
        self.driven = [model.states.index(s) for s in noisy]
        holes = any(not np.isfinite(r.outputs).all() for r in records)
        if gain == "steady" and holes:
            raise refuse(
                "missing_samples",
                where="filter error",
                expected="every output at every sample for the steady-state gain",
                found="NaN",
                do="Use gain = 'varying' (or 'auto').",
            )
        self.varying = gain == "varying" or (gain == "auto" and holes)
        self.free = len(unknowns.free)
        noises = [f"F_{s}" for s in noisy] + [f"sigma_{y}" for y in model.outputs]
        theta = unknowns.vector(_without_noise(start), first_values(model, records, unknowns))
        guess = self._first_noises(theta)
        guess.update({n: v for n, v in start.items() if n in noises})
        guess.update({n: v for n, v in fixed.items() if n in noises})
        self.level = np.array([np.log(guess[n]) for n in noises])
        self.sought = [i for i, n in enumerate(noises) if n not in fixed]
        self.logarithmic = tuple(noises[i] for i in self.sought)
        self.names = (*unknowns.free_names, *self.logarithmic)
        self.first = np.concatenate([theta, self.level[self.sought]])
        self.belongs = {n: n.split("_", 1)[1] for n in noises}

    def bounds(self, given: Mapping[str, tuple[float, float]]) -> tuple[Array, Array]:
        """Lowest and highest (free,), noises on their logarithmic scale."""
        infinite = np.full(self.free, np.inf)
        plain = {n: b for n, b in given.items() if n not in self.logarithmic}
        low = self.unknowns.vector({n: b[0] for n, b in plain.items()}, -infinite)
        high = self.unknowns.vector({n: b[1] for n, b in plain.items()}, infinite)
        level = self.level[self.sought]
        least, most = level + np.log(LOWEST), level + np.log(HIGHEST)
        for i, n in enumerate(self.logarithmic):
            if n in given:
                least[i], most[i] = np.log(given[n][0]), np.log(given[n][1])
        return np.append(low, least), np.append(high, most)

    def run(self, members: Array) -> list[Innovations] | None:
        """Innovations of every maneuver for m parameter vectors (m, free)."""
        level = np.broadcast_to(self.level, (len(members), len(self.level))).copy()
        level[:, self.sought] = members[:, self.free :]
        noise = np.exp(level)
        intensity = np.zeros((len(members), len(self.model.states)))
        intensity[:, self.driven] = noise[:, : len(self.driven)] ** 2
        R = noise[:, len(self.driven) :] ** 2
        out = []
        for i in range(len(self.records)):
            values, x0 = self.unknowns.of(i, members[:, : self.free])
            filtered = self._filter(self.records[i], values, x0, intensity, R)
            if filtered is None:
                return None
            out.append(filtered)
        return out

    def _filter(
        self, record: LinearRecord, values: Array, x0: Array, intensity: Array, R: Array
    ) -> Innovations | None:
        m = self.model.at(values)
        step = sample(m, record.dt)
        k, s = m.C.shape[-2:]
        Q = process_covariance(m.A, intensity[:, :, None] * np.eye(s), record.dt)
        R = R[:, :, None] * np.eye(k)
        w = record.drive
        n = len(w)
        push = np.einsum("msc,nc->nms", step.now, w[:-1]) + np.einsum(
            "msc,nc->nms", step.next, w[1:]
        )
        direct = np.einsum("mkc,nc->nmk", m.D, w)
        good = np.isfinite(record.outputs)
        z = np.where(good, record.outputs, 0.0)
        turned, back = np.swapaxes(m.C, -1, -2), np.swapaxes(step.phi, -1, -2)
        v, y = np.empty((n, len(values), k)), np.empty((n, len(values), k))
        S = np.empty((n if self.varying else 1, len(values), k, k))
        x = x0
        P = np.zeros_like(Q)
        if not self.varying:
            P = steady_covariance(step.phi, m.C, Q, R)
            if not np.isfinite(P).all():
                return None
            S[0] = m.C @ P @ turned + R
            K = np.swapaxes(np.linalg.solve(S[0], m.C @ P), -1, -2)
        for i in range(n):
            y[i] = (m.C @ x[:, :, None])[:, :, 0] + direct[i]
            v[i] = np.where(good[i], z[i] - y[i], 0.0)
            if self.varying:
                seen = m.C * good[i][:, None]
                S[i] = seen @ P @ np.swapaxes(seen, -1, -2)
                S[i] += np.where(good[i][:, None] & good[i], R, np.eye(k))
                K = np.swapaxes(np.linalg.solve(S[i], seen @ P), -1, -2)
                P = P - K @ S[i] @ np.swapaxes(K, -1, -2)
                P = step.phi @ P @ back + Q
            x = x + (K @ v[i][:, :, None])[:, :, 0]
            if i < n - 1:
                x = (step.phi @ x[:, :, None])[:, :, 0] + push[i]
        return Innovations(np.moveaxis(v, 0, 1), np.moveaxis(S, 0, 1), np.moveaxis(y, 0, 1))

    def _first_noises(self, theta: Array) -> dict[str, float]:
        """Sensors' noise by third differences, process noise by one-step errors of the states."""
        out: dict[str, float] = {}
        for i, name in enumerate(self.model.outputs):
            white = np.mean([white_noise(r.outputs[:, i]) ** 2 for r in self.records])
            spread = max(float(np.nanstd(r.outputs[:, i])) for r in self.records)
            out[f"sigma_{name}"] = max(0.5 * float(white) ** 0.5, QUIET * spread, 1e-12)
        errors: dict[str, list[Array]] = {}
        for i, r in enumerate(self.records):
            known = measured_states(self.model, r)
            m = self.model.at(self.unknowns.of(i, theta)[0])
            x = np.column_stack(
                [known.get(s, np.full(len(r.t), np.nan)) for s in self.model.states]
            )
            drift = np.where(np.isnan(x), 0.0, x) @ (expm(m.A * r.dt) - np.eye(len(m.A))).T
            drift = drift + r.dt * r.drive @ m.B.T
            e = (np.diff(x, axis=0) - drift[:-1]) / r.dt**0.5
            for j, s in enumerate(self.model.states):
                errors.setdefault(s, []).append(e[:, j][np.isfinite(e[:, j])])
        dt = self.records[0].dt
        for s, parts in errors.items():
            e = np.concatenate(parts)
            size = float(np.mean(e**2)) if len(e) else 0.0
            sensor = 2.0 * out.get(f"sigma_{s}", 0.0) ** 2 / dt
            out[f"F_{s}"] = max(size - sensor, 0.05 * size, 1e-12) ** 0.5
        return out


def natural_scale(result: Identification, logarithmic: Collection[str]) -> Identification:
    """The result with noises as they are, not as logarithms; intervals by the logarithm's.

    A noise's estimate is never negative, so it is 'ok' wherever its logarithm is known to a factor.
    """
    parameters: list[Parameter] = []
    gain = np.ones(len(result.parameters))
    for i, p in enumerate(result.parameters):
        if p.name not in logarithmic or p.verdict == "not_identifiable":
            parameters.append(p)
            continue
        value = float(np.exp(p.value))
        gain[i] = value
        low, high = float(np.exp(p.ci95[0])), float(np.exp(min(p.ci95[1], 700.0)))
        parameters.append(
            replace(
                p,
                value=value,
                se_white=value * p.se_white,
                se=value * p.se,
                ci95=(low, high),
                verdict="ok" if p.se < 0.5 else "weak",
                truth=None if p.truth is None else float(np.exp(p.truth)),
            )
        )
    covariance = frozen(result.covariance * np.outer(gain, gain))
    return replace(result, parameters=tuple(parameters), covariance=covariance)


def _without_silent(
    names: Sequence[str], noises: Collection[str], found: Minimum, blocks: Sequence[Whitened]
) -> tuple[Sequence[str], Minimum, list[Whitened], list[Message]]:
    """All of it less the noises that ended at their lower bound: too small to be told from none."""
    gone = [n in noises and held for n, held in zip(names, found.at_bound, strict=True)]
    if not any(gone):
        return names, found, list(blocks), []
    keep = [i for i, lost in enumerate(gone) if not lost]
    small = [names[i] for i, lost in enumerate(gone) if lost]
    said = note(
        "noise_too_small",
        where=", ".join(small),
        expected="noise that shows in the innovations",
        found="none that can be told from zero",
        do="Nothing: it is held at its lower bound. State it as fixed if it is known.",
    )
    reduced = replace(
        found,
        value=found.value[keep],
        gradient=found.gradient[keep],
        information=found.information[np.ix_(keep, keep)],
        at_bound=tuple(found.at_bound[i] for i in keep),
    )
    left = [replace(b, sensitivity=b.sensitivity[:, keep]) for b in blocks]
    return [names[i] for i in keep], reduced, left, [said]


def _without_noise(given: Mapping[str, float] | None) -> dict[str, float]:
    return {n: v for n, v in (given or {}).items() if not n.startswith(("F_", "sigma_"))}
