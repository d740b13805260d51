"""Filters, smoother, output error and no filter: what each promises."""

import re
import tomllib
from pathlib import Path
from typing import get_args

import made
import numpy as np
import pytest

from alula.base.filters import FILTERS as WORDS
from alula.base.filters import FilterName
from alula.base.messages import BadInput
from alula.core import core
from alula.flight import Channel, Maneuver
from alula.reconstruct import METHODS, reconstruct
from alula.reconstruct.problem import make_problem

FILTERS = ["ekf", "iekf", "ukf", "srukf"]


def problem_of(recipe, **more):
    flight, truth = made.record(recipe)
    maneuver = Maneuver("m", "made", "", 0.0, recipe.duration)
    spec = made.spec(recipe.sensors, **more)
    return make_problem({"made": flight}, [maneuver], made.aircraft(recipe), spec), truth


def run_core(problem, method, smooth, sigma=None):
    record, n = problem.records[0], len(problem.names)
    start = np.full(len(record.t), -1, dtype=np.int32)
    start[0] = 0
    none = np.zeros(problem.motion)
    out = getattr(core, f"path_{method}")(
        problem.model(sigma), record.t, record.inputs, record.readings, start, problem.initial,
        np.concatenate([none, [u.value for u in problem.unknowns]]),
        np.concatenate([none, [u.prior for u in problem.unknowns]]),
        smooth=smooth, keep_covariance=True,
    )  # fmt: skip
    i, j = np.triu_indices(n)
    P = np.zeros((len(record.t), n, n))
    P[:, i, j] = P[:, j, i] = out["covariance"]
    return out, P


@pytest.mark.parametrize("method", FILTERS)
def test_smoother_is_never_less_certain_than_the_filter(method):
    problem, _ = problem_of(made.Recipe(duration=15.0))
    _, filtered = run_core(problem, method, smooth=False)
    _, smoothed = run_core(problem, method, smooth=True)
    scale = np.sqrt(np.diagonal(filtered, axis1=1, axis2=2))
    scaled = (filtered - smoothed) / (scale[:, :, None] * scale[:, None, :])
    # Positive semidefinite in units of the filter's own deviations, but for rounding.
    assert np.linalg.eigvalsh(scaled).min() > -1e-6
    assert np.linalg.eigvalsh(smoothed / (scale[:, :, None] * scale[:, None, :])).min() > 0.0
    np.testing.assert_allclose(smoothed[-1], filtered[-1])
    assert np.mean(
        np.diagonal(smoothed[300, 1:4, 1:4]) < 0.8 * np.diagonal(filtered[300, 1:4, 1:4])
    )


@pytest.mark.parametrize("method", FILTERS)
@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_covariance_stays_positive_for_absurd_noise_levels(method, factor):
    # Perfect readings: noise a million times the stated one would only move the state about.
    problem, _ = problem_of(made.Recipe(duration=10.0, noise=0.0))
    sigma = [s.sigma * (factor if i % 2 else 1.0) for i, s in enumerate(problem.sensors)]
    out, P = run_core(problem, method, smooth=False, sigma=sigma)
    assert out["done"] == len(problem.records[0].t)
    scale = np.sqrt(np.diagonal(P, axis1=1, axis2=2))
    assert np.isfinite(scale).all()
    assert (scale > 0.0).all()
    # A correlation matrix whose least eigenvalue is rounding, not negative beyond it.
    assert np.linalg.eigvalsh(P / (scale[:, :, None] * scale[:, None, :])).min() > -1e-9


def test_every_name_is_registered_and_has_words():
    assert set(get_args(FilterName)) == set(WORDS) == {*METHODS, "none"}


def test_square_root_and_covariance_form_agree():
    """With position, wind and scale errors: nine motion states and the long rows."""
    unknowns = {"k_alpha": {"prior": 0.05}, "k_V": {"prior": 0.02}}
    problem, _ = problem_of(made.Recipe(duration=15.0), unknowns=unknowns)
    for smooth in (False, True):
        (a, P), (b, Q) = (run_core(problem, m, smooth=smooth) for m in ("ukf", "srukf"))
        sigma = np.sqrt(np.diagonal(P, axis1=1, axis2=2))
        # Rounding: a covariance of deviations 1e4 apart has eight digits left.
        assert np.max(np.abs(a["x"] - b["x"]) / sigma) < 1e-6
        assert np.max(np.abs(P - Q) / (sigma[:, :, None] * sigma[:, None, :])) < 1e-6
        assert a["repairs"] == b["repairs"] == 0


