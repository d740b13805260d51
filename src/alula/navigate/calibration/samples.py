"""Readings fit for a calibration: numbers, inside of the sensor's range."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn

HUGE = 1e9  # no reading in SI is larger; NaN and infinity are none either
MOST_LOST = 0.5  # of all samples: beyond, the recording is no recording
LEVELS = 50  # distinct readings, below which a channel is too coarse to be judged
SHARED = 5  # samples at the same extreme reading
REST = 0.25  # of the span, within which of the median an extreme is the reading at rest
OVER = 3.0  # times as many there as at the reading next to it: noise never does that


def at_limit(readings: Array) -> NDArray[np.bool_]:
    """(n,) whether a reading stands at an extreme that many share: the range ends."""
    stuck = np.zeros(len(readings), dtype=np.bool_)
    levels, count = np.unique(readings[np.isfinite(readings)], return_counts=True)
    if len(levels) < LEVELS:
        return stuck
    middle, span = float(np.nanmedian(readings)), float(levels[-1] - levels[0])
    for end, beside in ((0, 1), (-1, -2)):
        if abs(levels[end] - middle) < REST * span:
            continue  # turned one way only, the sensor rests at its least reading
        if count[end] >= SHARED and count[end] > OVER * count[beside]:
            stuck |= readings == levels[end]
    return stuck


def usable(
    vectors: Array, where: str, limit: float | None = None
) -> tuple[NDArray[np.bool_], list[Message]]:
    """(n,) which vectors (n, 3) are numbers inside of the range, and what there is to say.

    limit: magnitude at which the sensor's range ends; found from the readings if None. Raises
    BadInput if fewer than half of the vectors are usable, or all are the same.
    """
    finite = np.asarray((np.abs(vectors) < HUGE).all(axis=1))
    if limit is not None:
        ends = np.abs(vectors) >= limit
    else:
        ends = np.column_stack([at_limit(v) for v in vectors.T])
    stuck = np.asarray(ends.any(axis=1)) & finite
    good = finite & ~stuck
    said = [
        warn(code, where=where, expected=expected, found=f"{int(bad.sum())} of {len(bad)} {what}",
             do=do)
        for code, bad, expected, what, do in (
            ("not_finite", ~finite, "numbers", "vectors with NaN or infinity",
             "They were left out."),
            ("saturated_sensor", stuck, "readings inside of the sensor's range",
             "vectors at its end", "They were left out. Use a larger range."),
        )
        if bad.any()
    ]  # fmt: skip
    if good.sum() < MOST_LOST * len(good):
        raise refuse(
            "no_usable_samples",
            where=where,
            expected="readings that are numbers inside of the sensor's range",
            found=f"{len(good)} vectors, {int((~finite).sum())} not finite, "
            f"{int(stuck.sum())} at the end of the range",
            do="Record anew, with a larger range if the sensor was at its end.",
        )
    if np.ptp(vectors[good], axis=0).max() == 0.0:
        raise refuse(
            "dead_sensor",
            where=where,
            expected="readings that differ from position to position",
            found=f"{int(good.sum())} times the same",
            do="Check the columns and the sensor.",
        )
    return good, said
