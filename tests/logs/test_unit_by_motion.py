"""Feet for meters and radians for degrees where sizes alone do not tell: the motion does."""

from __future__ import annotations

import pytest

from cli.command import SmallProject, demo_files, small

__all__ = ["demo_files", "small"]


def mapped(small: SmallProject, channel: str, how: str) -> None:
    """Another mapping of the channel, by what stands between the braces."""
    text = small.path.read_text()
    line = next(x for x in text.splitlines() if x.startswith(f"{channel} = "))
    small.edit(line, f"{channel} = {{{how}}}")


@pytest.mark.parametrize(
    ("channel", "how", "looks"),
    [
        ("h", 'from = "h_m", unit = "ft"', "m"),
        ("h", 'from = "h_m", unit = "m", scale = 3.2808', "ft"),  # as a log in feet
        ("alpha", 'from = "alpha_deg", unit = "deg", scale = 0.0174533', "rad"),
        ("alpha", 'from = "alpha_deg", unit = "rad"', "deg"),  # small enough for radians
    ],
)
def test_another_unit_is_named(small: SmallProject, channel: str, how: str, looks: str) -> None:
    mapped(small, channel, how)
    ran = small.check()
    assert ran.code == 2, ran.err
    said = [m for m in ran.messages("unit_implausible") if m["where"].endswith(channel)]
    assert any(f"it looks like {looks}" in m["found"] for m in said)
    assert any(f"unit = '{looks}'" in m["do"] for m in said)


def test_by_satellite_or_by_flow(small: SmallProject) -> None:
    """Without v_down the flight path angle of theta and alpha tells the height."""
    lines = small.path.read_text().splitlines()
    small.path.write_text("\n".join(x for x in lines if not x.startswith("v_down")) + "\n")
    mapped(small, "h", 'from = "h_m", unit = "ft"')
    (said,) = small.check().messages("unit_implausible")
    assert "V, theta and alpha" in said["expected"]


def test_what_is_confirmed_is_taken(small: SmallProject) -> None:
    mapped(small, "h", 'from = "h_m", unit = "ft", confirmed = true')
    ran = small.check()
    assert ran.code == 0, ran.err
    (said,) = ran.messages("unit_implausible")
    assert said["level"] == "warning"
