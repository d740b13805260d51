"""Samples at which a sensor stands at the end of its range.

They say that the quantity was at least so large, no more; taken for readings they pull the estimate
far beyond its standard errors. Output error leaves them out, as it does with missing ones.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.base.messages import Message, warn
from alula.identify.flown.measured_maneuver import MeasuredManeuver

LEVELS = 50  # distinct readings, below which a sensor is too coarse to be judged
SAMPLES = 5  # at the same extreme reading
OVER = 3.0  # times as many as at the reading next to it; a coarse sensor's peak has 2.4


def saturated(readings: Array) -> NDArray[np.bool_]:
    """(n,) whether a sample stands at an extreme that many share, which noise never makes."""
    stuck = np.zeros(len(readings), dtype=np.bool_)
    levels, count = np.unique(readings[np.isfinite(readings)], return_counts=True)
    if len(levels) < LEVELS:
        return stuck
    for end, beside in ((0, 1), (-1, -2)):
        if count[end] >= SAMPLES and count[end] > OVER * count[beside]:
            at = readings == levels[end]
            # readings a hair inside of the end are chosen by their noise: their neighbors go too
            near = np.convolve(at, np.ones(5), "same") > 0.0
            stuck |= near
    return stuck


def without_saturated(m: MeasuredManeuver) -> tuple[MeasuredManeuver, tuple[Message, ...]]:
    """The maneuver without saturated samples of its outputs, and a warning for each sensor."""
    outputs, said = dict(m.outputs), []
    for name, values in m.outputs.items():
        stuck = saturated(values)
        if stuck.any():
            outputs[name] = np.where(stuck, np.nan, values)
            said.append(
                warn(
                    "saturated_sensor",
                    where=f"maneuver {m.maneuver.id}, {name}",
                    expected="readings inside of the sensor's range",
                    found=f"{int(stuck.sum())} of {len(stuck)} samples at or beside its end",
                    do="They were left out. Use a sensor with more range, or a smaller input.",
                )
            )
    return (replace(m, outputs=outputs), tuple(said)) if said else (m, ())
