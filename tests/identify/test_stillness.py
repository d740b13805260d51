"""Flights without input: noise has maxima of its own, and none of them reads ok."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from alula.identify.likelihood.parameters import Fitted
from alula.identify.likelihood.stillness import still

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from verification.estimation.ill_posed import LONGITUDINAL, identify_output_error, problem


@pytest.mark.parametrize("seed", [456, 666])
def test_a_maximum_that_is_noise_does_not_read_ok(seed):
    """The search ends at a Cm_q or Cm_alpha over 20 of its standard errors from the truth."""
    p = problem(seed, "no excitation")
    found = identify_output_error(
        [p.maneuver], p.formulas, states="longitudinal", outputs=LONGITUDINAL, truth=p.truth
    )
    assert found.parameters
    assert not [q.name for q in found.parameters if q.verdict == "ok" and "(0)" not in q.name]
    assert "no_motion" in {m.code for m in found.messages}
    assert found["V(0)[m]"].verdict == "ok"  # it flies, and that is seen


def test_one_output_that_moves_is_enough():
    t = np.arange(500) / 25.0
    noise = 0.1 * np.random.default_rng(0).standard_normal((2, 500))
    motion = np.sin(t)

    def fitted(size, held_out=False):
        return [
            Fitted("q", "m", t, size * motion + noise[0], size * motion, held_out),
            Fitted("V", "m", t, 40.0 + noise[1], np.full(500, 40.0), held_out),
        ]

    assert still(fitted(0.05))
    assert not still(fitted(0.3))
    assert still([*fitted(0.05), *fitted(0.3, held_out=True)])
