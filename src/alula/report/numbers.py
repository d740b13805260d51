"""Numbers as people read them: digits by the error, degrees instead of radians."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

MISSING = "–"


class Shown(NamedTuple):
    """A unit on the page: shown = factor x SI value."""

    factor: float
    text: str


_DEGREES = 180.0 / math.pi
_UNITS = {
    "rad": Shown(_DEGREES, "°"),
    "rad/s": Shown(_DEGREES, "°/s"),
    "rad/s2": Shown(_DEGREES, "°/s²"),
    "": Shown(1.0, "–"),
    "1": Shown(1.0, "–"),
}


def shown(unit: str) -> Shown:
    """How a quantity in SI `unit` is shown: angles in degrees, powers as superscripts."""
    if unit in _UNITS:
        return _UNITS[unit]
    return Shown(1.0, unit.replace("2", "²").replace("3", "³"))


def _minus(text: str) -> str:
    return text.replace("-", "−")


_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(exponent: int) -> str:
    """'×10⁻³' for -3."""
    return f"×10{str(exponent).translate(_SUPERSCRIPT)}"


def number(value: float | None, digits: int = 4) -> str:
    """A number with `digits` significant digits; a dash where there is none."""
    if value is None or math.isnan(value):
        return MISSING
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if value == 0:
        return "0"
    exponent = int(f"{value:.{digits - 1}e}".split("e")[1])
    if -4 <= exponent < max(digits, 6):
        return _minus(f"{value:.{max(digits - 1 - exponent, 0)}f}")
    return _minus(f"{value / 10.0**exponent:.{digits - 1}f}") + " " + power_of_ten(exponent)


def digits_of_error(error: float) -> tuple[int, int]:
    """(exponent, decimals) of an error rounded to two significant digits; `error` > 0, finite."""
    exponent = int(f"{error:.1e}".split("e")[1])
    return exponent, 1 - exponent


def plus_minus(value: float, error: float) -> str:
    """'value ± error' with two significant digits of the error and the value to the same place."""
    if math.isnan(value):
        return MISSING
    if not (math.isfinite(error) and error > 0):
        return f"{number(value)} ± {number(error, 2)}"
    scale = max(abs(value), error)
    exponent, decimals = digits_of_error(error)
    top = math.floor(math.log10(scale))
    if -4 < top < 5 and decimals <= 7:
        places = max(decimals, 0)
        return _minus(f"{round(value, decimals):.{places}f} ± {round(error, decimals):.{places}f}")
    places = max(top - exponent + 1, 0)
    a, b = value / 10.0**top, error / 10.0**top
    return f"({_minus(f'{a:.{places}f} ± {b:.{places}f}')}) {power_of_ten(top)}"


def interval(low: float, high: float) -> str:
    """'low … high' with as many digits as tell the two apart to about 1 %."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return MISSING
    width = high - low
    if width <= 0:
        return f"{number(low)} … {number(high)}"
    top = math.floor(math.log10(max(abs(low), abs(high))))
    decimals = 1 - math.floor(math.log10(width))
    if -4 < top < 5 and decimals <= 7:
        places = max(decimals, 0)
        return _minus(f"{round(low, decimals):.{places}f} … {round(high, decimals):.{places}f}")
    places, ten = max(top + decimals, 0), 10.0**top
    return f"({_minus(f'{low / ten:.{places}f} … {high / ten:.{places}f}')}) {power_of_ten(top)}"


def compact(value: float, digits: int = 6) -> str:
    """A number that is known exactly, without trailing zeros: 25, 99.98, 1234.56."""
    return _minus(f"{value:.{digits}g}") if abs(value) < 10.0**digits else _minus(f"{value:.0f}")


def span(start: float | None, end: float | None) -> str:
    """'start … end' to the millisecond, as short as it can be written."""
    if start is None or end is None:
        return MISSING
    return " … ".join(_minus(f"{v:.3f}".rstrip("0").rstrip(".")) for v in (start, end))


def percent(ratio: float, digits: int = 2) -> str:
    """A ratio in percent."""
    return MISSING if not math.isfinite(ratio) else f"{number(100.0 * ratio, digits)} %"


def rms(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    """Root mean square of the finite values; NaN where there are none."""
    finite = values[np.isfinite(values)]
    # np.mean does the same sum, but takes three times as long over a short array
    return math.sqrt(np.add.reduce(finite**2) / finite.size) if finite.size else math.nan
