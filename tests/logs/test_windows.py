"""Gaps, windows and the log card."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest
import rich.console

from alula.base.project import load_project
from alula.flight import Channel, Flight, Maneuver, gaps, gaps_within, split_at_gaps
from alula.logs import log_card, read_all
from alula.logs.card import quantization
from alula.logs.card_view import card_view
from logs.made import flight_table
from logs.windows import windows

T = np.arange(0.0, 10.0, 0.1)


def channel(name: str, t: np.ndarray, values: np.ndarray | None = None) -> Channel:
    return Channel(name, t, np.sin(t) if values is None else values, "m/s", "test")


def holed(*holes: tuple[float, float]) -> np.ndarray:
    keep = np.ones(len(T), dtype=bool)
    for a, b in holes:
        keep &= ~((a + 0.05 < T) & (b - 0.05 > T))
    return T[keep]


def test_a_gap_is_over_three_intervals() -> None:
    assert gaps(channel("V", holed((2.0, 2.3)))) == ()  # two samples lost: three intervals
    (gap,) = gaps(channel("V", holed((2.0, 2.4))))
    assert (gap.start, gap.end) == (pytest.approx(2.0), pytest.approx(2.4))


def test_missing_values_are_gaps_too() -> None:
    values = np.sin(T)
    values[30:40] = np.nan
    (gap,) = gaps(channel("V", T, values))
    assert (gap.start, gap.end) == (pytest.approx(2.9), pytest.approx(4.0))


def test_split_leaves_no_gap_inside() -> None:
    slow = np.arange(0.05, 10.0, 1.0)
    flight = Flight(
        "log",
        {
            "V": channel("V", holed((2.0, 3.0), (6.0, 6.5))),
            "q": channel("q", holed((2.5, 3.5))),
            "h": channel("h", slow),
        },
    )
    maneuver = Maneuver("m", "log", "doublet", 1.0, 9.0)
    parts = split_at_gaps(flight, maneuver)
    assert [p.id for p in parts] == ["m.1", "m.2", "m.3"]
    edges = [(round(p.start, 6), round(p.end, 6)) for p in parts]
    assert edges == [(1.0, 2.0), (3.5, 6.0), (6.5, 9.0)]
    assert all(gaps_within(flight, p.start, p.end) == () for p in parts)
    assert split_at_gaps(flight, parts[0]) == (parts[0],)
    assert len(split_at_gaps(flight, maneuver, ["q"])) == 2


def test_windows(tmp_path: Path) -> None:
    found, messages = windows(tmp_path, "start = 0.0; end = 3.0", "start = 3.0; end = 7.98")
    assert [(m.id, m.start, m.end) for m in found] == [("m0", 0.0, 3.0), ("m1", 3.0, 7.98)]
    assert messages == ()


def test_log_card(tmp_path: Path) -> None:
    found, _ = windows(tmp_path, "start = 1.0; end = 3.0")
    project = load_project(tmp_path / "project.toml")
    flight = read_all(project)["log"]
    card = log_card(flight, found)
    speed = next(c for c in card.channels if c.name == "V")
    column = flight_table()[:, 4]
    assert (speed.n, speed.missing, speed.gaps, speed.unit) == (400, 0, (), "m/s")
    assert (speed.minimum, speed.maximum) == (column.min(), column.max())
    assert speed.rate == pytest.approx(50.0)
    assert card.maneuvers[0].samples == 101
    assert card.maneuvers[0].entry["V"] == pytest.approx(50.0 + 0.3 * np.sin(0.5 * 1.25), abs=1e-3)
    text = json.dumps(card.as_dict(), allow_nan=False)
    assert json.loads(text)["channels"][0]["name"] == "V"
    out = io.StringIO()
    rich.console.Console(file=out, width=200).print(card_view(card))
    assert "deg/s" in out.getvalue()


def test_card_escapes_markup_of_names(tmp_path: Path) -> None:
    flight = Flight("[red]log", {"V": channel("[bold]x[/bold]", T)})
    out = io.StringIO()
    rich.console.Console(file=out, width=200).print(card_view(log_card(flight)))
    assert "[bold]x[/bold]" in out.getvalue()
    assert "[red]log" in out.getvalue()


@pytest.mark.parametrize("step", [0.25, 0.1, 360 / 65536])
def test_quantization_step(step: float) -> None:
    x = np.round(np.sin(np.linspace(0, 20, 2000)) * 3 / step) * step
    assert quantization(x) == pytest.approx(step, rel=1e-9)
    rng = np.random.default_rng(1)
    assert np.isnan(quantization(x + 0.01 * rng.normal(size=2000)))
