"""Is a recording at rest, and which of its parts are?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse

Places = NDArray[np.intp]  # numbers of windows
WINDOW = 1.0  # s
LOUD = 4.0  # times the median spread of the windows
JUMP = 10.0  # times the usual change of the mean from one window to the next
LEAST_WINDOWS = 8
REST = 1.5  # times the quietest tenth's spread: at rest, when searching for positions
APART = np.radians(10.0)  # between two positions


def moves(y: Array, rate: float, where: str) -> list[Message]:
    """Nothing, for a record at rest; raises BadInput where windows of a second are louder than the
    others or their mean jumps. Slow drift passes: it is what the Allan variance measures."""
    size = max(int(WINDOW * rate), 8)
    count = len(y) // size
    if count < LEAST_WINDOWS:
        return []
    parts = y[: count * size].reshape(count, size)
    spread, mean = parts.std(axis=1), parts.mean(axis=1)
    usual = float(np.median(spread))
    step = np.abs(np.diff(mean))
    usual_step = max(float(np.median(step)), usual / np.sqrt(size))
    loud = np.flatnonzero(spread > LOUD * usual)
    jumps = np.flatnonzero(step > JUMP * usual_step)
    if len(loud) or len(jumps):
        raise _moved(loud, jumps, size / rate, where)
    return []


def _moved(loud: Places, jumps: Places, second: float, where: str) -> BadInput:
    first = int(min([*loud[:1], *jumps[:1]]))
    what = []
    if len(loud):
        what.append(f"{len(loud)} windows over {LOUD:g} times as loud as the others")
    if len(jumps):
        what.append(f"{len(jumps)} jumps of the mean")
    return refuse(
        "still_log_moves",
        where=where,
        expected="a sensor at rest from the first to the last sample",
        found=f"{' and '.join(what)}, the first at {first * second:.1f} s",
        do="State 'start' and 'end' of the part at rest, or record anew, away from people, "
        "fans and traffic.",
    )


def still_parts(t: Array, force: Array, least: float) -> list[tuple[float, float]]:
    """Windows (s) of `least` seconds or more at rest, one for each position in a row.

    force: (n, 3) readings of the accelerometer. At rest is a window of a second whose spread is
    near that of the quietest tenth; a mean that has turned begins a new position.
    """
    rate = 1.0 / float(np.median(np.diff(t)))
    size = max(int(WINDOW * rate / 2), 4)
    count = len(t) // size
    parts = force[: count * size].reshape(count, size, 3)
    spread = np.sqrt(np.var(parts, axis=1).sum(axis=1))
    mean = parts.mean(axis=1)
    finite = np.isfinite(spread)
    if not finite.any():
        return []
    quiet = finite & (spread < REST * 2.0 * np.quantile(spread[finite], 0.1))
    found: list[tuple[float, float]] = []
    first = -1
    for k in range(count + 1):
        same = k < count and quiet[k]
        if same and first >= 0:
            a, b = mean[first], mean[k]
            cosine = float(a @ b / (np.linalg.norm(a) * np.linalg.norm(b)))
            same = np.arccos(np.clip(cosine, -1.0, 1.0)) < APART
        if not same and first >= 0:
            # the first and the last half second are still settling
            start, end = t[min((first + 1) * size, len(t) - 1)], t[(k - 1) * size - 1]
            if end - start >= least:
                found.append((float(start), float(end)))
            first = k if k < count and quiet[k] else -1
        elif same and first < 0:
            first = k
    return found
