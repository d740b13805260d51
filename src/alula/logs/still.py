"""Channels that do not move though the aircraft does: constant, stuck, or held between samples."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, warn
from alula.flight import Channel

# Channels that rest for a whole log without anything being wrong.
MAY_REST = ("df", "gear", "mass", "Ixx", "Iyy", "Izz", "Ixz", "stabilizer", "x_cg", "y_cg", "z_cg")
MAY_REST_ENDS = ("_trim", "_left", "_right")
NEVER_STILL = ("V", "alpha", "beta", "p", "q", "r", "ax", "ay", "az")  # in flight
STUCK_S = 2.0  # s; gusts alone move each of them sooner
GROUND = 5.0  # m/s; below it an airspeed may rest at its least value


def resting(name: str, where: str, channel: Channel) -> list[Message]:
    """Warnings about a channel that rests; where: the log and the channel, for the message."""
    finite = channel.values[np.isfinite(channel.values)]
    return [
        *_constant(name, where, finite),
        *_held(where, channel),
        *_stuck(name, where, channel),
    ]


def _constant(name: str, where: str, values: Array) -> list[Message]:
    if len(values) < 2 or np.ptp(values) > 0 or name in MAY_REST or name.endswith(MAY_REST_ENDS):
        return []
    return [
        warn(
            "constant_channel",
            where=where,
            expected="values that change in flight",
            found=f"{values[0]:.6g} in all {len(values)} samples",
            do="The sensor may be dead; do not use it, or write constant = ... if it is one.",
        )
    ]


def _stuck(name: str, where: str, channel: Channel) -> list[Message]:
    """A sensor of the motion that stands still, to the last digit, after it has moved."""
    values, t = channel.values, channel.t
    if name not in NEVER_STILL or len(values) < 2:
        return []
    changes = np.flatnonzero(np.diff(values) != 0.0) + 1  # NaN counts as a change
    if len(changes) < 20:
        return []  # a coarse step or a constant, of which `_constant` tells
    first, last = np.append(0, changes), np.append(changes, len(values)) - 1
    lasted = t[last] - t[first]
    if name == "V":
        lasted[np.abs(values[first]) < GROUND] = 0.0
    k = int(np.argmax(lasted))
    others = np.delete(lasted, k)
    if lasted[k] < max(STUCK_S, 10.0 * float(np.quantile(others, 0.99))):
        return []  # a coarse or slow sensor is often still
    return [
        warn(
            "stuck_channel",
            where=where,
            expected="values that change in flight",
            found=f"{values[first[k]]:.6g} from {t[first[k]]:.6g} to {t[last[k]]:.6g} s",
            do="If the sensor stuck, end the maneuvers before it or take out the channel.",
        )
    ]


def _held(where: str, channel: Channel) -> list[Message]:
    """A slower sensor written at the log's rate: every value stands the same number of times."""
    changes = np.flatnonzero(np.diff(channel.values)) + 1  # NaN counts as a change
    if not 20 <= len(changes) <= 0.6 * len(channel.values):
        return []
    low, middle, high = np.quantile(np.diff(changes), (0.05, 0.5, 0.95))
    if middle < 2 or high > 1.2 * low:
        return []
    return [
        warn(
            "held_values",
            where=where,
            expected="a new value in each sample",
            found=f"a new value every {middle:g} samples, held between",
            do="Write repeats = 'drop' for it, or each value counts as often as it is repeated.",
        )
    ]
