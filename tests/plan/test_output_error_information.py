"""Standard errors predicted for output error, against those it then finds."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.identify.flown.problem import STATE_SETS
from alula.plan.output_error_information import predict_output_error

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from verification.estimation.campaign_coverage import CASES, flights, output_error
from verification.estimation.noisy_flights import SIGMA, measured, sportstar


def predicted(sigma=SIGMA, more=""):
    aircraft = sportstar()
    flight = flights(aircraft)["lateral"]
    formulas, outputs = CASES["lateral"]
    return predict_output_error(
        [measured(aircraft, flight, outputs, None)],
        aircraft.model,
        {**formulas, "Cn": formulas["Cn"] + more},
        sigma,
        states=STATE_SETS["lateral"],
        outputs=outputs,
    )


def test_prediction_is_what_output_error_then_finds():
    """The noise of 300 samples is known to 4 %; sensitivities at estimates add about as much."""
    aircraft = sportstar()
    found = output_error(aircraft, flights(aircraft)["lateral"], "lateral", 5, 0.0)
    for p in predicted():
        assert p.se == pytest.approx(found[p.name].se_white, rel=0.15), p.name


def test_what_cannot_be_told_is_infinite_and_noise_is_needed():
    df = {p.name: p for p in predicted(more=" + de")}  # the elevator stands still
    assert "Cn_de" not in df  # not in the a-priori model
    assert all(np.isfinite(df[n].se) for n in ("Cn_beta", "Cn_dr"))
    with pytest.raises(BadInput, match="standard deviation"):
        predicted(sigma={"beta": 0.01})
