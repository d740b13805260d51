"""The campaign of `make demo`: it flies whole, as its source says, and the truth is found."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from alula.campaign import run_project
from alula.model import load_model
from alula.simulate.virtual_campaign import fly_plan
from alula.simulate.virtual_flight import fly_maneuver, trimmed
from alula.simulate.virtual_loading import loadings_of
from alula.simulate.virtual_maneuvers import maneuvers_of
from alula.simulate.virtual_plan import Plan, load_plan

ROOT = Path(__file__).parents[2]
MODEL = load_model(ROOT / "aircraft" / "sportstar_aero.toml")


@pytest.fixture(scope="module")
def plan() -> Plan:
    return load_plan(ROOT / "examples" / "demo" / "campaign.toml")


def test_it_is_the_campaign_of_its_source(plan: Plan) -> None:
    """Dittrich 2016, section 4.3 and Table 4.3: 915 and 2438 m, 30 and 32 % of a chord of 1.25 m,
    from 1.2 V_S1 = 24.7 m/s, calibrated, to V_H = 59 m/s.
    """
    conditions = {m.condition for m in maneuvers_of(plan) if "check" not in m.condition.id}
    assert {c.h for c in conditions} == {915.0, 2438.0}
    for h, density in ((915.0, 0.9151), (2438.0, 0.7861)):  # over sea level's, US 1976
        speeds = [c.V for c in conditions if c.h == h]
        assert min(speeds) * np.sqrt(density) == pytest.approx(24.7, abs=0.1)
        assert max(speeds) == 59.0
    fwd, aft = (x.cg for x in loadings_of(plan).values())
    np.testing.assert_allclose(aft - fwd, [-0.02 * 1.25, 0.0, 0.0], atol=1e-12)


def test_every_maneuver_stays_in_the_envelope(plan: Plan) -> None:
    loadings = loadings_of(plan)
    trims = {}
    for item in maneuvers_of(plan):
        loading = loadings[item.loading]
        key = (item.loading, item.condition)
        if key not in trims:
            trims[key] = trimmed(plan, loading, MODEL, item.condition)
        m = fly_maneuver(plan, item, loading, MODEL, trims[key]).motion
        low, high = loading.aircraft.envelope.V or (0.0, 0.0)
        assert low < m.V.min() < m.V.max() < high, item.maneuver.id
        # A light aircraft's load factors, without a push; sideslip as the model knows it.
        assert -3.8 * 9.81 < m.az.min() < m.az.max() < 0.0, item.maneuver.id
        assert np.abs(m.beta).max() < MODEL.validity["beta"][1], item.maneuver.id
        # Short of the stall, which the formulas asked for do not know.
        assert m.alpha.max() < 0.26, item.maneuver.id


@pytest.mark.slow
def test_identified_values_are_the_true_ones(plan: Plan, tmp_path: Path) -> None:
    inside, far = [], []
    for seed in range(31, 34):
        found = fly_plan(plan, tmp_path / "out", seed=seed)
        assert not found.failed
        truth = json.loads((found.folder / "truth.json").read_text())["parameters"]
        for p in run_project(str(found.project)).identification.parameters:
            true = truth.get(p.name, 0.0)
            inside.append(p.ci95[0] <= true <= p.ci95[1])
            far.append(abs(p.value - true) > 5.0 * p.se)
    # 3 x 27 intervals of 95 %, those of one seed correlated as if they were a third as many.
    assert np.mean(inside) > 0.82  # three standard errors of 27 draws
    assert not any(far)
