"""Sensors at any rate, place and time base: the reconstruction is that of the motion itself."""

from dataclasses import replace

import made
import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.flight import Channel

TRUE = dict(
    zip(
        [f"b_{n}" for n in made.IMU] + ["wind_n", "wind_e", "wind_d"],
        made.BIAS.tolist() + made.WIND.tolist(),
        strict=True,
    )
)


def near_truth(result, skip=()):
    for name, (value, se) in made.constants(result).items():
        if name not in skip:
            # A dozen constants a case: beyond four standard errors one case in a thousand.
            assert abs(value - TRUE[name]) < 4.0 * se, name


@pytest.mark.parametrize("method", ["ekf", "iekf", "ukf", "srukf", "ml"])
def test_perfect_sensors_give_back_the_truth(method):
    recipe = made.Recipe(noise=0.0, duration=20.0)
    result, truth = made.solve(recipe, filter=method)
    for name, (value, _) in made.constants(result).items():
        # What is left is the trapezoid's error of inputs at 50 Hz and motion of 1 rad/s: 1e-5.
        assert value == pytest.approx(TRUE[name], abs=2e-5 if name.startswith("b_") else 1e-3)
    motion = result.segments[0].motion
    air = truth.air(motion.t)
    np.testing.assert_allclose(motion.V, air[:, 0], atol=1e-3)
    np.testing.assert_allclose(motion.alpha, air[:, 1], atol=2e-5)
    np.testing.assert_allclose(motion.beta, air[:, 2], atol=2e-5)


@pytest.mark.parametrize("method", ["ekf", "iekf", "ukf", "srukf", "ml"])
def test_noisy_sensors_give_the_truth_within_their_errors(method):
    result, _ = made.solve(made.Recipe(), filter=method)
    near_truth(result)


def test_slow_sensors_off_the_grid_give_the_same_as_on_it():
    slow = dict.fromkeys(("north", "east", "v_north", "v_east", "v_down"), 0.2)
    on, _ = made.solve(made.Recipe(every=slow))
    off, _ = made.solve(made.Recipe(every=slow, offset=dict.fromkeys(slow, 0.0137)))
    near_truth(on)
    near_truth(off)
    a, b = made.constants(on), made.constants(off)
    for name in a:
        assert abs(a[name][0] - b[name][0]) < 4.0 * a[name][1]
        # As many readings, as good: the same error bars but for one reading less of 150.
        assert b[name][1] == pytest.approx(a[name][1], rel=0.05)
    assert "inputs_interpolated" in {m.code for m in off.messages}
    motion = off.segments[0].motion
    assert len(motion.t) == 1501  # on the inertial sensor's stamps alone


def test_treated_as_on_the_grid_an_off_grid_sensor_would_be_wrong():
    """The positive control: 6.3 ms of turning at 4 m/s2, seen by a perfect speed sensor."""
    slow = {"v_east": 0.2}
    recipe = made.Recipe(every=slow, offset={"v_east": 0.0137}, noise=0.0, duration=10.0)
    flight, _ = made.record(recipe)
    channel = flight["v_east"]
    rounded = replace(channel, t=np.round(channel.t / 0.02) * 0.02)
    right, _ = made.solve(recipe, flight)
    wrong, _ = made.solve(recipe, made.replaced(flight, "v_east", rounded))
    assert right.segments[0].mismatch["v_east"] < 1e-3
    assert wrong.segments[0].mismatch["v_east"] > 1e-2


def test_readings_that_are_no_numbers_count_as_none():
    recipe = made.Recipe(duration=20.0)
    flight, _ = made.record(recipe)
    alpha = flight["alpha"]
    holes = alpha.values.copy()
    holes[100:400] = np.nan
    kept = np.isfinite(holes)
    with_nan = made.replaced(flight, "alpha", replace(alpha, values=holes))
    shorter = replace(alpha, t=alpha.t[kept], values=alpha.values[kept])
    a, _ = made.solve(recipe, with_nan)
    b, _ = made.solve(recipe, made.replaced(flight, "alpha", shorter))
    for name, (value, se) in made.constants(a).items():
        other = made.constants(b)[name]
        assert (value, se) == pytest.approx(other, rel=1e-9)
    sensor = next(s for s in a.segments[0].sensors if s.name == "alpha")
    assert len(sensor.t) == kept.sum()
    near_truth(a)


