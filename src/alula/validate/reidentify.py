"""Monte Carlo through the simulator: flights of the identified model, identified again and again.

The controls of every maneuver that the model was identified from are flown through it, from the
recorded start. To what it flies comes noise of the spectrum of the identification's own residuals,
drawn anew each time (a parametric bootstrap; Efron and Tibshirani, An Introduction to the
Bootstrap, 1993, ch. 6). What is estimated from that is set beside what was flown: the scatter is
a standard error without formulas, the mean's distance from the truth the bias of the method.
The flights are of the model: what its formulas lack shows in the spectrum of the noise only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import fft

from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse, warn
from alula.identify.coefficients import CoefficientData, regressor_variables
from alula.identify.coefficients import Reference as DataReference
from alula.identify.equation_error.task import MOMENTS
from alula.identify.flown.measured_maneuver import STATES, MeasuredManeuver
from alula.identify.result import Identification
from alula.model import AeroModel
from alula.simulate import SimulatedFlight
from alula.validate.case import Case
from alula.validate.flown import simulated

FEWEST = 10  # draws: a standard deviation of fewer says nothing

Readings = Sequence[MeasuredManeuver]
Identify = Callable[[Sequence[CoefficientData], Readings], Identification]


@dataclass(frozen=True)
class Reidentified:
    """One parameter over all draws that were identified.

    truth: as flown. mean, scatter: of the estimates, the standard deviation about their mean.
    stated: root mean square of the standard errors that came with them. inside: share of the 95 %
    intervals that hold the truth. draws: in which the parameter had a value.
    """

    name: str
    truth: float
    mean: float
    scatter: float
    stated: float
    inside: float
    draws: int


def reidentify(
    model: AeroModel,
    result: Identification,
    cases: Sequence[Case],
    data: Sequence[CoefficientData],
    readings: Readings,
    identify: Identify,
    *,
    gravity: float,
    draws: int,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[tuple[Reidentified, ...], tuple[Message, ...]]:
    """What identification makes of flights of its own model.

    cases, data, readings: of the maneuvers that `result` was identified from, in one order;
    readings may be empty where the method takes coefficients only. identify: the same method on
    other data. Maneuvers that the model does not fly to the end are left out, and named.
    Raises BadInput where none is left, or `draws` is too small to tell anything.
    """
    if draws < FEWEST:
        raise refuse(
            "bad_option",
            where="--reidentify",
            expected=f"at least {FEWEST} draws",
            found=str(draws),
            do="Ask for more: the scatter of 50 is known to a tenth.",
        )
    flights: dict[str, SimulatedFlight] = {}
    lost = []
    for case in cases:
        id = case.motion.maneuver.id
        try:
            flights[id] = simulated(model, case, gravity)
        except BadInput as error:
            if error.messages[0].code != "diverged":
                raise
            lost.append(id)
    if not flights:
        raise refuse(
            "diverged",
            where="--reidentify",
            expected="a model that flies at least one of its own maneuvers to the end",
            found="none: " + ", ".join(lost),
            do="Look at the model's flights first; shorter maneuvers diverge less.",
        )
    exact = [_coefficients(d, flights[d.maneuver.id], model) for d in data
             if d.maneuver.id in flights]  # fmt: skip
    clear = [_readings(m, flights[m.maneuver.id]) for m in readings if m.maneuver.id in flights]
    left = {(s.maneuver, s.coefficient): s.measured - s.model for s in result.series}
    random = np.random.default_rng(seed)
    found: list[Identification] = []
    failed = 0
    for k in range(draws):
        progress(f"identifying simulated flights, {k + 1} of {draws}")
        try:
            again = identify(
                [replace(d, coefficients=_noisy(d.maneuver.id, d.coefficients, left, random))
                 for d in exact],
                [replace(m, outputs=_noisy(m.maneuver.id, m.outputs, left, random))
                 for m in clear],
            )  # fmt: skip
        except BadInput:
            failed += 1
            continue
        found.append(again)
    said = []
    if lost or failed:
        said.append(
            warn(
                "draws_diverged",
                where="--reidentify",
                expected=f"{draws} sets of flights, identified",
                found=f"{failed} that could not be; maneuvers that the model does not fly to their "
                "end: " + (", ".join(lost) or "none"),
                do="They are left out: scatter and bias are of those that remain.",
            )
        )
    return tuple(_told(result, found, model)), tuple(said)


def coloured_like(residual: Array, random: np.random.Generator) -> Array:
    """Gaussian noise (n,) with the periodogram of a residual (n,) as its spectrum; NaN where the
    residual is.
    """
    known = np.isfinite(residual)
    n = len(residual)
    spectrum = fft.rfft(np.where(known, residual, 0.0))
    share = n / max(int(known.sum()), 1)
    turn = (random.standard_normal(len(spectrum)) + 1j * random.standard_normal(len(spectrum))) / (
        2.0**0.5
    )
    turn[0] = random.standard_normal()  # real: a mean has no phase
    if n % 2 == 0:
        turn[-1] = random.standard_normal()
    drawn = np.asarray(fft.irfft(np.abs(spectrum) * turn, n)) * share**0.5
    return np.where(known, drawn, np.nan)


def _noisy(
    id: str,
    exact: Mapping[str, Array],
    left: Mapping[tuple[str, str], Array],
    random: np.random.Generator,
) -> dict[str, Array]:
    """The values with noise like the residual of each; those that nothing was fitted to, exact."""
    out = dict(exact)
    for name, values in exact.items():
        residual = left.get((id, name))
        if residual is not None and len(residual) == len(values):
            out[name] = values + coloured_like(residual, random)
    return out


def _coefficients(
    data: CoefficientData, flight: SimulatedFlight, model: AeroModel
) -> CoefficientData:
    """The coefficients of a flight of the model, smoothed as the measured ones are."""
    r = model.reference
    point = model.reference_point
    variables = regressor_variables(
        replace(flight.motion, recorded={}), DataReference(r.S, r.b, r.c, point)
    )
    own = model.evaluate(variables)
    out = dict(data.coefficients)
    for name in out.keys() & own.keys():
        out[name] = own[name]
        if data.cubic is not None and name in MOMENTS:
            out[name] = data.cubic.matched(own[name][:, None])[:, 0]
    return replace(data, coefficients=out, variables=variables, perturbed=())


def _readings(m: MeasuredManeuver, flight: SimulatedFlight) -> MeasuredManeuver:
    """What exact sensors at the center of gravity would have read."""
    motion = flight.motion
    recorded = {n: v for n, v in motion.recorded.items() if n in m.coefficients}
    return replace(
        m,
        outputs={n: np.where(np.isfinite(z), getattr(motion, n), np.nan)
                 for n, z in m.outputs.items()},
        motion={n: getattr(motion, n) for n in STATES},
        rho=motion.rho,
        speed_of_sound=motion.V / np.maximum(flight.mach, 1e-9),
        force=flight.engine_force,
        moment=flight.engine_moment,
        coefficients={**m.coefficients, **recorded},
    )  # fmt: skip


def _told(
    result: Identification, found: Sequence[Identification], model: AeroModel
) -> Iterable[Reidentified]:
    for p in result.parameters:
        truth = model.params.get(p.name.split("[")[0])
        if truth is None:  # an initial state, a noise: not of the model
            continue
        every = [q for one in found for q in one.parameters if q.name == p.name]
        told = [q for q in every if np.isfinite(q.value)]
        if len(told) < 2:
            continue
        values = np.array([q.value for q in told])
        yield Reidentified(
            name=p.name,
            truth=truth,
            mean=float(values.mean()),
            scatter=float(values.std(ddof=1)),
            stated=float(np.sqrt(np.mean([q.se**2 for q in told]))),
            inside=float(np.mean([q.ci95[0] <= truth <= q.ci95[1] for q in told])),
            draws=len(told),
        )
