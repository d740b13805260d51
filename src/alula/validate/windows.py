"""When the pilot moved the controls, and when he left them alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array

# Share of its travel by which a control must leave its first or last position to have moved, and
# within which it must stay to count as fixed: above a pilot's tremor, far below an input.
MOVED = 0.1
LEAST_TRAVEL = np.radians(0.5)  # below this a control is noise and trim, not an input

ASPECT_CONTROLS: Mapping[str, tuple[str, ...]] = {
    "longitudinal": ("de",),
    "lateral": ("da", "dr"),
    "both": ("de", "da", "dr"),
}


@dataclass(frozen=True)
class Input:
    """The input of a maneuver: the control that moved most, first and last movement (s)."""

    control: str
    start: float
    end: float


def moving(controls: Mapping[str, Array], aspect: str) -> dict[str, Array]:
    """The aspect's control surfaces that moved at all, (n,) rad each."""
    return {
        name: controls[name]
        for name in ASPECT_CONTROLS[aspect]
        if name in controls and np.ptp(controls[name]) > LEAST_TRAVEL
    }


def find_input(t: Array, controls: Mapping[str, Array], aspect: str) -> Input | None:
    """The input over times t (n,); None where no surface of the aspect moved."""
    moved = moving(controls, aspect)
    if not moved:
        return None
    first, last = len(t), 0
    for u in moved.values():
        least = MOVED * np.ptp(u)
        first = min(first, int(np.argmax(np.abs(u - u[0]) > least)))
        last = max(last, int(np.flatnonzero(np.abs(u - u[-1]) > least)[-1]))
    main = max(moved, key=lambda name: float(np.ptp(moved[name])))
    return Input(main, float(t[first]), float(t[min(last + 1, len(t) - 1)]))


def free_response(t: Array, controls: Mapping[str, Array], aspect: str) -> slice:
    """The longest stretch, after the input began, in which every control stays where it is.

    Where no control moved it is the whole flight.
    """
    found = find_input(t, controls, aspect)
    if found is None:
        return slice(0, len(t))
    moved = list(moving(controls, aspect).values())
    begin = int(np.searchsorted(t, found.start))
    best, i = slice(begin, begin), begin
    low = [u[begin] for u in moved]
    high = list(low)
    for j in range(begin, len(t)):
        low = [min(a, u[j]) for a, u in zip(low, moved, strict=True)]
        high = [max(a, u[j]) for a, u in zip(high, moved, strict=True)]
        while any(b - a > MOVED * np.ptp(u) for a, b, u in zip(low, high, moved, strict=True)):
            i += 1
            low = [float(u[i : j + 1].min()) for u in moved]
            high = [float(u[i : j + 1].max()) for u in moved]
        if j + 1 - i > best.stop - best.start:
            best = slice(i, j + 1)
    return best