def test_lever_arms_are_taken_out():
    recipe = made.Recipe(
        imu=(1.5, -0.8, 0.4),
        places={
            "alpha": (6.0, 0.5, -0.2), "beta": (6.0, -0.5, 0.3), "V": (4.0, 2.0, 0.0),
            "v_north": (-2.0, 0.0, -1.0), "v_east": (-2.0, 0.0, -1.0), "v_down": (-2.0, 0.0, -1.0),
            "north": (-2.0, 0.0, -1.0), "east": (-2.0, 0.0, -1.0), "h": (1.0, 0.0, 0.5),
        },
        noise=0.0, duration=20.0,
    )  # fmt: skip
    result, truth = made.solve(recipe)
    motion = result.segments[0].motion
    air, force = truth.air(motion.t), truth.force(motion.t)
    np.testing.assert_allclose(motion.V, air[:, 0], atol=2e-3)
    np.testing.assert_allclose(motion.alpha, air[:, 1], atol=5e-5)
    np.testing.assert_allclose(motion.beta, air[:, 2], atol=5e-5)
    # Rotation makes 0.19 m/s2 of difference over this arm. Left: the angular accelerations, local
    # cubics over 0.16 s, good to 1e-3 rad/s2.
    found = np.column_stack([motion.ax, motion.ay, motion.az])
    np.testing.assert_allclose(found, force, atol=3e-3)
    assert np.abs(truth.force(motion.t, recipe.imu) - force).max() > 0.15
    np.testing.assert_allclose(motion.h, 1000.0 - truth.position(motion.t)[:, 2], atol=0.01)


def test_heading_through_south_is_no_jump():
    sensors = tuple(s for s in made.ALL if s not in ("north", "east"))
    recipe = made.Recipe(psi0=np.pi - 0.05, sensors=sensors, duration=20.0)
    flight, _ = made.record(recipe)
    psi = flight["psi"]
    wrapped = np.arctan2(np.sin(psi.values), np.cos(psi.values))
    assert np.ptp(wrapped) > 6.0  # it does go through 180 deg
    result, _ = made.solve(recipe, made.replaced(flight, "psi", replace(psi, values=wrapped)))
    near_truth(result)
    plain, _ = made.solve(recipe, flight)
    for name, (value, se) in made.constants(plain).items():
        assert abs(made.constants(result)[name][0] - value) < 1e-3 * se
    heading = next(s for s in result.segments[0].sensors if s.name == "psi")
    assert np.abs(heading.measured - heading.fitted).max() < 6.0 * made.SIGMA["psi"]


@pytest.mark.parametrize("case", ["plain", "date line", "holes"])
def test_latitude_and_longitude_are_local_meters(case):
    recipe = made.Recipe(duration=20.0)
    flight, truth = made.record(recipe)
    # Radii of WGS-84 at 49 deg N and 1000 m by their definition, Dittrich 2016, Eq. (2.3) to (2.5).
    phi, a, e2 = np.deg2rad(49.0), 6378137.0, 6.69437999014e-3
    w = np.sqrt(1.0 - e2 * np.sin(phi) ** 2)
    meridian, prime = a * (1.0 - e2) / w**3 + 1000.0, (a / w + 1000.0) * np.cos(phi)
    channels = {k: c for k, c in flight.channels.items() if k not in ("north", "east")}
    north, east = flight["north"], flight["east"]
    channels["lat"] = Channel("lat", north.t, phi + north.values / meridian, "rad", "made")
    longitude = 0.29 + east.values / prime
    if case == "date line":  # crossed within the maneuver
        longitude += np.pi - 0.29 - 0.5 * np.ptp(east.values) / prime
        longitude = np.arctan2(np.sin(longitude), np.cos(longitude))
        assert np.ptp(longitude) > 6.0
    channels["lon"] = Channel("lon", east.t, longitude, "rad", "made")
    if case == "holes":  # no fix at first, and a barometer that starts later
        for name in ("lat", "h"):
            values = channels[name].values.copy()
            values[:3] = np.nan
            channels[name] = replace(channels[name], values=values)
        flight = made.replaced(flight, "h", channels["h"])
        first = replace(north, values=np.where(np.isfinite(channels["lat"].values),
                                               north.values, np.nan))  # fmt: skip
        flight = made.replaced(flight, "north", first)
    local, _ = made.solve(recipe, flight)
    geodetic = made.spec(
        [s for s in made.ALL if s not in ("north", "east")],
    )
    sensors = dict(geodetic.sensors)
    sensors |= {"lat": made.spec().sensors["north"], "lon": made.spec().sensors["east"]}
    maneuver = made.Maneuver("m", "made", "", 0.0, recipe.duration)
    result = made.reconstruct(
        {"made": replace(flight, channels=channels)}, [maneuver], made.aircraft(recipe),
        geodetic.model_copy(update={"sensors": sensors}),
    )  # fmt: skip
    for name, (value, se) in made.constants(local).items():
        # The radii are taken at the first sample, whose height is noisy by 1 m in 6e6.
        assert made.constants(result)[name][0] == pytest.approx(value, abs=0.02 * se)
    assert truth.position(np.array([20.0]))[0, 0] > 500.0  # far enough for the radii to matter


