"""Filter error for the equations of motion with any formulas of the model grammar.

The rigid-body equations (Dittrich 2016, Eq. (2.61) to (2.66)), filtered in the core with exact
slopes; the same equations as Python functions serve the first values, and check the core. What is
not a state is taken as measured, and so are coefficients without a formula. Turbulence enters as
white process noise of the states named.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.flown.core_maneuver import formula_model, in_core
from alula.identify.flown.extended_filter_error import (
    FunctionModel,
    Pass,
    identify_extended_filter_error,
)
from alula.identify.flown.flight_functions import (
    NO_TIES,
    Ties,
    flight_functions,
    places_of,
    record_of,
)
from alula.identify.flown.good_enough import good_enough
from alula.identify.flown.measured_maneuver import OUTPUTS, STATES, MeasuredManeuver
from alula.identify.flown.problem import check_tied
from alula.identify.flown.start import start_values
from alula.identify.likelihood.innovations import Innovations
from alula.identify.likelihood.optimizer import Algorithm
from alula.identify.likelihood.parameters import Prior
from alula.identify.linear.record import LinearRecord
from alula.identify.result import Identification
from alula.identify.typical import constant_name
from alula.model import parse

STATES_OF: Mapping[str, tuple[str, ...]] = {
    "longitudinal": ("alpha", "q"),
    "lateral": ("beta", "p", "r"),
}


def identify_flight_filter_error(
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    *,
    states: Sequence[str],
    outputs: Sequence[str],
    noisy: Collection[str] | None = None,
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    tied: Ties | None = None,
    common_constant: bool = True,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Derivatives and process noise from outputs in turbulence.

    models: formula by coefficient, body or stability axes. states: of V alpha beta p q r phi theta;
    `STATES_OF` has sets that suffice for short maneuvers. outputs: what the filter is corrected by.
    start: values of terms and noises ('F_alpha', 'sigma_q'); terms by equation error else. tied:
    term by (another term, factor). Other arguments as `identify_extended_filter_error`. Raises
    BadInput for names that do not exist.
    """
    given = flight_filters(
        maneuvers, models, states, outputs, start, fixed, tied, common_constant=common_constant
    )
    enough = good_enough(models, [f"{s}(0)[{m.maneuver.id}]" for m in maneuvers for s in states])
    found = identify_extended_filter_error(
        given.models,
        given.records,
        start=given.start,
        noisy=noisy,
        own=given.own,
        fixed=fixed,
        bounds=bounds,
        priors=priors,
        algorithm=algorithm,
        scales={**enough, **(scales or {})},
        truth=truth,
        method="filter error",
    )
    return replace(
        found,
        formulas=dict(models),
        fixed={n: v for n, v in (fixed or {}).items() if n in term_names(models)},
        tied=dict(tied or {}),
    )


@dataclass(frozen=True)
class FlightFilters:
    """What the extended filter error takes of maneuvers to learn from; records of all of them."""

    models: Sequence[FunctionModel]
    records: Sequence[LinearRecord]
    start: Mapping[str, float]
    own: Sequence[str]


def flight_filters(
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    states: Sequence[str],
    outputs: Sequence[str],
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    tied: Ties | None = None,
    *,
    common_constant: bool = True,
) -> FlightFilters:
    """The filters of `identify_flight_filter_error`; arguments as there."""
    wrong = [s for s in states if s not in STATES] + [y for y in outputs if y not in OUTPUTS]
    if wrong or not states or not outputs or not models:
        raise refuse(
            "unknown_option",
            where="filter error",
            expected=f"models, states of {', '.join(STATES)}, outputs of {', '.join(OUTPUTS)}",
            found=", ".join(wrong) or "none",
            do="Name them.",
        )
    ties = tied or {}
    check_tied("filter error", ties, term_names(models))
    learn = [m for m in maneuvers if not m.maneuver.held_out]
    first = start_values(learn, models, {**(start or {}), **(fixed or {})}) if learn else {}
    records = [record_of(m, outputs) for m in maneuvers]
    functions = [flight_functions(m, models, states, outputs, ties) for m in learn]
    flown = [
        replace(f, filter=core_filter(m, models, f, ties))
        for m, f in zip(learn, functions, strict=True)
    ]
    constants = [] if common_constant or not flown else [constant_name(c) for c in models]
    return FlightFilters(flown, records, first, [c for c in constants if c in flown[0].parameters])


def term_names(models: Mapping[str, str]) -> list[str]:
    """Names of all terms of the formulas."""
    return [t.name(c) for c, formula in models.items() for t in parse(formula)]


def core_filter(
    m: MeasuredManeuver,
    models: Mapping[str, str],
    functions: FunctionModel,
    tied: Ties = NO_TIES,
) -> Pass:
    """The core's extended filter over the maneuver; what it takes as `functions` has it."""
    states = functions.states
    model = formula_model(models, dict.fromkeys(term_names(models), 0.0), m.reference)
    fit = in_core(m, model, states, functions.outputs)
    terms, factors = places_of(model.names, functions.parameters, tied)
    places = [STATES.index(s) for s in states]

    def run(values: Array, x0: Array, intensity: Array, R: Array) -> Innovations | None:
        eight = np.zeros((2, len(values), len(STATES)))
        eight[0, :, places], eight[1, :, places] = x0.T, intensity.T
        whole, v, S, y = fit.innovations(
            np.ascontiguousarray(values[:, terms] * factors), *eight, R
        )
        return Innovations(v, S, y) if whole else None

    return run
