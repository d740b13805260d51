"""Windows that do not fit their log or each other."""

from __future__ import annotations

from pathlib import Path

import pytest

from logs.windows import refusal, windows


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
