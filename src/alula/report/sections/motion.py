"""The plots of one maneuver's reconstruction."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np

from alula.base.arrays import Array
from alula.flight import Maneuver, Motion
from alula.reconstruct.result import Segment, SensorFit
from alula.report.figures import Band, Figure, Line, Panel
from alula.report.names import titled, unit_of
from alula.report.numbers import compact, number, shown

_MOTION = {
    "Air data": ("V", "alpha", "beta"),
    "Attitude": ("phi", "theta", "psi"),
    "Rates": ("p", "q", "r"),
    "Angular accelerations": ("pdot", "qdot", "rdot"),
    "Specific force": ("ax", "ay", "az"),
}
_STATES = {
    "u": "Velocity",
    "V": "Air data",
    "phi": "Attitude",
    "b_ax": "Accelerometer biases",
    "b_p": "Rate gyro biases",
}
_PANELS = 3  # states above one another in a figure


def state_figures(segment: Segment) -> Iterator[Figure]:
    """The filter's states, neighbors of one unit in one figure, with bands of ±2 se."""
    names = segment.state_names
    steady = steady_states(segment)
    moving = [k for k in range(len(names)) if names[k] not in steady]
    groups = [list(group) for _, group in groupby(moving, key=lambda k: unit_of(names[k]))]
    # the tall figures first, so that those of one panel do not leave holes beside them
    for members in sorted(groups, key=lambda g: -min(len(g), _PANELS)):
        for first in range(0, len(members), _PANELS):
            chosen = members[first : first + _PANELS]
            first_name = names[chosen[0]]
            alone = titled(first_name) if len(chosen) == 1 else ", ".join(names[k] for k in chosen)
            title = alone if len(chosen) == 1 else _STATES.get(first_name, alone)
            yield Figure(
                title,
                segment.maneuver.id,
                segment.motion.t,
                tuple(_state(segment, k) for k in chosen),
            )


def steady_states(segment: Segment) -> tuple[str, ...]:
    """The states that keep one value and one error: constants, which a table tells better."""

    def steady(values: Array, scale: float) -> bool:
        return bool(np.ptp(values) <= 1e-3 * scale)

    return tuple(
        name
        for name, values, se in zip(
            segment.state_names, segment.states.T, segment.states_se.T, strict=True
        )
        if name.startswith(("b_", "k_", "wind_"))
        and steady(values, float(np.median(se)))
        and steady(se, float(np.median(se)))
    )


def _state(segment: Segment, k: int) -> Panel:
    name = segment.state_names[k]
    factor, unit = shown(unit_of(name))
    values = factor * segment.states[:, k]
    return Panel(
        f"{titled(name)} ({unit})",
        (Line("estimate", values, "estimate"),),
        (Band("±2 se", 2.0 * factor * segment.states_se[:, k], values),),
        small=True,
    )


def motion_figures(motion: Motion) -> Iterator[Figure]:
    """Air data, attitude, rates, accelerations, controls and thrust."""
    for title, names in _MOTION.items():
        yield _figure(title, motion, {n: getattr(motion, n) for n in names})
    if motion.controls:
        yield _figure("Controls", motion, dict(motion.controls))
    if motion.thrust is not None:
        yield _figure("Thrust", motion, {"thrust": motion.thrust})


def _figure(
    title: str,
    motion: Motion,
    columns: dict[str, np.ndarray[tuple[int, ...], np.dtype[np.float64]]],
) -> Figure:
    panels = []
    for name, values in columns.items():
        factor, unit = shown("1" if name == "dt" else unit_of(name))
        line = Line(name, factor * values, "estimate")
        panels.append(Panel(f"{titled(name)} ({unit})", (line,), small=True))
    return Figure(title, motion.maneuver.id, motion.t, tuple(panels))


def sensor_figure(sensor: SensorFit, maneuver: Maneuver, title: str) -> Figure:
    """Measured and fitted above; innovations in their 2 sigma band below, else the residual."""
    factor, unit = shown(sensor.unit)
    if np.isfinite(sensor.innovation).any():
        below = Line("innovation", factor * sensor.innovation, "residual")
        half, name = 2.0 * factor * sensor.innovation_se, "±2 σ"
        what = "innovations"
    else:
        below = Line("measured − fitted", factor * (sensor.measured - sensor.fitted), "residual")
        half, name = np.full(len(sensor.t), 2.0 * factor * sensor.sigma), "±2 σ stated"
        what = "residuals"
    limit = _limit(below.values, half)
    return Figure(
        title,
        maneuver.id,
        sensor.t,
        (
            Panel(
                f"{sensor.name} ({unit})",
                (
                    Line("measured", factor * sensor.measured, "measured"),
                    Line("fitted", factor * sensor.fitted, "model"),
                ),
            ),
            Panel(f"{below.name} ({unit})", (below,), (Band(name, half),), small=True, limit=limit),
        ),
        note=_beyond(sensor.t, below.values, limit, what, unit),
    )


def _limit(values: Array, half: Array) -> float | None:
    """How far the axis of innovations reaches: four median standard deviations (two half bands).

    So a filter's first samples, whose band is that of the initial covariance, do not flatten the
    rest. Wider where more than one sample in fifty would lie outside, or all by little.
    """
    size, bands = np.abs(values[np.isfinite(values)]), half[np.isfinite(half)]
    if not (size.size and bands.size):
        return None
    usual = max(2.0 * float(np.median(bands)), 1.05 * float(np.quantile(size, 0.98)))
    largest = 1.05 * float(size.max())
    limit = largest if usual < largest <= 1.5 * usual else usual
    return limit if limit > 0.0 else None


def _beyond(t: Array, values: Array, limit: float | None, what: str, unit: str) -> str:
    """What the caption says of the samples beyond the axis; empty where there are none."""
    size = np.abs(np.nan_to_num(values))
    count = 0 if limit is None else int((size > limit).sum())
    if not count:
        return ""
    k = int(size.argmax())
    return (
        f"{count} of {len(t)} {what} beyond this axis, marked at its edge; the largest is "
        f"{number(float(values[k]), 3)}\u00a0{unit} at {compact(float(t[k]))}\u00a0s. "
        "Zoom in to less than a tenth of the time to see them."
    )
