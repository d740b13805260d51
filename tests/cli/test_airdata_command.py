"""`alula airdata`: result, page, exit codes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cli.command import alula
from verification.airdata.inflight_calibration import flown, record, truth_of

UNITS = {"V": "m/s", "h": "m", "h_gps": "m", "ax": "m/s2", "ay": "m/s2", "az": "m/s2",
         "v_north": "m/s", "v_east": "m/s", "v_down": "m/s", "p": "rad/s", "q": "rad/s",
         "r": "rad/s"}  # fmt: skip


def project(folder: Path, seed: int, straight: bool = False) -> Path:
    """A project with one simulated log."""
    made = record(flown(seed, 120.0, straight, 0.5), truth_of(seed), seed)
    names = list(made.readings)
    rows = np.column_stack([made.t, *made.readings.values()])
    np.savetxt(folder / "log.csv", rows, delimiter=",", header=",".join(["t", *names]), comments="",
               fmt="%.7g")  # fmt: skip
    lines = ['schema = "alula.project/1"', 'name = "Wandering"', "[[logs]]", 'id = "one"',
             'path = "log.csv"', "[channels]", 't = {from = "t", unit = "s"}']  # fmt: skip
    lines += [
        f'{n} = {{from = "{n}", unit = "{UNITS.get(n, "rad")}", confirmed = true}}' for n in names
    ]
    path = folder / "project.toml"
    path.write_text("\n".join(lines) + "\n")
    return path


def test_wandering_flight(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    done = alula("airdata", project(tmp_path, 3), "--json", "-", "--report", page)
    assert done.code == 0, done.err
    envelope = done.envelope
    assert envelope["schema"] == "alula.airdata/1"
    (log,) = envelope["result"]["logs"]
    found = {p["name"]: p for p in log["parameters"]}
    truth = truth_of(3).errors
    for name in ("k_V", "wind_north"):
        assert abs(found[name]["value"] - truth[name]) < 4.0 * found[name]["se"]
    assert log["rich"] is True
    assert envelope["inputs"][0]["bytes"] > 0
    text = page.read_text()
    assert "upwash at the alpha vane" in text
    assert "<script" not in text


def test_straight_flight(tmp_path: Path) -> None:
    done = alula("airdata", project(tmp_path, 1, straight=True))
    assert done.code == 1
    assert "Not rich enough" in done.out
    assert "flight_not_rich" in done.err


@pytest.mark.parametrize("words", [("--log", "two"), ("--start", "100")])
def test_bad_input(tmp_path: Path, words: tuple[str, str]) -> None:
    done = alula("airdata", project(tmp_path, 3), *words)
    assert done.code == 2
    assert "error:" in done.err
    assert "Traceback" not in done.err


def test_all_that_is_missing_is_named(tmp_path: Path) -> None:
    path = project(tmp_path, 3)
    lines = path.read_text().splitlines()
    kept = [line for line in lines if not line.startswith(("v_north", "v_east", "v_down", "psi"))]
    assert len(kept) == len(lines) - 4
    path.write_text("\n".join(kept) + "\n")
    done = alula("airdata", path, "--json", "-")
    assert done.code == 2
    (said,) = done.messages("missing_channel")
    assert said["found"].startswith("no psi, v_north, v_east, v_down among ")
