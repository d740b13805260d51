"""Changes of channels over short windows, and whether two accounts of them go together."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from alula.base.arrays import Array
from alula.flight import Channel


def at(channels: Mapping[str, Channel], name: str, t: Array, angle: bool = False) -> Array | None:
    """A channel at t, linear between samples; None where there is none or it says next to nothing.

    angle: full turns are taken out first.
    """
    channel = channels.get(name)
    if channel is None:
        return None
    good = np.isfinite(channel.values)
    if good.sum() < 2:
        return None
    values = np.unwrap(channel.values[good]) if angle else channel.values[good]
    return np.asarray(np.interp(t, channel.t[good], values))


def integral(t: Array, x: Array) -> Array:
    """Of x (n,) over t (n,) by trapezoids, from zero."""
    return np.concatenate(([0.0], np.cumsum(0.5 * (x[1:] + x[:-1]) * np.diff(t))))


def together(y: Array, x: Array) -> tuple[float, float]:
    """Correlation of the two, and how many times as large as x the first one is; NaN for none."""
    if len(x) < 8 or np.std(x) == 0.0 or np.std(y) == 0.0:
        return math.nan, math.nan
    return float(np.corrcoef(x, y)[0, 1]), float(np.std(y) / np.std(x))
