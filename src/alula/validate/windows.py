"""When the pilot moved the controls, and when he left them alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array

# Share of the input's travel by which a surface must leave its first or last position to have
# moved, and within which it must stay to count as fixed: above tremor and trim, far below an input.
MOVED = 0.1
LEAST_TRAVEL = np.radians(0.5)  # below this nothing was an input

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


def moving(controls: Mapping[str, Array], aspect: str) -> tuple[dict[str, Array], float]:
    """The aspect's surfaces that moved, (n,) rad each, and the travel (rad) that counts as none."""
    surfaces = {n: controls[n] for n in ASPECT_CONTROLS[aspect] if n in controls}
    travel = max((float(np.ptp(u)) for u in surfaces.values()), default=0.0)
    if travel < LEAST_TRAVEL:
        return {}, 0.0
    still = MOVED * travel
    return {n: u for n, u in surfaces.items() if np.ptp(u) > still}, still


def find_input(t: Array, controls: Mapping[str, Array], aspect: str) -> Input | None:
    """The input over times t (n,); None where no surface of the aspect moved."""
    moved, still = moving(controls, aspect)
    if not moved:
        return None
    first, last = len(t) - 1, 0
    for u in moved.values():
        begun = np.abs(u - u[0]) > still
        ended = np.flatnonzero(np.abs(u - u[-1]) > still)
        first = min(first, int(np.argmax(begun)) if begun.any() else len(t) - 1)
        last = max(last, int(ended[-1]) if len(ended) else 0)
    main = max(moved, key=lambda name: float(np.ptp(moved[name])))
    return Input(main, float(t[first]), float(t[min(last + 1, len(t) - 1)]))


def free_response(t: Array, controls: Mapping[str, Array], aspect: str) -> slice:
    """The longest stretch, after the input began, in which every surface stays where it is.

    Where none moved it is the whole flight.
    """
    found = find_input(t, controls, aspect)
    if found is None:
        return slice(0, len(t))
    moved, still = moving(controls, aspect)
    surfaces = list(moved.values())
    begin = int(np.searchsorted(t, found.start))
    best, i = slice(begin, begin), begin
    for j in range(begin, len(t)):
        while any(np.ptp(u[i : j + 1]) > still for u in surfaces):
            i += 1
        if j + 1 - i > best.stop - best.start:
            best = slice(i, j + 1)
    return best
