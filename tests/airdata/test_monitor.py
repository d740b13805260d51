"""The monitor's front: who was named, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from alula.airdata.monitor import HEALTH, MonitorSettings, Source, monitor
from alula.base.messages import BadInput
from verification.airdata.monitor import KINDS, false_alarms, faulty

DEG = np.pi / 180.0


@pytest.mark.parametrize("kind", range(4))
def test_each_kind_of_fault(kind: int) -> None:
    """Two of each kind of the row's flights; all of them stand in the verification table."""
    for seed in (6 * kind, 6 * kind + 2):
        run = faulty(seed)
        assert run.kind == KINDS[kind]
        assert (run.named, run.reason) == (run.source, run.kind)
        assert 0.0 <= run.late < 2.0
        assert run.error < 0.4 * DEG  # the vote of five sources of 0.2 to 0.5 deg


def test_half_an_hour_without_alarm() -> None:
    assert false_alarms(0.5, seed=1) == 0


def three(n: int = 1000) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, Source]]:
    random, t = np.random.default_rng(1), np.arange(n) * 0.02
    source = Source(0.2 * DEG, 0.2 * DEG)
    names = ("left", "right", "probe")
    readings = {k: 0.05 + 0.2 * DEG * random.standard_normal(n) for k in names}
    return t, readings, dict.fromkeys(names, source)


def test_a_source_comes_back() -> None:
    t, readings, sources = three()
    readings["left"][300:500] = np.nan
    stays = monitor(t, readings, sources)
    assert [(one.source, one.reason) for one in stays.named] == [("left", "dead")]
    assert stays.named[0].t == pytest.approx(t[300] + 0.5, abs=0.05)
    assert HEALTH[stays.health[-1, 0]] == "dead"
    back = monitor(t, readings, sources, MonitorSettings(readmit=3.0))
    assert HEALTH[back.health[-1, 0]] == "healthy"
    assert back.used[-1] == 3
    assert back.messages[0].code == "source_dead"


def test_nothing_left_is_nan() -> None:
    t, readings, sources = three(300)
    none = {k: np.where(t < 2.0, v, np.nan) for k, v in readings.items()}
    voted = monitor(t, none, sources)
    assert np.isfinite(voted.angle[:90]).all()
    assert np.isnan(voted.angle[-1])
    assert voted.used[-1] == 0


def test_time_that_goes_back_is_counted() -> None:
    t, readings, sources = three(100)
    t[50] = t[40]
    assert [m.code for m in monitor(t, readings, sources).messages] == ["backward_time"]


def test_bad_input() -> None:
    t, readings, sources = three(100)
    for wrong in (
        {},
        {**sources, "nose": Source(0.1, 0.1)},
        {"left": Source(0.0, 0.0)},
    ):
        with pytest.raises(BadInput, match="monitor_sources"):
            monitor(t, readings, wrong)
