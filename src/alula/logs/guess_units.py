"""Units of a first guess: by size, as other columns have them, an airspeed's by what tells it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.units import find_unit
from alula.flight import Channel
from alula.logs.address import Column
from alula.logs.airspeed import other_unit as other_airspeed
from alula.logs.height import other_unit as other_height
from alula.logs.plausibility import doubt_of

# Units to try in turn where nothing states one; the first that the values do not contradict.
CANDIDATES = {
    "s": ("s", "ms", "us", "ns"),
    "rad": ("rad", "deg"),
    "rad/s": ("rad/s", "deg/s"),
    "rad/s2": ("rad/s2", "deg/s2"),
    "m/s2": ("m/s2", "g", "ft/s2"),
    "m/s": ("m/s", "ft/min"),
    "kg/s": ("kg/s", "kg/h", "lb/h"),
    "K": ("K", "degC", "degF"),
    "Pa": ("Pa", "hPa", "kPa", "inHg"),
    "kg/m3": ("kg/m3", "slug/ft3"),
    "1": ("1", "%"),
}
BY_SIZE = "its name, unit by size"
_LIKE_V = ("V_cas", "V_ias")


@dataclass(frozen=True)
class Guess:
    """One column and what it may be."""

    source: int | str
    column: Column
    name: str  # '' if nothing fits
    unit: str
    sign: int
    why: str
    offset: float = 0.0  # in the source's unit


def unit_by_size(name: str, si: str, values: Array) -> str:
    for unit in CANDIDATES.get(si, (si,)):
        found = find_unit(unit)
        assert found is not None
        converted = found.scale * values + found.offset
        if name == "t":
            if len(values) > 2 and np.median(np.abs(np.diff(converted))) < 5.0:
                return unit
        else:
            doubt = doubt_of(name, si, converted)
            if doubt is None or doubt.code in ("axes_z_up", "gravity_removed"):
                return unit
    return si


def alike(guesses: list[Guess]) -> list[Guess]:
    """A log with one angle in degrees has all in degrees; ax and ay have the unit of az."""
    degrees = any(g.unit == "deg" for g in guesses if g.name)
    vertical = next((g.unit for g in guesses if g.name == "az"), "")
    out = []
    for g in guesses:
        unit = g.unit
        if g.why == BY_SIZE and degrees:
            unit = {"rad": "deg", "rad/s": "deg/s", "rad/s2": "deg/s2"}.get(unit, unit)
        if g.why == BY_SIZE and g.name in ("ax", "ay") and vertical:
            unit = vertical
        out.append(g if unit == g.unit else replace(g, unit=unit, why="its name, unit as others"))
    return out


def by_motion(guesses: list[Guess]) -> list[Guess]:
    """A height and a true airspeed whose unit nothing states, by what else tells them; calibrated
    and indicated airspeed are then in the unit of the true one.
    """
    times = next((g for g in guesses if g.name == "t"), None)
    if times is None:
        return guesses
    for name in ("h", "h_gps", "V"):
        bare = [g for g in guesses if g.name == name and g.why == BY_SIZE]
        channels = _channels(guesses, times)
        if not bare or name not in channels:
            continue
        if name == "V":
            bare += [g for g in guesses if g.name in _LIKE_V and g.why == BY_SIZE]
            other = other_airspeed(channels, bare[0].unit)
            found = None if other is None else (other.unit, other.by)
        else:
            height = other_height(name, channels, bare[0].unit)
            found = None if height is None else height[:2]
        if found is not None:
            why = f"its name, unit by {found[1]}"
            guesses = [replace(g, unit=found[0], why=why) if g in bare else g for g in guesses]
    return guesses


def _channels(guesses: list[Guess], times: Guess) -> dict[str, Channel]:
    """The guesses as channels; without airspeeds that may be in the same wrong unit."""
    n = len(times.column.values)
    return {
        g.name: Channel(g.name, _si(times), _si(g), "", "")
        for g in guesses
        if g.name not in ("", "t", *_LIKE_V) and len(g.column.values) == n
    }


def _si(guess: Guess) -> Array:
    unit = find_unit(guess.unit)
    assert unit is not None
    return unit.scale * guess.sign * (guess.column.values + guess.offset) + unit.offset
