"""Digits follow the error; nothing that is missing reads as a number."""

from __future__ import annotations

import math

import pytest

from alula.report.numbers import compact, interval, number, plus_minus, shown, span


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (-0.95, 0.0204, "−0.950 ± 0.020"),
        (1.23456, 0.0996, "1.23 ± 0.10"),  # 0.0996 rounds up to a new digit
        (12345.0, 678.0, "12340 ± 680"),
        (0.0, 0.2, "0.00 ± 0.20"),
        (1.23e-5, 4.5e-7, "(1.230 ± 0.045) ×10⁻⁵"),
        (215000.0, 1300.0, "(2.150 ± 0.013) ×10⁵"),
        (3.0e-6, 2.9e-5, "(0.3 ± 2.9) ×10⁻⁵"),
        (1.0, math.inf, "1.000 ± ∞"),
        (1.0, math.nan, "1.000 ± –"),
        (math.nan, 0.1, "–"),
    ],
)
def test_value_and_error(value: float, error: float, text: str) -> None:
    assert plus_minus(value, error) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-9.80665, "−9.807"),
        (123456.0, "123456"),
        (1.5e7, "1.500 ×10⁷"),
        (2.0e-6, "2.000 ×10⁻⁶"),
        (0.99996, "1.000"),
        (math.nan, "–"),
        (-math.inf, "−∞"),
        (None, "–"),
    ],
)
def test_number(value: float | None, text: str) -> None:
    assert number(value) == text


def test_interval_tells_its_ends_apart() -> None:
    assert interval(-0.989, -0.911) == "−0.989 … −0.911"
    assert interval(1.0e-6, 3.0e-6) == "(1.0 … 3.0) ×10⁻⁶"
    assert interval(math.nan, 1.0) == "–"


def test_times_and_rates_are_short() -> None:
    assert span(30.0, 55.04000001) == "30 … 55.04"
    assert compact(25.0, 4) == "25"
    assert compact(99.98, 4) == "99.98"


def test_units_of_the_page() -> None:
    assert shown("rad/s").text == "°/s"
    assert shown("rad/s").factor * math.pi == pytest.approx(180.0)
    assert shown("m/s2") == (1.0, "m/s²")
