"""Turns and rests cut out of a recording, and integrated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse, warn
from alula.navigate.calibration.gyro import Turns
from alula.navigate.calibration.samples import at_limit

FIXED = 0.98  # of the path that a turn about a fixed axis makes; the rest is noise
LEAST_SAMPLES = 10


@dataclass(frozen=True)
class Turn:
    """A window of a recording, s. angle: rad, 0 at rest. axis: in body axes, or None."""

    start: float
    end: float
    angle: float = 0.0
    axis: tuple[float, float, float] | None = None


def turns_of(
    t: Array, rate: Array, force: Array | None, windows: Sequence[Turn], where: str = "gyro"
) -> tuple[Turns, list[Message]]:
    """The integrals of raw rate (n, 3) and calibrated specific force (n, 3) over each window.

    Trapezoids, cut at the window's ends. Axes are used if every turn has one. Raises BadInput for
    windows outside of the recording, with a hole, or at the end of the sensor's range.
    """
    f = np.zeros_like(rate) if force is None else force
    good = np.isfinite(rate).all(axis=1) & np.isfinite(f).all(axis=1)
    stuck = np.column_stack([at_limit(v) for v in rate.T]).any(axis=1)
    rows, said = [], []
    for k, window in enumerate(windows):
        label = f"{where}: {window.start:g} to {window.end:g} s"
        inside = (t >= window.start) & (t <= window.end)
        _check(t, window, int(inside.sum()), int((inside & ~good).sum()),
               int((inside & stuck).sum()), label)  # fmt: skip
        at = np.concatenate([[window.start], t[inside], [window.end]])
        values = np.column_stack(
            [np.interp(at, t[good], v[good]) for v in np.column_stack([rate, f]).T]
        )
        whole = np.trapezoid(values, at, axis=0)
        rows.append(np.concatenate([whole, [window.end - window.start]]))
        if window.angle > 0.0:
            unit = whole[:3] / np.linalg.norm(whole[:3])
            smooth = _smoothed(values[:, :3])
            path = float(np.trapezoid(np.linalg.norm(smooth, axis=1), at))
            straight = float(np.trapezoid(smooth @ unit, at))
            if straight < FIXED * path:
                said.append(
                    warn(
                        "axis_wandered",
                        where=f"{label} (turn {k + 1})",
                        expected="a turn about one axis, without swinging back",
                        found=f"{100.0 * (1.0 - straight / path):.1f} % of the path off the axis",
                        do="Turn against a straight edge; an angle about a moving axis is not "
                        "the integral of the rate.",
                    )
                )
    table = np.array(rows)
    axis = None
    if all(w.axis is not None for w in windows if w.angle > 0.0):
        axis = np.array([w.axis if w.axis is not None else (1.0, 0.0, 0.0) for w in windows])
        axis = axis / np.linalg.norm(axis, axis=1)[:, None]
    angle = np.array([w.angle for w in windows])
    return Turns(table[:, :3], table[:, 3:6], table[:, 6], angle, axis), said


def _smoothed(rate: Array) -> Array:
    """Means of about fifty parts of the window: noise makes the path longer, not the turn."""
    width = max(len(rate) // 50, 1)
    kernel = np.ones(width) / width
    held = np.pad(rate, ((width // 2, width - 1 - width // 2), (0, 0)), mode="edge")
    return np.column_stack([np.convolve(v, kernel, "valid") for v in held.T])


def _check(t: Array, window: Turn, count: int, holes: int, stuck: int, label: str) -> None:
    if window.start < t[0] or window.end > t[-1] or count < LEAST_SAMPLES:
        raise refuse(
            "bad_window",
            where=label,
            expected=f"a window of the recording, {t[0]:g} to {t[-1]:g} s, with samples",
            found=f"{count} samples",
            do="Correct 'start' and 'end'.",
        )
    if holes:
        raise refuse(
            "not_finite",
            where=label,
            expected="numbers over the whole turn",
            found=f"{holes} of {count} samples are none",
            do="Leave this turn out; an integral has no holes.",
        )
    if stuck:
        raise refuse(
            "saturated_sensor",
            where=label,
            expected="rates inside of the sensor's range",
            found=f"{stuck} of {count} samples at its end",
            do="Turn more slowly, or set a larger range.",
        )
