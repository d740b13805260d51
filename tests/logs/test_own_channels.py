"""Names of channels that are none of Alula's: slips of the pen are asked about, others let be."""

from __future__ import annotations

import pytest

from alula.base.units import CHANNELS
from alula.logs.own_channels import near
from cli.command import SmallProject, demo_files, small

__all__ = ["demo_files", "small"]


@pytest.mark.parametrize(
    ("slip", "meant"),
    [("betta", "beta"), ("alfa", "alpha"), ("Alpha", "alpha"), ("thetta", "theta"), ("AX", "ax"),
     ("elevator", "de"), ("aoa", "alpha"), ("v_nort", "v_north"), ("oil_temp", ""), ("rpm", ""),
     ("egt", ""), ("marker", "")],
)  # fmt: skip
def test_what_a_name_may_stand_for(slip: str, meant: str) -> None:
    assert near(slip) == meant


def test_every_known_name_stands_for_itself() -> None:
    assert all(near(name) == name for name in CHANNELS)


def line_of(small: SmallProject, channel: str) -> str:
    """The line that maps a channel."""
    return next(x for x in small.path.read_text().splitlines() if x.startswith(f"{channel} = "))


def renamed(small: SmallProject, old: str, new: str) -> None:
    line = line_of(small, old)
    small.edit(line, line.replace(f"{old} =", f"{new} =", 1))


def added(small: SmallProject, *lines: str) -> None:
    """More channels after beta."""
    line = line_of(small, "beta")
    small.edit(line, "\n".join([line, *lines]))


def test_a_slip_is_asked_about(small: SmallProject) -> None:
    renamed(small, "beta", "betta")
    (said,) = small.check().messages("unknown_channel")
    assert said["level"] == "warning"
    assert said["where"].endswith("demo.toml: channels.betta")
    assert "Did you mean 'beta'?" in said["do"]


def test_a_channel_that_is_missing_names_the_slip(small: SmallProject) -> None:
    renamed(small, "alpha", "alpa")
    ran = small.identify("--filter", "none")
    assert ran.code == 2
    (said,) = ran.messages("missing_channel")
    assert "'alpa'" in said["do"]


def test_a_name_of_ones_own_is_no_warning(small: SmallProject) -> None:
    added(
        small, 'oil_temp = {constant = 350.0, unit = "K"}', 'betta = {constant = 0, unit = "rad"}'
    )
    ran = small.check()
    assert ran.code == 0, ran.err
    assert not ran.messages("unknown_channel")  # beta itself is mapped
    (said,) = ran.messages("own_channel")
    assert said["level"] == "info"
    assert said["found"] == "oil_temp, betta"


def test_a_name_that_an_engine_takes_is_used(small: SmallProject) -> None:
    """'thrst' looks like 'thrust', but the aircraft file asks for it."""
    renamed(small, "thrust", "thrst")
    assert small.check().messages("unknown_channel")
    small.edit('channel = "thrust"', 'channel = "thrst"', "sportstar.toml")
    ran = small.check()
    assert ran.code == 0, ran.err
    assert not ran.messages("unknown_channel")
    assert not ran.messages("own_channel")
