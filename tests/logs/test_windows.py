"""Gaps, windows and the log card."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest
import rich.console

from alula.base.messages import BadInput
from alula.base.project import load_project
from alula.flight import Channel, Flight, Maneuver, gaps, gaps_within, split_at_gaps
from alula.logs import log_card, maneuvers, read_all
from alula.logs.card import quantization
from alula.logs.card_view import card_view
from logs.made import csv_text, flight_table

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


PROJECT = """
schema = "alula.project/1"
name = "windows"
[[logs]]
id = "log"
path = "log.csv"
[channels]
t = {from = "t", unit = "s"}
V = {from = "V", unit = "m/s"}
q = {from = "q", unit = "deg/s"}
"""


def windows(folder: Path, *entries: str, hole: tuple[int, int] | None = None):
    table = flight_table()
    if hole:
        table = np.delete(table, slice(*hole), axis=0)
    (folder / "log.csv").write_text(csv_text(table))
    text = PROJECT
    for k, entry in enumerate(entries):
        text += f'[[maneuvers]]\nid = "m{k}"\nlog = "log"\n' + entry.replace("; ", "\n") + "\n"
    (folder / "project.toml").write_text(text)
    project = load_project(folder / "project.toml")
    return maneuvers(project, read_all(project))


def refusal(folder: Path, *entries: str, hole: tuple[int, int] | None = None) -> list[str]:
    with pytest.raises(BadInput) as caught:
        windows(folder, *entries, hole=hole)
    assert all(m.where and m.expected and m.found and m.do for m in caught.value.messages)
    return [m.code for m in caught.value.messages]


def test_windows(tmp_path: Path) -> None:
    found, messages = windows(tmp_path, "start = 0.0; end = 3.0", "start = 3.0; end = 7.98")
    assert [(m.id, m.start, m.end) for m in found] == [("m0", 0.0, 3.0), ("m1", 3.0, 7.98)]
    assert messages == ()


@pytest.mark.parametrize("window", ["start = 5.0; end = 9.0", "start = -1.0; end = 3.0"])
def test_window_outside_the_log(tmp_path: Path, window: str) -> None:
    assert refusal(tmp_path, window) == ["window_outside_log"]


def test_window_of_a_few_samples(tmp_path: Path) -> None:
    assert refusal(tmp_path, "start = 1.0; end = 1.1") == ["too_few_samples"]


def test_gap_refused_or_split(tmp_path: Path) -> None:
    window = "start = 0.5; end = 6.0"
    assert refusal(tmp_path, window, hole=(100, 150)) == ["gap_in_maneuver"]
    found, messages = windows(tmp_path, f'{window}; on_gap = "split"', hole=(100, 150))
    assert [(m.id, m.start, m.end) for m in found] == [
        ("m0.1", 0.5, pytest.approx(1.98)),
        ("m0.2", pytest.approx(3.0), 6.0),
    ]
    assert [m.code for m in messages] == ["split_at_gaps"]


@pytest.mark.parametrize(
    ("first", "second", "level"),
    [
        ('aspect = "longitudinal"', 'aspect = "lateral"', "info"),
        ('aspect = "longitudinal"', 'aspect = "longitudinal"', "warning"),
        ('aspect = "both"', 'aspect = "lateral"', "warning"),
    ],
)
def test_overlapping_windows(tmp_path: Path, first: str, second: str, level: str) -> None:
    _, messages = windows(
        tmp_path, f"start = 0.0; end = 4.0; {first}", f"start = 3.0; end = 7.0; {second}"
    )
    assert [(m.code, m.level) for m in messages] == [("overlapping_windows", level)]


def test_held_out_samples_are_never_seen(tmp_path: Path) -> None:
    entries = ("start = 0.0; end = 4.0", "start = 3.0; end = 7.0; held_out = true")
    assert refusal(tmp_path, *entries) == ["overlapping_windows"]


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
