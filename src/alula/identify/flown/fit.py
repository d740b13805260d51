"""The search of output error: from first values to the maximum of the likelihood."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.output_likelihood import OutputErrorLikelihood, likelihood_of
from alula.identify.flown.problem import FlightProblem, Setting
from alula.identify.likelihood.optimizer import Algorithm, Minimum, minimize, with_prior
from alula.identify.likelihood.parameters import Prior
from alula.model import AeroModel

Covariance = Literal["diagonal", "full"]
CLOSE = 5e-4  # standard errors that the next step would take: no digit told would change
PULLS = (2.0, 10.0, 40.0)  # 1/s, of a first search where the start values diverge


@dataclass(frozen=True)
class OutputErrorFit:
    """A finished search: the problem, its likelihood, where it ended."""

    problem: FlightProblem
    likelihood: OutputErrorLikelihood
    found: Minimum
    messages: tuple[Message, ...] = ()

    @property
    def params(self) -> dict[str, float]:
        """The values by parameter name."""
        return dict(zip(self.problem.names, self.found.value.tolist(), strict=True))


def fit_output_error(
    maneuvers: Sequence[MeasuredManeuver],
    model: AeroModel,
    setting: Setting,
    *,
    noise: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    covariance: Covariance = "diagonal",
) -> OutputErrorFit:
    """The search alone, without error bars for coloured residuals and verdicts.

    model: its values are the start. noise: standard deviation of every output where it is known.
    bounds, priors: by parameter name; of initial states and biases too, 'alpha(0)[id]'.
    """
    problem = FlightProblem(maneuvers, model, setting)
    known = None
    if noise is not None:
        _check_names("noise", noise, setting.outputs, setting.outputs)
        known = np.array([noise[name] for name in setting.outputs]) ** 2
    likelihood = likelihood_of(problem, known, covariance == "full")

    def search(likelihood: OutputErrorLikelihood, problem: FlightProblem, at: Array) -> Minimum:
        return _search(likelihood, problem, at, bounds or {}, priors or {}, algorithm)

    found = search(likelihood, problem, problem.start)
    said: tuple[Message, ...] = ()
    if not found.converged and found.iterations == 0 and not setting.stabilize:
        first, pull = _pulled_start(maneuvers, model, setting, known, search)
        found = search(likelihood, problem, first)
        said = (
            note(
                "start_diverges",
                where="output error",
                expected="a motion that can be flown with the first values",
                found=f"one that diverges; a first search pulled the states to their measurements "
                f"({pull:g}/s)",
                do="Nothing where the search then converged; else give start values.",
            ),
        )
    return OutputErrorFit(problem, likelihood, found, said)


def _pulled_start(
    maneuvers: Sequence[MeasuredManeuver],
    model: AeroModel,
    setting: Setting,
    variance: Array | None,
    search: Callable[[OutputErrorLikelihood, FlightProblem, Array], Minimum],
) -> tuple[Array, float]:
    """First values (k,) by states pulled to their measurements, as gently as will do."""
    fastest = 1.0 / max(float(np.max(np.diff(m.t))) for m in maneuvers)
    for gain in PULLS:
        gain = min(gain, fastest)  # beyond it the pull itself is too fast for the steps
        pull = {name: gain for name in setting.states if name in setting.outputs}
        held = FlightProblem(maneuvers, model, replace(setting, stabilize=pull))
        likelihood = likelihood_of(held, variance, False)
        if likelihood(held.start, True) is not None:
            break
    return search(likelihood, held, held.start).value, gain


def _search(
    likelihood: OutputErrorLikelihood,
    problem: FlightProblem,
    start: Array,
    bounds: Mapping[str, tuple[float, float]],
    priors: Mapping[str, Prior],
    algorithm: Algorithm,
) -> Minimum:
    _check_names("bounds", bounds, problem.names)
    _check_names("priors", priors, problem.names)
    low = np.array([bounds.get(n, (-np.inf, np.inf))[0] for n in problem.names])
    high = np.array([bounds.get(n, (-np.inf, np.inf))[1] for n in problem.names])
    if not priors:
        return minimize(likelihood, start, algorithm=algorithm, lower=low, upper=high, close=CLOSE)
    mean = np.array([priors[n].mean if n in priors else 0.0 for n in problem.names])
    weight = np.array([priors[n].se ** -2 if n in priors else 0.0 for n in problem.names])
    joint = with_prior(likelihood, mean, np.diag(weight))
    return minimize(joint, start, algorithm=algorithm, lower=low, upper=high, close=CLOSE)


def _check_names(
    what: str,
    given: Mapping[str, object],
    known: Sequence[str],
    needed: Sequence[str] = (),
) -> None:
    bad = [n for n in given if n not in known]
    missing = [n for n in needed if n not in given]
    if bad or missing:
        raise refuse(
            "unknown_parameter",
            where=f"output error, {what}",
            expected=f"{'all of' if needed else 'some of'} {', '.join(known)}",
            found=f"{', '.join(bad) or 'nothing unknown'}; missing: {', '.join(missing) or 'none'}",
            do="Correct the names.",
        )
