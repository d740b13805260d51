"""`alula airdata --angles`: table, result, page; models and logs that do not fit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.model import save_model
from cli.command import alula
from verification.airdata import angle_sources as made

ROOT = Path(__file__).parents[2]
UNITS = {"V": "m/s", "h": "m", "rho": "kg/m3", "thrust": "N", "ax": "m/s2", "ay": "m/s2",
         "az": "m/s2", "p": "rad/s", "q": "rad/s", "r": "rad/s", "v_north": "m/s",
         "v_east": "m/s", "v_down": "m/s", "north": "m", "east": "m", "down": "m"}  # fmt: skip


@pytest.fixture(scope="module")
def log():
    return made.log_of(made.wandering(1, 90.0, sigma=made.CALM), 1)


def project(folder: Path, log, names: tuple[str, ...] = ()) -> Path:
    """A project with the log as columns of one file, or of some of its channels."""
    chosen = {n: c for n, c in log.channels.items() if not names or n in names}
    arrays, lines = {}, []
    for name, channel in chosen.items():
        arrays |= {name: channel.values, f"t_{name}": channel.t}
        lines.append(
            f'{name} = {{from = "{name}", unit = "{UNITS.get(name, "rad")}", confirmed = true, '
            f'time = {{from = "t_{name}", unit = "s"}}}}'
        )
    np.savez(folder / "log.npz", **arrays)
    path = folder / "project.toml"
    path.write_text(
        'schema = "alula.project/1"\nname = "Calm"\n'
        f'aircraft = "{ROOT / "aircraft" / "sportstar.toml"}"\n'
        '[[logs]]\nid = "one"\npath = "log.npz"\n[channels]\n' + "\n".join(lines)
        + "\n[navigate]\ngust = 0.2\ngust_length = 150.0\n"
    )  # fmt: skip
    return path


def test_angles(tmp_path: Path, log) -> None:
    model, page = tmp_path / "model.toml", tmp_path / "page.html"
    save_model(made.lift_model(), model)
    done = alula("airdata", project(tmp_path, log), "--model", model, "--json", "-", "--report",
                 page)  # fmt: skip
    assert done.code in (0, 1), done.err
    (one,) = done.envelope["result"]["logs"]
    rows = {r["name"]: r for r in one["angles"]["alpha"]["sources"]}
    assert set(rows) == {"recorded", "ASSE", "ASSE, zero order", "joint filter", "lift model"}
    assert rows["lift model"]["rms_deg"] < 2.0  # against a vane whose errors are that large
    assert rows["ASSE, zero order"]["votes"] is False
    assert one["angles"]["alpha"]["voted"]["observed"] > 0.95
    assert one["angles"]["beta"]["absent"] == []
    text = page.read_text()
    assert "<script" not in text
    assert text.count('class="angle"') >= 6  # pictures of what was observed
    assert "Angle of attack at the center of gravity" in text


def test_log_that_cannot_be_calibrated(tmp_path: Path, log) -> None:
    names = ("V", "alpha", "ax", "ay", "az", "p", "q", "r", "phi", "theta")
    path = project(tmp_path, log, names)
    assert alula("airdata", path).code == 2
    page = tmp_path / "page.html"
    done = alula("airdata", path, "--angles", "--report", page)
    assert done.code == 0, done.err
    assert "not_calibrated" in done.err
    assert "ASSE" in done.out
    assert "not there: no v_north, v_east" in done.out
    assert "not calibrated" in page.read_text()


@pytest.mark.parametrize(
    ("text", "words"),
    [("schema = 3", "schema"), ("", "schema"), (None, "found")],
)
def test_model_that_is_none(tmp_path: Path, log, text: str | None, words: str) -> None:
    model = tmp_path / "model.toml"
    if text is not None:
        model.write_text(text)
    done = alula("airdata", project(tmp_path, log), "--model", model)
    assert done.code == 2
    assert words in done.err
    assert "Traceback" not in done.err


def test_log_without_angles(tmp_path: Path, log) -> None:
    done = alula("airdata", project(tmp_path, log, ("h", "V")), "--angles")
    assert done.code == 2
    assert "no_angles" in done.err