def test_duplicate_sensors_are_compared():
    recipe = made.Recipe(duration=15.0)
    flight, _ = made.record(recipe)
    alpha = flight["alpha"]
    twin = Channel("alpha_2", alpha.t, alpha.values + 0.02, "rad", "made")
    result, _ = made.solve(recipe, made.replaced(flight, "alpha_2", twin))
    said = [m for m in result.messages if m.code == "duplicate_sensors"]
    assert len(said) == 1
    assert "offset 0.02 rad" in said[0].found
    broken = replace(twin, values=np.random.default_rng(1).normal(0.0, 0.1, len(alpha.t)))
    result, _ = made.solve(recipe, made.replaced(flight, "alpha_2", broken))
    assert "duplicate_sensors_disagree" in {m.code for m in result.messages}


def test_a_longitude_without_any_latitude_is_refused():
    recipe = made.Recipe(duration=10.0, sensors=made.AIR)
    flight, _ = made.record(recipe)
    lon = Channel("lon", flight["h"].t, 0.3 + 1e-6 * flight["h"].t, "rad", "made")
    spec = made.spec(made.AIR)
    maneuver = made.Maneuver("m", "made", "", 0.0, 10.0)
    with pytest.raises(BadInput, match="latitude"):
        made.reconstruct(
            {"made": replace(flight, channels={**flight.channels, "lon": lon})}, [maneuver],
            made.aircraft(recipe), spec,
        )  # fmt: skip


def test_attitudes_a_turn_apart_are_the_same_and_heights_are_compared():
    recipe = made.Recipe(duration=15.0, psi0=np.pi - 0.05)
    flight, _ = made.record(recipe)
    psi, h = flight["psi"], flight["h"]
    wrapped = np.arctan2(np.sin(psi.values), np.cos(psi.values))
    assert np.ptp(wrapped) > 6.0
    both = made.replaced(flight, "psi_2", Channel("psi_2", psi.t, wrapped + 0.01, "rad", "made"))
    slow = Channel("h_gps", h.t[::10], h.values[::10] + 47.0, "m", "made")  # the geoid
    result, _ = made.solve(recipe, made.replaced(both, "h_gps", slow))
    said = {m.where.split(", ")[1]: m for m in result.messages if m.code == "duplicate_sensors"}
    assert "offset 0.01 rad" in said["psi and psi_2"].found
    assert "offset 47 m" in said["h and h_gps"].found
    assert "duplicate_sensors_disagree" not in {m.code for m in result.messages}


def test_wind_asked_for_without_ground_speed_is_not_observable():
    recipe = made.Recipe(sensors=made.AIR, steady=True, duration=20.0)
    unknowns = {"wind_n": {}, "wind_e": {}}
    result, _ = made.solve(recipe, unknowns=unknowns)
    names = {c.name for c in result.constants}
    assert "b_q" in names
    assert not names & {"wind_n", "wind_e"}
    assert {m.where for m in result.messages if m.code == "not_observable"} >= {
        "unknown wind_n",
        "unknown wind_e",
    }


def test_with_ground_speed_it_is():
    sensors = (*made.AIR, "v_north", "v_east", "v_down")
    result, _ = made.solve(made.Recipe(sensors=sensors, steady=True, duration=20.0))
    assert all(c.observable for c in result.constants if c.name.startswith("wind"))
    near_truth(result)
