"""Standard errors predicted before the flight, and the scatter of output error over 200 flights."""

from __future__ import annotations

import numpy as np

from alula.identify.flown.problem import STATE_SETS
from alula.plan.output_error_information import predict_output_error
from verification.estimation.campaign_coverage import CASES, flights, output_error
from verification.estimation.noisy_flights import SIGMA, measured, sportstar


def ratios(runs: int, first: int = 1000) -> dict[str, float]:
    """Predicted standard error over the scatter of `runs` estimates, by parameter."""
    aircraft = sportstar()
    out: dict[str, float] = {}
    for aspect, flight in flights(aircraft).items():
        formulas, outputs = CASES[aspect]
        predicted = predict_output_error(
            [measured(aircraft, flight, outputs, None)],
            aircraft.model,
            formulas,
            SIGMA,
            states=STATE_SETS[aspect],
            outputs=outputs,
        )
        found = [output_error(aircraft, flight, aspect, first + i, 0.0) for i in range(runs)]
        for p in predicted:
            scatter = float(np.std([f[p.name].value for f in found], ddof=1))
            out[p.name] = p.se / scatter
    return out


def plan_scatter(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds.

    The scatter of 200 flights is itself known to 5 %, that of 20 (quick) to 16 %.
    """
    runs = 20 if quick else 200
    by = ratios(runs)
    low, high = min(by, key=lambda n: by[n]), max(by, key=lambda n: by[n])
    got = (
        f"predicted over scatter of {runs} flights: {by[low]:.2f} ({low}) to {by[high]:.2f} "
        f"({high}), {len(by)} parameters"
    )
    slack = 0.3 if quick else 0.0
    return got, by[low] > 0.7 - slack and by[high] < 1.3 + slack
