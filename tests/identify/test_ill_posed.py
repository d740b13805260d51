"""Problems that data cannot solve: a verdict, and no wrong value that reads ok."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from alula.identify.flown.saturation import saturated

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from verification.estimation.ill_posed import KINDS, judged, problem


@pytest.mark.parametrize("kind", KINDS)
def test_no_wrong_value_reads_ok(kind):
    for seed in (300, 301):  # not those of the verification's own run
        found = judged(problem(seed, kind))
        assert found.verdicts, found.status
        assert not found.wrong
        if kind in ("collinear controls", "no excitation", "unobservable"):
            assert "not_identifiable" in found.verdicts
        if kind == "wrong sign":
            assert "weak" in found.verdicts
            assert "sign contradicted" in found.status


def test_well_posed_reads_ok():
    """At least 95 % of the parameters of three problems, as of the many in the verification."""
    verdicts = [v for seed in (300, 301, 302) for v in judged(problem(seed, None)).verdicts]
    assert np.mean([v == "ok" for v in verdicts]) >= 0.95


def test_saturated_samples_are_found_and_others_are_not():
    t = np.arange(400) / 25.0
    noisy = np.sin(t) + 0.01 * np.random.default_rng(0).standard_normal(len(t))
    assert not saturated(noisy).any()
    assert not saturated(np.round(noisy / 0.01) * 0.01).any()  # quantized is not saturated
    assert not saturated(np.zeros(100)).any()
    clipped = np.clip(noisy, -0.7, 2.0)
    stuck = saturated(clipped)
    assert stuck[clipped == -0.7].all()
    assert not stuck[clipped > 0.0].any()