def test_iterated_filter_converges_or_says_that_it_did_not():
    recipe = made.Recipe(duration=15.0)
    iterated, _ = made.solve(recipe, filter="iekf")
    assert iterated.converged
    for name, truth in (("b_p", made.BIAS[3]), ("wind_n", made.WIND[0])):
        value, se = made.constants(iterated)[name]
        assert abs(value - truth) < 4.0 * se
    flight, _ = made.record(recipe)
    airspeed = flight["V"]
    values = airspeed.values.copy()
    values[100:110] = 2000.0  # against 60 m/s before and after, and against the ground's
    wrong = made.replaced(flight, "V", Channel("V", airspeed.t, values, "m/s", "made"))
    result, _ = made.solve(recipe, wrong, filter="iekf")
    assert not result.converged
    assert "did not converge" in result.status
    assert [m.where for m in result.messages if m.code == "update_not_converged"] == ["filter iekf"]


def test_innovations_are_white_and_of_the_stated_size():
    result, _ = made.solve(made.Recipe())
    low, high = result.nis_interval
    # The interval holds in 95 of 100 cases; here twice as wide.
    assert 2.0 * low - 1.0 < result.nis_mean < 2.0 * high - 1.0
    for sensor in result.segments[0].sensors:
        assert abs(sensor.whiteness) < 4.0 / np.sqrt(len(sensor.t))


def test_coloured_sensor_error_widens_the_error_bars():
    recipe = made.Recipe(duration=20.0)
    flight, _ = made.record(recipe)
    rng = np.random.default_rng(5)
    theta, wander = flight["theta"], np.zeros(1001)
    for k in range(1, 1001):
        wander[k] = 0.98 * wander[k - 1] + 0.2 * made.SIGMA["theta"] * rng.standard_normal()
    dirty = Channel("theta", theta.t, theta.values + 2.0 * wander, "rad", "made")
    clean = made.constants(made.solve(recipe, flight)[0])
    wide = made.constants(made.solve(recipe, made.replaced(flight, "theta", dirty))[0])
    # Twice the noise with a correlation time of 1 s: some fifty samples count as one.
    assert wide["b_q"][1] > 2.0 * clean["b_q"][1]
    assert abs(wide["b_q"][0] - made.BIAS[4]) < 4.0 * wide["b_q"][1]


def test_a_walk_follows_a_drifting_bias():
    recipe = made.Recipe(duration=30.0)
    flight, _ = made.record(recipe)
    az = flight["az"]
    drift = 0.2 * np.sin(2.0 * np.pi * az.t / 30.0)
    moved = made.replaced(flight, "az", Channel("az", az.t, az.values + drift, "m/s2", "made"))
    walk = {"b_az": {"state": "walk", "walk": 0.05}}
    walking, _ = made.solve(recipe, moved, unknowns=walk)
    fixed, _ = made.solve(recipe, moved)

    def rms(result):
        column = result.segments[0].state_names.index("b_az")
        found = result.segments[0].states[:, column]
        return np.sqrt(np.mean((found - made.BIAS[2] - drift) ** 2))

    # The drift has an rms of 0.14; a walk of 0.05 per square root of a second follows to a quarter.
    assert rms(fixed) > 0.1
    assert rms(walking) < 0.035
    column = walking.segments[0].state_names.index("b_az")
    error = walking.segments[0].states[:, column] - made.BIAS[2] - drift
    assert np.sqrt(np.mean((error / walking.segments[0].states_se[:, column]) ** 2)) < 2.0


def walk_of(t, random):
    """A random walk from zero, one per square root of a second."""
    steps = np.sqrt(np.diff(t)) * random.standard_normal(len(t) - 1)
    return np.concatenate([[0.0], np.cumsum(steps)])


@pytest.mark.parametrize("method", ["ekf", "ukf"])
def test_van_den_hoeks_states_as_the_page_has_them(method):
    """14 states; upwash and accelerometers drift as stated, and the errors are as stated."""
    page = Path(__file__).parents[2] / "docs/methods/flight_path_reconstruction.md"
    (block,) = re.findall(r"```toml\n(.*?)```", page.read_text(), re.S)
    asked = tomllib.loads(block)["reconstruct"]
    recipe = made.Recipe(duration=40.0, wind=(0.0, 0.0, 0.0), sensors=made.AIR)
    flight, truth = made.record(recipe)
    t, random = flight["az"].t, np.random.default_rng(5)
    true = {"k_alpha": 0.1 + 1e-3 * walk_of(t, random)}
    alpha = flight["alpha"].values + true["k_alpha"] * truth.air(t)[:, 1]
    flight = made.replaced(flight, "alpha", Channel("alpha", t, alpha, "rad", "made"))
    for i, name in enumerate(("ax", "ay", "az")):
        drift = 2e-3 * walk_of(t, random)
        true[f"b_{name}"] = made.BIAS[i] + drift
        moved = Channel(name, t, flight[name].values + drift, "m/s2", "made")
        flight = made.replaced(flight, name, moved)
    result, _ = made.solve(recipe, flight, **{**asked, "filter": method})
    (segment,) = result.segments
    assert segment.state_names == (
        "h", "u", "v", "w", "phi", "theta", "psi",
        "b_ax", "b_ay", "b_az", "b_p", "b_q", "b_r", "k_alpha",
    )  # fmt: skip
    off = []
    for name, values in true.items():
        i = segment.state_names.index(name)
        off.append((segment.states[:, i] - values) / segment.states_se[:, i])
        assert np.ptp(segment.states[:, i]) > 0.2 * np.ptp(values), name  # no constant
    # Four drifts of 40 s, each known anew every few: some twenty errors of one standard deviation,
    # whose rms scatters by 0.16.
    assert 0.5 < np.sqrt(np.mean(np.square(off))) < 1.5
    for i, name in enumerate(("b_p", "b_q", "b_r")):
        value, se = made.constants(result)[name]
        assert abs(value - made.BIAS[3 + i]) < 4.0 * se


