"""Time histories against a band: every sample of the response counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.validate.requirement import Requirement, evidence_row, follows
from alula.validate.result import Criterion, Evidence, Flown, Verdict
from alula.validate.windows import find_input

AFTER_INPUT = 5.0  # s after the last movement that belong to the response: two short periods


@dataclass(frozen=True)
class Band:
    """A time history within +-absolute, or +-share of the measured value where that is more."""

    channel: str
    quantity: str
    unit: str
    factor: float
    absolute: float
    share: float = 0.0


def response(flown: Flown) -> tuple[float, float] | None:
    """From the input's beginning to AFTER_INPUT s past its end, within the maneuver."""
    found = find_input(flown.t, flown.controls, flown.maneuver.aspect)
    if found is None:
        return None
    return found.start, min(found.end + AFTER_INPUT, flown.maneuver.end)


def history_row(
    flown: Flown, requirement: Requirement, bands: Sequence[Band], tolerance: str
) -> Evidence:
    """Every sample from the input's beginning to AFTER_INPUT s past its end, against a band."""
    window = response(flown)
    if window is None:
        return evidence_row(
            flown, requirement, tolerance, (), "not_judged", None, "no control surface moved"
        )
    bands = [b for b in bands if flown.channels[b.channel].recorded]
    if not bands:
        return evidence_row(
            flown, requirement, tolerance, (), "not_judged", window, "channel not recorded"
        )
    filled = [b.channel for b in bands if flown.channels[b.channel].as_recorded]
    bands = [b for b in bands if b.channel not in filled]
    if not bands:
        why = follows(filled)
        return evidence_row(flown, requirement, tolerance, (), "not_judged", window, why)
    inside = (flown.t >= window[0]) & (flown.t <= window[1])
    if int(inside.sum()) < 2:
        why = f"the model's flight ended at {flown.t[-1]:.5g} s, before the input"
        verdict: Verdict = "fail" if flown.diverged_at is not None else "not_judged"
        return evidence_row(flown, requirement, tolerance, (), verdict, window, why)
    criteria = tuple(_within(flown, band, inside) for band in bands)
    met = any(c.met for c in criteria)
    if flown.diverged_at is not None and flown.diverged_at < window[1]:
        why = f"the model's flight diverged at {flown.diverged_at:.5g} s"
        return evidence_row(flown, requirement, tolerance, criteria, "fail", window, why)
    if flown.t[-1] < window[1] - 1e-6 - (flown.t[1] - flown.t[0]):
        window = (window[0], float(flown.t[-1]))
    return evidence_row(
        flown, requirement, tolerance, criteria, "pass" if met else "fail", window, ""
    )


def _within(flown: Flown, band: Band, inside: NDArray[np.bool_]) -> Criterion:
    channel = flown.channels[band.channel]
    measured = band.factor * channel.measured[inside]
    model = band.factor * channel.model[inside]
    allowed = np.maximum(band.absolute, band.share * np.abs(measured))
    k = int(np.argmax(np.abs(model - measured) / allowed))
    good = np.abs(model - measured) <= allowed
    return Criterion(
        quantity=band.quantity,
        unit=band.unit,
        measured=float(measured[k]),
        model=float(model[k]),
        deviation=float(model[k] - measured[k]),
        tolerance=float(allowed[k]),
        met=bool(good.all()),
        within_share=float(good.mean()),
    )


def half_width(flown: Flown, band: Band) -> Array | None:
    """Half width (n,) of the tolerance about the measured channel, SI; NaN where not judged.

    None where the channel says nothing about the model, or nothing moved.
    """
    window = response(flown)
    channel = flown.channels[band.channel]
    if window is None or not channel.counts:
        return None
    half = np.maximum(band.absolute, band.share * np.abs(band.factor * channel.measured))
    inside = (flown.t >= window[0]) & (flown.t <= window[1])
    return np.asarray(np.where(inside, half / abs(band.factor), np.nan))
