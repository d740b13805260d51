"""`alula calibrate`: from bench files to the calibration file, the channels and the page."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from alula.base.messages import BadInput
from alula.base.project import load_project
from alula.cli.app import app
from alula.logs import read
from alula.navigate.calibration import calibrate, calibration_text, load_imu_calibration

sys.path.insert(0, str(Path(__file__).parents[1]))
from data import data

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples/real/armhawk_calibration.toml"
G = 9.81
C = np.array([[1.02, 0.01, 0.0], [-0.01, 0.98, 0.005], [0.0, 0.0, 1.01]])
OFFSET = np.array([0.1, -0.2, 0.05])
RATES = np.array([[1.03, 0.0, 0.01], [0.0, 0.99, 0.0], [-0.01, 0.0, 1.02]])
DRIFT, COUPLING = np.array([0.02, -0.01, 0.005]), np.diag([1e-3, 5e-4, 2e-3])
FACES = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    """Six faces up; upon each, a half turn about the vertical of 2 s and rest of 6 s. 50 Hz."""
    rng = np.random.default_rng(0)
    t = np.arange(0.0, 48.0, 0.02)
    force, rate, turns = np.zeros((len(t), 3)), np.zeros((len(t), 3)), []
    for k, face in enumerate(np.array(FACES, dtype=float)):
        mine = (t >= 8 * k) & (t < 8 * (k + 1))
        force[mine] = G * face
        pulse = (t > 8 * k + 5) & (t < 8 * k + 7)
        rate[pulse] = face * (np.pi / 2 * (1 - np.cos(np.pi * (t[pulse] - 8 * k - 5))))[:, None]
        turns += [
            (8 * k + 4.5, 8 * k + 7.5, 180.0, list(face)),
            (8 * k + 0.5, 8 * k + 4.0, 0, None),
        ]
    raw_f = force @ np.linalg.inv(C).T + OFFSET + 0.01 * rng.standard_normal(force.shape)
    raw_w = (rate + force @ COUPLING.T) @ np.linalg.inv(RATES).T + DRIFT
    raw_w += 1e-3 * rng.standard_normal(rate.shape)
    table = np.column_stack([t, raw_f / 9.80665, np.degrees(raw_w)])
    np.savetxt(tmp_path / "bench.csv", table, delimiter=",", comments="",
               header="t,fx,fy,fz,wx,wy,wz", fmt="%.9g")  # fmt: skip
    windows = [[8 * k + 0.5, 8 * k + 4.0] for k in range(6)]
    lines = [
        'schema = "alula.calibration/1"', 'name = "bench"', "[[logs]]", 'id = "b"',
        'path = "bench.csv"', "[accelerometer]", "gravity = 9.81", 'directions = "faces"',
        "[accelerometer.recording]", 'log = "b"', 'from = ["fx", "fy", "fz"]', 'unit = "g"',
        'time_unit = "s"', f"windows = {json.dumps(windows)}", "[gyro]",
        'recording = {log = "b", from = ["wx", "wy", "wz"], unit = "deg/s", time_unit = "s"}',
        'force = {log = "b", from = ["fx", "fy", "fz"], unit = "g"}',
    ]  # fmt: skip
    for start, end, angle, axis in turns:
        lines += [
            "[[gyro.turns]]",
            f"start = {start}",
            f"end = {end}",
            f"angle_deg = {float(angle)}",
        ]
        lines += [f"axis = {json.dumps(axis)}"] if axis else []
    (tmp_path / "bench.toml").write_text("\n".join(lines) + "\n")
    return tmp_path / "bench.toml"


def on_the_bench(lines: str) -> str:
    """A log whose az is not that of a flight, and right."""
    return lines.replace('unit = "g"}', 'unit = "g", confirmed = true}')


def test_bench_to_file_to_channels(bench: Path) -> None:
    """The written [channels], in an ordinary project, calibrate the log."""
    out, page, envelope = (bench.with_name(n) for n in ("imu.toml", "imu.html", "imu.json"))
    done = CliRunner().invoke(
        app, ["calibrate", str(bench), "--out", str(out), "--report", str(page),
              "--json", str(envelope), "--quiet"],
    )  # fmt: skip
    assert done.exit_code == 0, done.output
    found = load_imu_calibration(out)
    # mean of 175 samples of 0.01 m/s2 noise: 1e-3 m/s2
    np.testing.assert_allclose(found.sensors["accelerometer"].matrix, C, atol=1e-3)
    np.testing.assert_allclose(found.sensors["accelerometer"].offset, OFFSET, atol=5e-3)
    np.testing.assert_allclose(found.sensors["gyro"].matrix, RATES, atol=1e-3)
    np.testing.assert_allclose(found.sensors["gyro"].offset, DRIFT, atol=1e-3)
    np.testing.assert_allclose(found.sensors["gyro"].g_sensitivity, COUPLING, atol=1e-4)
    channels = out.read_text().split("[channels]")[1].split("[provenance]")[0].split("\n", 1)[1]
    project = bench.with_name("flight.toml")
    project.write_text(
        'schema = "alula.project/1"\nname = "f"\n[[logs]]\nid = "b"\npath = "bench.csv"\n'
        '[channels]\nt = {from = "t", unit = "s"}\n' + on_the_bench(channels)
    )
    loaded = load_project(project)
    flight = read(loaded.logs[0], loaded.channels_of(loaded.logs[0]))
    size = np.sqrt(sum(flight[n].values ** 2 for n in ("ax", "ay", "az")))
    assert np.mean(size) == pytest.approx(G, abs=0.005)
    rest = flight["p"].t < 4.0  # x up: 1e-3 * 9.81 rad/s of coupling are gone
    assert abs(np.mean(flight["p"].values[rest])) < 1e-3
    said = json.loads(envelope.read_text())
    assert said["status"] == "ok"
    assert {p["name"] for p in said["result"]["parameters"]} >= {"accelerometer.C_xx", "gyro.G_z"}
    assert sum(f["decoded"] + f["skipped"] + f["unknown"] - f["bytes"] for f in said["inputs"]) == 0
    text = page.read_text()
    assert text.count("<svg") >= 4
    assert "http" not in text.replace("http-equiv", "")


def test_file_applied_to_a_flight_is_the_same_as_its_channels(bench: Path) -> None:
    out = bench.with_name("imu.toml")
    out.write_text(calibration_text(calibrate(bench)))
    raw = bench.with_name("raw.toml")
    raw.write_text(
        'schema = "alula.project/1"\nname = "f"\n[[logs]]\nid = "b"\npath = "bench.csv"\n'
        '[channels]\nt = {from = "t", unit = "s"}\n'
        + "".join(
            f'{n} = {{from = "f{a}", unit = "g", confirmed = true}}\n'
            for n, a in zip(("ax", "ay", "az"), "xyz", strict=True)
        )
        + "".join(
            f'{n} = {{from = "w{a}", unit = "deg/s"}}\n' for n, a in zip("pqr", "xyz", strict=True)
        )
    )
    loaded = load_project(raw)
    flight = read(loaded.logs[0], loaded.channels_of(loaded.logs[0]))
    done = load_imu_calibration(out).apply(flight)
    lines = out.read_text().split("[channels]")[1].split("[provenance]")[0].split("\n", 1)[1]
    head = raw.read_text().split("[channels]")[0]
    raw.write_text(head + '[channels]\nt = {from = "t", unit = "s"}\n' + on_the_bench(lines))
    loaded = load_project(raw)
    mapped = read(loaded.logs[0], loaded.channels_of(loaded.logs[0]))
    for name in ("ax", "ay", "az", "p", "q", "r"):
        # one and the same arithmetic in another order
        np.testing.assert_allclose(done[name].values, mapped[name].values, atol=1e-10)


def test_coplanar_recording_ends_with_one_and_leaves_the_sensor_out(tmp_path: Path) -> None:
    angle = np.linspace(0.0, 6.0, 16)
    f = np.column_stack([0 * angle, G * np.cos(angle), G * np.sin(angle)])
    np.savetxt(tmp_path / "p.csv", f, delimiter=",", header="x,y,z", comments="")
    project = tmp_path / "p.toml"
    project.write_text(
        'schema = "alula.calibration/1"\nname = "p"\n[[logs]]\nid = "p"\npath = "p.csv"\n'
        '[accelerometer]\npositions = {log = "p", from = ["x", "y", "z"], unit = "m/s2"}\n'
    )
    out, page = tmp_path / "o.toml", tmp_path / "o.html"
    words = ["calibrate", str(project), "--out", str(out), "--report", str(page), "--json", "-"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 1
    said = json.loads(done.stdout)
    assert said["status"] == "not_identifiable"
    codes = {m["code"] for m in said["messages"]}
    assert codes >= {"coplanar_positions", "sensor_left_out", "standard_gravity"}
    assert load_imu_calibration(out).sensors == {}
    assert "not identifiable" in page.read_text()


def test_still_log_gives_noise_settings(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    t = np.arange(0.0, 80.0, 0.01)
    y = 1e-2 * rng.standard_normal((len(t), 3)) + [0.0, 0.0, -G]
    np.savez(tmp_path / "s.npz", t=t, x=y[:, 0], y=y[:, 1], z=y[:, 2])
    project = tmp_path / "s.toml"
    project.write_text(
        'schema = "alula.calibration/1"\nname = "s"\n[[logs]]\nid = "s"\npath = "s.npz"\n'
        '[[still]]\nsensor = "accelerometer"\nlog = "s"\nfrom = ["x", "y", "z"]\n'
        'unit = "m/s2"\ntime_unit = "s"\n'
    )
    out = tmp_path / "o.toml"
    done = CliRunner().invoke(app, ["calibrate", str(project), "--out", str(out), "--quiet"])
    assert done.exit_code == 0, done.output
    # 8000 samples: standard deviation known to 0.8 %
    noise = load_imu_calibration(out).noise["accelerometer"]
    assert noise.white_noise == pytest.approx([1e-3] * 3, rel=0.05)
    settings = out.read_text().split("[reconstruct.imu]")[1]
    full = tmp_path / "f.toml"
    full.write_text(
        'schema = "alula.project/1"\nname = "f"\n[[logs]]\nid = "s"\npath = "s.npz"\n'
        "[reconstruct.imu]" + settings.split("[provenance]")[0]
    )
    assert load_project(full).reconstruct.imu["ax"].sigma_si == pytest.approx(1e-2, rel=0.05)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ('log = "b", from = ["wx"', 'log = "c", from = ["wx"', "unknown_log"),
        ('unit = "deg/s"', 'unit = "m"', "wrong_unit"),
        ('"fx", "fy", "fz"]\nunit', '"fx", "fy", "nothing"]\nunit', "missing_channel"),
        ("angle_deg = 180.0", "angle = 180.0", "unknown_key"),
        ("gravity = 9.81", "gravity = 981.0", "bad_value"),
        ('directions = "faces"', 'directions = "corners"', "bad_value"),
        ('force = {log = "b", from = ["fx", "fy", "fz"], unit = "g"}', "", "missing_force"),
        ("end = 7.5", "end = 0.5", "bad_value"),
        ("end = 47.5", "end = 99.0", "bad_window"),
    ],
)
def test_bad_projects_are_refused(bench: Path, old: str, new: str, code: str) -> None:
    text = bench.read_text()
    assert old in text
    bench.write_text(text.replace(old, new))
    with pytest.raises(BadInput) as error:
        calibrate(bench)
    assert code in {m.code for m in error.value.messages}


def test_a_log_is_not_overwritten(bench: Path) -> None:
    log = bench.with_name("bench.csv")
    before = log.read_bytes()
    done = CliRunner().invoke(app, ["calibrate", str(bench), "--out", str(log)])
    assert done.exit_code == 2
    assert log.read_bytes() == before


def test_armhawk() -> None:
    """The real bench: what the author published, by another method."""
    data("armhawk")
    found = calibrate(EXAMPLE).sensors
    acc, mag = found["accelerometer"], found["magnetometer"]
    assert acc.after.largest < 0.0030
    assert acc.after.rms < 0.0016
    published = np.array([-103.18, -69.476, -73.740]) * 1e-6
    assert np.all(np.abs(mag.offset - published) < 0.2e-6)
    # the same four standings, averaged alike: to the digits printed
    np.testing.assert_allclose(mag.current, [8.2807e-9, 1.2813e-8, -2.3106e-8], rtol=1e-4)
