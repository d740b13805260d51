"""The search of every filter error: parameters, initial states and noises of one likelihood.

Noises are sought as logarithms: 'F_p', process noise per square root of a second into the state p,
and 'sigma_ay', the deviation of an output's white noise.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, note
from alula.identify.likelihood.innovations import InnovationLikelihood, Innovations
from alula.identify.likelihood.named_search import prior_blocks, with_priors
from alula.identify.likelihood.optimizer import Algorithm, Minimum, minimize
from alula.identify.likelihood.parameters import Fitted, Prior, Whitened, assembled
from alula.identify.linear.record import LinearRecord, Unknowns
from alula.identify.linear.start import white_noise
from alula.identify.result import Identification, Parameter, Verdict

QUIET = 1e-4  # of an output's standard deviation: least first value of its noise
LOWEST, HIGHEST = 1e-3, 1e4  # of a noise's first value: bounds of the search
LARGEST = 1.0  # change of a noise's logarithm in one iteration: far from the maximum it overshoots


class NoisyProblem(ABC):
    """Names, first values and bounds of a filter error; `filtered` is the filter.

    A bank of filters, one per parameter vector, over several maneuvers. names: of the search's
    vector. first: (k,). logarithmic: the noises in it. belongs: by name, the row each parameter
    stands in.
    """

    def __init__(
        self,
        unknowns: Unknowns,
        records: Sequence[LinearRecord],
        states: Sequence[str],
        noisy: Sequence[str],
        outputs: Sequence[str],
        theta: Array,
        guess: Mapping[str, float],
        fixed: Mapping[str, float],
        belongs: Mapping[str, str],
    ) -> None:
        self.unknowns, self.records = unknowns, records
        self.states, self.driven = len(states), [states.index(s) for s in noisy]
        self.free = len(unknowns.free)
        self.count = len(noisy)
        noises = [f"F_{s}" for s in noisy] + [f"sigma_{y}" for y in outputs]
        self.level = np.array([np.log(fixed.get(n, guess[n])) for n in noises])
        self.sought = [i for i, n in enumerate(noises) if n not in fixed]
        self.logarithmic = tuple(noises[i] for i in self.sought)
        self.names = (*unknowns.free_names, *self.logarithmic)
        self.first = np.concatenate([theta, self.level[self.sought]])
        self.belongs = {**belongs, **{n: n.split("_", 1)[1] for n in noises}}

    @abstractmethod
    def filtered(
        self, maneuver: int, values: Array, x0: Array, intensity: Array, R: Array
    ) -> Innovations | None:
        """Innovations of one maneuver for m values, initial states, intensities and variances.

        None where the filter has no result.
        """

    def run(self, members: Array) -> list[Innovations] | None:
        """Innovations of every maneuver for m parameter vectors (m, k).

        A maneuver is filtered only with those that differ from the first in what concerns it.
        """
        out = []
        for i in range(len(self.records)):
            given = self.arguments(i, members)
            own = np.hstack(given)
            at = np.append(0, np.flatnonzero((own != own[0]).any(axis=1)))
            values, x0, intensity, R = (part[at] for part in given)
            found = self.filtered(i, values, x0, intensity, R)
            if found is None:
                return None
            out.append(replace(found, members=at))
        return out

    def arguments(self, maneuver: int, members: Array) -> tuple[Array, Array, Array, Array]:
        """What `filtered` takes of m parameter vectors (m, k)."""
        intensity = np.zeros((len(members), self.states))
        intensity[:, self.driven], R = self.noises(members)
        return *self.unknowns.of(maneuver, members[:, : self.free]), intensity, R

    def vector(self, by_name: Mapping[str, float], default: Array) -> Array:
        """(k,) values by name, none of them noises."""
        return np.append(self.unknowns.vector(by_name, default[: self.free]), default[self.free :])

    def noises(self, members: Array) -> tuple[Array, Array]:
        """F F' (m, driven states) and variances of the outputs' noise (m, outputs)."""
        level = np.broadcast_to(self.level, (len(members), len(self.level))).copy()
        level[:, self.sought] = members[:, self.free :]
        squares = np.exp(2.0 * level)
        return squares[:, : self.count], squares[:, self.count :]

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


def search_noises(
    method: str,
    problem: NoisyProblem,
    outputs: Sequence[str],
    rows: Mapping[str, str],
    records: Sequence[LinearRecord],
    bounds: Mapping[str, tuple[float, float]],
    priors: Mapping[str, Prior],
    algorithm: Algorithm,
    scales: Mapping[str, float],
    truth: Mapping[str, float],
    aside: Sequence[Message] = (),
) -> Identification:
    """The maximum of the likelihood with error bars and verdicts, noises on their natural scale."""
    likelihood = InnovationLikelihood(problem.run)
    names: Sequence[str] = problem.names
    low, high = problem.bounds(bounds)
    search = with_priors(likelihood, problem.vector, priors, len(names))
    largest = np.append(np.full(problem.free, np.inf), np.full(len(names) - problem.free, LARGEST))
    found = minimize(
        search, problem.first, algorithm=algorithm, lower=low, upper=high, largest=largest
    )
    blocks = likelihood.blocks(found.value) if found.information.any() else []
    blocks += prior_blocks(names, found.value, priors)
    shown = []
    if found.converged:
        runs = problem.run(found.value[None, :]) or []
        shown = [
            Fitted(name, record.id, record.t, record.outputs[:, i], r.y[0][:, i], record.held_out)
            for record, r in zip(records, runs, strict=True)
            for i, name in enumerate(outputs)
        ]
    names, found, blocks, said = _without_silent(names, problem.logarithmic, found, blocks)
    true = {n: float(np.log(v)) if n in problem.logarithmic else v for n, v in truth.items()}
    result = assembled(
        method, names, problem.belongs, blocks, found, shown, rows,
        scales=scales, truth=true, messages=(*aside, *said),
    )  # fmt: skip
    return natural_scale(result, problem.logarithmic)


def left_aside(records: Sequence[LinearRecord]) -> list[Message]:
    """A note on held-out maneuvers: predictions one sample ahead would tell nothing of a model."""
    held = [r.id for r in records if r.held_out]
    if not held:
        return []
    return [
        note(
            "held_out",
            where=", ".join(held),
            expected="maneuvers to learn from",
            found="maneuvers that are held out: they were left aside",
            do="Nothing; judge the model on them by flying it.",
        )
    ]


def first_sensor_noises(
    outputs: Sequence[str], records: Sequence[LinearRecord]
) -> dict[str, float]:
    """'sigma_y' by third differences of each output, halved: part of that is process noise."""
    out = {}
    for i, name in enumerate(outputs):
        white = np.mean([white_noise(r.outputs[:, i]) ** 2 for r in records])
        spread = max(float(np.nanstd(r.outputs[:, i])) for r in records)
        out[f"sigma_{name}"] = max(0.5 * float(white) ** 0.5, QUIET * spread, 1e-12)
    return out


def first_process_noises(
    errors: Mapping[str, Sequence[Array]], sensors: Mapping[str, float], dt: float
) -> dict[str, float]:
    """'F_x' from one-step errors of the states over sqrt(dt), less what sensors put into them."""
    out = {}
    for s, parts in errors.items():
        e = np.concatenate(parts)
        size = float(np.mean(e**2)) if len(e) else 0.0
        sensor = 2.0 * sensors.get(f"sigma_{s}", 0.0) ** 2 / dt
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
                verdict=noise_verdict(p.se),
                truth=None if p.truth is None else float(np.exp(p.truth)),
            )
        )
    covariance = frozen(result.covariance * np.outer(gain, gain))
    return replace(result, parameters=tuple(parameters), covariance=covariance)


def noise_verdict(relative: float) -> Verdict:
    """Of a noise by the standard error of its logarithm."""
    return "ok" if relative < 0.5 else "weak"


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


def without_noises(given: Mapping[str, float] | None) -> dict[str, float]:
    """Values of what is no noise."""
    return {n: v for n, v in (given or {}).items() if not n.startswith(("F_", "sigma_"))}
