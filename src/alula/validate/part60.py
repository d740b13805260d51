"""Verdicts by 14 CFR Part 60 Appendix A, Table A2A, in the edition of 1 January 2014.

The table's objective tests of longitudinal and lateral-directional handling, those that a model of
rigid-body motion with recorded surface positions can be put to: 2.c.9 phugoid, 2.c.10 short
period, 2.d.2 roll rate response, 2.d.6 rudder response, 2.d.7 Dutch roll. The regulation speaks of
simulators; here the flight of the model takes the simulator's place, and flight conditions,
control forces and the number of maneuvers remain the reader's business.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.validate.free_motion import oscillation_rows
from alula.validate.requirement import Requirement
from alula.validate.result import Evidence, Flown
from alula.validate.time_history import Band, half_width, history_row
from alula.validate.windows import find_input

REGULATION = "14 CFR Part 60, Appendix A, Table A2A (1-1-14 edition)"
G = 9.80665

PITCH = Band("theta", "pitch angle", "deg", 180.0 / np.pi, 1.5)
PITCH_RATE = Band("q", "pitch rate", "deg/s", 180.0 / np.pi, 2.0)
NORMAL = Band("az", "normal acceleration", "g", -1.0 / G, 0.10)
ROLL_RATE = Band("p", "roll rate", "deg/s", 180.0 / np.pi, 2.0, 0.10)
YAW_RATE = Band("r", "yaw rate", "deg/s", 180.0 / np.pi, 2.0, 0.10)


@dataclass(frozen=True)
class Test:
    """How one entry is judged. bands: of its time histories, for pictures."""

    requirement: Requirement
    judge: Callable[[Flown, Requirement], list[Evidence]]
    bands: tuple[Band, ...] = ()


def judge(flown: Flown) -> tuple[Evidence, ...]:
    """Every row of evidence that this maneuver gives.

    The tests follow from the maneuver's kind where it names one ('phugoid', 'short_period',
    'dutch_roll', 'roll', 'bank_to_bank', 'rudder_response'); else from the surface that moved
    most: elevator, short period; aileron, roll response; rudder, Dutch roll and rudder response.
    """
    tests = tests_of(flown)
    return tuple(row for test in tests for row in test.judge(flown, test.requirement))


def tests_of(flown: Flown) -> Sequence[Test]:
    """The table's entries that a maneuver serves."""
    kind = flown.maneuver.kind.lower().replace(" ", "_").replace("-", "_")
    for name, tests in _BY_KIND.items():
        if name in kind:
            return tests
    found = find_input(flown.t, flown.controls, flown.maneuver.aspect)
    return () if found is None else _BY_CONTROL[found.control]


def tolerances(flown: Flown) -> dict[str, Array]:
    """Half width (n,) of the tolerance about each judged channel, SI; NaN where not judged."""
    halves = {
        band.channel: half_width(flown, band) for test in tests_of(flown) for band in test.bands
    }
    return {name: half for name, half in halves.items() if half is not None}


def _short_period(flown: Flown, requirement: Requirement) -> list[Evidence]:
    pitch = "±1.5° pitch angle or ±2 °/s pitch rate"
    return [
        history_row(flown, requirement, (PITCH, PITCH_RATE), pitch),
        history_row(flown, requirement, (NORMAL,), "±0.10 g normal acceleration"),
    ]


def _roll_response(flown: Flown, requirement: Requirement) -> list[Evidence]:
    return [history_row(flown, requirement, (ROLL_RATE,), "±10 % or ±2 °/s roll rate")]


def _rudder_response(flown: Flown, requirement: Requirement) -> list[Evidence]:
    return [history_row(flown, requirement, (YAW_RATE,), "±2 °/s or ±10 % yaw rate")]


def _phugoid(flown: Flown, requirement: Requirement) -> list[Evidence]:
    return oscillation_rows(flown, requirement, ("V", "theta"), None)


def _dutch_roll(flown: Flown, requirement: Requirement) -> list[Evidence]:
    return oscillation_rows(flown, requirement, ("beta", "p", "r", "phi"), 0.5)


PHUGOID = Test(Requirement("2.c.9", "Phugoid dynamics"), _phugoid)
SHORT_PERIOD = Test(
    Requirement("2.c.10", "Short period dynamics"), _short_period, (PITCH, PITCH_RATE, NORMAL)
)
ROLL_RESPONSE = Test(Requirement("2.d.2", "Roll response (rate)"), _roll_response, (ROLL_RATE,))
RUDDER_RESPONSE = Test(Requirement("2.d.6", "Rudder response"), _rudder_response, (YAW_RATE,))
DUTCH_ROLL = Test(Requirement("2.d.7", "Dutch roll (yaw damper off)"), _dutch_roll)

_BY_KIND: Mapping[str, Sequence[Test]] = {
    "phugoid": (PHUGOID,),
    "short_period": (SHORT_PERIOD,),
    "dutch_roll": (DUTCH_ROLL,),
    "rudder_response": (RUDDER_RESPONSE,),
    "roll": (ROLL_RESPONSE,),
    "bank_to_bank": (ROLL_RESPONSE,),
    "spiral": (),
}
_BY_CONTROL: Mapping[str, Sequence[Test]] = {
    "de": (SHORT_PERIOD,),
    "da": (ROLL_RESPONSE,),
    "dr": (DUTCH_ROLL, RUDDER_RESPONSE),
}
