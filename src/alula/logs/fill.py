"""Samples that are no samples: NaN, infinity and fill values such as -9999."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse

# Written by recorders and converters for 'no data'; never taken for one without being asked.
USUAL = (-9999.0, -99999.0, -999999.0, -999.25, 9999.0, 99999.0, -32768.0)
HUGE = 1e30  # netCDF's 9.96921e36 and other impossible values


def take_out(values: Array, fill: list[float] | None, where: str) -> tuple[Array, list[Message]]:
    """`values` (n,) with NaN for infinities and fill values, and what there is to say.

    fill: the values that mean 'no data'; None if nobody said, and then values that look like it
    are refused (BadInput) rather than guessed at.
    """
    messages = []
    bad = ~np.isfinite(values)
    count, infinite = int(bad.sum()), int(np.isinf(values).sum())
    if count:
        messages.append(
            note(
                "not_finite",
                where=where,
                expected="a number in every sample",
                found=f"{count} of {len(values)} empty, NaN or infinite ({infinite} infinite)",
                do="They are NaN from here on; no value was put in their place.",
            )
        )
    if fill is None:
        looks = looks_filled(values)
        if looks is not None:
            value, times = looks
            raise refuse(
                "fill_value",
                where=where,
                expected="measured values",
                found=f"{value:g} in {times} of {len(values)} samples, far from all others",
                do=f"If it means 'no data' write fill_values = [{value:g}], else fill_values = [].",
            )
    filled = np.isin(values, fill) if fill else np.zeros(len(values), dtype=bool)
    if filled.any():
        messages.append(
            note(
                "fill_values",
                where=where,
                expected="a number in every sample",
                found=f"{int(filled.sum())} of {len(values)} are fill values",
                do="They are NaN from here on; no value was put in their place.",
            )
        )
    if infinite or filled.any():
        values = np.where(np.isfinite(values) & ~filled, values, np.nan)
    return values, messages


def looks_filled(values: Array) -> tuple[float, int] | None:
    """A usual fill value that lies outside the span of the other values by more than that span."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return None
    low, high = float(finite.min()), float(finite.max())
    for value in {low, high}:
        if value not in USUAL and abs(value) < HUGE:
            continue
        others = finite[finite != value]
        if len(others) == 0:
            continue
        span = float(np.ptp(others)) + 1e-9 * abs(value)
        if min(abs(value - others.min()), abs(value - others.max())) > span:
            return value, int((finite == value).sum())
    return None
