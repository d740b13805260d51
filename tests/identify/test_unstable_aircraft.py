"""Output error of an aircraft that only its feedback keeps flying."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from verification.estimation.unstable import (
    DERIVATIVES,
    aft_sportstar,
    errors,
    flight_in_loop,
    growth,
    identified,
    loop_alone,
)


@pytest.fixture(scope="module")
def aircraft():
    return aft_sportstar()


def test_derivatives_of_an_unstable_aircraft(aircraft):
    """One flight: five of six within two standard errors, all within three and a half.

    Of honest estimates 95 % are within two; 3.5 leaves a chance of 0.3 % for the six.
    """
    assert growth(aircraft) > 0.0
    found = identified(aircraft, flight_in_loop(aircraft), 1)
    z = np.abs(errors(found))
    assert np.sum(z < 2.0) >= 5
    assert np.max(z) < 3.5
    assert all(found[n].verdict == "ok" for n in ("CL_alpha", "Cm_alpha", "Cm_q", "Cm_de"))
    assert "stabilized" in {m.code for m in found.messages}
    assert "control_follows_states" not in {m.code for m in found.messages}


def test_feedback_alone_is_named_and_not_trusted():
    """No input on top of the feedback: the law is named, no derivative of the loop reads ok."""
    found = loop_alone()
    where = {m.where for m in found.messages if m.code == "control_follows_states"}
    assert where == {"CL, de", "Cm, de"}
    assert all(found[n].verdict != "ok" for n in DERIVATIVES)