@pytest.mark.parametrize("share", ["all", "log", "maneuver"])
def test_constants_are_shared_as_asked(share):
    recipe = made.Recipe(duration=15.0)
    flights, planned = {}, []
    for seed, log in enumerate(("a", "b")):
        flight, _ = made.record(recipe, seed)
        flights[log] = made.Flight(log, flight.channels)
        for part, (start, end) in enumerate(((0.0, 7.0), (7.5, 15.0))):
            planned.append(Maneuver(f"{log}{part}", log, "", start, end))
    spec = made.spec(recipe.sensors, share=share)
    result = reconstruct(flights, planned, made.aircraft(recipe), spec)
    assert [s.maneuver.id for s in result.segments] == ["a0", "a1", "b0", "b1"]
    groups = {"all": 1, "log": 2, "maneuver": 4}[share]
    assert len(result.constants) == 9 * groups
    assert result.constants_cov.shape == (9 * groups, 9 * groups)
    suffix = {"all": "", "log": "[b]", "maneuver": "[b1]"}[share]
    found = {c.name: c for c in result.constants}[f"b_p{suffix}"]
    assert abs(found.value - made.BIAS[3]) < 4.0 * found.se


def test_more_maneuvers_give_smaller_errors():
    recipe = made.Recipe(duration=20.0)
    flight, _ = made.record(recipe)
    halves = [Maneuver("1", "made", "", 0.0, 9.99), Maneuver("2", "made", "", 10.0, 20.0)]
    se = {}
    for share in ("all", "maneuver"):
        spec = made.spec(recipe.sensors, share=share)
        result = reconstruct({"made": flight}, halves, made.aircraft(recipe), spec)
        se[share] = {c.name: c.se for c in result.constants}
    for name in ("b_ax", "b_q", "wind_n"):
        two = (se["maneuver"][f"{name}[1]"] ** -2.0 + se["maneuver"][f"{name}[2]"] ** -2.0) ** -0.5
        # Independent halves add their information, but for the prior, which counts twice, and for
        # correlations between the constants.
        assert se["all"][name] == pytest.approx(two, rel=0.25)


def test_without_a_filter_the_channels_are_the_motion():
    recipe = made.Recipe(duration=10.0)
    flight, _ = made.record(recipe)
    result, _ = made.solve(recipe, flight, filter="none")
    assert result.constants == ()
    motion = result.segments[0].motion
    for name in ("V", "alpha", "beta", "phi", "theta", "p", "q", "r"):
        np.testing.assert_array_equal(getattr(motion, name), flight[name].values)


def test_states_taken_as_measured_need_output_error():
    with pytest.raises(BadInput, match="given"):
        made.solve(made.Recipe(duration=5.0), given=["phi"])


def test_stated_initial_motion_is_what_output_error_holds():
    recipe = made.Recipe(duration=10.0, noise=0.0)
    truth = made.Motion(recipe)
    u, v, w = truth.velocity(np.zeros(1))[0]
    stated = {"m": {"u": {"value": u}, "v": {"value": v}, "w": {"value": w}}}
    result, _ = made.solve(recipe, filter="ml", initial_state="measured", initial=stated)
    start = dict(zip(result.segments[0].state_names, result.segments[0].states[0], strict=True))
    assert (start["u"], start["v"], start["w"]) == (u, v, w)
    name, value = "u", {"value": u / 0.3048, "unit": "ft/s"}
    feet, _ = made.solve(
        recipe, filter="ml", initial_state="measured", initial={"m": {**stated["m"], name: value}}
    )
    assert feet.segments[0].states[0, 1] == pytest.approx(u, rel=1e-12)
