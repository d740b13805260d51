"""In-flight calibration on flights whose truth is known; refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from alula.airdata.inflight import calibrate_in_flight
from alula.airdata.inflight_model import autoregression
from alula.airdata.inflight_motion import prepared
from alula.airdata.inflight_record import AirDataRecord, record_of
from alula.base.messages import BadInput
from alula.flight import Channel, Flight
from verification.airdata.inflight_calibration import flown, record, truth_of


@pytest.fixture(scope="module")
def wandering() -> AirDataRecord:
    return record(flown(3, 150.0, sigma=0.5), truth_of(3), 3)


def test_truth_is_inside(wandering: AirDataRecord) -> None:
    found = calibrate_in_flight(wandering)
    truth = truth_of(3).errors
    for name in ("k_V", "k_alpha", "b_alpha", "k_beta", "b_beta", "wind_north", "wind_east"):
        one = found[name]
        assert one.verdict != "not_identifiable", name
        # Four standard errors: one in 15000 lies outside, and the seed is fixed.
        assert abs(one.value - truth[name]) < 4.0 * one.se, name
        assert one.ci95[0] < one.value < one.ci95[1]
    # It is worth something: the upwash to 0.1, the airspeed to 2 %.
    assert found["k_alpha"].se < 0.05
    assert found["k_V"].se < 0.01
    assert found.rich
    assert found.gps_delay == pytest.approx(truth["gps_delay"], abs=0.02)
    right = found.corrected({"V": wandering.readings["V"]})["V"]
    assert np.mean(right) == pytest.approx(
        np.mean(wandering.readings["V"]) / (1.0 + found["k_V"].value)
    )


def test_straight_flight_is_refused() -> None:
    found = calibrate_in_flight(record(flown(1, 100.0, straight=True), truth_of(1), 1))
    assert not found.rich
    assert found["k_V"].verdict == "not_identifiable"
    assert np.isnan(found["k_V"].value)
    assert {n for n, _ in found["k_V"].tied_to} & {"wind_north", "wind_east"}
    assert "flight_not_rich" in {m.code for m in found.messages}
    with pytest.raises(BadInput, match="flight_not_rich"):
        found.corrected({"V": np.ones(3)})
    assert found.as_dict()["rich"] is False
    assert "not identifiable" in found.summary()


def test_flank_angle_and_no_vanes(wandering: AirDataRecord) -> None:
    """Without vanes airspeed and wind remain; a vane that reads the flank angle says so."""
    readings = {k: v for k, v in wandering.readings.items() if k not in ("alpha", "beta")}
    found = calibrate_in_flight(replace(wandering, readings=readings))
    truth = truth_of(3).errors
    assert abs(found["k_V"].value - truth["k_V"]) < 4.0 * found["k_V"].se
    with pytest.raises(BadInput, match="unknown_parameter"):
        found["k_alpha"]
    readings["beta_flank"] = np.asarray(wandering.readings["beta"])
    assert "beta_flank" in calibrate_in_flight(replace(wandering, readings=readings)).outputs


def test_holes_and_nan_are_left_out(wandering: AirDataRecord) -> None:
    readings = {k: np.array(v) for k, v in wandering.readings.items()}
    readings["alpha"][1000:1500] = np.nan
    readings["V"][3000:3200] = np.nan
    readings["v_north"][4000:4010] = np.nan
    found = calibrate_in_flight(replace(wandering, readings=readings))
    truth = truth_of(3).errors
    for name in ("k_V", "k_alpha"):
        assert abs(found[name].value - truth[name]) < 4.0 * found[name].se


def test_motion_is_smoothed_to_the_truth() -> None:
    """Blended with the inertial sensors the GPS's 0.1 m/s is down to a fraction."""
    flight = flown(2, 100.0)
    smooth, delay = prepared(record(flight, truth_of(2), 2))
    assert delay == pytest.approx(0.15, abs=0.01)
    off = smooth.readings["v_north"] - np.interp(smooth.t, flight.motion.t, flight.velocity[:, 0])
    inside = slice(50, -50)  # at the ends a parabola of 4 s to one side is less well known
    assert np.std(off[inside]) < 0.06


def test_autoregression_finds_its_own() -> None:
    random = np.random.default_rng(1)
    from scipy.signal import lfilter

    x = lfilter([1.0], [1.0, -0.9, 0.2], random.standard_normal(20000))
    # Standard errors of the coefficients are 0.007.
    assert autoregression(x, 10)[:3] == pytest.approx([1.0, -0.9, 0.2], abs=0.03)
    assert autoregression(random.standard_normal(20), 10).tolist() == [1.0]


def _flight(record: AirDataRecord, **changed: np.ndarray) -> Flight:
    return Flight(
        "log",
        {
            n: Channel(n, record.t, changed.get(n, np.asarray(v)), "", "made")
            for n, v in record.readings.items()
        },
    )


def test_record_of_a_flight(wandering: AirDataRecord) -> None:
    V = np.array(wandering.readings["V"])
    V[:500] = 0.0  # on the ground
    made = record_of(_flight(wandering, V=V), rate=25.0)
    assert np.isnan(made.readings["V"][:240]).all()
    assert np.isfinite(made.readings["V"][260:]).all()
    assert made.messages[0].code == "resampled"
    assert np.median(np.diff(made.t)) == pytest.approx(0.04)


def test_bad_input(wandering: AirDataRecord) -> None:
    flight = _flight(wandering)
    with pytest.raises(BadInput, match="air_data_too_short"):
        record_of(flight, 10.0, 30.0)
    lacking = Flight("log", {k: v for k, v in flight.channels.items() if k != "v_east"})
    with pytest.raises(BadInput, match="v_east"):
        record_of(lacking)
    with pytest.raises(BadInput, match="air_data_time"):
        replace(wandering, t=wandering.t[::-1])
    with pytest.raises(BadInput, match="missing_channel"):
        replace(wandering, readings={"V": wandering.readings["V"]})
    with pytest.raises(BadInput, match="known_error"):
        calibrate_in_flight(wandering, known={"b_phi": -1.0})
    with pytest.raises(BadInput, match="known_error"):
        calibrate_in_flight(wandering, known={"b_nose": 1.0})
    nothing = {**wandering.readings, "V": np.full(len(wandering.t), np.nan)}
    with pytest.raises(BadInput, match="air_data_too_short"):
        replace(wandering, readings=nothing)
