"""An airspeed in knots that is declared in m/s, or the other way, in logs of half a minute."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.units import KT
from cli.command import SmallProject, demo_files, small

__all__ = ["demo_files", "small"]


def line_of(small: SmallProject, channel: str) -> str:
    return next(x for x in small.path.read_text().splitlines() if x.startswith(f"{channel} = "))


def without(small: SmallProject, *channels: str) -> None:
    """The project with channels and their sensors not mapped."""
    lines = small.path.read_text().splitlines()
    starts = tuple(f"{c} = " for c in channels)
    small.path.write_text("\n".join(x for x in lines if not x.startswith(starts)) + "\n")


def in_knots(small: SmallProject) -> None:
    """Recorded in knots: 45 m/s are 87 kt. The project says m/s."""
    small.column("V_m/s")[:] /= KT
    small.write_log()
    line = line_of(small, "V")
    small.edit(line, 'V = {from = "V_m/s", unit = "m/s"}')


@pytest.mark.parametrize("missing", [(), ("v_north", "v_east"), ("alpha",)])
def test_knots_for_metres_per_second(small: SmallProject, missing: tuple[str, ...]) -> None:
    """By the motion, by the velocity over ground, by either alone."""
    in_knots(small)
    without(small, *missing)
    ran = small.check()
    assert ran.code == 2, ran.err
    (said,) = ran.messages("unit_implausible")
    assert said["where"].endswith("channel V")
    assert "it looks like kt" in said["found"]
    assert "unit = 'kt'" in said["do"]


def test_metres_per_second_for_knots(small: SmallProject) -> None:
    line = line_of(small, "V")
    small.edit(line, 'V = {from = "V_m/s", unit = "kt"}')
    ran = small.check()
    assert ran.code == 2, ran.err
    (said,) = ran.messages("unit_implausible")
    assert "it looks like m/s" in said["found"]


def test_calibrated_airspeed_tells_it(small: SmallProject) -> None:
    """Where nothing of the motion is mapped."""
    in_knots(small)
    small.header.append("ias_kt")
    small.table = np.column_stack([small.table, 0.95 * small.column("V_m/s")])
    small.write_log()
    without(small, "v_north", "v_east", "alpha")
    line = line_of(small, "V")
    small.edit(line, line + '\nV_ias = {from = "ias_kt", unit = "kt"}')
    (said,) = small.check().messages("unit_implausible")
    assert "by V_ias" in said["expected"]


def test_a_confirmed_airspeed_is_only_warned_of(small: SmallProject) -> None:
    in_knots(small)
    line = line_of(small, "V")
    small.edit(line, line.replace("}", ", confirmed = true}"))
    ran = small.check()
    assert ran.code != 2
    (said,) = ran.messages("unit_implausible")
    assert said["level"] == "warning"


def test_the_envelope_tells_where_nothing_else_does(small: SmallProject) -> None:
    in_knots(small)
    without(small, "v_north", "v_east", "alpha", "h")
    (said,) = small.check().messages("outside_envelope")
    assert said["level"] == "warning"
    assert "'kt'" in said["do"]


def test_a_right_airspeed_is_not_asked_about(small: SmallProject) -> None:
    ran = small.check()
    assert ran.code == 0
    assert not ran.messages("unit_implausible")
    assert not ran.messages("outside_envelope")
