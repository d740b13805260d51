"""Output error of a real flight against its published estimates; output error at speed."""

from __future__ import annotations

from data import data
from verification.twin_otter_output_error import twin_otter_output_error


def test_published_estimates_come_back() -> None:
    words, good = twin_otter_output_error(data("twin_otter", "totter_lon_020213f1_018.mat"))
    assert good, words
