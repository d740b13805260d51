"""A virtual flight test: same seed, same bytes; logs and truth agree as the sensors say."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput
from alula.base.project import load_project
from alula.model import load_model
from alula.simulate.virtual_campaign import fly_plan
from alula.simulate.virtual_flight import fly_maneuver, trimmed
from alula.simulate.virtual_loading import loadings_of
from alula.simulate.virtual_maneuvers import maneuvers_of
from alula.simulate.virtual_plan import Plan, load_plan
from alula.simulate.virtual_sensing import channels_of, constants_of, sensed
from simulate.virtual import AIRCRAFT, doublet, plan_tree, small_plan

MODEL = load_model(AIRCRAFT / "sportstar_aero.toml")
DEG = np.pi / 180.0
WIDTHLESS = {"control": "de", "kind": "doublet", "amplitude_deg": 1.0}


def bytes_of(folder: Path) -> dict[str, str]:
    return {
        str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in sorted(folder.rglob("*"))
        if p.is_file()
    }


def noisy(folder: Path, **more: object) -> Plan:
    return small_plan(
        folder,
        conditions=[{"V": [40.0, 50.0], "h": 915.0}],
        maneuvers=[
            {"id": "pull", "inputs": [doublet("de", 1.0)]},
            {"id": "yaw", "inputs": [doublet("dr", 2.0)]},
        ],
        sensors={
            "alpha": {"sigma": 0.1, "bias_sigma": 0.3, "scale_sigma": 0.05, "unit": "deg"},
            "V": {"sigma": 0.2},
            "h": {"sigma": 0.5, "rate": 10.0},
        },
        **more,
    )


def test_same_seed_same_bytes_whatever_the_threads(tmp_path: Path) -> None:
    plan = noisy(tmp_path)
    one = fly_plan(plan, tmp_path / "one", seed=5, threads=1)
    many = fly_plan(plan, tmp_path / "many", seed=5, threads=4)
    other = fly_plan(plan, tmp_path / "other", seed=6, threads=4)
    assert bytes_of(one.folder) == bytes_of(many.folder)
    assert len(one.maneuvers) == 4
    a, c = bytes_of(one.folder), bytes_of(other.folder)
    assert all(a[name] != c[name] for name in a if name.endswith(".csv"))
    truth = [name for name in a if name.startswith("truth/")]
    assert truth
    assert all(a[name] == c[name] for name in truth)  # no turbulence: the seed is the sensors'


def test_a_maneuver_does_not_depend_on_its_neighbours(tmp_path: Path) -> None:
    plan = noisy(tmp_path)
    alone = plan.model_copy(update={"maneuvers": [plan.maneuvers[1]]})
    alone._path = plan.path
    whole = bytes_of(fly_plan(plan, tmp_path / "whole").folder)
    part = bytes_of(fly_plan(alone, tmp_path / "part").folder)
    logs = [name for name in part if name.startswith(("logs/", "truth/"))]
    assert len(logs) == 6
    assert all(part[name] == whole[name] for name in logs)


def test_files_are_what_the_result_says(tmp_path: Path) -> None:
    found = fly_plan(noisy(tmp_path), tmp_path / "out")
    now = bytes_of(found.folder)
    for written in found.maneuvers:
        for file in written.files:
            assert now[file.name] == file.sha256
            assert (found.folder / file.name).stat().st_size == file.bytes


def test_csv_and_parquet_hold_the_same_numbers(tmp_path: Path) -> None:
    found = fly_plan(noisy(tmp_path), tmp_path / "out")
    id = found.maneuvers[0].plan.maneuver.id
    text = pd.read_csv(found.folder / "logs" / f"{id}.csv")
    stored = pd.read_parquet(found.folder / "logs" / f"{id}.parquet")
    assert list(text.columns) == list(stored.columns)
    for name in text.columns:  # the text has all digits of a 32-bit number
        np.testing.assert_array_equal(
            text[name].to_numpy(np.float32), stored[name].to_numpy(np.float32)
        )
    assert text["h_m"].notna().sum() == len(text) // 5 + 1  # 10 Hz in 50 Hz
    assert text["h_m"].notna()[::5].all()


def test_readings_err_by_what_is_stated(tmp_path: Path) -> None:
    """Against the written truth, carried to the vane by the cross product."""
    plan = noisy(tmp_path, rate=100.0, duration=12.0)
    found = fly_plan(plan, tmp_path / "out", seed=3)
    constants = json.loads((found.folder / "truth.json").read_text())["constants"]
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    arm = aircraft.sensor_position("alpha") - aircraft.mass_properties(np.zeros(1)).cg[0]
    for written in found.maneuvers:
        id = written.plan.maneuver.id
        log = pd.read_parquet(found.folder / "logs" / f"{id}.parquet")
        true = pd.read_parquet(found.folder / "truth" / f"{id}.parquet")
        u = true.V * np.cos(true.alpha) * np.cos(true.beta) + true.q * arm[2] - true.r * arm[1]
        w = true.V * np.sin(true.alpha) * np.cos(true.beta) + true.p * arm[1] - true.q * arm[0]
        local = np.arctan2(w, u)
        error = log.alpha_deg * DEG - (1.0 + constants["k_alpha"]) * local - constants["b_alpha"]
        noise = error / (0.1 * DEG)
        assert abs(noise.mean()) < 5 / np.sqrt(len(log))  # five sigma
        assert abs(noise.std() - 1.0) < 5 / np.sqrt(2 * len(log))


def test_lever_arms_of_speed_and_height(tmp_path: Path) -> None:
    """An antenna ahead of the center of gravity, against differences of its own position."""
    text = (AIRCRAFT / "sportstar.toml").read_text()
    text += (
        "\n[sensors.gps]\nposition = [2.0, 0.5, -1.0]\n[sensors.h]\nposition = [2.0, 0.5, -1.0]\n"
    )
    (tmp_path / "craft.toml").write_text(text)
    plan = small_plan(tmp_path, aircraft=str(tmp_path / "craft.toml"), rate=200.0)
    loading = loadings_of(plan)[""]
    item = maneuvers_of(plan)[0]
    trim = trimmed(plan, loading, MODEL, item.condition)
    read = sensed(fly_maneuver(plan, item, loading, MODEL, trim), loading)
    climb = np.gradient(read["h"], 1.0 / 200.0)
    # Central differences at 200 Hz of a motion of 5 rad/s: 2e-4 of the swing of 0.5 m/s.
    np.testing.assert_allclose(climb[1:-1], -read["v_down"][1:-1], atol=2e-3)


def test_project_identifies_as_it_is(tmp_path: Path) -> None:
    plan = small_plan(
        tmp_path,
        loadings=[{"id": "fwd"}, {"id": "aft", "cg_shift": [-0.05, 0.0, 0.0]}],
        maneuvers=[
            {"id": "pull", "inputs": [doublet("de", 1.5)]},
            {"id": "again", "inputs": [doublet("de", -1.5)], "held_out": True},
        ],
    )
    found = fly_plan(plan, tmp_path / "out")
    project = load_project(found.project)
    assert [m.id for m in project.maneuvers] == [w.plan.maneuver.id for w in found.maneuvers]
    assert [m.held_out for m in project.maneuvers] == [False, True, False, True]
    files = {log.id: (log.aircraft or project.aircraft) for log in project.logs}
    cgs = {id: load_aircraft(f).mass_properties(np.zeros(1)).cg[0] for id, f in files.items() if f}
    fwd, aft = cgs["fwd_V45_h915_pull"], cgs["aft_V45_h915_pull"]
    np.testing.assert_allclose(aft - fwd, [-0.05, 0.0, 0.0], atol=1e-12)


def test_a_shift_leaves_inertia_and_reference_point(tmp_path: Path) -> None:
    plan = small_plan(tmp_path, loadings=[{"id": "a"}, {"id": "b", "cg_shift": [-0.1, 0.0, 0.02]}])
    a, b = (x.aircraft for x in loadings_of(plan).values())
    one, two = (x.mass_properties(np.zeros(1)) for x in (a, b))
    np.testing.assert_allclose(two.cg[0] - one.cg[0], [-0.1, 0.0, 0.02], atol=1e-12)
    np.testing.assert_allclose(two.inertia[0], one.inertia[0], rtol=1e-9)
    np.testing.assert_allclose(b.reference_point, a.reference_point, atol=1e-12)


def test_cm_alpha_moves_with_the_center_of_gravity(tmp_path: Path) -> None:
    """In trim the elevator takes up the moment of lift about the new center of gravity."""
    shift = -0.05
    plan = small_plan(tmp_path, loadings=[{"id": "a"}, {"id": "b", "cg_shift": [shift, 0.0, 0.0]}])
    item = maneuvers_of(plan)[0]
    a, b = (trimmed(plan, x, MODEL, item.condition) for x in loadings_of(plan).values())
    p = MODEL.params
    m, g = 560.0, 9.80665
    CL = m * g / (0.5 * 1.1214 * 45.0**2 * 10.6)  # at 915 m; mass of about 560 kg, thrust left out
    moved = CL * shift / 1.25 / p["Cm_de"]  # lift ahead of the new center raises the nose
    # The elevator's own lift, and thrust and drag, take part by some percent.
    assert b.controls["de"] - a.controls["de"] == pytest.approx(moved, rel=0.25)


def test_free_controls_and_a_pilot_in_turbulence(tmp_path: Path) -> None:
    still = small_plan(tmp_path, duration=10.0)
    rough = small_plan(tmp_path, duration=10.0, turbulence={"sigma": 1.5}, seed=3)
    flights = {}
    for name, plan in (("still", still), ("rough", rough)):
        loading, item = loadings_of(plan)[""], maneuvers_of(plan)[0]
        trim = trimmed(plan, loading, MODEL, item.condition)
        flights[name] = fly_maneuver(plan, item, loading, MODEL, trim, seed=3)
        again = fly_maneuver(plan, item, loading, MODEL, trim, seed=3)
        np.testing.assert_array_equal(again.motion.az, flights[name].motion.az)
    before = flights["still"].motion.t < 0.9
    assert np.ptp(flights["still"].motion.az[before]) < 1e-6  # trimmed, in calm air
    assert np.ptp(flights["rough"].motion.az[before]) > 0.3  # 1.5 m/s at 45 m/s: 0.03 rad
    de = flights["rough"].motion.controls["de"]
    assert np.ptp(de[before]) > 1e-4  # the pilot works
    after = flights["rough"].motion.t > 3.0
    assert np.ptp(de[after]) == 0.0  # controls fixed: he let go


def test_pilot_holds_what_would_drift(tmp_path: Path) -> None:
    """With and without him, in the same turbulence."""
    height = {}
    for hold in (True, False):
        plan = small_plan(
            tmp_path,
            duration=40.0,
            turbulence={"sigma": 1.5},
            pilot={"hold": hold},
            maneuvers=[{"id": "wait"}],
        )
        loading, item = loadings_of(plan)[""], maneuvers_of(plan)[0]
        trim = trimmed(plan, loading, MODEL, item.condition)
        m = fly_maneuver(plan, item, loading, MODEL, trim, seed=4).motion
        height[hold] = (np.std(m.phi), np.ptp(m.psi))
    assert height[True][0] < 0.5 * height[False][0]
    assert height[True][1] < 0.5 * height[False][1]


def test_floating_elevator_softens_the_short_period(tmp_path: Path) -> None:
    """The elevator of a free stick follows the angle of attack, to the letter."""
    maneuver = {"id": "pull", "inputs": [doublet("de", 1.5)], "controls": "free"}
    plan = small_plan(tmp_path, maneuvers=[maneuver], float={"de": {"alpha": -0.1, "rate": 0.0}})
    loading, item = loadings_of(plan)[""], maneuvers_of(plan)[0]
    trim = trimmed(plan, loading, MODEL, item.condition)
    m = fly_maneuver(plan, item, loading, MODEL, trim).motion
    after = m.t > item.last + 0.05
    expected = trim.controls["de"] - 0.1 * (m.alpha[after] - trim.alpha)
    np.testing.assert_allclose(m.controls["de"][after], expected, atol=1e-9)
    assert np.ptp(m.controls["de"][after]) > 1e-4


def test_what_cannot_be_flown_is_said_and_stops_nothing_else(tmp_path: Path) -> None:
    plan = small_plan(tmp_path, conditions=[{"V": [8.0, 45.0], "h": 915.0}])
    found = fly_plan(plan, tmp_path / "out")
    assert [w.plan.maneuver.id for w in found.maneuvers] == ["V45_h915_pull"]
    assert list(found.failed) == ["V8_h915_pull"]
    assert found.failed["V8_h915_pull"][0].where.startswith("maneuver V8_h915_pull")
    assert len(load_project(found.project).logs) == 1


def test_nothing_to_fly_leaves_nothing(tmp_path: Path) -> None:
    plan = small_plan(tmp_path, conditions=[{"V": 8.0, "h": 915.0}])
    before = sorted(p.name for p in tmp_path.iterdir())
    with pytest.raises(BadInput):
        fly_plan(plan, tmp_path / "out")
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_a_folder_of_something_else_stays(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.txt").write_text("mine")
    with pytest.raises(BadInput, match="other files"):
        fly_plan(small_plan(tmp_path), tmp_path / "out")
    assert (tmp_path / "out" / "thesis.txt").read_text() == "mine"


def test_an_earlier_campaign_is_replaced_whole(tmp_path: Path) -> None:
    fly_plan(noisy(tmp_path), tmp_path / "out")
    fly_plan(small_plan(tmp_path), tmp_path / "out")
    assert [p.name for p in (tmp_path / "out" / "logs").glob("*.csv")] == ["V45_h915_pull.csv"]
    assert not [p for p in tmp_path.iterdir() if p.name.startswith(".")]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"sensors": {"alfa": {"sigma": 1.0}}}, "'alfa'"),
        ({"sensors": {"alpha": {"sigma": -1.0}}}, "greater than or equal to 0"),
        ({"maneuvers": [{"id": "a", "conditions": ["there"]}]}, "'there'"),
        ({"maneuvers": [{"id": "a"}, {"id": "a"}]}, "'a' several times"),
        ({"maneuvers": [{"id": "a", "inputs": [WIDTHLESS]}]}, "width for kind 'doublet'"),
        ({"maneuvers": [{"id": "a", "controls": "free"}]}, "[float.de]"),
        ({"loadings": [{"id": "x", "cg_shift": [1.0]}]}, "at least 3"),
        ({"rat": 50.0}, "Did you mean 'rate'?"),
        ({"sensors": {"alpha": {"sigma": 1.0, "unit": "degg"}}}, "degg"),
    ],
)  # fmt: skip
def test_a_plan_that_cannot_be_is_refused(
    tmp_path: Path, change: dict[str, object], said: str
) -> None:
    with pytest.raises(BadInput) as refused:
        small_plan(tmp_path, **change)
    assert said in str(refused.value)


def test_conditions_make_a_grid(tmp_path: Path) -> None:
    plan = small_plan(
        tmp_path,
        loadings=[{"id": "x"}, {"id": "y", "fuel_used": 10.0}],
        conditions=[
            {"V": [40.0, 45.0, 50.0], "h": [500.0, 900.0]},
            {"id": "slow", "V": 30.0, "h": 0.0, "loadings": ["x"]},
        ],
        maneuvers=[{"id": "one", "repeats": 2}, {"id": "two"}],
    )
    ids = [m.maneuver.id for m in maneuvers_of(plan)]
    assert len(ids) == (2 * 6 + 1) * 3
    assert "x_V40_h500_one_2" in ids
    assert "x_slow_two" in ids
    assert "y_slow_two" not in ids
    assert "fuel_used" in channels_of(plan, loadings_of(plan))


def test_constant_errors_are_drawn_once_for_each_seed(tmp_path: Path) -> None:
    plan = noisy(tmp_path)
    assert constants_of(plan, 1) == constants_of(plan, 1) != constants_of(plan, 2)
    drawn = np.array([constants_of(plan, s)["b_alpha"] for s in range(400)]) / (0.3 * DEG)
    assert abs(drawn.mean()) < 5 / 20.0  # five standard errors of 400 draws
    assert abs(drawn.std() - 1.0) < 5 / np.sqrt(800.0)


def test_widths_stretch_as_the_aircraft_slows(tmp_path: Path) -> None:
    maneuver = {
        "id": "a",
        "inputs": [doublet("de", 2.0)],
        "reference_V": 45.0,
        "amplitude_exponent": 1.0,
    }
    plan = small_plan(tmp_path, conditions=[{"V": [30.0, 45.0], "h": 0.0}], maneuvers=[maneuver])
    slow, fast = (m.signals["de"] for m in maneuvers_of(plan))
    t = np.arange(0.0, 5.0, 0.01)
    assert np.sum(slow.value(t) > 0.01) == pytest.approx(
        1.5 * np.sum(fast.value(t) > 0.01), rel=0.1
    )
    assert slow.value(t).max() == pytest.approx(1.5 * fast.value(t).max())


def test_multisines_flown_at_once_are_orthogonal(tmp_path: Path) -> None:
    sine = {"kind": "multisine", "start": 1.0, "duration": 10.0, "band_hz": [0.1, 1.5]}
    inputs = [{"control": c, "amplitude_deg": 1.0, **sine} for c in ("de", "da", "dr")]
    plan = small_plan(tmp_path, duration=12.0, maneuvers=[{"id": "sines", "inputs": inputs}])
    item = maneuvers_of(plan)[0]
    t = np.arange(1.0, 11.0, 0.02)
    de, da, dr = (item.signals[c].value(t) for c in ("de", "da", "dr"))
    for a, b in ((de, da), (de, dr), (da, dr)):
        assert abs(a @ b) < 1e-10 * np.sqrt((a @ a) * (b @ b))  # rounding
    assert item.maneuver.aspect == "both"


def test_plan_file_is_read_with_paths_from_its_folder(tmp_path: Path) -> None:
    for name in ("sportstar.toml", "sportstar_aero.toml"):
        (tmp_path / name).write_text((AIRCRAFT / name).read_text())
    plan = small_plan(tmp_path, aircraft="sportstar.toml", model="sportstar_aero.toml")
    assert plan.aircraft == tmp_path / "sportstar.toml"
    assert load_plan(tmp_path / "plan.toml").sha256 == plan.sha256
    assert plan_tree()["schema"] == "alula.plan/1"


def test_the_plan_page_shows_a_plan_that_flies(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "plan_file.md").read_text()
    text = page.split("```toml\n")[1].split("```")[0]
    for name in ("sportstar.toml", "sportstar_aero.toml"):
        (tmp_path / name).write_text((AIRCRAFT / name).read_text())
    (tmp_path / "plan.toml").write_text(text)
    found = fly_plan(load_plan(tmp_path / "plan.toml"), tmp_path / "out")
    # 2 loadings, (2 x 3 + 1) conditions, elevator twice; two more from the fast one.
    assert len(found.maneuvers) + len(found.failed) == 2 * (7 * 2 + 2)
    assert "aft_slow_V26_h915_elevator_1" in {w.plan.maneuver.id for w in found.maneuvers}
    assert set(found.failed) <= {w for w in found.failed if "V26_h2438" in w}
