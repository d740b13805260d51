"""Joint filter and pair on motions known exactly, and on what recordings really bring."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.navigate import (
    Inertial,
    JointSettings,
    PairSettings,
    Readings,
    Start,
    assumed_sideslip,
    navigate_joint,
    navigate_pair,
)
from navigate.recordings import FIELD, sensors, turning, without

SETTINGS = JointSettings(field=tuple(FIELD), gust=(0.2, 0.2, 0.2))
WIND = (5.0, -8.0, 0.0)


def off_deg(found, motion, every: int) -> np.ndarray:
    """Differences of phi theta psi, deg."""
    d = np.degrees(motion.euler[::every] - found.euler)
    return (d + 180.0) % 360.0 - 180.0


def test_turn_in_wind() -> None:
    motion = turning(60.0, wind=WIND)
    found = navigate_joint(motion.inertial, sensors(motion), SETTINGS, every=40)
    late = found.t > 30.0
    # exact readings: what is left is what biases, still being found, hide
    assert np.abs(off_deg(found, motion, 40)[late]).max() < 0.1
    assert np.abs(found.wind[late] - WIND).max() < 0.1
    assert np.abs((found.position - motion.position[::40])[late]).max() < 0.1
    assert np.all(
        np.abs(off_deg(found, motion, 40)[late]) < 3.0 * np.degrees(found.se("euler"))[late]
    )
    for sensor in found.takings:
        assert "gated" not in sensor.counts
        assert sensor.mean_nis < 0.2  # no noise, far less than stated
    assert found.inertial == {"taken": len(motion.t)}


def test_straight_flight_without_vanes_does_not_know_the_wind_across() -> None:
    motion = turning(20.0, turn=0.0, wind=WIND)
    plain = without(sensors(motion), "alpha", "beta")
    found = navigate_joint(motion.inertial, plain, SETTINGS, every=400)
    assert found.se("wind")[-1, 0] < 1.0  # along: the airspeed tells
    assert found.se("wind")[-1, 1] > 4.0  # across: nothing does
    more = navigate_joint(
        motion.inertial, [*plain, assumed_sideslip(motion.inertial)], SETTINGS, every=400
    )
    assert more.se("wind")[-1, 1] < 2.0  # 0.12 rad of 30 m/s over the root of 20 readings, and more
    assert np.abs(more.wind[-1] - WIND)[:2].max() < 3.0 * more.se("wind")[-1].max()


@pytest.mark.parametrize("psi", [0.5, 2.0, -3.0, np.pi])
def test_unknown_heading_is_found(psi: float) -> None:
    motion = turning(30.0)
    start = Start(
        t=0.0, euler=(0.55, 0.0, psi), velocity=motion.velocity[0], position=motion.position[0],
        sigma_heading=1.8,
    )  # fmt: skip
    found = navigate_joint(motion.inertial, sensors(motion), SETTINGS, start, every=400)
    assert np.abs(off_deg(found, motion, 400)[-1]).max() < 0.2
    pair = navigate_pair(
        motion.inertial, sensors(motion), PairSettings(field=tuple(FIELD)), start, every=400
    )
    assert np.abs(off_deg(pair, motion, 400)[-1]).max() < 2.0


def test_pair_in_a_turn_needs_the_centripetal_part() -> None:
    motion = turning(60.0)
    settings = PairSettings(field=tuple(FIELD))
    found = navigate_pair(motion.inertial, sensors(motion), settings, every=400)
    # a bank of 31 deg: without w x V gravity would be seen along the body's z, bank zero
    assert np.abs(off_deg(found, motion, 400)[-10:]).max() < 1.0
    assert np.isnan(found.wind).all()
    assert found.covariance.shape[1:] == (15, 15)


def test_late_readings_are_taken_as_late() -> None:
    motion = turning(40.0, wind=WIND)
    for delay in (0.0, 0.2, 1.0):
        found = navigate_joint(motion.inertial, sensors(motion, delay=delay), SETTINGS, every=400)
        # at 30 m/s a second taken for none would be 30 m
        assert np.abs(found.position[-1] - motion.position[-1]).max() < 0.2
    too_late = navigate_joint(motion.inertial, sensors(motion, delay=3.0), SETTINGS, every=400)
    assert too_late.takings[0].counts.get("taken", 0) == 0
    assert too_late.takings[0].counts["too_old"] > 150


def test_numbers_that_are_none_change_nothing() -> None:
    motion = turning(20.0)
    clean = sensors(motion)
    dirty, spoiled = [], 0
    for r in clean:
        again = np.array(r.values)
        bad = np.full_like(again[:10], np.nan)
        spoiled += 10
        # after each of ten readings, one that is not a number
        t = np.concatenate([r.t, r.t[10:20]])
        dirty.append(
            Readings(
                r.kind, t, np.concatenate([again, bad]), r.sigma,
                None if r.arrived is None else np.concatenate([r.arrived, r.arrived[10:20]]),
            )
        )  # fmt: skip
    found = navigate_joint(motion.inertial, dirty, SETTINGS, every=100)
    same = navigate_joint(motion.inertial, clean, SETTINGS, every=100)
    assert sum(s.counts["not_finite"] for s in found.takings) == spoiled
    np.testing.assert_array_equal(found.q, same.q)
    np.testing.assert_array_equal(found.covariance, same.covariance)


def test_inertial_samples_that_are_none_are_counted() -> None:
    motion = turning(20.0)
    rate, t = np.array(motion.rate), np.array(motion.t)
    rate[4000:4004] = np.nan
    t[6000] = t[5999] - 1.0  # back in time
    found = navigate_joint(Inertial(t, rate, motion.force), sensors(motion), SETTINGS, every=400)
    assert found.inertial["not_finite"] == 4
    assert found.inertial["backwards"] == 1
    assert np.isfinite(found.covariance).all()
    assert np.abs(off_deg(found, motion, 400)[-1]).max() < 0.3


def test_jump_of_a_kilometer() -> None:
    motion = turning(40.0)
    readings = sensors(motion)
    jump = np.array(readings[0].values)
    jump[(readings[0].t > 20.0) & (readings[0].t < 23.0)] += [1000.0, 0.0, 0.0]
    readings[0] = replace(readings[0], values=jump)
    found = navigate_joint(motion.inertial, readings, SETTINGS, every=40)
    after = found.t > 20.0
    assert found.takings[0].counts["gated"] == 14
    assert np.abs((found.position - motion.position[::40])[after]).max() < 1.0


def test_ten_seconds_without_any_update() -> None:
    motion = turning(60.0)
    quiet = []
    for r in sensors(motion):
        keep = (r.t < 30.0) | (r.t > 40.0)
        quiet.append(
            replace(r, t=r.t[keep], values=r.values[keep],
                    arrived=None if r.arrived is None else r.arrived[keep])
        )  # fmt: skip
    found = navigate_joint(motion.inertial, quiet, SETTINGS, every=40)
    se = found.se("position")[:, 0]
    at = {t: int(t * 10) for t in (30, 40, 50)}
    assert se[at[40]] > 2.0 * se[at[30]]
    assert np.all(np.diff(se[at[30] + 5 : at[40]]) > 0.0)
    assert se[at[50]] < 1.2 * se[at[30]]
    error = np.abs(found.position - motion.position[::40])[:, 0]
    assert np.all(error[at[30] : at[40]] < 3.0 * se[at[30] : at[40]])


def test_magnetic_disturbance() -> None:
    motion = turning(60.0)
    readings = sensors(motion)
    field = np.array(readings[2].values)
    field[(readings[2].t > 30.0) & (readings[2].t < 45.0)] += [0.0, 25e-6, 0.0]
    readings[2] = replace(readings[2], values=field)
    found = navigate_joint(motion.inertial, readings, SETTINGS, every=40)
    # the filter knows its attitude to some tenths of a degree then: all of it is refused
    assert found.takings[2].counts["gated"] > 740
    assert np.abs(off_deg(found, motion, 40)[found.t > 30.0]).max() < 0.3


def test_nothing_but_inertial_samples() -> None:
    motion = turning(5.0)
    found = navigate_joint(motion.inertial, [], JointSettings(), every=100)
    assert [m.code for m in found.messages] == ["unknown_heading"]
    assert np.isfinite(found.covariance).all()


@pytest.mark.parametrize(
    "wrong",
    [
        Readings("speed", np.zeros(2), np.zeros(2), 1.0),
        Readings("V", np.zeros(2), np.zeros(3), 1.0),
        Readings("V", np.zeros(2), np.zeros(2), 0.0),
        Readings("V", np.zeros(2), np.zeros(2), float("nan")),
        Readings("position", np.zeros(2), np.zeros((2, 2)), 1.0),
    ],
)
def test_readings_that_make_no_sense_are_refused(wrong: Readings) -> None:
    motion = turning(1.0)
    with pytest.raises(BadInput) as raised:
        navigate_joint(motion.inertial, [wrong], SETTINGS)
    assert raised.value.messages[0].code == "readings"


def test_no_inertial_sample_is_refused() -> None:
    nan = np.full((10, 3), np.nan)
    with pytest.raises(BadInput):
        navigate_joint(Inertial(np.arange(10.0), nan, nan), [], SETTINGS)
    with pytest.raises(BadInput):
        Inertial(np.arange(10.0), nan, nan[:5])


def test_flight_in_turbulence() -> None:
    """Two and a half minutes of the row that `make verify` judges over ten."""
    from verification.airdata.navigation_flight import navigation_flight

    got, holds = navigation_flight(True)
    assert holds, got


def test_ten_readings_a_second_are_no_row_of_holes() -> None:
    t = 0.1 * np.arange(601)  # whose differences are 0.1 but for the last bits, above and below
    still = Inertial(t, np.zeros((601, 3)), np.tile([0.0, 0.0, -9.80665], (601, 1)))
    assert np.diff(t).max() > 0.1
    assert not navigate_joint(still, [], SETTINGS).inertial.get("gap")
    kept = np.delete(np.arange(601), np.arange(300, 310))
    holed = Inertial(t[kept], still.rate[kept], still.force[kept])
    assert navigate_joint(holed, [], SETTINGS).inertial["gap"] == 1
    assert not navigate_pair(still, []).inertial.get("gap")
    assert navigate_pair(holed, []).inertial["gap"] == 1
