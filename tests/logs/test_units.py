"""Units against their definitions (NIST SP 811, appendix B; exact where the unit is)."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from alula.base.messages import BadInput
from alula.base.units import CHANNELS, Unit, expected_unit, find_unit, to_si


@pytest.mark.parametrize(
    ("unit", "scale", "si"),
    [
        ("ft", 0.3048, "m"),
        ("in", 0.0254, "m"),
        ("kt", 1852 / 3600, "m/s"),
        ("km/h", 1 / 3.6, "m/s"),
        ("ft/min", 5.08e-3, "m/s"),
        ("mph", 0.44704, "m/s"),
        ("g", 9.80665, "m/s2"),
        ("ft/s2", 0.3048, "m/s2"),
        ("deg/s", math.pi / 180, "rad/s"),
        ("rpm", 2 * math.pi / 60, "rad/s"),
        ("psi", 6.894757e3, "Pa"),
        ("lbf/ft2", 4.788026e1, "Pa"),
        ("inHg", 3.386389e3, "Pa"),
        ("hPa", 100, "Pa"),
        ("lb", 0.45359237, "kg"),
        ("slug", 1.459390e1, "kg"),
        ("lbf", 4.448222, "N"),
        ("slug/ft3", 5.153788e2, "kg/m3"),
        ("slug ft2", 1.355818, "kg m2"),
        ("lb/h", 1.259979e-4, "kg/s"),
        ("%", 0.01, "1"),
        ("uT", 1e-6, "T"),
        ("gauss", 1e-4, "T"),
        ("us", 1e-6, "s"),
    ],
)
def test_factors(unit: str, scale: float, si: str) -> None:
    found = to_si(unit)
    assert found.si == si
    assert found.scale == pytest.approx(scale, rel=5e-7)  # seven digits printed: half of the last
    assert found.offset == 0


def test_temperatures() -> None:
    for unit, value, kelvin in (("degC", 15, 288.15), ("degF", 59, 288.15), ("degF", -40, 233.15)):
        found = to_si(unit)
        assert found.scale * value + found.offset == pytest.approx(kelvin, abs=1e-9)


@pytest.mark.parametrize(
    ("spellings", "same"),
    [
        (("m/s^2", "m/s**2", "m/s²", "[m/s2]", "(m/s/s)", "M/S2", "m / s2", "m/sec^2"), "m/s2"),
        (("°/s", "deg/sec", "DEG/S", "dps", "degrees/s", "[deg/s]"), "deg/s"),
        (("kts", "knots", "KT", "Knot"), "kt"),
        (("° C", "celsius", "deg C", "°C"), "degC"),
        (("slug*ft^2", "slug-ft2", "slug ft²"), "slug ft2"),
        (("", "-", "none"), "1"),
    ],
)
def test_spellings(spellings: tuple[str, ...], same: str) -> None:
    for spelling in spellings:
        assert to_si(spelling) == to_si(same), spelling


@pytest.mark.parametrize(
    ("unit", "near"), [("G", "'g' or 'gauss'"), ("degg", "deg"), ("knt", "kt")]
)
def test_unknown_units_name_near_ones(unit: str, near: str) -> None:
    with pytest.raises(BadInput) as caught:
        to_si(unit, where="project.toml: channels.az.unit")
    (message,) = caught.value.messages
    assert message.code == "unknown_unit"
    assert near in message.do
    assert message.where == "project.toml: channels.az.unit"


def test_every_channel_has_an_si_unit() -> None:
    for name, channel in CHANNELS.items():
        assert to_si(channel.unit) == Unit(1.0, 0.0, channel.unit), name
        assert channel.meaning


def test_second_sensors_share_the_unit() -> None:
    assert expected_unit("alpha_2") == "rad"
    assert expected_unit("V_cas") == "m/s"
    assert expected_unit("elephants") is None


@given(st.text(max_size=12))
def test_any_text_is_a_unit_or_none(text: str) -> None:
    found = find_unit(text)
    assert found is None or found.scale > 0
